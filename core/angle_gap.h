/// The widest gap between directions about an axis.
#pragma once

#include <algorithm>
#include <vector>

#include "core/units.h"

namespace meshwind {

/// \param angles_rad each within one turn of the others; a single one leaves a whole turn, none 0
[[nodiscard]] inline double widest_gap_rad(std::vector<double> angles_rad) {
    if (angles_rad.empty()) {
        return 0.0;
    }
    std::sort(angles_rad.begin(), angles_rad.end());
    double widest = angles_rad.front() + 2.0 * kPi - angles_rad.back();
    for (std::size_t i = 1; i < angles_rad.size(); ++i) {
        widest = std::max(widest, angles_rad[i] - angles_rad[i - 1]);
    }
    return widest;
}

}  // namespace meshwind
