#include "winding/vessel/hoop_layer.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "mesh/shapes/make_checks.h"

namespace meshwind {
namespace {

constexpr const char* kRange = "pattern.out_of_range";

// Share of a turn that is no reason for one turn more: lengths that are whole multiples of the
// pitch come with rounding.
constexpr double kSameCount = 1e-9;

void check(const HoopRequest& request) {
    const double around_mm = 2.0 * kPi * request.radius_mm;
    require(request.radius_mm > 0.0 && std::isfinite(request.radius_mm), kRange, "radius_mm",
            request.radius_mm, "a finite number above", 0.0);
    require(request.band_mm > 0.0, kRange, "band_mm", request.band_mm, "above", 0.0);
    require(request.length_mm > request.band_mm && std::isfinite(request.length_mm), kRange,
            "length_mm", request.length_mm, "finite and more than the band,", request.band_mm);
    require(request.passes > 0, kRange, "passes", request.passes, "above", 0.0);
    require(request.least_overlap > -1.0 && std::isfinite(request.least_overlap), kRange,
            "least_overlap", request.least_overlap, "a finite number above", -1.0);
    // Else even bands along the axis would overlap more than enough.
    require(request.band_mm < (1.0 + request.least_overlap) * around_mm, kRange, "band_mm",
            request.band_mm, "less than the way around times 1 + least_overlap,",
            (1.0 + request.least_overlap) * around_mm);
}

}  // namespace

HoopLayer hoop_layer(const HoopRequest& request) {
    check(request);
    const double around_mm = 2.0 * kPi * request.radius_mm;
    // pitch (1 + overlap) <= band / sin(angle), sin(angle) = around / hypot(around, pitch).
    const double wanted = 1.0 + request.least_overlap;
    const double slope = request.band_mm / around_mm;
    const double most_pitch_mm = request.band_mm / std::sqrt(wanted * wanted - slope * slope);
    const double travel_mm = request.length_mm - request.band_mm;

    HoopLayer layer;
    layer.turns =
        std::max<std::int64_t>(1, std::llround(std::ceil(travel_mm / most_pitch_mm - kSameCount)));
    layer.pitch_mm = travel_mm / static_cast<double>(layer.turns);
    layer.angle_rad = std::atan2(around_mm, layer.pitch_mm);
    layer.overlap = request.band_mm / (layer.pitch_mm * std::sin(layer.angle_rad)) - 1.0;
    layer.passes = request.passes;
    layer.total_rad =
        2.0 * kPi * static_cast<double>(layer.passes * layer.turns + layer.passes + 1);
    return layer;
}

}  // namespace meshwind
