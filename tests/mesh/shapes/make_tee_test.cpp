#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/units.h"
#include "mesh/io/export.h"
#include "mesh/shapes/analytic.h"
#include "mesh/shapes/make.h"
#include "tests/support/mesh_measures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Rounding of coordinates of some 100 mm through a few square roots: a thousandth of this.
constexpr double kOnSurface_mm = 1e-9;

class MakeTee : public testing::TestWithParam<TeeShape> {};

// Distance to the surface found without tee_foot's case distinction: outside the ball of every
// sampled spine point and on one of the three surfaces.
double brute_distance_mm(const TeeShape& shape, const Vector3d& p) {
    const double run = std::abs(p.head<2>().norm() - shape.run_radius_mm);
    const Vector3d axis(std::cos(shape.lean_rad), 0.0, std::sin(shape.lean_rad));
    const double branch = std::abs(axis.cross(p).norm() - shape.branch_radius_mm);
    double spine = 1e9;
    constexpr int kSteps = 5000;
    for (int i = 0; i < kSteps; ++i) {
        spine = std::min(spine, (tee_spine_mm(shape, 2.0 * kPi * i / kSteps) - p).norm());
    }
    // The spine runs at most sqrt(2) (branch + blend) per radian, more where it leans; half a step
    // of it away from a sample the distance is seen too large by (step / 2)^2 / (2 blend).
    const double step = std::sqrt(2.0) * (1.0 + std::sin(shape.lean_rad)) /
                        std::cos(shape.lean_rad) *
                        (shape.branch_radius_mm + shape.blend_radius_mm) * 2.0 * kPi / kSteps;
    const double slack = step * step / (8.0 * shape.blend_radius_mm);
    EXPECT_GE(spine, shape.blend_radius_mm - kOnSurface_mm);
    const double blend = std::max(0.0, spine - shape.blend_radius_mm - slack);
    return p.x() > 0.0 ? std::min({run, branch, blend}) : run;
}

TEST_P(MakeTee, IsAnOrientedManifoldWithThreeRims) {
    const test::MeshMeasures measures = test::measure(make_tee(GetParam()));
    EXPECT_TRUE(measures.oriented_manifold);
    EXPECT_EQ(measures.euler, -1);
    EXPECT_EQ(measures.rims, 3);
}

TEST_P(MakeTee, HasEvenTriangles) {
    const test::MeshMeasures measures = test::measure(make_tee(GetParam(), {.edge_mm = 4.0}));
    EXPECT_GT(measures.min_edge_mm, 0.5 * 4.0);
    EXPECT_LT(measures.max_edge_mm, 1.5 * 4.0);
    EXPECT_GT(measures.min_angle_deg, 30.0);
}

TEST_P(MakeTee, HasItsVerticesOnTheSurface) {
    const TriangleSoup soup = make_tee(GetParam());
    for (std::size_t i = 0; i < soup.points_mm.size(); ++i) {
        const Vector3d& point = soup.points_mm[i];
        ASSERT_LT(std::abs(tee_foot(GetParam(), point).distance_mm), kOnSurface_mm);
        if (i % 100 == 0) {
            ASSERT_LT(brute_distance_mm(GetParam(), point), kOnSurface_mm);
        }
    }
}

TEST_P(MakeTee, FacesOutward) {
    const TriangleSoup soup = make_tee(GetParam(), {.edge_mm = 3.0});
    // A facet of edge h turns from the normal at its centre by about h over the least radius of
    // curvature.
    const double turn =
        1.2 * 3.0 / std::min(GetParam().blend_radius_mm, GetParam().branch_radius_mm);
    for (const auto& [a, b, c] : soup.faces) {
        const Vector3d& p = test::point_of(soup, a);
        const Vector3d& q = test::point_of(soup, b);
        const Vector3d& r = test::point_of(soup, c);
        const Vector3d normal = (q - p).cross(r - p).normalized();
        const Vector3d exact = tee_foot(GetParam(), (p + q + r) / 3.0).normal;
        ASSERT_LT(std::atan2(normal.cross(exact).norm(), normal.dot(exact)), turn);
    }
}

TEST_P(MakeTee, EndsInCircles) {
    const TeeShape& shape = GetParam();
    int run = 0;
    int branch = 0;
    for (const Vector3d& point : make_tee(shape).points_mm) {
        run += std::abs(std::abs(point.z()) - 0.5 * shape.run_length_mm) < kOnSurface_mm ? 1 : 0;
        const double along =
            point.x() * std::cos(shape.lean_rad) + point.z() * std::sin(shape.lean_rad);
        branch += std::abs(along - shape.branch_length_mm) < kOnSurface_mm ? 1 : 0;
    }
    EXPECT_EQ(run, 2 * std::lround(2.0 * kPi * shape.run_radius_mm / 5.0));
    EXPECT_EQ(branch, std::lround(2.0 * kPi * shape.branch_radius_mm / 5.0));
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, MakeTee,
    testing::Values(TeeShape{50, 40, 15, 400, 236}, TeeShape{50, 50, 15, 400, 236},
                    TeeShape{50, 40, 6, 400, 236}, TeeShape{50, 25, 10, 400, 236},
                    TeeShape{50, 40, 20, 400, 236}, TeeShape{50, 49.9, 15, 400, 236},
                    TeeShape{50, 40, 15, 400, 236, 0.25 * kPi},
                    TeeShape{50, 30, 9, 500, 260, kPi / 3.0},
                    TeeShape{50, 50, 15, 400, 236, kPi / 6.0}));

