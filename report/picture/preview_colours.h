/// Colours of pictures. Included by .cpp files of this folder only.
#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace meshwind {

/// Linear light of an sRGB colour, 0xRRGGBB.
[[nodiscard]] Eigen::Vector3f linear_colour(std::uint32_t rgb);

/// Seven colours in turn, distinguishable with any of the common kinds of colour blindness.
/// Source: okabe_ito_2008_colour, its seven colours beside black.
[[nodiscard]] Eigen::Vector3f course_colour(std::size_t course);

/// Colour scale from dark to light in evenly bright steps: five colours of matplotlib's viridis.
/// \param share clamped to 0..1
[[nodiscard]] Eigen::Vector3f scale_colour(double share);

}  // namespace meshwind
