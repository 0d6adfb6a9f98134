#include "geodesic/jacobi_field.h"

#include <cmath>

#include <Eigen/Geometry>

#include "geodesic/trace.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d shape_operator_per_mm(const Surface& surface, const SurfacePoint& point) {
    const auto& corner = surface.corner[static_cast<std::size_t>(point.face)];
    Matrix3d shape = Matrix3d::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
        shape += point.bary[static_cast<Eigen::Index>(c)] *
                 surface.shape_operator_per_mm[static_cast<std::size_t>(corner[c])];
    }
    return shape;
}

CurvatureAlong curvature(const Surface& surface, const SurfacePoint& point, const Vector3d& t,
                         const Vector3d& b) {
    const Matrix3d shape = shape_operator_per_mm(surface, point);
    const Vector3d along = shape * t;
    const double torsion = b.dot(along);
    const double normal = t.dot(along);
    const double across = b.dot(shape * b);
    return {normal * across - torsion * torsion, normal, across, torsion};
}

}  // namespace

double gaussian_curvature_per_mm2(const Surface& surface, const SurfacePoint& point) {
    const Vector3d n = smooth_normal(surface, point);
    const Vector3d t = n.unitOrthogonal();
    return curvature(surface, point, t, n.cross(t)).gaussian_per_mm2;
}

CurvatureAlong curvature_along(const Surface& surface, const PathPoint& station) {
    return curvature(surface, station.at, station.tangent, station.normal.cross(station.tangent));
}

std::vector<double> jacobi_field_mm(const Surface& surface, const SurfacePath& path,
                                    double slip_ratio) {
    std::vector<double> field;
    field.reserve(path.size());
    const double steered = 1.0 + slip_ratio * slip_ratio;
    double y = 0.0;
    double slope = 1.0;
    double torsion = 0.0;  // its integral over s
    CurvatureAlong last{};
    for (std::size_t i = 0; i < path.size(); ++i) {
        const PathPoint& p = path[i];
        const CurvatureAlong here = curvature_along(surface, p);
        if (i > 0) {
            const double ds = p.s_mm - path[i - 1].s_mm;
            // Half the turn before the step and half after it: second order.
            slope -= 0.5 * ds * steered * last.gaussian_per_mm2 * y;
            y += ds * slope;
            slope -= 0.5 * ds * steered * here.gaussian_per_mm2 * y;
            torsion += 0.5 * ds * (last.torsion_per_mm + here.torsion_per_mm);
        }
        field.push_back(y * std::exp(slip_ratio * torsion));
        last = here;
    }
    return field;
}

}  // namespace meshwind