TEST(MakeTee, IsTheSameEveryTime) {
    const TriangleSoup first = make_tee({});
    const TriangleSoup second = make_tee({});
    EXPECT_EQ(first.points_mm, second.points_mm);
    EXPECT_EQ(first.faces, second.faces);
}

TEST(MakeTee, MakesTheShippedFile) {
    std::ifstream file(MESHWIND_SOURCE_DIR "/data/tee.stl", std::ios::binary);
    const std::string shipped(std::istreambuf_iterator<char>(file), {});
    const std::string made =
        mesh_file_bytes(make_tee({50, 40, 15, 400, 236}, {.edge_mm = 5.0}), MeshFormat::Stl);
    EXPECT_TRUE(made == shipped) << "if the change is wanted, make data/tee.stl again";
}

TEST(TeeFoot, CrossesContactCurvesWithoutJump) {
    const TeeShape shape{50, 40, 15, 400, 236};
    for (int i = 0; i < 360; ++i) {
        const Vector3d centre = tee_spine_mm(shape, rad_from_deg(i));
        const Vector3d on_run = centre - 15.0 * Vector3d(centre.x(), centre.y(), 0).normalized();
        const Vector3d on_branch = centre - 15.0 * Vector3d(0, centre.y(), centre.z()).normalized();
        const Vector3d way = (on_branch - on_run).normalized();
        for (const Vector3d& contact : {on_run, on_branch}) {
            const ShapeFoot before = tee_foot(shape, contact - 1e-6 * way);
            const ShapeFoot after = tee_foot(shape, contact + 1e-6 * way);
            EXPECT_NE(before.part, after.part);
            EXPECT_LT((before.normal - after.normal).norm(), 1e-6);
            EXPECT_LT(std::abs(before.distance_mm) + std::abs(after.distance_mm), 2e-6);
        }
    }
}

TEST(TeeFoot, FindsTheFootOfPointsOffTheSurface) {
    for (const TeeShape& shape : {TeeShape{50, 40, 15, 400, 236}, TeeShape{50, 50, 15, 400, 236}}) {
        for (const Vector3d& point : make_tee(shape).points_mm) {
            const Vector3d normal = tee_foot(shape, point).normal;
            for (const double off : {-5.0, 0.5, 5.0}) {
                const ShapeFoot foot = tee_foot(shape, point + off * normal);
                ASSERT_NEAR(foot.distance_mm, off, kOnSurface_mm);
                // The foot moves with the square root of rounding along the spine.
                ASSERT_LT((foot.point_mm - point).norm(), 1e-6);
            }
        }
    }
}

std::string code_of(const TeeShape& shape, double edge_mm = 5.0) {
    try {
        (void)make_tee(shape, {.edge_mm = edge_mm});
    } catch (const InputError& error) {
        return error.code();
    }
    return "none";
}

TEST(MakeTee, RefusesImpossibleShapes) {
    EXPECT_EQ(code_of({0, 40, 15, 400, 236}), "make.not_positive");
    EXPECT_EQ(code_of({50, -1, 15, 400, 236}), "make.not_positive");
    EXPECT_EQ(code_of({50, 40, std::nan(""), 400, 236}), "make.not_positive");
    EXPECT_EQ(code_of({50, 40, 15, HUGE_VAL, 236}), "make.not_positive");
    EXPECT_EQ(code_of({50, 51, 15, 400, 236}), "make.branch_too_wide");
    EXPECT_EQ(code_of({50, 40, 160, 400, 236}), "make.blend_too_large");
    EXPECT_EQ(code_of({50, 40, 15, 400, 60}), "make.blend_too_large");
    EXPECT_EQ(code_of({26, 5.2, 34.8, 112, 114}, 1.2), "make.blend_too_large");  // would fold
    EXPECT_EQ(code_of({50, 40, 15, 400, 236, 1.1}), "make.lean_too_large");
    EXPECT_EQ(code_of({50, 40, 15, 400, 236, -0.1}), "make.negative");
    EXPECT_EQ(code_of({50, 40, 15, 250, 236, 0.8}), "make.lean_too_large");
    EXPECT_EQ(code_of({50, 40, 15, 400, 130, 0.8}), "make.lean_too_large");
    EXPECT_EQ(code_of({50, 12, 14, 600, 400, 1.0}, 3.0), "make.blend_too_large");  // would fold
    EXPECT_EQ(code_of({}, 30.0), "make.edge_too_large");
    EXPECT_EQ(code_of({}, 0.0), "make.not_positive");
    EXPECT_EQ(code_of({}, std::nan("")), "make.not_positive");
}

}  // namespace
}  // namespace meshwind
