/// Families of parallel courses: what makes a plan readable, and a winding even.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geodesic/surface_path.h"

namespace meshwind {

/// A family has at least so many members.
inline constexpr std::size_t kLeastFamily = 3;

/// The family of every course, -1 where it belongs to none; numbered by their first members. Two
/// courses are neighbours where over most of the length of either the other runs within one and a
/// half bands beside it, in nearly the same direction or against it; a family is joined by
/// neighbours. \param courses in winding order \param band_mm > 0
[[nodiscard]] std::vector<std::int32_t> families_of(std::span<const SurfacePath* const> courses,
                                                    double band_mm);

}  // namespace meshwind
