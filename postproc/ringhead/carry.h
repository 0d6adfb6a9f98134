/// Winding of a frame that a robot carries through a fixed ring head: motion, program, fibres. No
/// file is read or written.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "machines/machine.h"
#include "postproc/ringhead/carried_path.h"
#include "postproc/ringhead/carry_axis.h"
#include "postproc/ringhead/carry_winding.h"
#include "postproc/ringhead/frame_axis.h"
#include "postproc/ringhead/krl.h"
#include "postproc/ringhead/ring_head.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// The paper's frame.
inline constexpr double kTubeRadius_mm = 20.0;

struct CarryRequest {
    std::string name = "program";  ///< of the program and its file
    double speed_mm_s = 20.0;      ///< passage of the frame's axis through the head
    double tolerance_mm = 0.2;     ///< largest distance of the axis from the centre of the head
    double tolerance_deg = 0.2;    ///< largest error of the frame's turn
    /// None: that of the mesh; with a table kTubeRadius_mm.
    std::optional<double> tube_radius_mm;
    double ring_radius_mm = 40.0;
    double ring_distance_mm = 70.0;
    double clearance_mm = 5.0;           ///< of the frame from bodies on the machine's base
    double angle_deg = 45.0;             ///< wanted of the rings' fibres, one ring to each side
    int tows = 12;                       ///< on each ring
    std::optional<double> tow_width_mm;  ///< none: the narrowest that covers
    CarryWindingOptions winding;
    /// Frame of the axis' table on the robot's flange: x, y, z in mm, a, b, c in deg.
    std::array<double, 6> tool{};
    bool force = false;
};

/// Result of one ring.
struct RingResult {
    double lowest_deg = 0.0;  ///< angle laid where the ring turns at one speed all the way
    double highest_deg = 0.0;
    double slowest_rev_min = 0.0;  ///< speeds that keep the wanted angle
    double fastest_rev_min = 0.0;
};

struct CarryOutcome {
    explicit CarryOutcome(CarryAxis along) : axis(std::move(along)) {}

    CarryAxis axis;
    CarryRequest request;
    double tube_radius_mm = 0.0;
    Machine machine;
    RingHead head;
    std::size_t stations = 0;
    double length_mm = 0.0;
    CarryPoints points;
    RingFit fit;
    std::vector<CarriedSample> samples;
    CarriedJoints joints;
    TimedPath planned;               ///< with the limits that set the moves' time
    KrlProgram program;              ///< as it was read back
    std::vector<double> duration_s;  ///< of its moves
    CarryError program_error;        ///< on its moves
    AxisLoads loads;                 ///< of its moves
    double turns_per_mm = 0.0;       ///< of a ring, for the wanted angle
    std::array<RingResult, 2> ring;  ///< right-handed, left-handed
    double longitudinal_deg = 0.0;   ///< largest lean of fibres along the axis, of the frame's turn
    std::optional<CarryWinding> winding;  ///< none at an angle of 0: the rings stand still
    /// ring, reach, limits, wrist, clearance (with bodies), interpolation, rounding, and those of
    /// `winding`
    std::vector<Check> checks;
    bool usable = false;    ///< the programs may be run: all checks passed, or by force
    std::string text;       ///< of the program
    std::string back_text;  ///< of that for the way back; empty where there is none
    std::string motion;     ///< motion.csv

    [[nodiscard]] bool passed() const;
    /// Whether a program for the way back belongs to it.
    [[nodiscard]] bool winds_back() const;
    [[nodiscard]] double total_s() const;
};

/// Plans motion, program and winding, reads the program back from its text and checks it.
/// \param machine its eye stands still: the centre of the head
/// \param machine_file as messages name it
/// \throws InputError carry.*, krl.*
[[nodiscard]] CarryOutcome carry(CarryAxis axis, const Machine& machine,
                                 const CarryRequest& request,
                                 const std::string& machine_file = "machine");

/// Frame on the flange from X,Y,Z,A,B,C. \throws InputError carry.tool
[[nodiscard]] std::array<double, 6> tool_of(const std::string& text);

}  // namespace meshwind
