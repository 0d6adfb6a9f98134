/// Surface points, paths over the surface, and the taut string and slip of a path.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// A point in a face by barycentric coordinates (sum 1, each >= -kBaryEps).
struct SurfacePoint {
    std::int32_t face = kNoFace;
    Eigen::Vector3d bary = Eigen::Vector3d::Constant(1.0 / 3.0);
};

/// One station of a path. Mandrel frame; all directions unit.
struct PathPoint {
    SurfacePoint at;
    Eigen::Vector3d position_mm;
    Eigen::Vector3d normal;   ///< smooth outward normal
    Eigen::Vector3d tangent;  ///< direction of travel, perpendicular to `normal`
    double s_mm = 0.0;        ///< arc length from the path's start
    double kn_per_mm = 0.0;   ///< normal curvature, > 0 where tension presses the fibre on
    double kg_per_mm = 0.0;   ///< geodesic curvature, > 0 to the left of travel seen from outside
};

using SurfacePath = std::vector<PathPoint>;

/// The same way travelled backwards; arc length counts from the new start.
[[nodiscard]] SurfacePath reversed(const SurfacePath& path);

/// The taut string over a path: where the fibre really is. One entry per station.
struct TautString {
    std::vector<double> gap_mm;  ///< height of the string over the surface, >= 0
    std::vector<double> slope;   ///< rise of the string against the path's tangent, mm per mm
    double worst_gap_mm = 0.0;
    std::size_t worst_station = 0;
};

/// Position and direction of the fibre at a station, on the taut string over the path.
struct StringPoint {
    Eigen::Vector3d position_mm;
    Eigen::Vector3d tangent;
};
[[nodiscard]] StringPoint string_point(const PathPoint& point, double gap_mm, double slope);

/// Slip measured from the positions of a finished path, independent of how it was steered.
struct SlipMeasure {
    std::vector<double> slip;  ///< per station, |kg| / kn; 0 where the fibre is straight or lifted
    std::vector<double> kg_per_mm;  ///< per station, measured
    std::vector<double> error;  ///< per station, stated error of the ratio; the friction where the
                                ///< ratio has no meaning, infinite where nothing was measured
    double worst = 0.0;
    std::size_t worst_station = 0;
};

/// A place beside a point on the Hermite cubic between two places, whose unit tangents are scaled
/// by the chord. Where both places coincide, as on a crease, it is the first.
struct CubicPlace {
    double share;  ///< of the chord, 0..1
    Eigen::Vector3d position_mm;
    Eigen::Vector3d tangent;  ///< unit
};

[[nodiscard]] inline CubicPlace beside(const Eigen::Vector3d& a_mm,
                                       const Eigen::Vector3d& a_tangent,
                                       const Eigen::Vector3d& b_mm,
                                       const Eigen::Vector3d& b_tangent,
                                       const Eigen::Vector3d& point_mm) {
    const Eigen::Vector3d chord = b_mm - a_mm;
    const double length = chord.norm();
    if (length == 0.0) {
        return {0.0, a_mm, a_tangent};
    }
    const double s = std::clamp((point_mm - a_mm).dot(chord) / (length * length), 0.0, 1.0);
    const double r = 1.0 - s;
    const Eigen::Vector3d in = length * a_tangent - chord;
    const Eigen::Vector3d out = chord - length * b_tangent;
    const Eigen::Vector3d bulge = r * in + s * out;
    return {s, a_mm + s * chord + s * r * bulge,
            (chord + (r - s) * bulge + s * r * (out - in)).normalized()};
}

}  // namespace meshwind
