#include "mesh/segment/spindle_axis.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/angle_gap.h"
#include "core/small_linear.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A wall goes all around its axis when it leaves no wider gap than this, a little more than a prism
// of three sides does. A bend of a quarter or half a turn lies about the axis of its torus as well,
// and nothing could hold it there.
constexpr double kWidestGap_rad = 0.7 * kPi;

struct Line {
    Vector3d origin;
    Vector3d direction;  // unit
    double residual_mm = 0.0;
};

struct PointOnSurface {
    Vector3d point;
    Vector3d normal;
    double area = 0.0;
};

// Vertices with area-weighted normals: on a regular tessellation the noise of facets cancels.
std::vector<PointOnSurface> points_of(const TriangleSoup& surface) {
    std::vector<PointOnSurface> points(surface.points_mm.size());
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
            PointOnSurface& p = points[static_cast<std::size_t>(face[i])];
            p.normal += angle * area / size;
            p.area += size / 3.0;
        }
    }
    for (PointOnSurface& p : points) {
        p.normal.normalize();
    }
    return points;
}

Vector3d centroid_of(const std::vector<PointOnSurface>& points) {
    Vector3d sum = Vector3d::Zero();
    double area = 0.0;
    for (const PointOnSurface& p : points) {
        sum += p.area * p.point;
        area += p.area;
    }
    return sum / area;
}

double distance_from(const Line& line, const Vector3d& point) {
    return (point - line.origin).cross(line.direction).norm();
}

// Largest angle about the line in which there is no surface. Points close to the line have no
// angle.
double gap_about_rad(const Line& line, const std::vector<PointOnSurface>& points,
                     double mean_radius_mm) {
    constexpr double kClose = 0.1;
    const Vector3d u = line.direction.unitOrthogonal();
    const Vector3d v = line.direction.cross(u);
    std::vector<double> angles;
    for (const PointOnSurface& p : points) {
        if (p.area > 0.0 && distance_from(line, p.point) > kClose * mean_radius_mm) {
            const Vector3d arm = p.point - line.origin;
            angles.push_back(std::atan2(v.dot(arm), u.dot(arm)));
        }
    }
    return widest_gap_rad(std::move(angles));
}

std::optional<Line> through_coaxial_rims(std::span<const Rim> rims) {
    std::optional<Line> best;
    double longest = 0.0;
    for (std::size_t i = 0; i < rims.size(); ++i) {
        for (std::size_t j = i + 1; j < rims.size(); ++j) {
            const Vector3d apart = rims[j].centre_mm - rims[i].centre_mm;
            const double distance = apart.norm();
            if (distance <= longest || rims[i].axis.dot(rims[j].axis) > 0.0) {
                continue;
            }
            const double off =
                std::max(apart.cross(rims[i].axis).norm(), apart.cross(rims[j].axis).norm());
            const double turn = rims[i].axis.cross(rims[j].axis).norm();
            if (off <= kCoaxialSine * distance && turn <= kCoaxialSine) {
                longest = distance;
                best = Line{0.5 * (rims[i].centre_mm + rims[j].centre_mm), apart / distance, off};
            }
        }
    }
    return best;
}

