/// Small closed-form shapes for the tests of mesh/.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/triangle_soup.h"

namespace meshwind::test {

/// Surface of revolution about Z through the (radius, z) points of `profile`; outside is to the
/// right of the profile's direction seen with z up and radius to the right, that is a profile
/// running up. A closed profile (first point given again at the end) makes a torus-like solid, a
/// radius of 0 a pole.
inline TriangleSoup revolve(const std::vector<Eigen::Vector2d>& profile, int segments) {
    TriangleSoup soup;
    const auto index = [&](std::size_t ring, int s) {
        return static_cast<std::int32_t>(ring) * segments + s % segments;
    };
    for (const Eigen::Vector2d& p : profile) {
        for (int s = 0; s < segments; ++s) {
            const double angle = 2.0 * kPi * s / segments;
            soup.points_mm.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
        }
    }
    for (std::size_t r = 0; r + 1 < profile.size(); ++r) {
        for (int s = 0; s < segments; ++s) {
            if (profile[r].x() > 0.0) {
                soup.faces.push_back({index(r, s), index(r, s + 1), index(r + 1, s)});
            }
            if (profile[r + 1].x() > 0.0) {
                soup.faces.push_back({index(r, s + 1), index(r + 1, s + 1), index(r + 1, s)});
            }
        }
    }
    return soup;
}

/// Open tube about Z from z = 0 to `length`.
inline TriangleSoup tube(double radius, double length, int segments, int rings = 4) {
    std::vector<Eigen::Vector2d> profile;
    for (int i = 0; i <= rings; ++i) {
        profile.emplace_back(radius, length * i / rings);
    }
    return revolve(profile, segments);
}

/// Hollow solid pipe: outer wall, bore and two annular ends.
inline TriangleSoup pipe(double outer, double inner, double length, int segments) {
    return revolve({{outer, 0.0}, {outer, length}, {inner, length}, {inner, 0.0}, {outer, 0.0}},
                   segments);
}

inline TriangleSoup moved(TriangleSoup soup, const Eigen::Isometry3d& motion) {
    for (Eigen::Vector3d& p : soup.points_mm) {
        p = motion * p;
    }
    return soup;
}

inline void add(TriangleSoup& soup, const TriangleSoup& more) {
    const auto offset = static_cast<std::int32_t>(soup.points_mm.size());
    soup.points_mm.insert(soup.points_mm.end(), more.points_mm.begin(), more.points_mm.end());
    for (const auto& [a, b, c] : more.faces) {
        soup.faces.push_back({a + offset, b + offset, c + offset});
    }
}

/// Axis-parallel box, outside in front.
inline TriangleSoup box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    TriangleSoup soup;
    for (int i = 0; i < 8; ++i) {
        soup.points_mm.emplace_back(i % 2 == 0 ? low.x() : high.x(),
                                    i / 2 % 2 == 0 ? low.y() : high.y(),
                                    i / 4 == 0 ? low.z() : high.z());
    }
    soup.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return soup;
}

}  // namespace meshwind::test
