#include "winding/laminate/material_axes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

Vector3d corner(const Surface& surface, std::size_t f, std::size_t k) {
    return surface.position_mm[static_cast<std::size_t>(surface.face[f][k])];
}

Vector3d centre(const Surface& s, std::size_t f) {
    return (corner(s, f, 0) + corner(s, f, 1) + corner(s, f, 2)) / 3.0;
}

Vector3d normal(const Surface& s, std::size_t f) {
    return (corner(s, f, 1) - corner(s, f, 0))
        .cross(corner(s, f, 2) - corner(s, f, 0))
        .normalized();
}

void expect_unit_in_plane(const Surface& surface, const std::vector<Vector3d>& axes) {
    ASSERT_EQ(axes.size(), surface.face.size());
    for (std::size_t f = 0; f < axes.size(); ++f) {
        EXPECT_NEAR(axes[f].norm(), 1.0, 1e-12);
        EXPECT_NEAR(axes[f].dot(normal(surface, f)), 0.0, 1e-12);
    }
}

TEST(MaterialAxes, OfABodyOfRevolutionFollowTheSpindle) {
    const Mandrel mandrel = test::made("vessel", {}, 6.0);
    const std::vector<Vector3d> axes = material_axes(mandrel);
    expect_unit_in_plane(mandrel.surface, axes);
    for (std::size_t f = 0; f < axes.size(); ++f) {
        const Vector3d place = centre(mandrel.surface, f);
        const Vector3d around = Vector3d(-place.y(), place.x(), 0.0).normalized();
        EXPECT_GT(axes[f].z(), 0.0);
        // A facet leans by its edges at most, and on the dome's steep ring so does its axis.
        EXPECT_LT(std::abs(axes[f].dot(around)), 0.25);
    }
}

// The run's axis is the spindle, and the branch stands on it along X.
TEST(MaterialAxes, OfATeeFollowRunAndBranch) {
    const Mandrel mandrel = test::small_tee(6.0);
    const std::vector<Vector3d> axes = material_axes(mandrel);
    const Surface& surface = mandrel.surface;
    expect_unit_in_plane(surface, axes);
    Vector3d out = Vector3d::Zero();
    for (const Rim& rim : mandrel.rims) {
        out = std::abs(rim.axis.z()) < 0.1 ? rim.axis : out;
    }
    ASSERT_NEAR(out.norm(), 1.0, 1e-9);
    int on_branch = 0;
    int on_run = 0;
    for (std::size_t f = 0; f < axes.size(); ++f) {
        const Vector3d place = centre(surface, f);
        if (place.dot(out) > 70.0) {  // 110 mm from the run's axis to the rim, blend of 12 mm
            ++on_branch;
            EXPECT_GT(axes[f].dot(out) * (out.x() > -0.1 ? 1.0 : -1.0),
                      std::cos(rad_from_deg(3.0)));
        } else if (std::abs(place.z()) > 60.0) {
            ++on_run;
            EXPECT_GT(axes[f].z(), std::cos(rad_from_deg(3.0)));
        }
    }
    EXPECT_GT(on_branch, 50);
    EXPECT_GT(on_run, 100);
}

// The tangent of the bend's circle, and one sense from rim to rim.
TEST(MaterialAxes, OfAnElbowFollowItsLine) {
    const Mandrel mandrel = test::made("elbow", {}, 8.0);
    const std::vector<Vector3d> axes = material_axes(mandrel);
    const Surface& surface = mandrel.surface;
    expect_unit_in_plane(surface, axes);
    for (std::size_t f = 0; f < axes.size(); ++f) {
        for (const std::int32_t next : surface.neighbour[f]) {
            if (next != kNoFace) {
                EXPECT_GT(axes[f].dot(axes[static_cast<std::size_t>(next)]),
                          std::cos(rad_from_deg(20.0)));
            }
        }
    }
    // Against each leg's rim one way, along the other's the other way.
    int forth = 0;
    for (const Rim& rim : mandrel.rims) {
        double sum = 0.0;
        int n = 0;
        for (std::size_t f = 0; f < axes.size(); ++f) {
            if ((centre(surface, f) - rim.centre_mm).norm() < 1.1 * rim.radius_mm) {
                sum += axes[f].dot(rim.axis);
                ++n;
            }
        }
        ASSERT_GT(n, 5);
        EXPECT_GT(std::abs(sum / n), 0.99);
        forth += sum > 0.0 ? 1 : 0;
    }
    EXPECT_EQ(forth, 1);
}

TEST(PlyAngle, CountsCounterClockwiseSeenFromOutside) {
    const Vector3d z = Vector3d::UnitZ();  // the axis
    const Vector3d out = Vector3d::UnitX();
    const Vector3d left = out.cross(z);
    for (const double deg : {-89.0, -45.0, -1.0, 0.0, 30.0, 60.0, 89.0}) {
        const double angle = rad_from_deg(deg);
        const Vector3d along = std::cos(angle) * z + std::sin(angle) * left;
        EXPECT_NEAR(ply_angle_rad(z, out, along), angle, 1e-12);
        EXPECT_NEAR(ply_angle_rad(z, out, -along), angle, 1e-12);
    }
    EXPECT_NEAR(ply_angle_rad(z, out, left), 0.5 * kPi, 1e-12);
    EXPECT_NEAR(ply_angle_rad(z, out, -left), 0.5 * kPi, 1e-12);
    // A right-handed screw about the axis goes up to the left, seen from outside.
    const Vector3d screw = (z + Vector3d::UnitZ().cross(out)).normalized();
    EXPECT_NEAR(std::abs(ply_angle_rad(z, out, screw)), 0.25 * kPi, 1e-12);
}

}  // namespace
}  // namespace meshwind
