/// Detects planes, balls, cylinders and cones on which a file's facets lie exactly.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/even/ruled_shape.h"

namespace meshwind {

/// A surface in closed form.
struct WallShape {
    enum class Kind { Plane, Ball, Ruled };
    Kind kind = Kind::Plane;
    RuledShape ruled{};                                   ///< of a cylinder or cone
    Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< of a ball; a point of a plane
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();    ///< of a plane, unit
    double radius_mm = 0.0;                               ///< of a ball

    /// The point of the surface nearest to `p`. \pre p is not on the axis, nor a ball's centre
    [[nodiscard]] Eigen::Vector3d nearest(const Eigen::Vector3d& p) const {
        if (kind == Kind::Ruled) {
            return ruled.nearest(p);
        }
        if (kind == Kind::Ball) {
            return centre_mm + radius_mm * (p - centre_mm).normalized();
        }
        return p - normal.dot(p - centre_mm) * normal;
    }
    [[nodiscard]] double distance_mm(const Eigen::Vector3d& p) const {
        if (kind == Kind::Ruled) {
            return ruled.distance_mm(p);
        }
        if (kind == Kind::Ball) {
            return std::abs((p - centre_mm).norm() - radius_mm);
        }
        return std::abs(normal.dot(p - centre_mm));
    }
    /// Unit normal there, on either side.
    [[nodiscard]] Eigen::Vector3d normal_at(const Eigen::Vector3d& p) const {
        if (kind == Kind::Ruled) {
            return ruled.normal_at(p);
        }
        return kind == Kind::Ball ? (p - centre_mm).normalized() : normal;
    }
};

struct WallShapes {
    std::vector<WallShape> shapes;
    std::vector<std::int32_t> of_face;  ///< per face of the part, -1: none
};

/// The shapes of the wall's facets, begun from the largest ones. A shape takes connected facets,
/// across no crease, whose vertices lie on it but for rounding and whose normals are its own. A
/// ring of facets between two circles lies on a cone as well as on a fillet: it is a cone where it
/// is longer than what it turns into, or turns to different sides.
/// \param kept per region: whether it is wall
[[nodiscard]] WallShapes find_wall_shapes(const LabelledMesh& part, const std::vector<char>& kept);

}  // namespace meshwind
