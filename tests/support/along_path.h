/// Places of a path between its stations, for tests that look where a path crosses something.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "geodesic/surface_path.h"

namespace meshwind::test {

struct Here {
    Eigen::Vector3d position_mm, tangent;
};

/// The cubic through both positions with both tangents, whose error is of fourth order in their
/// distance.
inline Here between(const PathPoint& a, const PathPoint& b, double share) {
    const double s = share;
    const double r = 1.0 - s;
    const double way = b.s_mm - a.s_mm;
    const Eigen::Vector3d chord = b.position_mm - a.position_mm;
    const Eigen::Vector3d p = a.position_mm + (3.0 - 2.0 * s) * s * s * chord +
                              way * s * r * (r * a.tangent - s * b.tangent);
    const Eigen::Vector3d t = 6.0 * s * r / way * chord + r * (1.0 - 3.0 * s) * a.tangent -
                              s * (2.0 - 3.0 * s) * b.tangent;
    return {p, t.normalized()};
}

/// Share of the way between two places at which `value` is zero, by halving.
template <class Value>
double zero_between(const PathPoint& a, const PathPoint& b, const Value& value) {
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        ((value(between(a, b, middle)) < 0.0) == (value(between(a, b, 0.0)) < 0.0) ? low : high) =
            middle;
    }
    return 0.5 * (low + high);
}

/// From the direction of a to that of b, counter-clockwise, within half a turn.
inline double turn_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

}  // namespace meshwind::test
