/// Even remeshing of a part whose faces are known exactly.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mesh/brep/cad_mesh.h"
#include "mesh/smooth/jet_fit.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// The faces of a part, by number. A face's surface is extended beyond its borders as far as
/// possible.
class ExactFaces {
public:
    ExactFaces() = default;
    ExactFaces(const ExactFaces&) = delete;
    ExactFaces& operator=(const ExactFaces&) = delete;
    virtual ~ExactFaces() = default;

    /// The point of a face's surface nearest to a point beside it; none where it is not found.
    [[nodiscard]] virtual std::optional<Eigen::Vector3d> on_face(std::int32_t face,
                                                                 const Eigen::Vector3d& p) = 0;
    /// The point nearest to `p` of the edges between two faces; \param other -1: of edges that are
    /// of `face` alone
    [[nodiscard]] virtual std::optional<Eigen::Vector3d> on_border(std::int32_t face,
                                                                   std::int32_t other,
                                                                   const Eigen::Vector3d& p) = 0;
    /// The surface about a point on it, outside up; none at a pole or another point without a
    /// normal. \param reach_mm as far as it is evaluated; 0: what normal and curvature alone say
    [[nodiscard]] virtual std::optional<Jet> jet(std::int32_t face, const Eigen::Vector3d& p,
                                                 double reach_mm) = 0;
};

/// Even triangles (mesh/even/even_mesh.h) with borders of faces along their edges. Vertices of one
/// face lie on its surface, those on a border on its edge; others are the given ones.
/// \param start oriented manifold, mm, vertices on the faces; its triangles may be long and narrow
/// \param face of each of them \param edge_mm longest edge; 0: by the part's size
/// \return without data that only the file holds: kinds of faces, units
[[nodiscard]] CadMesh even_part(const TriangleSoup& start, std::span<const std::int32_t> face,
                                ExactFaces& exact, double edge_mm);

}  // namespace meshwind
