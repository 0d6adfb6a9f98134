#include "winding/laminate/stage_ask.h"

#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

// Of the share of a cover that may stay bare, what does once it is filled: the rest is left for
// courses given up later.
constexpr double kCoverFilledTo = 0.5;

}  // namespace

StageAsk whole_cover(const Surface& surface, double tow_width_mm, std::uint64_t seed,
                     std::int32_t layers, double most_bare) {
    const auto places = [&](Stream stream) {
        AskedPlaces asked;
        asked.at = plan_samples(surface, tow_width_mm, seed, stream).at;
        asked.layers.assign(asked.at.size(), layers);
        return asked;
    };
    StageAsk ask;
    ask.measured = places(Stream::Sampling);
    ask.weighed = places(Stream::Ground);
    ask.left = ask.measured.layers;
    ask.filled_to = kCoverFilledTo * most_bare;
    ask.beyond_layers = beyond_even_layers(layers);
    return ask;
}

}  // namespace meshwind
