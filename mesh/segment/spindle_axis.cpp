#include "mesh/segment/spindle_axis.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "core/small_linear.h"
#include "mesh/segment/spindle_lines.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// The two that lie farthest apart.
std::optional<SpindleLine> through_coaxial_rims(std::span<const Rim> rims) {
    const std::vector<CoaxialRims> found = coaxial_rims(rims);
    const auto longest = std::max_element(
        found.begin(), found.end(),
        [](const CoaxialRims& a, const CoaxialRims& b) { return a.apart_mm < b.apart_mm; });
    return longest == found.end() ? std::nullopt : std::optional(longest->line);
}

std::optional<SpindleLine> of_revolution(const std::vector<WeighedPoint>& points,
                                         const Vector3d& centroid) {
    const SpindleLine line = line_of_normals(points, centroid);
    const double radius = mean_distance_from(line, points);
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
void settle_on_rim(SpindleLine& line, std::span<const Rim> rims) {
    constexpr double kNearSine = 0.1;   // 6 deg
    constexpr double kNearShare = 0.1;  // of the rim's radius
    double nearest = kNearShare;
    SpindleLine settled = line;
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

SpindleLine principal(const std::vector<WeighedPoint>& points, const Vector3d& centroid,
                      std::span<const Rim> rims) {
    SpindleLine line{centroid, principal_direction(inertia_of(points, centroid), rims), 0.0};
    settle_on_rim(line, rims);
    line.residual_mm = scatter_about(line, points);
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

Vector3d cross_axis(const SpindleLine& line, std::span<const Rim> rims) {
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
    const std::vector<WeighedPoint> points = weighed_points(surface);
    const Vector3d centroid = centroid_of(points);
    SpindleFrame frame;
    SpindleLine line;
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
