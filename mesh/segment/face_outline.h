/// Traces outlines of sets of faces of a part. Included by .cpp files of this folder only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/index.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// Faces of a part with their measures. \pre the referenced arrays outlive it
struct MeasuredFaces {
    const TriangleSoup& soup;
    const std::vector<std::array<std::int32_t, 3>>& neighbours;  ///< see face_neighbours
    const std::vector<Eigen::Vector3d>& normals;                 ///< unit
    const std::vector<double>& area_mm2;
    double tolerance_mm = 0.0;  ///< vertices this near to a plane lie in it

    /// \param i corner of face `f`, taken modulo 3
    [[nodiscard]] const Eigen::Vector3d& corner(std::int32_t f, std::size_t i) const {
        return soup.points_mm[at(soup.faces[at(f)][i % 3])];
    }
    [[nodiscard]] Eigen::Vector3d centre(std::int32_t f) const {
        return (corner(f, 0) + corner(f, 1) + corner(f, 2)) / 3.0;
    }
};

/// Set membership: per face the number of the set it was put into last. Sets are not emptied; each
/// new one gets a new number.
struct FaceMarks {
    std::vector<int> of_face;  ///< 0: in none yet
    int last = 0;

    [[nodiscard]] int fresh() { return ++last; }
};

/// A face and one of its edges.
using HalfEdge = std::pair<std::int32_t, std::size_t>;

/// A loop of the boundary of a set of faces.
struct FaceOutline {
    std::vector<HalfEdge> edges;  ///< in order; it turns left about the faces
    double enclosed_mm2 = 0.0;    ///< area within, seen along a normal
};

/// Marks faces with a fresh number. The loop of their boundary that encloses the largest area;
/// without edges where the part is open at one of the faces.
/// \param normal loops turn left about it
[[nodiscard]] FaceOutline marked_outline(const MeasuredFaces& part,
                                         const std::vector<std::int32_t>& faces,
                                         const Eigen::Vector3d& normal, FaceMarks& marks);

}  // namespace meshwind
