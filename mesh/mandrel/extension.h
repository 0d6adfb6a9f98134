/// The mandrel's extensions: cylinders beyond the rims, on which the fibre turns round.
#pragma once

#include "mesh/mandrel.h"
#include "mesh/surface.h"

namespace meshwind {

/// Cylinder of the rim's radius from the rim outward, closed at its far end: for collision checks.
/// \param length_mm > 0 \param segments >= 3 around
[[nodiscard]] TriangleSoup extension_of(const Rim& rim, double length_mm, int segments = 96);

/// The winding surface continued by the extensions of all its rims, each joined to the rim's own
/// vertices and cylindrical from its highest vertex on. The former rims are feature edges, so the
/// patches of the wall stay unchanged; those of the extensions come from the cylinder through each
/// vertex. The far ends carry the rims' ids. Faces of the wall keep their numbers; those of
/// extensions follow, with region kExtensionRegion.
/// \param length_mm beyond the rim; 0: the surface as it is
[[nodiscard]] Surface extended_surface(const Mandrel& mandrel, double length_mm);

inline constexpr std::int32_t kExtensionRegion = -1;

}  // namespace meshwind
