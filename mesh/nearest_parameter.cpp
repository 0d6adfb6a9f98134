#include "mesh/nearest_parameter.h"

#include <algorithm>
#include <limits>

#include "core/roots.h"

namespace meshwind {

double nearest_parameter(const ParameterRange& range, const std::function<double(double)>& distance,
                         const std::function<double(double)>& slope) {
    // A curve that turns by a right angle bends little in a sixteenth of it: the nearest sample's
    // neighbours bracket the minimum.
    constexpr int kSteps = 16;
    const auto parameter = [&](int step) {
        return range.low + (range.high - range.low) * step / kSteps;
    };
    int best = 0;
    double least = std::numeric_limits<double>::max();
    for (int step = 0; step <= kSteps; ++step) {
        const double value = distance(parameter(step));
        if (value < least) {
            least = value;
            best = step;
        }
    }
    const double low = parameter(std::max(best - 1, 0));
    const double high = parameter(std::min(best + 1, kSteps));
    const double slope_low = slope(low);
    const double slope_high = slope(high);
    if (slope_low >= 0.0) {
        return low;
    }
    if (slope_high <= 0.0) {
        return high;
    }
    return zero_between({low, high, slope_low, slope_high}, slope).middle();
}

}  // namespace meshwind
