/// Remeshes the wall of a body of revolution in rings of triangles.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/even/labelled_mesh.h"
#include "mesh/revolution/meridian.h"

namespace meshwind {

/// The part with the wall that its meridian sweeps in place of its own (mesh/revolution/
/// swept_wall.h). Each stretch between two creases gets the region that most of the wall there had.
/// Faces that are no wall stay, and share no vertex with it any more. None where there would be too
/// many triangles. \param kept per region: whether it is wall \param mandrel_from_part Z is the
/// axis there
[[nodiscard]] std::optional<LabelledMesh> swept_part(const LabelledView& part,
                                                     const std::vector<char>& kept,
                                                     const Meridian& meridian,
                                                     const Eigen::Isometry3d& mandrel_from_part);

}  // namespace meshwind
