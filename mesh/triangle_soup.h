/// Triangles as files hold them: points and index triples, no topology.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// Index of the face across an edge at which a surface ends.
inline constexpr std::int32_t kNoFace = -1;

struct TriangleSoup {
    std::vector<Eigen::Vector3d> points_mm;          ///< n x 3
    std::vector<std::array<std::int32_t, 3>> faces;  ///< m x 3, counter-clockwise seen from outside
};

/// Area in mm^2 of one face.
[[nodiscard]] double area_mm2(const std::vector<Eigen::Vector3d>& points_mm,
                              const std::array<std::int32_t, 3>& face);

/// Middle of one face.
[[nodiscard]] Eigen::Vector3d middle_mm(const std::vector<Eigen::Vector3d>& points_mm,
                                        const std::array<std::int32_t, 3>& face);

/// Area in mm^2 of all faces.
[[nodiscard]] double area_mm2(const TriangleSoup& soup);

/// Length in mm of the bounding box's diagonal; 0 for no points.
[[nodiscard]] double diagonal_mm(const std::vector<Eigen::Vector3d>& points_mm);
[[nodiscard]] double diagonal_mm(const TriangleSoup& soup);

}  // namespace meshwind
