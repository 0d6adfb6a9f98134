#include "mesh/shapes/analytic.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/shapes/make.h"
#include "mesh/shapes/make_kinds.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A point moved along the normal keeps its foot while it stays within the radii of curvature.
TEST(MandrelFoot, FindsTheFootOfPointsOffTheSurface) {
    for (const MakeKind& kind : make_kinds()) {
        if (kind.name == "combination") {
            continue;  // its sharp rings have no single normal
        }
        MakeValues values;
        if (kind.name == "isotensoid") {
            values = {{"design-radius", 20.0}};  // else concave by under 4 mm beside the opening
        }
        const TriangleSoup soup =
            make_mandrel(kind.name, values, {.edge_mm = 10.0, .irregular = true});
        for (const Vector3d& point : soup.points_mm) {
            const Vector3d normal = mandrel_foot(kind.name, values, point).normal;
            for (const double off : {-4.0, 0.5, 4.0}) {
                const ShapeFoot foot = mandrel_foot(kind.name, values, point + off * normal);
                ASSERT_NEAR(foot.distance_mm, off, 1e-9) << kind.name << ' ' << point.transpose();
                ASSERT_LT((foot.point_mm - point).norm(), 1e-6) << kind.name;
                ASSERT_LT((foot.normal - normal).norm(), 1e-6) << kind.name;
            }
        }
    }
}

// Where bend and second leg meet, rounding may leave a place in neither: angles and places all
// around.
TEST(ElbowFoot, HasNoGapWhereBendAndLegMeet) {
    for (int degrees = 1; degrees <= 180; ++degrees) {
        const ElbowShape shape{40.0, 120.0, rad_from_deg(degrees), 150.0, 90.0};
        const double c = std::cos(shape.angle_rad);
        const double s = std::sin(shape.angle_rad);
        const Vector3d outward(-c, 0.0, s);
        for (int k = 0; k < 60; ++k) {
            const double phi = 2.0 * kPi * k / 60;
            const Vector3d place = Vector3d(120.0, 0.0, 150.0) +
                                   (120.0 + 40.0 * std::cos(phi)) * outward +
                                   40.0 * std::sin(phi) * Vector3d::UnitY();
            EXPECT_NEAR(elbow_foot(shape, place).distance_mm, 0.0, 1e-9) << degrees << ' ' << k;
        }
    }
}

// Sphere: the foot is known without any search.
TEST(EllipsoidFoot, AgreesWithTheSphere) {
    const EllipsoidShape sphere{100.0, 100.0};
    for (const Vector3d& point : {Vector3d(90, 20, 60), Vector3d(-30, 0.1, -110),
                                  Vector3d(1, 2, 99), Vector3d(120, 0, 0)}) {
        const ShapeFoot foot = ellipsoid_foot(sphere, point);
        EXPECT_LT((foot.point_mm - 100.0 * point.normalized()).norm(), 1e-9);
        EXPECT_LT((foot.normal - point.normalized()).norm(), 1e-11);
        EXPECT_NEAR(foot.distance_mm, point.norm() - 100.0, 1e-10);
    }
}

TEST(EllipsoidFoot, HoldsAtThePoles) {
    const EllipsoidShape shape{100.0, 75.0};
    for (const double sign : {-1.0, 1.0}) {
        for (const double zero : {0.0, -0.0}) {
            const ShapeFoot foot = ellipsoid_foot(shape, Vector3d(zero, zero, 80.0 * sign));
            EXPECT_LT((foot.point_mm - Vector3d(0, 0, 75.0 * sign)).norm(), 1e-12);
            EXPECT_LT((foot.normal - Vector3d(0, 0, sign)).norm(), 1e-12);
            EXPECT_NEAR(foot.distance_mm, 5.0, 1e-12);
        }
    }
}

TEST(MandrelFoot, NamesThePiece) {
    EXPECT_EQ(vessel_foot({}, {75, 0, 0}).part, ShapePart::Cylinder);
    EXPECT_EQ(vessel_foot({}, {40, 0, 140}).part, ShapePart::Dome);
    EXPECT_EQ(vessel_foot({}, {40, 0, -140}).part, ShapePart::Dome);
    EXPECT_EQ(isotensoid_foot({}, {75, 0, 99}).part, ShapePart::Cylinder);
    EXPECT_EQ(isotensoid_foot({}, {40, 0, -140}).part, ShapePart::Dome);
    EXPECT_EQ(combination_foot({}, {0, 50, 150}).part, ShapePart::Cone);
    EXPECT_EQ(elbow_foot({}, {40, 0, 10}).part, ShapePart::Leg);
    EXPECT_EQ(elbow_foot({}, {150, 0, 215}).part, ShapePart::Leg);
    EXPECT_EQ(elbow_foot({}, {0, 0, 160}).part, ShapePart::Bend);
    EXPECT_EQ(tee_foot({}, {-50, 0, 0}).part, ShapePart::Run);
    EXPECT_EQ(tee_foot({}, {150, 0, 40}).part, ShapePart::Branch);
    EXPECT_EQ(tee_foot({}, {55, 0, 45}).part, ShapePart::Blend);
}

TEST(ConeFoot, HasTheConesNormal) {
    // Narrowing by 30 over 200: the normal leans up by atan(0.15).
    const ShapeFoot foot = cone_foot({60.0, 30.0, 200.0}, {50.0, 0.0, 0.0});
    const double lean = std::atan(30.0 / 200.0);
    EXPECT_NEAR(foot.normal.x(), std::cos(lean), 1e-14);
    EXPECT_NEAR(foot.normal.z(), std::sin(lean), 1e-14);
    EXPECT_NEAR(foot.distance_mm, 5.0 * std::cos(lean), 1e-12);
}

}  // namespace
}  // namespace meshwind
