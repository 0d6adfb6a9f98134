/// Collision-free lengths of the free fibre between the landing point and the delivery eye.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "mesh/ray_query.h"

namespace meshwind {

/// A round part of the machine that follows the eye on the line leading radially away from the
/// spindle axis.
struct ArmPart {
    double from_mm = 0.0;  ///< distance of its axis' ends from the eye, outward
    double to_mm = 0.0;
    double radius_mm = 0.0;
};

/// Limits of the machine and the job for the free fibre; all lengths mm.
struct FreeFibreRule {
    double min_mm = 60.0;          ///< shortest the machine can wind with
    double preferred_mm = 200.0;   ///< taken where nothing is in the way
    double max_mm = 400.0;         ///< longest the machine can wind with
    double head_radius_mm = 10.0;  ///< ball around the eye that stands for its head
    std::vector<ArmPart> arm{};    ///< the parts that carry the head
    double clearance_mm = 5.0;     ///< kept between head, arm and anything
    double stand_off_mm = 0.3;     ///< the ray starts this far above the landing point: facets are
                                   ///< not smooth
    double start_mm = 5.0;         ///< and this far along: what the landing facet itself hides
};

/// A range of free lengths. Empty when low_mm > high_mm.
struct FreeFibreWindow {
    double low_mm = 1.0;
    double high_mm = 0.0;

    [[nodiscard]] bool empty() const { return low_mm > high_mm; }
};

/// Lengths L for which the segment from the landing point to the eye at L is free and head and arm
/// stay clear, as ascending separate ranges. Lengths over the preferred one are tried only where
/// none up to it is possible. \param landing_mm, normal, tangent mandrel frame, unit; tangent
/// points to the eye
[[nodiscard]] std::vector<FreeFibreWindow> free_fibre_windows(const RayQuery& obstacles,
                                                              const Eigen::Vector3d& landing_mm,
                                                              const Eigen::Vector3d& normal,
                                                              const Eigen::Vector3d& tangent,
                                                              const FreeFibreRule& rule);

/// Estimated distance of head and arm to the nearest obstacle beyond the clearance, with the eye at
/// a place; negative where the clearance is broken.
/// \param outward unit, where the arm leads away from the eye
/// \param more_mm clearance on top of the rule's
[[nodiscard]] double head_spare_mm(const RayQuery& obstacles, const FreeFibreRule& rule,
                                   const Eigen::Vector3d& eye_mm, const Eigen::Vector3d& outward,
                                   double more_mm = 0.0);

/// True when head_spare_mm() is not negative: cheaper.
[[nodiscard]] bool is_head_clear(const RayQuery& obstacles, const FreeFibreRule& rule,
                                 const Eigen::Vector3d& eye_mm, const Eigen::Vector3d& outward,
                                 double more_mm = 0.0);

/// The longest free fibre that meets nothing, up to the rule's.
[[nodiscard]] double unobstructed_mm(const RayQuery& obstacles, const Eigen::Vector3d& landing_mm,
                                     const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent,
                                     const FreeFibreRule& rule);

/// True when `length_mm` is one of the lengths that free_fibre_windows() tells: much cheaper.
[[nodiscard]] bool is_free_length(const RayQuery& obstacles, const Eigen::Vector3d& landing_mm,
                                  const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent,
                                  const FreeFibreRule& rule, double length_mm);

/// Largest growth of the free length per fibre laid (no unit): the fibre then runs through the eye
/// three times as fast as it is laid.
inline constexpr double kLengtheningRate = 3.0;

/// Largest shrinkage per fibre laid (no unit): below 1 fibre always runs out of the eye and never
/// goes slack.
inline constexpr double kShorteningRate = 0.8;

/// Ranges of free length that can be kept to along a path: at each station every length from low to
/// high.
struct FreeLengths {
    std::vector<double> low_mm;
    std::vector<double> high_mm;
    /// Stations without a window, or with none that can be reached from the one before; empty on
    /// success. The lengths before and behind such a station can be kept to.
    std::vector<std::size_t> blocked;
};

/// Chooses one window at each station and narrows them until the length can change from each to the
/// next within the rates above. Among the choices that pass it takes one that stays near
/// `preferred_mm`.
/// \param s_mm ascending arc length \param windows per station, as from free_fibre_windows
[[nodiscard]] FreeLengths choose_free_lengths(std::span<const double> s_mm,
                                              std::span<const std::vector<FreeFibreWindow>> windows,
                                              double preferred_mm);

}  // namespace meshwind
