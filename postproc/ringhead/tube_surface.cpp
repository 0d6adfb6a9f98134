#include "postproc/ringhead/tube_surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Newton's steps for a foot: four do from a tenth of the radius of curvature away.
constexpr int kFootSteps = 20;
constexpr double kFoot_mm = 1e-10;

FrameAxis without_turn(const FrameAxis& axis) {
    std::vector<AxisStation> stations = axis.stations();
    // What meets the head at the start, so that round angles count from there.
    stations.front().reference = axis.at(0.0).reference;
    for (std::size_t i = 0; i < stations.size(); ++i) {
        stations[i].turn_rad = 0.0;
        if (i > 0) {
            const AxisStation& before = stations[i - 1];
            stations[i].reference =
                carried_reference(before.point_mm, before.tangent, stations[i].point_mm,
                                  stations[i].tangent, before.reference);
        }
    }
    return FrameAxis(std::move(stations));
}

}  // namespace

TubeSurface::TubeSurface(const FrameAxis& axis, double radius_mm)
    : axis_(without_turn(axis)), radius_mm_(radius_mm) {
    assert(radius_mm > 0.0);
    const auto count = static_cast<std::size_t>(std::ceil(length_mm() / kCurvatureStep_mm)) + 1;
    for (std::size_t i = 0; i < count; ++i) {
        const double s = static_cast<double>(i) * kCurvatureStep_mm;
        const double low = std::max(0.0, s - 0.5 * kCurvatureStep_mm);
        const double high = std::min(length_mm(), s + 0.5 * kCurvatureStep_mm);
        curvature_.emplace_back(Vector3d::Zero());
        if (high > low) {
            curvature_.back() = (axis_.at(high).tangent - axis_.at(low).tangent) / (high - low);
        }
    }
}

AxisFrame TubeSurface::axis_at(double s_mm) const {
    AxisFrame frame = axis_.at(s_mm);
    frame.point_mm += (s_mm - std::clamp(s_mm, 0.0, length_mm())) * frame.tangent;
    return frame;
}

Vector3d TubeSurface::axis_curvature(double s_mm) const {
    if (s_mm < 0.0 || s_mm > length_mm()) {
        return Vector3d::Zero();
    }
    const double place = s_mm / kCurvatureStep_mm;
    const std::size_t low = std::min(static_cast<std::size_t>(place), curvature_.size() - 1);
    const std::size_t high = std::min(low + 1, curvature_.size() - 1);
    const double share = place - static_cast<double>(low);
    return (1.0 - share) * curvature_[low] + share * curvature_[high];
}

TubeFoot TubeSurface::foot(const Vector3d& point_mm, double near_s_mm) const {
    TubeFoot found;
    found.s_mm = near_s_mm;
    AxisFrame frame = axis_at(near_s_mm);
    for (int step = 0; step < kFootSteps; ++step) {
        const Vector3d away = point_mm - frame.point_mm;
        const double ahead_mm = away.dot(frame.tangent);
        if (std::abs(ahead_mm) < kFoot_mm) {
            break;
        }
        // Not below a quarter: near the centre of a bend the step would be boundless.
        const double slope = std::max(0.25, 1.0 - away.dot(axis_curvature(found.s_mm)));
        found.s_mm += ahead_mm / slope;
        frame = axis_at(found.s_mm);
    }
    Vector3d away = point_mm - frame.point_mm;
    away -= away.dot(frame.tangent) * frame.tangent;
    found.distance_mm = away.norm();
    found.normal = found.distance_mm > 0.0 ? Vector3d(away / found.distance_mm) : frame.reference;
    found.tangent = frame.tangent;
    found.round_rad = std::atan2(found.normal.dot(frame.tangent.cross(frame.reference)),
                                 found.normal.dot(frame.reference));
    found.surface_mm = frame.point_mm + radius_mm_ * found.normal;
    return found;
}

Vector3d TubeSurface::point(double s_mm, double round_rad) const {
    const AxisFrame frame = axis_at(s_mm);
    return frame.point_mm +
           radius_mm_ * (std::cos(round_rad) * frame.reference +
                         std::sin(round_rad) * frame.tangent.cross(frame.reference));
}

double TubeSurface::stretch(const TubeFoot& foot) const {
    return 1.0 - radius_mm_ * foot.normal.dot(axis_curvature(foot.s_mm));
}

double TubeSurface::normal_curvature(const TubeFoot& foot, const Vector3d& direction) const {
    const double along = direction.dot(foot.tangent);
    const double round = direction.dot(foot.tangent.cross(foot.normal));
    const double inward = foot.normal.dot(axis_curvature(foot.s_mm));
    return round * round / radius_mm_ - along * along * inward / (1.0 - radius_mm_ * inward);
}

}  // namespace meshwind
