#include "mesh/segment/spindle_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/angle_gap.h"
#include "mesh/segment/spindle_axis.h"

namespace meshwind {

using Eigen::Vector3d;

namespace {

double area_of(const std::vector<WeighedPoint>& points) {
    double area = 0.0;
    for (const WeighedPoint& p : points) {
        area += p.area;
    }
    return area;
}

}  // namespace

std::vector<WeighedPoint> weighed_points(const TriangleSoup& surface) {
    std::vector<WeighedPoint> points(surface.points_mm.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
        points[v] = {surface.points_mm[v], Vector3d::Zero(), 0.0};
    }
    for (const auto& face : surface.faces) {
        const auto corner = [&](std::size_t i) -> const Vector3d& {
            return surface.points_mm[static_cast<std::size_t>(face[i % 3])];
        };
        const Vector3d area = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0));
        const double size = area.norm();
        for (std::size_t i = 0; i < 3 && size > 0.0; ++i) {
            const Vector3d a = corner(i + 1) - corner(i);
            const Vector3d b = corner(i + 2) - corner(i);
            const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
            WeighedPoint& p = points[static_cast<std::size_t>(face[i])];
            p.normal += angle * area / size;
            p.area += size / 3.0;
        }
    }
    for (WeighedPoint& p : points) {
        p.normal.normalize();
    }
    return points;
}

Vector3d centroid_of(const std::vector<WeighedPoint>& points) {
    Vector3d sum = Vector3d::Zero();
    double area = 0.0;
    for (const WeighedPoint& p : points) {
        sum += p.area * p.point;
        area += p.area;
    }
    return sum / area;
}

double distance_from(const SpindleLine& line, const Vector3d& point) {
    return (point - line.origin).cross(line.direction).norm();
}

double mean_distance_from(const SpindleLine& line, const std::vector<WeighedPoint>& points) {
    const double area = area_of(points);
    double radius = 0.0;
    for (const WeighedPoint& p : points) {
        radius += p.area * distance_from(line, p.point) / area;
    }
    return radius;
}

double scatter_about(const SpindleLine& line, const std::vector<WeighedPoint>& points) {
    const double area = area_of(points);
    const double mean = mean_distance_from(line, points);
    double square = 0.0;
    for (const WeighedPoint& p : points) {
        const double distance = distance_from(line, p.point);
        square += p.area * distance * distance / area;
    }
    return std::sqrt(std::max(0.0, square - mean * mean));
}

double gap_about_rad(const SpindleLine& line, const std::vector<WeighedPoint>& points,
                     double mean_radius_mm) {
    constexpr double kClose = 0.1;
    const Vector3d u = line.direction.unitOrthogonal();
    const Vector3d v = line.direction.cross(u);
    std::vector<double> angles;
    for (const WeighedPoint& p : points) {
        if (p.area > 0.0 && distance_from(line, p.point) > kClose * mean_radius_mm) {
            const Vector3d arm = p.point - line.origin;
            angles.push_back(std::atan2(v.dot(arm), u.dot(arm)));
        }
    }
    return widest_gap_rad(std::move(angles));
}

std::vector<CoaxialRims> coaxial_rims(std::span<const Rim> rims) {
    std::vector<CoaxialRims> found;
    for (std::size_t i = 0; i < rims.size(); ++i) {
        for (std::size_t j = i + 1; j < rims.size(); ++j) {
            const Vector3d apart = rims[j].centre_mm - rims[i].centre_mm;
            const double distance = apart.norm();
            if (!(distance > 0.0) || rims[i].axis.dot(rims[j].axis) > 0.0) {
                continue;
            }
            const double off =
                std::max(apart.cross(rims[i].axis).norm(), apart.cross(rims[j].axis).norm());
            const double turn = rims[i].axis.cross(rims[j].axis).norm();
            if (off <= kCoaxialSine * distance && turn <= kCoaxialSine) {
                found.push_back(
                    {{0.5 * (rims[i].centre_mm + rims[j].centre_mm), apart / distance, off},
                     distance,
                     i,
                     j});
            }
        }
    }
    return found;
}

// The normals of a surface of revolution meet its axis: (p x n) . a + n . m = 0 for the axis'
// Pluecker coordinates (a, m). Least squares over (a, m) with |a| = 1.
SpindleLine line_of_normals(const std::vector<WeighedPoint>& points, const Vector3d& centroid) {
    Eigen::Matrix3d aa = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d am = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d mm = Eigen::Matrix3d::Zero();
    double area = 0.0;
    for (const WeighedPoint& p : points) {
        const Vector3d arm = (p.point - centroid).cross(p.normal);
        aa += p.area * arm * arm.transpose();
        am += p.area * arm * p.normal.transpose();
        mm += p.area * p.normal * p.normal.transpose();
        area += p.area;
    }
    // Along a cylinder's axis no normal points: there the moment is free and stays zero.
    const PrincipalAxes<3> moments = principal_axes(mm);
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) {
        if (moments.values[i] > 1e-3 * area) {
            const Vector3d e = moments.vectors.col(i);
            inverse += e * e.transpose() / moments.values[i];
        }
    }
    const PrincipalAxes<3> axes =
        principal_axes(Eigen::Matrix3d(aa - am * inverse * am.transpose()));
    SpindleLine line;
    line.residual_mm = std::sqrt(std::max(0.0, axes.values[0]) / area);
    line.direction = axes.vectors.col(0);
    // A sphere turns about every line: keep to the file's Z.
    if (axes.values[2] / area < 4.0 * line.residual_mm * line.residual_mm) {
        line.direction = Vector3d::UnitZ();
    }
    const Vector3d moment = -inverse * am.transpose() * line.direction;
    line.origin = centroid + line.direction.cross(moment);
    return line;
}

PrincipalAxes<3> inertia_of(const std::vector<WeighedPoint>& points, const Vector3d& centroid) {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const WeighedPoint& p : points) {
        spread += p.area * (p.point - centroid) * (p.point - centroid).transpose();
    }
    return principal_axes(spread);
}

}  // namespace meshwind
