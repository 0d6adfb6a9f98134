#include "mesh/triangle_soup.h"

#include <Eigen/Geometry>

namespace meshwind {

double area_mm2(const std::vector<Eigen::Vector3d>& points_mm,
                const std::array<std::int32_t, 3>& face) {
    const Eigen::Vector3d& origin = points_mm[static_cast<std::size_t>(face[0])];
    return 0.5 * (points_mm[static_cast<std::size_t>(face[1])] - origin)
                     .cross(points_mm[static_cast<std::size_t>(face[2])] - origin)
                     .norm();
}

Eigen::Vector3d middle_mm(const std::vector<Eigen::Vector3d>& points_mm,
                          const std::array<std::int32_t, 3>& face) {
    const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& {
        return points_mm[static_cast<std::size_t>(face[i])];
    };
    return (corner(0) + corner(1) + corner(2)) / 3.0;
}

double area_mm2(const TriangleSoup& soup) {
    double area = 0.0;
    for (const auto& face : soup.faces) {
        area += area_mm2(soup.points_mm, face);
    }
    return area;
}

double diagonal_mm(const std::vector<Eigen::Vector3d>& points_mm) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& point : points_mm) {
        box.extend(point);
    }
    return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

double diagonal_mm(const TriangleSoup& soup) {
    return diagonal_mm(soup.points_mm);
}

}  // namespace meshwind
