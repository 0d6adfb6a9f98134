#include "mesh/triangle_soup.h"

#include <Eigen/Geometry>

namespace meshwind {

double area_mm2(const TriangleSoup& soup) {
    double area = 0.0;
    for (const auto& [a, b, c] : soup.faces) {
        const Eigen::Vector3d& origin = soup.points_mm[static_cast<std::size_t>(a)];
        area += 0.5 * (soup.points_mm[static_cast<std::size_t>(b)] - origin)
                          .cross(soup.points_mm[static_cast<std::size_t>(c)] - origin)
                          .norm();
    }
    return area;
}

double diagonal_mm(const TriangleSoup& soup) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& point : soup.points_mm) {
        box.extend(point);
    }
    return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

}  // namespace meshwind
