#include "postproc/verify/laid_slip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geodesic/slip_and_bridging.h"

namespace meshwind {
namespace {

// Chords in tow widths.
constexpr std::array kChords = {1.0, 2.0, 4.0};

// Along the path, from the nearest of some stations.
template <class Is>
std::vector<double> distance_to(const LaidPath& laid, const Is& is) {
    std::vector<double> distance(laid.path.size(), std::numeric_limits<double>::infinity());
    double last = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        last = is(laid.at[i]) ? laid.path[i].s_mm : last;
        distance[i] = laid.path[i].s_mm - last;
    }
    last = std::numeric_limits<double>::infinity();
    for (std::size_t i = laid.path.size(); i-- > 0;) {
        last = is(laid.at[i]) ? laid.path[i].s_mm : last;
        distance[i] = std::min(distance[i], last - laid.path[i].s_mm);
    }
    return distance;
}

}  // namespace

std::vector<double> laid_slip(const Surface& wall, const LaidPath& laid,
                              const LaidSlipOptions& options) {
    const auto to_pin = distance_to(laid, [](const LaidAt& at) { return at.held; });
    const auto to_bridge = distance_to(laid, [](const LaidAt& at) { return at.lifted; });
    const TautString string = taut_string(laid.path);
    const double length_mm = laid.path.empty() ? 0.0 : laid.path.back().s_mm;
    std::vector<double> slip(laid.path.size(), 0.0);
    std::vector<std::size_t> open;  // stations that are not told yet
    for (std::size_t i = 0; i < slip.size(); ++i) {
        if (std::min(to_bridge[i], to_pin[i]) > options.tow_width_mm) {
            open.push_back(i);
        }
    }
    for (const double widths : kChords) {
        if (open.empty()) {
            break;
        }
        const double chord_mm = widths * options.tow_width_mm;
        const SlipMeasure measure = measure_slip(
            wall, laid.path, string,
            {.window_mm = chord_mm, .friction = options.friction, .method = TraceMethod::Patches});
        std::erase_if(open, [&](std::size_t i) {
            if (to_pin[i] < chord_mm) {  // it would bend about the pin
                slip[i] = 0.0;
                return true;
            }
            slip[i] = measure.slip[i];
            const double over = slip[i] - options.friction;
            if (over <= 0.0) {
                return true;
            }
            const double to_end_mm = std::min(laid.path[i].s_mm, length_mm - laid.path[i].s_mm);
            const double reach_mm = std::min(chord_mm, to_end_mm);
            const double over_per_mm = std::abs(measure.kg_per_mm[i]) * over / slip[i];
            if (0.5 * over_per_mm * reach_mm * reach_mm > options.aside_mm) {
                return true;
            }
            // No longer chord fits between the ends: there is nothing to tell it by.
            slip[i] = to_end_mm < chord_mm ? 0.0 : slip[i];
            return to_end_mm < chord_mm;
        });
    }
    return slip;
}

}  // namespace meshwind
