#include "mesh/even/ruled_shape.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// One row of flat facets on a cone of revolution, from an end circle to the other.
struct Row {
    std::vector<Vector3d> points;
    std::vector<RuledFacet> facets;
};

Row row_of(const Eigen::Isometry3d& place, double radius, double growth, double length,
           double arc_rad, int count) {
    Row row;
    const auto at = [&](int i, double z) {
        const double phi = arc_rad * i / count;
        const double r = radius + growth * z;
        return Vector3d(place * Vector3d(r * std::cos(phi), r * std::sin(phi), z));
    };
    for (int i = 0; i <= count; ++i) {
        row.points.push_back(at(i, 0.0));
        row.points.push_back(at(i, length));
    }
    const auto add = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
        const Vector3d area = 0.5 * (b - a).cross(c - a);
        row.facets.push_back({(a + b + c) / 3.0, area.normalized(), area.norm()});
    };
    for (int i = 0; i < count; ++i) {
        add(at(i, 0.0), at(i + 1, 0.0), at(i, length));
        add(at(i + 1, 0.0), at(i + 1, length), at(i, length));
    }
    return row;
}

Eigen::Isometry3d somewhere() {
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.translate(Vector3d(30.0, -12.0, 7.0));
    place.rotate(Eigen::AngleAxisd(1.1, Vector3d(0.3, -0.5, 0.8).normalized()));
    return place;
}

// Points on the shape leave nothing but rounding.
TEST(RuledShape, FindsCylindersAndCones) {
    for (const double growth : {0.0, 0.2, -0.4}) {
        for (const double arc : {rad_from_deg(360.0), rad_from_deg(120.0), rad_from_deg(30.0)}) {
            const Row row = row_of(somewhere(), 50.0, growth, 80.0, arc, 24);
            const auto shape = fit_ruled_shape(row.points, row.facets);
            ASSERT_TRUE(shape) << growth << ' ' << arc;
            EXPECT_LT(shape->residual_mm, 1e-9) << growth << ' ' << arc;
            const Vector3d axis = somewhere().linear() * Vector3d::UnitZ();
            EXPECT_LT(shape->axis.cross(axis).norm(), 1e-9) << growth << ' ' << arc;
            EXPECT_NEAR(std::abs(shape->growth), std::abs(growth), 1e-9);
        }
    }
}

// The foot of a point lies on the surface, and the way to it is square to it.
TEST(RuledShape, NearestPointsAreFeet) {
    const Row row = row_of(somewhere(), 50.0, 0.3, 80.0, rad_from_deg(200.0), 24);
    const auto shape = fit_ruled_shape(row.points, row.facets);
    ASSERT_TRUE(shape);
    const Vector3d p = somewhere() * Vector3d(40.0, 55.0, 33.0);
    const Vector3d foot = shape->nearest(p);
    const Vector3d local = somewhere().inverse() * foot;
    EXPECT_NEAR(local.head<2>().norm(), 50.0 + 0.3 * local.z(), 1e-9);
    const Vector3d outward = somewhere().inverse().linear() * (p - foot);
    const Vector3d ruling(0.3 * local.x() / local.head<2>().norm(),
                          0.3 * local.y() / local.head<2>().norm(), 1.0);
    EXPECT_NEAR(outward.normalized().dot(ruling.normalized()), 0.0, 1e-9);
}

TEST(RuledShape, FlatFacetsTellNone) {
    std::vector<Vector3d> points;
    std::vector<RuledFacet> facets;
    for (int i = 0; i < 8; ++i) {
        points.emplace_back(i, 0.0, 0.0);
        points.emplace_back(i, 40.0, 0.0);
        facets.push_back({{i + 0.5, 20.0, 0.0}, Vector3d::UnitZ(), 40.0});
    }
    EXPECT_FALSE(fit_ruled_shape(points, facets));
}

}  // namespace
}  // namespace meshwind
