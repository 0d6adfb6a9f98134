/// Finds the spindle axis of a mandrel, and the mandrel frame on it.
#pragma once

#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "mesh/mandrel.h"

namespace meshwind {

/// Rims are coaxial when their axes meet the line through their centres under less than this sine
/// (1.7 deg): far above the misfit of exported circles, below any bend made on purpose.
inline constexpr double kCoaxialSine = 0.03;

/// A surface of revolution misses its axis by less than this share of its mean radius: facets of a
/// pipe with twelve sides miss by half of it.
inline constexpr double kRevolutionShare = 0.03;

struct SpindleFrame {
    SpindleAxis axis;
    Eigen::Isometry3d mandrel_from_file = Eigen::Isometry3d::Identity();  ///< lengths in mm
};

/// The given axis (its origin becomes the mandrel's); else the pair of coaxial rims that lie
/// farthest apart; else the axis of revolution of the surface; else the principal axis of inertia
/// that most rims point along (moved onto a rim's own axis where that is near), or without rims the
/// one whose moment differs most from the two others. The residual in mm is the largest distance of
/// the two centres' axes from the other centre, the rms distance of the surface's normals from the
/// axis, or the rms scatter of the surface's distance from the axis. +Z points along the larger
/// component of the file's axes; the origin is the middle between coaxial rims, else the centroid's
/// foot on the axis; +X points to the rim farthest off the axis, where there is one off it, else
/// along the file's X (or Y). \param surface the winding surface, in the file's frame, mm \param
/// rims its rims
[[nodiscard]] SpindleFrame find_spindle(const TriangleSoup& surface, std::span<const Rim> rims,
                                        const std::optional<MandrelOptions::Axis>& given);

}  // namespace meshwind
