/// Transfers a CAD part's exact faces to the mandrel. Included by .cpp files of this folder only.
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

/// Makes the kept faces of a CAD part a region of their own. \param cad the triangles' part, or
/// nullptr \param words each names at least one face; empty: regions stay
/// \throws InputError mesh.no_such_face
void keep_named_faces(const CadMesh* cad, const TriangleSoup& whole,
                      const std::vector<std::string>& words, const std::string& name,
                      Segmentation& segmentation);

/// The exact faces of the wall. \pre the CAD part outlives it
struct ExactWall {
    const CadMesh& cad;
    ExactCorners corners;
    std::vector<std::int32_t> face_region;  ///< per face of the part, see regions_of_faces
};

/// Marks borders of faces on the wall, see mark_bend_borders.
/// \param cad the triangles' part, or nullptr \param wall in the part's frame
[[nodiscard]] std::optional<ExactWall> exact_wall(const CadMesh* cad, const TriangleSoup& whole,
                                                  const Segmentation& segmentation,
                                                  LabelledMesh& wall);

/// Stores the faces in the mandrel. \param motion from the part's frame to the mandrel's
void take_cad_faces(ExactWall&& exact, const Eigen::Isometry3d& motion, Mandrel& mandrel);

/// Adds remarks on sewn edges, open edges and edges off their faces.
void add_cad_remarks(const CadMesh& cad, Mandrel& mandrel);

}  // namespace meshwind
