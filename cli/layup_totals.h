/// What layers put on the first one's mandrel, face by face.
#pragma once

#include <span>
#include <vector>

#include "cli/wind_layer.h"

namespace meshwind {

/// Per face of the first layer's surface; grown mandrels keep its triangles.
struct LayupTotals {
    std::vector<double> layers;
    std::vector<double> thickness_mm;
    std::vector<double> angle_deg;  ///< mean between fibre and spindle axis, 0..90, by layers
};

/// \pre layers is not empty, each has a plan
[[nodiscard]] LayupTotals layup_totals(std::span<const WoundLayer> layers);

}  // namespace meshwind
