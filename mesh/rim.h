/// Rims: the boundary loops of the winding surface.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// A boundary loop of the winding surface: where courses end. Mandrel frame.
struct Rim {
    std::int32_t id = 0;
    Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, pointing away from the mandrel
    double radius_mm = 0.0;       ///< mean distance of the loop from the axis, notches left out
    double circularity_mm = 0.0;  ///< largest distance of a vertex from that circle
    double cut_off_mm =
        0.0;  ///< length cut off the part beyond it: a rounded lip, tabs, a notched edge
    std::vector<std::int32_t> vertices;  ///< surface vertices in loop order
};

}  // namespace meshwind
