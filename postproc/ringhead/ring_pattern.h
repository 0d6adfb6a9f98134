/// Winding pattern of a ring head: spools needed, winding angle in a bend, amount of fibre.
#pragma once

#include <limits>

namespace meshwind {

/// One layer to either side, wound on a tube by the spools of a ring each.
struct RingPatternTask {
    double tube_radius_mm = 20.0;
    double angle_rad = 0.0;     ///< from the axis, > 0, < pi/2
    int spools = 12;            ///< on each ring, >= 1
    double tow_width_mm = 0.0;  ///< > 0; 0: the narrowest that covers, in kTowWidthStep_mm
    int passes = 0;  ///< of each ring over the frame; 0: as few as cover (one where the width is 0)
    double bend_radius_mm = std::numeric_limits<double>::infinity();  ///< tightest of the axis
    double laid_mm = 0.0;  ///< length of axis that each ring's fibres cover
};

/// Fibres that advance evenly along the axis: d(round)/ds = tan(angle) / r, so that on a bend,
/// where the surface is longer or shorter than the axis by 1 -+ r/R, tan(laid) = tan(angle) / (1 -+
/// r/R).
struct RingPattern {
    double tows_needed = 0.0;          ///< 2 pi r cos(angle) / width: to cover a straight arm
    double tows_needed_outside = 0.0;  ///< the same outside the bend, where most are needed
    int passes = 1;
    double offset_rad = 0.0;  ///< between the passes of a ring, round the tube: 2 pi / (n passes)
    double tow_width_mm = 0.0;
    double coverage = 0.0;          ///< layers of one ring on a straight arm, all passes
    double coverage_outside = 0.0;  ///< where the bend spreads them most; covered where >= 1
    double inside_rad = 0.0;        ///< angle inside the bend
    double outside_rad = 0.0;       ///< and outside
    /// Layers inside against layers outside: cos(outside) / cos(inside).
    double thickness_ratio = 1.0;
    /// Least angle at which fibre inside the bend is not hollow below: atan sqrt(r / (R - r)).
    double bridging_rad = 0.0;
    double fibre_per_tow_mm = 0.0;  ///< laid / cos(angle); a bend changes it by under (r/R)^2
    double fibre_mm = 0.0;          ///< of all tows of both rings in all passes
};

/// \throws InputError carry.tight where the bend's radius is no larger than the tube's
/// \pre 0 < angle_rad < pi/2
[[nodiscard]] RingPattern ring_pattern(const RingPatternTask& task);

/// Widths that are chosen are rounded up to this: finer than tows are made.
inline constexpr double kTowWidthStep_mm = 0.1;

/// `width_mm` up to the next step.
[[nodiscard]] double next_tow_width_mm(double width_mm);

/// Fibre of `length_mm` at `tex` (g per km), kg.
[[nodiscard]] double fibre_mass_kg(double length_mm, double tex);

}  // namespace meshwind
