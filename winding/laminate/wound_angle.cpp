#include "winding/laminate/wound_angle.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"
#include "geodesic/jacobi_field.h"
#include "geodesic/trace.h"

namespace meshwind {
namespace {

// A pipe's other curvature is at most this share of that around it.
constexpr double kStraightShare = 0.25;

// From here on fibre is simply off, however far.
constexpr double kOff_rad = 10.0 * kPi / 180.0;

// From a station's tangent to the direction in which the wall is most convex, counter-clockwise,
// -pi/2 to pi/2; nothing where the wall is not like a pipe.
std::optional<double> hoop_from_tangent_rad(const Surface& surface, const PathPoint& station) {
    const CurvatureAlong along = curvature_along(surface, station);
    // The shape operator in tangent and binormal: [[kn, tau], [tau, across]].
    const double mean = 0.5 * (along.normal_per_mm + along.across_per_mm);
    const double half = 0.5 * (along.normal_per_mm - along.across_per_mm);
    const double radius = std::hypot(half, along.torsion_per_mm);
    const double around = mean + radius;  // the most convex principal curvature
    const double axial = mean - radius;
    if (around <= 0.0 || std::abs(axial) > kStraightShare * around) {
        return std::nullopt;
    }
    return 0.5 * std::atan2(along.torsion_per_mm, half);
}

}  // namespace

std::optional<double> winding_angle_rad(const Surface& surface, const PathPoint& station) {
    const auto hoop = hoop_from_tangent_rad(surface, station);
    return hoop ? std::optional(0.5 * kPi - std::abs(*hoop)) : std::nullopt;
}

std::optional<double> axial_direction_rad(const Surface& surface, const SurfacePoint& place) {
    PathPoint station;
    station.at = place;
    station.normal = smooth_normal(surface, place);
    station.tangent = station.normal.unitOrthogonal();
    const auto hoop = hoop_from_tangent_rad(surface, station);
    return hoop ? std::optional(*hoop + 0.5 * kPi) : std::nullopt;
}

AngleKept angle_kept(const Surface& surface, const SurfacePath& path, double wish_rad) {
    AngleKept kept;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const auto angle = winding_angle_rad(surface, path[i]);
        if (!angle) {
            continue;
        }
        const double length = path[i + 1].s_mm - path[i].s_mm;
        const double off = *angle - wish_rad;
        kept.measured_mm += length;
        kept.off_mm += length * std::min(1.0, off * off / (kOff_rad * kOff_rad));
        kept.angle_mm += length * *angle;
        kept.square_mm += length * off * off;
    }
    return kept;
}

WoundAngles wound_angles(const Surface& surface, std::span<const SurfacePath* const> courses,
                         std::optional<double> wish_rad) {
    AngleKept sum;
    for (const SurfacePath* course : courses) {
        const AngleKept kept = angle_kept(surface, *course, wish_rad.value_or(0.0));
        sum.measured_mm += kept.measured_mm;
        sum.off_mm += kept.off_mm;
        sum.angle_mm += kept.angle_mm;
        sum.square_mm += kept.square_mm;
    }
    WoundAngles angles;
    if (sum.measured_mm <= 0.0) {
        return angles;
    }
    angles.measured_mm = sum.measured_mm;
    angles.mean_rad = sum.angle_mm / sum.measured_mm;
    if (wish_rad) {
        angles.wish_rad = wish_rad;
        angles.rms_off_rad = std::sqrt(sum.square_mm / sum.measured_mm);
        angles.off_share = sum.off_mm / sum.measured_mm;
    }
    return angles;
}

}  // namespace meshwind
