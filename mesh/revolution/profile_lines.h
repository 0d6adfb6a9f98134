/// Finds straight stretches of a profile given by scattered points.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "mesh/revolution/profile_points.h"

namespace meshwind {

/// Points at nearly one arc length: a ring of vertices, or a short stretch of scattered ones.
struct ProfilePlace {
    Eigen::Vector2d at_mm = Eigen::Vector2d::Zero();  ///< mean
    double arc_mm = 0.0;                              ///< mean
    double low_mm = 0.0;                              ///< least and largest arc
    double high_mm = 0.0;
    double spread_mm = 0.0;   ///< root mean square of the points' distances from the mean
    double spacing_mm = 0.0;  ///< of its first point
    std::size_t first = 0;    ///< of the points
    std::size_t last = 0;     ///< one behind
};

/// \param points ascending arc
[[nodiscard]] std::vector<ProfilePlace> places_of(std::span<const ProfilePoint> points);

struct ProfileLine {
    Eigen::Vector2d origin_mm = Eigen::Vector2d::Zero();  ///< (radius, z)
    Eigen::Vector2d way = Eigen::Vector2d::UnitY();       ///< unit, towards growing arc

    /// \return > 0 on the right of the way, where outside is
    [[nodiscard]] double off_mm(const Eigen::Vector2d& p) const {
        const Eigen::Vector2d arm = p - origin_mm;
        return arm.x() * way.y() - arm.y() * way.x();
    }
    [[nodiscard]] double along_mm(const Eigen::Vector2d& p) const {
        return (p - origin_mm).dot(way);
    }
    [[nodiscard]] Eigen::Vector2d foot_mm(const Eigen::Vector2d& p) const {
        return origin_mm + along_mm(p) * way;
    }
};

/// A stretch of places, both ends included, that is a line or is not; neighbours share a place or
/// leave at most one between.
struct ProfileStretch {
    bool straight = false;
    std::size_t first = 0;
    std::size_t last = 0;
    ProfileLine line;  ///< of a straight one
};

/// Typical distance of places from a smooth curve through their neighbours, or less where they are
/// rings whose vertices lie nearer together.
[[nodiscard]] double scatter_mm(std::span<const std::vector<ProfilePlace>> sections);

/// \param tolerance_mm places this near to a line are on it \param precision_mm of the coordinates
[[nodiscard]] std::vector<ProfileStretch> stretches_of(std::span<const ProfilePoint> points,
                                                       const std::vector<ProfilePlace>& places,
                                                       double tolerance_mm, double precision_mm);

}  // namespace meshwind
