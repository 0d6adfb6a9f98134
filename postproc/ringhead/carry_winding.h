/// Winding by the rings of `meshwind carry`: the pattern, and the fibre laid by the written
/// programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "postproc/ringhead/frame_axis.h"
#include "postproc/ringhead/krl.h"
#include "postproc/ringhead/ring_cover.h"
#include "postproc/ringhead/ring_drive.h"
#include "postproc/ringhead/ring_head.h"
#include "postproc/ringhead/ring_laydown.h"
#include "postproc/ringhead/ring_pattern.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// Options of the winding.
struct CarryWindingOptions {
    std::optional<double> spool_radius_mm{};  ///< where fibres leave a ring; none: its opening
    int passes = 0;                           ///< 0: as few as cover
    bool at_once = false;                     ///< RingPassageTask::at_once
    double angle_tolerance_deg = 1.0;         ///< on regular arms; in bends their swing besides
    std::optional<double> friction{};         ///< none: the slip is reported and not judged
    std::optional<double> tow_tex{};          ///< g per km; none: no mass
};

/// The winding task, and the programs that do it.
struct CarryWindingTask {
    const RingHead& head;
    const FrameAxis& axis;
    const std::vector<double>& s_mm;  ///< of the points of the program
    std::string forth;                ///< text of the program
    std::string back;                 ///< of the one back; not read where all is wound at once
    double tube_radius_mm = 20.0;
    double angle_rad = 0.0;  ///< > 0, < pi/2
    int tows = 12;
    double tow_width_mm = 0.0;  ///< 0: the narrowest that covers
};

struct CarryWinding {
    RingPattern pattern;
    double spool_radius_mm = 0.0;
    double lag_mm = 0.0;
    double bend_radius_mm = 0.0;  ///< infinity without a bend
    double zone_from_mm = 0.0;    ///< where both rings' fibres are to lie
    double zone_to_mm = 0.0;
    std::vector<RingPassage> passages;
    std::string rings;  ///< text of rings.csv
    std::vector<RingFibre> fibres;
    RingCover cover;
    RingQuality quality;
    std::size_t bridges = 0;
    double fibre_mm = 0.0;      ///< laid, all tows
    std::vector<Check> checks;  ///< laydown, bridging, slip (with a friction), coverage, thickness
};

/// Makes the rings' table, reads it and the programs back from their texts, lays the fibre of every
/// spool and judges it. \throws InputError carry.spool, carry.short, carry.tight
[[nodiscard]] CarryWinding wind_carried(const CarryWindingTask& task,
                                        const CarryWindingOptions& options);

/// `pass,ring,spool,s_mm,round_deg,x_mm,y_mm,z_mm,angle_deg`: the landing curves, mandrel frame.
[[nodiscard]] std::string fibre_csv(const std::vector<RingFibre>& fibres);

/// Largest scatter of layers on regular arms, standard deviation over mean.
inline constexpr double kRegularCv = 0.02;

}  // namespace meshwind
