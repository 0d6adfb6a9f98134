/// Errors of the tangent rules on an exact helix, without any mesh.
#pragma once

#include "study/path_reference.h"
#include "study/tangent_rules.h"

namespace meshwind {

struct Helix {
    double radius_mm = 70.0;
    double angle_rad = 0.0;  ///< winding angle, from the axis
};

/// Point and direction after `s_mm` of fibre from (radius, 0, 0), counter-clockwise about +z, and
/// along it.
[[nodiscard]] CurveState helix_state(const Helix& helix, double s_mm);

/// Arc lengths to the landing points before and after, > 0.
struct Spacing {
    double before_mm = 1.0;
    double after_mm = 1.0;
};

/// \pre rule is not TangentRule::Traced
/// Source: fu_2009_post_processing, sec. 1. Leading terms for equal spacing h with D = h sin b / R:
/// chord dC = -(D / 2) L^2 sin^2 b / (R^2 + L^2 sin^2 b), direction D sin b / 2; central dC = -(R L
/// sin b cos^2 b / (R^2 + L^2 sin^2 b)) D^2 / 6, direction D^2 sin b cos b / 6.
[[nodiscard]] EyeError helix_error(TangentRule rule, const Helix& helix, const Spacing& spacing,
                                   double free_length_mm);

/// Equal spacing in mm at which |dC| is `c_error_rad`; `longest_mm` when it is smaller up to there.
/// \pre rule is not TangentRule::Traced; |dC| grows with the spacing up to `longest_mm`
[[nodiscard]] double spacing_for_c_error_mm(TangentRule rule, const Helix& helix,
                                            double free_length_mm, double c_error_rad,
                                            double longest_mm);

}  // namespace meshwind
