/// A body of revolution with a hollow waist: a fibre along it bridges between two shoulders.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "core/units.h"
#include "mesh/mandrel.h"
#include "mesh/mandrel/extension.h"
#include "tests/support/frozen.h"
#include "tests/support/shapes.h"

namespace meshwind::test {

/// Profile of three arcs in (radius, z): shoulders about (ring, -+height), the waist between them
/// about (waist_ring(), 0), from outside. They meet in one tangent.
struct Hourglass {
    double ring_mm = 40.0;
    double height_mm = 12.0;
    double shoulder_mm = 25.0;
    double waist_mm = 25.0;

    [[nodiscard]] double waist_ring_mm() const {
        const double both = shoulder_mm + waist_mm;
        return ring_mm + std::sqrt(both * both - height_mm * height_mm);
    }
    /// The common tangent of the two shoulders, which touches them at z = -+height.
    [[nodiscard]] double line_mm() const { return ring_mm + shoulder_mm; }
    [[nodiscard]] double gap_mm() const { return line_mm() - (waist_ring_mm() - waist_mm); }
    /// Where shoulder and waist meet.
    [[nodiscard]] double joint_mm() const {
        return height_mm * waist_mm / (shoulder_mm + waist_mm);
    }

    /// On the profile at height z: radius, and normal in (radius, z).
    [[nodiscard]] Eigen::Vector2d point(double z) const {
        if (std::abs(z) < joint_mm()) {
            return {waist_ring_mm() - std::sqrt(waist_mm * waist_mm - z * z), z};
        }
        const double above = std::abs(z) - height_mm;
        return {ring_mm + std::sqrt(shoulder_mm * shoulder_mm - above * above), z};
    }
    [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& p) const {
        const double r = p.head<2>().norm();
        Eigen::Vector2d n(r - ring_mm, p.z() - std::copysign(height_mm, p.z()));
        if (std::abs(p.z()) < joint_mm()) {
            n = {waist_ring_mm() - r, -p.z()};
        }
        n.normalize();
        return {n.x() * p.x() / r, n.x() * p.y() / r, n.y()};
    }

    [[nodiscard]] TriangleSoup mesh(double edge_mm) const {
        // Stations at equal angles of the three arcs, ends included.
        const double joint = std::asin(height_mm / (shoulder_mm + waist_mm));
        const double end = rad_from_deg(60.0);
        std::vector<Eigen::Vector2d> profile;
        const auto arc = [&](double ring, double z, double radius, double from, double to) {
            const int n = static_cast<int>(std::ceil(std::abs((to - from) * radius) / edge_mm));
            for (int i = profile.empty() ? 0 : 1; i <= n; ++i) {
                const double angle = from + (to - from) * i / n;
                profile.emplace_back(ring + radius * std::cos(angle),
                                     z + std::abs(radius) * std::sin(angle));
            }
        };
        arc(ring_mm, -height_mm, shoulder_mm, -end, joint);
        arc(waist_ring_mm(), 0.0, -waist_mm, -joint, joint);
        arc(ring_mm, height_mm, shoulder_mm, -joint, end);
        return revolve(profile, static_cast<int>(2.0 * kPi * line_mm() / edge_mm));
    }

    [[nodiscard]] Surface surface(double edge_mm) const { return frozen(mesh(edge_mm)); }
};

}  // namespace meshwind::test
