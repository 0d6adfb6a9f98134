/// The free fibre between the landing point and the delivery eye: which lengths are free of
/// collision.
#pragma once

#include <Eigen/Core>

#include "mesh/ray_query.h"

namespace meshwind {

/// What the machine and the job ask of the free fibre; all lengths mm.
struct FreeFibreRule {
    double min_mm = 60.0;          ///< shortest the machine can wind with
    double preferred_mm = 200.0;   ///< taken where nothing is in the way
    double max_mm = 400.0;         ///< longest the machine can wind with
    double head_radius_mm = 12.0;  ///< ball around the eye that stands for its head
    double clearance_mm = 5.0;     ///< kept between head and anything
    double stand_off_mm =
        0.3;  ///< the ray starts this far above the landing point: facets are not smooth
    double start_mm = 5.0;  ///< and this far along: what the landing facet itself hides
};

/// Free lengths around the one nearest to the preferred. Empty when low_mm > high_mm.
struct FreeFibreWindow {
    double low_mm = 1.0;
    double high_mm = 0.0;

    [[nodiscard]] bool empty() const { return low_mm > high_mm; }
};

/// Lengths L for which the segment from the landing point to the eye at L is free and the head's
/// ball stays clear: the connected piece of [min, max] that holds the length nearest to the
/// preferred one. \param landing_mm, normal, tangent mandrel frame, unit; tangent points to the eye
[[nodiscard]] FreeFibreWindow free_fibre_window(const RayQuery& obstacles,
                                                const Eigen::Vector3d& landing_mm,
                                                const Eigen::Vector3d& normal,
                                                const Eigen::Vector3d& tangent,
                                                const FreeFibreRule& rule);

}  // namespace meshwind
