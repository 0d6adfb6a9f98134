/// Where the delivery eye must be for every landing point.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// One landing point and its eye. Mandrel frame; directions unit.
struct EyePoint {
    std::int32_t piece = 0;      ///< index of the course or transition in winding order
    std::int32_t point = 0;      ///< index within the piece
    double s_mm = 0.0;           ///< fibre laid since the start of the program
    Eigen::Vector3d landing_mm;  ///< P, where the fibre touches down
    Eigen::Vector3d tangent;     ///< tau, from the landing point along the free fibre to the eye
    Eigen::Vector3d binormal;    ///< across the band; the roller is to be parallel to it, sign free
    Eigen::Vector3d eye_mm;      ///< E = P + free_length tau
    double free_length_mm = 0.0;
};

using EyePath = std::vector<EyePoint>;

}  // namespace meshwind