// The normals of a surface of revolution meet its axis: (p x n) . a + n . m = 0 for the axis'
// Pluecker coordinates (a, m). Least squares over (a, m) with |a| = 1.
std::optional<Line> of_revolution(const std::vector<PointOnSurface>& points,
                                  const Vector3d& centroid) {
    Eigen::Matrix3d aa = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d am = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d mm = Eigen::Matrix3d::Zero();
    double area = 0.0;
    for (const PointOnSurface& p : points) {
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
    Line line;
    line.residual_mm = std::sqrt(std::max(0.0, axes.values[0]) / area);
    line.direction = axes.vectors.col(0);
    // A sphere turns about every line: keep to the file's Z.
    if (axes.values[2] / area < 4.0 * line.residual_mm * line.residual_mm) {
        line.direction = Vector3d::UnitZ();
    }
    const Vector3d moment = -inverse * am.transpose() * line.direction;
    line.origin = centroid + line.direction.cross(moment);
    double radius = 0.0;
    for (const PointOnSurface& p : points) {
        radius += p.area * distance_from(line, p.point) / area;
    }
    const bool turns = line.residual_mm <= kRevolutionShare * radius &&
                       gap_about_rad(line, points, radius) <= kWidestGap_rad;
    return turns ? std::optional(line) : std::nullopt;
}

// The principal axis that most rims point along, the longer one of equals; without rims the one
// whose moment differs most from the two others.
Vector3d principal_direction(const PrincipalAxes<3>& axes, std::span<const Rim> rims) {
    const Vector3d& moment = axes.values;
    if (rims.empty()) {
        const bool long_one_differs = moment[2] - moment[1] >= moment[1] - moment[0];
        return axes.vectors.col(long_one_differs ? 2 : 0);
    }
    constexpr double kClearlyMore = 1.05;  // less is a tie: the two diagonals of an elbow
    double most = 0.0;
    Vector3d best = Vector3d::UnitZ();
    for (int i = 2; i >= 0; --i) {
        const Vector3d direction = axes.vectors.col(i);
        double along = 0.0;
        for (const Rim& rim : rims) {
            along += std::abs(rim.axis.dot(direction));
        }
        if (along > kClearlyMore * most) {
            most = along;
            best = direction;
        }
    }
    return best;
}

// Moves the line onto the axis of the rim that lies nearest to it, if one nearly does: lettering
// and uneven facets turn the moments, not the rims.
void settle_on_rim(Line& line, std::span<const Rim> rims) {
    constexpr double kNearSine = 0.1;   // 6 deg
    constexpr double kNearShare = 0.1;  // of the rim's radius
    double nearest = kNearShare;
    Line settled = line;
    for (const Rim& rim : rims) {
        const double off = distance_from(line, rim.centre_mm) / rim.radius_mm;
        const double share = rim.axis.cross(line.direction).norm() <= kNearSine ? off : 1.0;
        if (share < nearest) {
            nearest = share;
            settled = {rim.centre_mm, rim.axis, 0.0};
        }
    }
    line = settled;
}

Line principal(const std::vector<PointOnSurface>& points, const Vector3d& centroid,
               std::span<const Rim> rims) {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    double area = 0.0;
    for (const PointOnSurface& p : points) {
        spread += p.area * (p.point - centroid) * (p.point - centroid).transpose();
        area += p.area;
    }
    Line line{centroid, principal_direction(principal_axes(spread), rims), 0.0};
    settle_on_rim(line, rims);
    double mean = 0.0;
    double square = 0.0;
    for (const PointOnSurface& p : points) {
        const double distance = distance_from(line, p.point);
        mean += p.area * distance / area;
        square += p.area * distance * distance / area;
    }
    line.residual_mm = std::sqrt(std::max(0.0, square - mean * mean));
    return line;
}

Vector3d with_positive_lead(const Vector3d& direction) {
    Eigen::Index lead = 0;
    const double largest = direction.cwiseAbs().maxCoeff();
    // The first of nearly equal components leads, so that rounding cannot turn the axis.
    while (std::abs(direction[lead]) < (1.0 - 1e-6) * largest) {
        ++lead;
    }
    return direction[lead] < 0.0 ? Vector3d(-direction) : direction;
}

Vector3d cross_axis(const Line& line, std::span<const Rim> rims) {
    constexpr double kOffAxisShare = 0.1;  // of its radius: nearer rims count as on the axis
    Vector3d best = Vector3d::Zero();
    double farthest = 0.0;
    for (const Rim& rim : rims) {
        const Vector3d arm = rim.centre_mm - line.origin;
        const Vector3d off = arm - line.direction * line.direction.dot(arm);
        if (off.norm() > kOffAxisShare * rim.radius_mm && off.norm() > (1.0 + 1e-6) * farthest) {
            farthest = off.norm();
            best = off;
        }
    }
    if (farthest == 0.0) {
        constexpr double kAlong = 0.9;  // cosine: X this close to the axis gives no direction
        best = std::abs(line.direction.x()) < kAlong ? Vector3d::UnitX() : Vector3d::UnitY();
        best -= line.direction * line.direction.dot(best);
    }
    return best.normalized();
}

}  // namespace

SpindleFrame find_spindle(const TriangleSoup& surface, std::span<const Rim> rims,
                          const std::optional<MandrelOptions::Axis>& given) {
    const std::vector<PointOnSurface> points = points_of(surface);
    const Vector3d centroid = centroid_of(points);
    SpindleFrame frame;
    Line line;
    if (given) {
        line = {given->origin, given->direction.normalized(), 0.0};
        frame.axis.rule = "given";
    } else {
        if (const auto coaxial = through_coaxial_rims(rims)) {
            line = *coaxial;
            frame.axis.rule = "coaxial-rims";
        } else if (const auto revolution = of_revolution(points, centroid)) {
            line = *revolution;
            frame.axis.rule = "revolution";
        } else {
            line = principal(points, centroid, rims);
            frame.axis.rule = "principal";
        }
        if (frame.axis.rule != "coaxial-rims") {
            line.origin += line.direction * line.direction.dot(centroid - line.origin);
        }
        line.direction = with_positive_lead(line.direction);
    }
    frame.axis.residual_mm = line.residual_mm;
    Eigen::Matrix3d rows;
    rows.row(2) = line.direction;
    rows.row(0) = cross_axis(line, rims);
    rows.row(1) = rows.row(2).cross(rows.row(0));
    frame.mandrel_from_file.linear() = rows;
    frame.mandrel_from_file.translation() = -rows * line.origin;
    return frame;
}

}  // namespace meshwind
