/// What a CAD part's exact faces tell of the mandrel. Included by .cpp files of this folder only.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/brep/cad_mesh.h"
#include "mesh/brep/exact_corners.h"
#include "mesh/even/labelled_mesh.h"
#include "mesh/mandrel.h"
#include "mesh/segment/segment.h"

namespace meshwind {

/// What is kept of a CAD part's faces becomes a region of its own. \param cad that the triangles
/// are of, or nullptr \param words each means one face at least; empty: regions stay
/// \throws InputError mesh.no_such_face
void keep_named_faces(const CadMesh* cad, const TriangleSoup& whole,
                      const std::vector<std::string>& words, const std::string& name,
                      Segmentation& segmentation);

/// What the faces tell of the wall. \pre the CAD part outlives it
struct ExactWall {
    const CadMesh& cad;
    ExactCorners corners;
    std::vector<std::int32_t> face_region;  ///< per face of the part, see regions_of_faces
};

/// Marks borders of faces on the wall, see mark_bend_borders.
/// \param cad that the triangles are of, or nullptr \param wall in the part's frame
[[nodiscard]] std::optional<ExactWall> exact_wall(const CadMesh* cad, const TriangleSoup& whole,
                                                  const Segmentation& segmentation,
                                                  LabelledMesh& wall);

/// The faces become the mandrel's. \param motion from the part's frame to the mandrel's
void take_cad_faces(ExactWall&& exact, const Eigen::Isometry3d& motion, Mandrel& mandrel);

/// Sewn and open edges, edges off their faces.
void add_cad_remarks(const CadMesh& cad, Mandrel& mandrel);

}  // namespace meshwind
