#include "postproc/verify/laid_slip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geodesic/measure.h"

namespace meshwind {
namespace {

// Chords in tow widths.
constexpr std::array kChords = {1.0, 2.0, 4.0};

// Along the path, from the nearest station that is lifted or held by a pin.
std::vector<double> distance_to_bridges(const LaidPath& laid) {
    std::vector<double> distance(laid.path.size(), std::numeric_limits<double>::infinity());
    double last = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        last = laid.at[i].lifted || laid.at[i].held ? laid.path[i].s_mm : last;
        distance[i] = laid.path[i].s_mm - last;
    }
    last = std::numeric_limits<double>::infinity();
    for (std::size_t i = laid.path.size(); i-- > 0;) {
        last = laid.at[i].lifted || laid.at[i].held ? laid.path[i].s_mm : last;
        distance[i] = std::min(distance[i], last - laid.path[i].s_mm);
    }
    return distance;
}

}  // namespace

std::vector<double> laid_slip(const Surface& wall, const LaidPath& laid,
                              const LaidSlipOptions& options) {
    const std::vector<double> to_bridge = distance_to_bridges(laid);
    const TautString string = taut_string(laid.path);
    std::vector<double> slip(laid.path.size(), 0.0);
    std::vector<char> open(laid.path.size(), 1);  // not told yet
    for (const double widths : kChords) {
        if (std::find(open.begin(), open.end(), 1) == open.end()) {
            break;
        }
        const double chord_mm = widths * options.tow_width_mm;
        const SlipMeasure measure = measure_slip(
            wall, laid.path, string,
            {.window_mm = chord_mm, .friction = options.friction, .method = TraceMethod::Patches});
        for (std::size_t i = 0; i < slip.size(); ++i) {
            if (open[i] == 0 || to_bridge[i] <= options.tow_width_mm) {
                open[i] = 0;
                continue;
            }
            const double over = measure.slip[i] - options.friction;
            const double over_per_mm =
                over > 0.0 ? std::abs(measure.kg_per_mm[i]) * over / measure.slip[i] : 0.0;
            const double s_mm = laid.path[i].s_mm;
            const double reach_mm = std::min({chord_mm, s_mm, laid.path.back().s_mm - s_mm});
            const bool counts = 0.5 * over_per_mm * reach_mm * reach_mm > options.aside_mm;
            slip[i] = counts ? measure.slip[i] : std::min(measure.slip[i], options.friction);
            open[i] = static_cast<char>(over > 0.0 && !counts);
        }
    }
    return slip;
}

}  // namespace meshwind
