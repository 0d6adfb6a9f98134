/// Assigns the exact faces of a CAD part to the corners of the winding surface.
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

/// Exact faces and jets of a wall's triangles; -1 for those that are no longer the CAD part's.
struct ExactCorners {
    std::vector<std::int32_t> face;                ///< per triangle: index in CadMesh::faces
    std::vector<std::array<std::int32_t, 3>> jet;  ///< per corner: index in CadMesh::jets
};

/// Finds the wall's triangles among those of the part, by their vertices.
/// \param wall in the part's frame
[[nodiscard]] ExactCorners exact_corners(const CadMesh& part, const TriangleSoup& wall);

/// Marks as feature edges the borders between faces where the surface is smooth but its curvature
/// jumps, as between a cylinder and its fillet: no fit may go across.
void mark_bend_borders(const CadMesh& part, const ExactCorners& known, LabelledMesh& wall);

/// Per face the region in which most of its area lies; -1: its triangles are gone. \param whole,
/// region of the part
[[nodiscard]] std::vector<std::int32_t> regions_of_faces(const CadMesh& part,
                                                         const TriangleSoup& whole,
                                                         std::span<const std::int32_t> region);

/// Replaces fits by the exact faces, and records which triangles lie on cylinders. \param motion
/// from the part's frame to the surface's
void set_exact(const CadMesh& part, const ExactCorners& known, const Eigen::Isometry3d& motion,
               Surface& surface);

}  // namespace meshwind
