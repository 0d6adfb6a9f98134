/// Nearest point of a plane or space curve given by a parameter.
#pragma once

#include <functional>

namespace meshwind {

struct ParameterRange {
    double low = 0.0;
    double high = 0.0;
};

/// Parameter of the least `distance` in the range, to the last digits of `slope`'s zero.
/// \param distance any rising function of the distance \param slope a positive multiple of its
/// derivative \pre the curve turns by at most about a right angle over the range
[[nodiscard]] double nearest_parameter(const ParameterRange& range,
                                       const std::function<double(double)>& distance,
                                       const std::function<double(double)>& slope);

}  // namespace meshwind
