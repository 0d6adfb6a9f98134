#include "mesh/even/ruled_shape.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "core/small_linear.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Mean square of what the normals turn by, square to their mean plane's axis: 2 degrees.
constexpr double kMinTurn = 1e-3;

constexpr int kRounds = 12;
constexpr double kRidge = 1e-12;  // of the diagonal: what the points do not tell stays as it is

struct Seen {
    double distance_mm;  // of the point from the surface along the radius
    double height_mm;    // along the axis
    Vector3d outward;    // unit, square to the axis
};

Seen seen_from(const RuledShape& shape, const Vector3d& p) {
    const Vector3d d = p - shape.origin_mm;
    const double z = d.dot(shape.axis);
    const Vector3d aside = d - z * shape.axis;
    const double radius = aside.norm();
    return {radius - shape.radius_mm - shape.growth * z, z,
            radius > 0.0 ? Vector3d(aside / radius) : Vector3d::Zero()};
}

// Axis, a point of it, radius and growth by the facets.
std::optional<RuledShape> first_guess(std::span<const Vector3d> points,
                                      std::span<const RuledFacet> facets) {
    Vector3d mean = Vector3d::Zero();
    double area = 0.0;
    for (const RuledFacet& facet : facets) {
        mean += facet.area_mm2 * facet.normal;
        area += facet.area_mm2;
    }
    mean /= area;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const RuledFacet& facet : facets) {
        const Vector3d off = facet.normal - mean;
        spread += facet.area_mm2 / area * off * off.transpose();
    }
    const PrincipalAxes<3> axes = principal_axes(spread);
    if (!(axes.values[1] > kMinTurn * kMinTurn) || !(axes.values[2] > kMinTurn)) {
        return std::nullopt;
    }
    RuledShape shape;
    shape.axis = axes.vectors.col(0);
    // Square to the axis the normals' lines meet it.
    const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - shape.axis * shape.axis.transpose();
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const RuledFacet& facet : facets) {
        const Vector3d way = (flat * facet.normal).normalized();
        const Eigen::Matrix3d aside = flat - way * way.transpose();
        sum += facet.area_mm2 * aside;
        right += facet.area_mm2 * aside * facet.centre_mm;
    }
    const Vector3d centre = mean_mm(points);
    sum += area * shape.axis * shape.axis.transpose();
    right += area * shape.axis * shape.axis.dot(centre);
    shape.origin_mm = sum.ldlt().solve(right);
    double n = 0.0;
    double z1 = 0.0;
    double z2 = 0.0;
    double r1 = 0.0;
    double rz = 0.0;
    for (const Vector3d& p : points) {
        const Seen seen = seen_from(shape, p);
        n += 1.0;
        z1 += seen.height_mm;
        z2 += seen.height_mm * seen.height_mm;
        r1 += seen.distance_mm;
        rz += seen.distance_mm * seen.height_mm;
    }
    const double determinant = n * z2 - z1 * z1;
    if (!(determinant > 0.0) || !shape.origin_mm.allFinite()) {
        return std::nullopt;
    }
    shape.growth = (n * rz - z1 * r1) / determinant;
    shape.radius_mm = (r1 - shape.growth * z1) / n;
    return shape;
}

}  // namespace

Vector3d RuledShape::nearest(const Vector3d& p) const {
    const Seen seen = seen_from(*this, p);
    // Square to the surface: less along the radius than the distance there, and a little along the
    // axis.
    const double share = seen.distance_mm / (1.0 + growth * growth);
    return p - share * (seen.outward - growth * axis);
}

double RuledShape::distance_mm(const Vector3d& p) const {
    return std::abs(seen_from(*this, p).distance_mm) / std::sqrt(1.0 + growth * growth);
}

Vector3d RuledShape::normal_at(const Vector3d& p) const {
    const Vector3d d = p - origin_mm;
    const Vector3d out = (d - d.dot(axis) * axis).normalized();
    return (out - growth * axis).normalized();
}

Vector3d RuledShape::ruling_at(const Vector3d& p) const {
    const Vector3d d = p - origin_mm;
    const Vector3d out = (d - d.dot(axis) * axis).normalized();
    return (axis + growth * out).normalized();
}

std::optional<RuledShape> fit_ruled_shape(std::span<const Vector3d> points_mm,
                                          std::span<const RuledFacet> facets) {
    std::optional<RuledShape> shape = first_guess(points_mm, facets);
    if (!shape) {
        return std::nullopt;
    }
    for (int round = 0; round < kRounds; ++round) {
        const Vector3d u = shape->axis.unitOrthogonal();
        const Vector3d v = shape->axis.cross(u);
        Matrix6d normal = Matrix6d::Zero();
        Vector6d right = Vector6d::Zero();
        for (const Vector3d& p : points_mm) {
            const Seen seen = seen_from(*shape, p);
            const Vector3d d = p - shape->origin_mm;
            const double ou = seen.outward.dot(u);
            const double ov = seen.outward.dot(v);
            Vector6d row;
            row << -ou, -ov, -seen.height_mm * ou - shape->growth * d.dot(u),
                -seen.height_mm * ov - shape->growth * d.dot(v), -1.0, -seen.height_mm;
            normal += row * row.transpose();
            right -= seen.distance_mm * row;
        }
        normal.diagonal() *= 1.0 + kRidge;
        const Vector6d step = normal.ldlt().solve(right);
        if (!step.allFinite()) {
            return std::nullopt;
        }
        shape->origin_mm += step[0] * u + step[1] * v;
        shape->axis = (shape->axis + step[2] * u + step[3] * v).normalized();
        shape->radius_mm += step[4];
        shape->growth += step[5];
    }
    if (!(shape->radius_mm > 0.0) || !std::isfinite(shape->growth)) {
        return std::nullopt;
    }
    shape->residual_mm = 0.0;
    for (const Vector3d& p : points_mm) {
        shape->residual_mm = std::max(shape->residual_mm, shape->distance_mm(p));
    }
    return shape;
}

Vector3d mean_mm(std::span<const Vector3d> points_mm) {
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : points_mm) {
        mean += p / static_cast<double>(points_mm.size());
    }
    return mean;
}

std::optional<BallShape> fit_ball(std::span<const Vector3d> points_mm) {
    const Vector3d mean = mean_mm(points_mm);
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Vector3d& p : points_mm) {
        const Vector3d d = p - mean;
        const Eigen::Vector4d row(2.0 * d.x(), 2.0 * d.y(), 2.0 * d.z(), 1.0);
        sum += row * row.transpose();
        right += d.squaredNorm() * row;
    }
    const Eigen::Vector4d x = sum.ldlt().solve(right);
    const double squared = x[3] + x.head<3>().squaredNorm();
    if (!x.allFinite() || !(squared > 0.0)) {
        return std::nullopt;
    }
    return BallShape{mean + x.head<3>(), std::sqrt(squared)};
}

}  // namespace meshwind
