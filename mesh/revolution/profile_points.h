/// Orders the vertices of a surface of revolution along its meridian (radius, z).
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "mesh/rim.h"
#include "mesh/surface.h"

namespace meshwind {

/// An end of a body of revolution.
struct MeridianEnd {
    enum class Kind { Rim, Pole };
    Kind kind = Kind::Rim;
    std::int32_t rim = -1;  ///< id of the rim, -1 at a pole
};

struct ProfilePoint {
    Eigen::Vector2d at_mm = Eigen::Vector2d::Zero();  ///< (radius, z)
    double arc_mm = 0.0;      ///< along the chords of the meridian from its first end
    double spacing_mm = 0.0;  ///< to the second nearest vertex beside it
};

/// A circle of feature edges about the axis.
struct ProfileCrease {
    Eigen::Vector2d at_mm = Eigen::Vector2d::Zero();  ///< mean of its vertices
    double low_mm = 0.0;                              ///< least and largest arc of its vertices
    double high_mm = 0.0;
};

struct ProfilePoints {
    std::vector<ProfilePoint> points;    ///< ascending arc
    std::vector<ProfileCrease> creases;  ///< ascending
    std::array<MeridianEnd, 2> end;
    std::array<Eigen::Vector2d, 2> end_mm;  ///< mean of a rim's vertices; of a pole (0, z) nearly
    std::string why_not;  ///< not empty: the surface is no body of revolution about Z, in words
};

/// Arc lengths are shortest paths over the edges, measured in the half plane: motion about the axis
/// costs nothing, so meridians of any form are put in order. The first end is the lower one, unless
/// outside would lie on the left of the way up.
[[nodiscard]] ProfilePoints profile_points(const Surface& surface, std::span<const Rim> rims);

}  // namespace meshwind
