/// Marks creases where exact shapes meet.
#pragma once

#include <vector>

#include "mesh/even/wall_shapes.h"

namespace meshwind {

/// Marks edges as creases where one shape meets another at an angle, by their own normals, not
/// those of facets. \param kept per region: whether it is wall \return how many edges became one
int mark_shape_creases(const WallShapes& shapes, const std::vector<char>& kept, LabelledMesh& part);

}  // namespace meshwind
