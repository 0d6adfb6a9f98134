/// Smallest angles of two triangles before and after a flip of the edge between them.
#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace meshwind {

/// Largest cosine of the angles of a triangle: the smaller, the better its smallest angle.
/// \param ab, bc, ca unit, its sides one after the other
[[nodiscard]] inline double worst_cosine_of_sides(const Eigen::Vector3d& ab,
                                                  const Eigen::Vector3d& bc,
                                                  const Eigen::Vector3d& ca) {
    return std::max({-ab.dot(ca), -ab.dot(bc), -bc.dot(ca)});
}

struct FlipCosines {
    double before;
    double after;
};

/// Worse cosine of the two triangles on an edge from a to b, before and after its flip.
/// \param c, d their third corners, left and right of the edge
[[nodiscard]] inline FlipCosines flip_cosines(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                              const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
    const Eigen::Vector3d ab = (b - a).normalized();
    const Eigen::Vector3d bc = (c - b).normalized();
    const Eigen::Vector3d ca = (a - c).normalized();
    const Eigen::Vector3d ad = (d - a).normalized();
    const Eigen::Vector3d db = (b - d).normalized();
    const Eigen::Vector3d dc = (c - d).normalized();
    return {std::max(worst_cosine_of_sides(ab, bc, ca), worst_cosine_of_sides(-ab, ad, db)),
            std::max(worst_cosine_of_sides(ad, dc, ca), worst_cosine_of_sides(db, bc, -dc))};
}

}  // namespace meshwind
