/// Meshes a surface of revolution with rings of triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/revolution/meridian.h"

namespace meshwind {

/// Rings of vertices on the surface that the meridian sweeps about Z: one on each crease, joint and
/// end, or a vertex at a pole, and in between spaced like the edges of an even mesh there
/// (even_options()), but at least three rows of triangles over curved stretches, however short.
/// Outside is in front. \return regions number the stretches between creases, from 0; empty where
/// there would be more than kMaxEvenTriangles
[[nodiscard]] LabelledMesh swept_wall(const Meridian& meridian, double size_mm);

}  // namespace meshwind
