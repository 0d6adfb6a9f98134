#include "report/picture/preview_colours.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meshwind {

using Eigen::Vector3f;

Vector3f linear_colour(std::uint32_t rgb) {
    Vector3f colour;
    for (int i = 0; i < 3; ++i) {
        const float c = static_cast<float>((rgb >> (16 - 8 * i)) & 0xFFU) / 255.0F;
        colour[i] = c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
    }
    return colour;
}

Vector3f course_colour(std::size_t course) {
    constexpr std::array<std::uint32_t, 7> kColours = {0xE69F00, 0x56B4E9, 0x009E73, 0xF0E442,
                                                       0x0072B2, 0xD55E00, 0xCC79A7};
    return linear_colour(kColours[course % kColours.size()]);
}

Vector3f scale_colour(double share) {
    constexpr std::array<std::uint32_t, 5> kStops = {0x440154, 0x3B528B, 0x21918C, 0x5EC962,
                                                     0xFDE725};
    const double place = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
    const auto rest = static_cast<float>(place - static_cast<double>(below));
    return (1.0F - rest) * linear_colour(kStops[below]) + rest * linear_colour(kStops[below + 1]);
}

}  // namespace meshwind
