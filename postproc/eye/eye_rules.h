/// Eye rules: the point of the free fibre at which the delivery eye stands.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "postproc/eye/eye_path.h"

namespace meshwind {

/// All but Adaptive are strict: the free length comes from the rule and nothing else. Collisions
/// are then found by the checks and not avoided. docs/post.md says more.
enum class EyeRule {
    EqualFreeLength,  ///< L is the job's free length for the place
    Cylinder,         ///< the eye keeps its distance from the spindle axis
    HorizontalPlane,  ///< the eye keeps its height; seen along the spindle the fibre is vertical
    VerticalPlane,    ///< the eye keeps its distance across; seen along the spindle the fibre is
                      ///< horizontal
    Adaptive          ///< the preferred length, changed where something is in the way
};

/// Properties of a rule.
struct EyeRuleTraits {
    EyeRule rule = EyeRule::Adaptive;
    std::string_view word;  ///< in job files
    /// The free length is a number of the job; else it follows from where the eye is.
    bool reads_free_length = false;
    bool forces_turn = false;  ///< it sets the turn of the mandrel
};

/// One row per rule, in the order of the enumerators.
inline constexpr std::array kEyeRules = {
    EyeRuleTraits{EyeRule::EqualFreeLength, "equal-free-length", true, false},
    EyeRuleTraits{EyeRule::Cylinder, "cylinder", false, false},
    EyeRuleTraits{EyeRule::HorizontalPlane, "horizontal-plane", false, true},
    EyeRuleTraits{EyeRule::VerticalPlane, "vertical-plane", false, true},
    EyeRuleTraits{EyeRule::Adaptive, "adaptive", true, false},
};

[[nodiscard]] constexpr const EyeRuleTraits& traits_of(EyeRule rule) {
    return kEyeRules[static_cast<std::size_t>(rule)];
}

/// As the job file says it.
[[nodiscard]] constexpr std::string_view name_of(EyeRule rule) {
    return traits_of(rule).word;
}

/// A stretch of fibre with a free length of its own.
struct LengthPiece {
    std::optional<std::int32_t> piece;  ///< a whole piece of the program, or:
    double from_mm = 0.0;               ///< fibre laid since the start of the program
    double to_mm = 0.0;                 ///< > from_mm
    double free_length_mm = 0.0;        ///< > 0
};

/// A rule with its numbers.
struct EyeLaw {
    EyeRule rule = EyeRule::Adaptive;
    double free_length_mm = 200.0;     ///< > 0; EqualFreeLength, Adaptive
    std::vector<LengthPiece> lengths;  ///< EqualFreeLength: of several for a place the last holds
    double radius_mm = 0.0;            ///< > 0; Cylinder
    double plane_x_mm = 0.0;           ///< > 0; VerticalPlane, machine frame
    double plane_y_mm = 0.0;           ///< not 0; HorizontalPlane, machine frame
};

/// Eye points by a strict rule.
///  - EqualFreeLength (fu_2009_post_processing, sec. 1): L is free_length_mm, or that of the
///    pieces. It changes by no more than the rates of free_fibre.h: the longer length holds all
///    over its own stretch, and the change lies in the shorter one. L is the shortest that respects
///    the given lengths and keeps the rates.
///  - Cylinder (andrianov_2022_machine_path; chen_2023_gas_cylinders with its y = 0): where the
///    free fibre leaves the cylinder about the spindle axis. With P at the radius rho, the fibre's
///    radial and tangential parts t_r and t_th and q = t_r^2 + t_th^2
///        L = (-rho t_r + sqrt(rho^2 t_r^2 + q (radius^2 - rho^2))) / q.
///  - VerticalPlane, HorizontalPlane: in the machine the eye is in the plane x = plane_x or
///    y = plane_y, and the mandrel is turned so that the fibre meets the plane squarely, seen along
///    the spindle: L = (plane - rho t_r / sqrt(q)) / sqrt(q), and the eye is off the spindle, along
///    the plane, by the fibre's lever arm rho t_th / sqrt(q). EyePoint::azimuth_rad passes the turn
///    on.
/// Blocked are points without such an eye, and those at which the free fibre is shorter or longer
/// than the machine can wind with; the eye is then at the nearest length that it can.
/// \param range only its shortest and longest length count \pre law.rule is not Adaptive
[[nodiscard]] EyePathResult strict_eye_path(std::span<const Piece> pieces, const EyeLaw& law,
                                            const FreeFibreRule& range);

/// Eye points by any rule. \param more_clearance_mm, search as for adaptive_free_length(); other
/// rules ignore them
[[nodiscard]] EyePathResult eye_path(std::span<const Piece> pieces, const EyeLaw& law,
                                     const RayQuery& obstacles, const FreeFibreRule& rule,
                                     std::span<const double> more_clearance_mm = {},
                                     LengthSearch search = LengthSearch::Near);

}  // namespace meshwind
