#include "machines/drawn_starts.h"

#include <cmath>

#include "core/units.h"

namespace meshwind {
namespace {

constexpr unsigned kSeed = 1;
constexpr double kEndless_rad = kPi;

}  // namespace

DrawnStarts::DrawnStarts(const Machine& machine, const DrawnStartsOptions& options)
    : machine_(machine), options_(options), engine_(kSeed) {}

std::vector<double> DrawnStarts::next(std::span<const double> at_hand) {
    std::vector<double> start(at_hand.begin(), at_hand.end());
    for (std::size_t j = options_.first; j < start.size(); ++j) {
        const Axis& axis = machine_.axis(j);
        const double range = axis.type == AxisType::Rotary ? kEndless_rad : options_.endless_mm;
        const double low = std::isfinite(axis.min) ? axis.min : start[j] - range;
        const double high = std::isfinite(axis.max) ? axis.max : start[j] + range;
        const double share =
            static_cast<double>(engine_()) / static_cast<double>(std::mt19937::max());
        start[j] = low + share * (high - low);
    }
    return start;
}

}  // namespace meshwind
