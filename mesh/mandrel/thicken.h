/// Offsets the winding surface by the layers laid on it.
#pragma once

#include <span>
#include <vector>

#include "mesh/mandrel.h"

namespace meshwind {

/// Moves the vertices of the winding surface along their normals; other surfaces of the file (caps,
/// bores) keep their place except for points shared with the wall. At a feature edge a vertex moves
/// so that each side is moved by its thickness. The offset mesh is imported again: repaired,
/// segmented, its rims found; spindle and mandrel frame stay.
///
/// Accuracy: on a smooth wall the normals are of fourth order in the edge length, so vertices of a
/// cylinder or sphere lie on the offset one to T dn^2 / 2 for a thickness T and an error dn;
/// tests/mesh/mandrel/thicken_test.cpp.
/// \param thickness_mm per vertex of mandrel.surface, >= 0
/// \throws InputError thicken.folds where the wall is more concave than the thickness allows, so
/// that triangles fold or cross, with the place; thicken.changed where the offset mesh is another
/// surface
[[nodiscard]] Mandrel thicken(const Mandrel& mandrel, std::span<const double> thickness_mm);

}  // namespace meshwind
