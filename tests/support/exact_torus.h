/// The torus around z in closed form: normal and shape operator anywhere near it.
#pragma once

#include <cmath>

#include <Eigen/Geometry>

namespace meshwind::test {

struct ExactTorus {
    double ring_radius_mm = 200.0;
    double tube_radius_mm = 50.0;

    [[nodiscard]] Eigen::Vector3d centre(const Eigen::Vector3d& p) const {
        return ring_radius_mm * Eigen::Vector3d(p.x(), p.y(), 0.0).normalized();
    }
    [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& p) const {
        return (p - centre(p)).normalized();
    }
    [[nodiscard]] Eigen::Vector3d foot(const Eigen::Vector3d& p) const {
        return centre(p) + tube_radius_mm * normal(p);
    }
    /// Principal curvatures: cos(v) / rho around the axis, 1 / r around the tube.
    [[nodiscard]] Eigen::Matrix3d shape_operator_per_mm(const Eigen::Vector3d& p) const {
        const double rho = std::hypot(p.x(), p.y());
        const Eigen::Vector3d around(-p.y() / rho, p.x() / rho, 0.0);
        const Eigen::Vector3d n = normal(p);
        const Eigen::Vector3d tube = n.cross(around);
        const double cos_v = (n.x() * p.x() + n.y() * p.y()) / rho;
        return cos_v / rho * around * around.transpose() +
               1.0 / tube_radius_mm * tube * tube.transpose();
    }
};

}  // namespace meshwind::test
