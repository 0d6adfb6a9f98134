/// Table of the ring drives of a ring head, for each passage of the frame.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "postproc/ringhead/krl.h"
#include "postproc/ringhead/ring_head.h"
#include "postproc/ringhead/ring_laydown.h"

namespace meshwind {

/// One ring winding on one way of the frame through the head.
struct RingPassage {
    int pass = 0;              ///< from 0; each has both rings
    int ring = 0;              ///< 0: ahead of the centre, 1: behind it, along the head's direction
    bool back = false;         ///< the frame is carried from the end of its axis to the start
    bool right_handed = true;  ///< turn of the ring against the frame about the head's direction
    double phase_rad = 0.0;    ///< of the first spool: passes lie between one another
    double wait_mm = 0.0;      ///< axis length before the ring starts to turn against the frame
    double tie_s_mm = 0.0;     ///< where the fibres are tied on
    double end_s_mm = 0.0;     ///< where they land at last, on a straight end
};

struct RingPassageTask {
    double length_mm = 0.0;  ///< of the axis
    double lag_mm = 0.0;     ///< landing_lag_mm
    int passes = 1;
    double offset_rad = 0.0;  ///< RingPattern::offset_rad
    /// Both rings wind on the way forth. Else each winds on the way on which the frame meets it
    /// first: its fibres then land near the head's centre, where the frame is held square. Those of
    /// the other ring land lag + distance / 2 behind it, where a bend has left the head's axis.
    bool at_once = false;
};

/// The passages in their order. A ring waits until fibres tied on the frame's end, as far behind
/// its plane as they will land, have the wanted angle: then the angle is right from the start.
[[nodiscard]] std::vector<RingPassage> ring_passages(const RingHead& head,
                                                     const RingPassageTask& task);

/// The program that carries a frame back along the moves on which it came.
/// \param start_nano axis values at its end, where the way back begins
[[nodiscard]] KrlProgram back_program(const KrlProgram& forth, const std::string& name,
                                      const std::array<std::int64_t, 6>& start_nano);

struct RingRow {
    double time_s = 0.0;
    double s_mm = 0.0;      ///< of the axis in the head
    double ring_rad = 0.0;  ///< right-handed about the head's direction, from 0
};

/// Rows at the program's points and where the wait ends: the frame's own turn and
/// 2 pi turns_per_mm of passage more, so that fibres advance evenly along the axis.
/// \param s_mm of the program's points, in its order
[[nodiscard]] std::vector<RingRow> drive_ring(const RingPassage& passage, const KrlProgram& program,
                                              const std::vector<double>& s_mm, const RingHead& head,
                                              double turns_per_mm);

/// `pass,ring,time_s,s_mm,ring_deg`, a row for each; passes and rings from 1.
[[nodiscard]] std::string rings_csv(const std::vector<RingPassage>& passages,
                                    const std::vector<std::vector<RingRow>>& rows);

/// The rows of one passage as knots, both rings alike. \throws InputError rings.column,
/// rings.number
[[nodiscard]] std::vector<RingKnot> read_rings_csv(std::string_view text, const std::string& file,
                                                   const RingPassage& passage);

}  // namespace meshwind
