/// Role of a course in the laminate: over junctions, as hoop, clamping the fibre under it.
#pragma once

#include <span>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"
#include "winding/plan/figures.h"

namespace meshwind {

/// Lengths of a course by their role in holding the laminate together.
struct CourseCharacter {
    double length_mm = 0.0;
    double junction_mm =
        0.0;                ///< the part where the wall is not like a pipe: blends, knuckles, domes
    double hoop_mm = 0.0;   ///< over pipes within 20 degrees of hoop
    double clamp_mm = 0.0;  ///< over pipes, weighed by how far it presses on: sin^2 of the angle
    /// From -1, all in junctions, to 1, all hoop.
    [[nodiscard]] double lateness() const {
        return length_mm > 0.0 ? (clamp_mm - junction_mm) / length_mm : 0.0;
    }
};
[[nodiscard]] CourseCharacter character_of(const Surface& surface, const SurfacePath& path);

[[nodiscard]] Places places_of(const Surface& surface, std::span<const SurfacePath* const> courses);

}  // namespace meshwind
