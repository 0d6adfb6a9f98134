/// Deviation of the laid fibre from the planned one: the only place where a verification sees the
/// plan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "postproc/verify/laydown.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// A station of the plan, on the wall. Mandrel frame.
struct PlannedStation {
    std::int32_t piece = 0;
    std::int32_t point = 0;
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();
    bool lifted = false;  ///< under a bridge
    bool held = false;    ///< by a pin, which sets where the fibre is laid
};

using PlannedFibre = std::vector<PlannedStation>;

/// All stations in winding order.
[[nodiscard]] PlannedFibre planned_fibre(std::span<const Piece> pieces);

struct LaydownTolerance {
    double deviation_mm = 0.2;
    double angle_rad = 0.005;  ///< 0.3 deg
};

/// An error that leads a fibre aside by at most this share of its tolerance does not count: an
/// angle where it comes down from a bridge, or where the normals of two patches differ at their
/// edge; slip over less than a tow's width.
inline constexpr double kUnnoticed = 0.05;

/// Indices are of laid stations.
struct Deviation {
    double max_mm = 0.0;  ///< sideways, in the tangent plane
    std::size_t max_at = 0;
    double max_angle_rad =
        0.0;  ///< between the tangents, in the tangent plane; not of short swings
    std::size_t max_angle_at = 0;
    double end_gap_mm = 0.0;           ///< from the last landing point to the last planned one
    std::vector<std::size_t> wrong;    ///< laid stations beyond a tolerance, ascending
    std::vector<std::size_t> planned;  ///< per laid station: the planned one before it
};

/// Goes along both fibres at once: each laid station is compared with the cubic between the planned
/// stations around it. Over a bridge, from the station before it to the one after, nothing is
/// compared: there the fibre is in the air. An angle beyond the tolerance that goes aside by no
/// more than a twentieth of the deviation allowed, as over a few tenths of a mm where the fibre
/// comes down from a bridge, is a swing and counts as none.
/// \pre planned is not empty
[[nodiscard]] Deviation compare(const LaidPath& laid, const PlannedFibre& planned,
                                const LaydownTolerance& tolerance);

}  // namespace meshwind
