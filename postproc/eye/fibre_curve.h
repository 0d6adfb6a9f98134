/// Interpolates the planned fibre between its stations.
#pragma once

#include <Eigen/Core>

#include "postproc/eye/eye_path.h"

namespace meshwind {

/// The fibre at one place: a right-handed frame on the landing point. Mandrel frame, unit vectors.
struct FibreFrame {
    Eigen::Vector3d landing_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();    ///< away from the mandrel
    Eigen::Vector3d binormal = Eigen::Vector3d::UnitY();  ///< normal x tangent
    double free_length_mm = 0.0;

    [[nodiscard]] Eigen::Vector3d eye_mm() const { return landing_mm + free_length_mm * tangent; }
};

[[nodiscard]] FibreFrame fibre_at(const EyePoint& point);

/// Between two neighbouring stations: the landing point on the cubic with the stations' positions
/// and tangents, the tangent along that cubic, the normal turned evenly and kept at a right angle
/// to it, the free length even. Stations closer than kSamePlace_mm (both sides of a feature edge,
/// the joint of two pieces) define no direction between them: there the tangent turns evenly as
/// well. \param share 0 at `from`, 1 at `to`; both ends are met exactly
[[nodiscard]] FibreFrame fibre_between(const EyePoint& from, const EyePoint& to, double share);

/// Positions of stations are good to a few 0.001 mm: over this distance that is a direction to
/// 0.01 rad, at most a quarter of which shows between the ends of the cubic.
inline constexpr double kSamePlace_mm = 0.2;

}  // namespace meshwind
