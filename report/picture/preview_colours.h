/// Colours of pictures. Included by .cpp files of this folder only.
#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace meshwind {

/// sRGB, 0xRRGGBB, as light.
[[nodiscard]] Eigen::Vector3f linear_colour(std::uint32_t rgb);

/// Seven in turn, told apart with any of the common kinds of colour blindness.
/// Source: okabe_ito_2008_colour, its seven colours beside black.
[[nodiscard]] Eigen::Vector3f course_colour(std::size_t course);

/// From dark to light, evenly bright steps: five colours of matplotlib's viridis.
/// \param share clamped to 0..1
[[nodiscard]] Eigen::Vector3f scale_colour(double share);

}  // namespace meshwind
