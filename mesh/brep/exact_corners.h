/// The exact faces of a CAD part about the corners of the wall that is wound.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/brep/cad_mesh.h"
#include "mesh/even/labelled_mesh.h"
#include "mesh/surface.h"

namespace meshwind {

/// What is known of a wall's triangles; -1 of those that are not the CAD part's any more.
struct ExactCorners {
    std::vector<std::int32_t> face;                ///< per triangle: index in CadMesh::faces
    std::vector<std::array<std::int32_t, 3>> jet;  ///< per corner: index in CadMesh::jets
};

/// Finds the wall's triangles among those of the part, by their vertices.
/// \param wall in the part's frame
[[nodiscard]] ExactCorners exact_corners(const CadMesh& part, const TriangleSoup& wall);

/// Makes feature edges of borders between faces where the surface is smooth but bends otherwise on
/// one side than on the other, as between a cylinder and its fillet: no fit may go across.
void mark_bend_borders(const CadMesh& part, const ExactCorners& known, LabelledMesh& wall);

/// The region in which most of each face's area lies, -1: its triangles are gone. \param whole,
/// region of the part
[[nodiscard]] std::vector<std::int32_t> regions_of_faces(const CadMesh& part,
                                                         const TriangleSoup& whole,
                                                         std::span<const std::int32_t> region);

/// Puts the exact faces in place of fits, and says which triangles lie on cylinders. \param motion
/// from the part's frame to the surface's
void set_exact(const CadMesh& part, const ExactCorners& known, const Eigen::Isometry3d& motion,
               Surface& surface);

}  // namespace meshwind
