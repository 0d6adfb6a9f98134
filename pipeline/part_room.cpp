#include "pipeline/part_room.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshwind {
namespace {

constexpr std::size_t kSlices = 1000;

}  // namespace

double head_gap_mm(const Machine& machine, const HeadEnvelope& envelope) {
    double gap = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d& eye = machine.eye.position_mm;
    for (const HeadEnvelope::Part& part : envelope.parts) {
        for (const Eigen::Vector3d& point : part.triangles.points_mm) {
            gap = std::min(gap, (point - eye).norm());
        }
        if (part.triangles.points_mm.empty()) {
            const Eigen::Vector3d along = part.capsule.to_mm - part.capsule.from_mm;
            const double length2 = along.squaredNorm();
            const double share =
                length2 > 0.0
                    ? std::clamp((eye - part.capsule.from_mm).dot(along) / length2, 0.0, 1.0)
                    : 0.0;
            gap = std::min(
                gap, (eye - part.capsule.from_mm - share * along).norm() - part.capsule.radius_mm);
        }
    }
    return gap;
}

double free_length_over_cylinder_mm(double radius_mm, double off_mm, double sine) {
    return std::sqrt(off_mm * (2.0 * radius_mm + off_mm)) / sine;
}

std::vector<Eigen::Vector2d> outline(const TriangleSoup& part) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Eigen::Vector3d& point : part.points_mm) {
        low = std::min(low, point.z());
        high = std::max(high, point.z());
    }
    std::vector<Eigen::Vector2d> widest(kSlices, {-1.0, 0.0});
    for (const Eigen::Vector3d& point : part.points_mm) {
        const double share = high > low ? (point.z() - low) / (high - low) : 0.0;
        auto& slice =
            widest[std::min(kSlices - 1, static_cast<std::size_t>(share * double{kSlices}))];
        const double radius = point.head<2>().norm();
        if (radius > slice.x()) {
            slice = {radius, point.z()};
        }
    }
    std::erase_if(widest, [](const Eigen::Vector2d& at) { return at.x() < 0.0; });
    return widest;
}

}  // namespace meshwind
