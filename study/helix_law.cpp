#include "study/helix_law.h"

#include <cmath>

#include "core/roots.h"

namespace meshwind {

CurveState helix_state(const Helix& helix, double s_mm) {
    const double turn = s_mm * std::sin(helix.angle_rad) / helix.radius_mm;
    const Eigen::Vector3d out(std::cos(turn), std::sin(turn), 0.0);
    const Eigen::Vector3d around(-out.y(), out.x(), 0.0);
    CurveState state;
    state.position_mm = helix.radius_mm * out;
    state.position_mm.z() = s_mm * std::cos(helix.angle_rad);
    state.tangent = std::sin(helix.angle_rad) * around;
    state.tangent.z() = std::cos(helix.angle_rad);
    return state;
}

EyeError helix_error(TangentRule rule, const Helix& helix, const Spacing& spacing,
                     double free_length_mm) {
    const CurveState here = helix_state(helix, 0.0);
    const Landing landing{.before = helix_state(helix, -spacing.before_mm).position_mm,
                          .here = here.position_mm,
                          .after = helix_state(helix, spacing.after_mm).position_mm,
                          .traced = here.tangent};
    return eye_error(here.position_mm, here.tangent, tangent_by(rule, landing), free_length_mm);
}

double spacing_for_c_error_mm(TangentRule rule, const Helix& helix, double free_length_mm,
                              double c_error_rad, double longest_mm) {
    constexpr int kBits = 48;  // all but what the differences of positions lose by rounding
    const auto excess = [&](double spacing_mm) {
        return std::abs(helix_error(rule, helix, {spacing_mm, spacing_mm}, free_length_mm).c_rad) -
               c_error_rad;
    };
    const double at_longest = excess(longest_mm);
    if (at_longest <= 0.0) {
        return longest_mm;
    }
    // From where rounding hides the error to the longest: a bracket for any error asked in earnest.
    const double shortest_mm = 1e-6 * longest_mm;
    const double at_shortest = excess(shortest_mm);
    if (at_shortest >= 0.0) {
        return shortest_mm;
    }
    return zero_between({shortest_mm, longest_mm, at_shortest, at_longest}, excess, {.bits = kBits})
        .middle();
}

}  // namespace meshwind
