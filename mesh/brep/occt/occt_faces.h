/// The faces and edges of an Open CASCADE shape as exact surfaces, and a first mesh of them.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <TopoDS_Shape.hxx>

#include "mesh/brep/even_part.h"
#include "mesh/brep/occt/occt_mesh.h"
#include "mesh/brep/occt/occt_read.h"

namespace meshwind {

/// Not thread-safe: Open CASCADE keeps what it evaluated last.
class OcctFaces : public ExactFaces {
public:
    /// \param shape whose faces and edges are numbered in its order
    explicit OcctFaces(const TopoDS_Shape& shape);
    ~OcctFaces() override;

    /// Also gives each face the start points of its projections. \pre called before the functions
    /// below
    [[nodiscard]] OcctMesh first_mesh();
    [[nodiscard]] std::vector<CadFace> describe(const FaceColours& colours) const;

    [[nodiscard]] std::optional<Eigen::Vector3d> on_face(std::int32_t face,
                                                         const Eigen::Vector3d& p) override;
    [[nodiscard]] std::optional<Eigen::Vector3d> on_border(std::int32_t face, std::int32_t other,
                                                           const Eigen::Vector3d& p) override;
    [[nodiscard]] std::optional<Jet> jet(std::int32_t face, const Eigen::Vector3d& p,
                                         double reach_mm) override;

private:
    struct Face;
    struct Edge;

    TopoDS_Shape shape_;
    std::vector<Face> faces_;
    std::vector<Edge> edges_;
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> border_;
};

}  // namespace meshwind
