#include "mesh/shapes/make.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/mesh_measures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Rounding of coordinates of some 100 mm through a few square roots: a thousandth of this.
constexpr double kOnSurface_mm = 1e-9;
constexpr double kEdge_mm = 5.0;

struct MakeCase {
    std::string name;
    std::string kind;
    MakeValues values;
    int euler;
    int rims;

    friend std::ostream& operator<<(std::ostream& stream, const MakeCase& c) {
        return stream << c.name;
    }
};

class MakeMandrel : public testing::TestWithParam<MakeCase> {
protected:
    static TriangleSoup make(const MakeOptions& options) {
        return make_mandrel(GetParam().kind, GetParam().values, options);
    }
    static ShapeFoot foot(const Vector3d& point) {
        return mandrel_foot(GetParam().kind, GetParam().values, point);
    }
};

void expect_on_surface(const TriangleSoup& soup, const MakeCase& c) {
    for (const Vector3d& point : soup.points_mm) {
        ASSERT_LT(std::abs(mandrel_foot(c.kind, c.values, point).distance_mm), kOnSurface_mm);
    }
}

TEST_P(MakeMandrel, IsAnOrientedManifold) {
    for (const bool irregular : {false, true}) {
        const auto measures = test::measure(make({.edge_mm = kEdge_mm, .irregular = irregular}));
        EXPECT_TRUE(measures.oriented_manifold);
        EXPECT_EQ(measures.euler, GetParam().euler);
        EXPECT_EQ(measures.rims, GetParam().rims);
    }
}

TEST_P(MakeMandrel, HasEvenTriangles) {
    const auto measures = test::measure(make({.edge_mm = kEdge_mm}));
    EXPECT_GT(measures.min_edge_mm, 0.5 * kEdge_mm);
    EXPECT_LT(measures.max_edge_mm, 1.5 * kEdge_mm);
    EXPECT_GT(measures.min_angle_deg, 30.0);
}

TEST_P(MakeMandrel, HasNoSliversWhenIrregular) {
    const auto measures = test::measure(make({.edge_mm = kEdge_mm, .irregular = true}));
    EXPECT_GT(measures.min_edge_mm, 0.25 * kEdge_mm);
    EXPECT_LT(measures.max_edge_mm, 2.0 * kEdge_mm);
    EXPECT_GT(measures.min_angle_deg, 15.0);
    // And is irregular indeed: the even mesh has no such angles.
    EXPECT_LT(measures.min_angle_deg, 25.0);
}

TEST_P(MakeMandrel, HasItsVerticesOnTheSurface) {
    expect_on_surface(make({.edge_mm = kEdge_mm}), GetParam());
    expect_on_surface(make({.edge_mm = kEdge_mm, .irregular = true}), GetParam());
}

TEST_P(MakeMandrel, FacesOutward) {
    const TriangleSoup soup = make({.edge_mm = 3.0, .irregular = true});
    for (const auto& [a, b, c] : soup.faces) {
        const Vector3d& p = test::point_of(soup, a);
        const Vector3d& q = test::point_of(soup, b);
        const Vector3d& r = test::point_of(soup, c);
        const Vector3d normal = (q - p).cross(r - p).normalized();
        ASSERT_GT(normal.dot(foot((p + q + r) / 3.0).normal), 0.85);
    }
}

TEST_P(MakeMandrel, IrregularKeepsTheRims) {
    const TriangleSoup even = make({.edge_mm = kEdge_mm});
    const TriangleSoup irregular = make({.edge_mm = kEdge_mm, .irregular = true});
    const auto moved = [&](std::size_t i) { return even.points_mm[i] != irregular.points_mm[i]; };
    ASSERT_EQ(even.points_mm.size(), irregular.points_mm.size());
    const auto rim = test::rim_vertices(even);
    std::size_t count = 0;
    for (std::size_t i = 0; i < even.points_mm.size(); ++i) {
        count += moved(i) ? 1 : 0;
        ASSERT_FALSE(moved(i) && rim.contains(static_cast<std::int32_t>(i)));
    }
    EXPECT_GT(count, even.points_mm.size() / 2);
}

TEST_P(MakeMandrel, DependsOnTheSeedAlone) {
    const MakeOptions seven{.edge_mm = kEdge_mm, .irregular = true, .seed = 7};
    const MakeOptions eight{.edge_mm = kEdge_mm, .irregular = true, .seed = 8};
    EXPECT_EQ(make(seven).points_mm, make(seven).points_mm);
    EXPECT_EQ(make(seven).faces, make(seven).faces);
    EXPECT_NE(make(seven).points_mm, make(eight).points_mm);
    EXPECT_NE(make(seven).faces, make(eight).faces);
}

TEST_P(MakeMandrel, SolidIsWatertightAndOfItsWallsVolume) {
    const double wall = 3.0;
    const double outer_area = area_mm2(make({.edge_mm = kEdge_mm}));
    for (const bool irregular : {false, true}) {
        const TriangleSoup soup =
            make({.edge_mm = kEdge_mm, .irregular = irregular, .solid = true, .wall_mm = wall});
        const auto measures = test::measure(soup);
        EXPECT_TRUE(measures.oriented_manifold);
        EXPECT_EQ(measures.rims, 0);
        // The double of a surface: Euler characteristics add, end faces have none.
        EXPECT_EQ(measures.euler, 2 * GetParam().euler);
        // Wall times middle area; the inside is at most an eighth smaller than the outside here,
        // the ellipsoidal domes are thinner than the wall between pole and equator.
        EXPECT_LT(measures.volume_mm3, wall * outer_area);
        EXPECT_GT(measures.volume_mm3, 0.87 * wall * outer_area);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, MakeMandrel,
    testing::Values(MakeCase{"cylinder", "cylinder", {}, 0, 2}, MakeCase{"cone", "cone", {}, 0, 2},
                    MakeCase{"widening_cone", "cone", {{"radius2", 90.0}}, 0, 2},
                    MakeCase{"vessel", "vessel", {}, 0, 2},
                    MakeCase{"uneven_vessel", "vessel", {{"upper-opening-radius", 25.0}}, 0, 2},
                    MakeCase{"half_closed_vessel", "vessel", {{"upper-opening-radius", 0.0}}, 1, 1},
                    MakeCase{"closed_vessel", "vessel", {{"opening-radius", 0.0}}, 2, 0},
                    MakeCase{"isotensoid", "isotensoid", {}, 0, 2},
                    MakeCase{"netting", "isotensoid", {{"ke", 0.0}, {"design-radius", 24.0}}, 0, 2},
                    MakeCase{"elbow", "elbow", {}, 0, 2},
                    MakeCase{"u_bend", "elbow", {{"angle", kPi}, {"leg1", 0.0}}, 0, 2},
                    MakeCase{"tee", "tee", {}, -1, 3},
                    MakeCase{"combination", "combination", {}, 0, 2},
                    MakeCase{"closed_combination", "combination", {{"opening-radius", 0.0}}, 1, 1},
                    MakeCase{"frame", "frame", {}, 0, 2}, MakeCase{"torus", "torus", {}, 0, 0},
                    MakeCase{"open_torus", "torus", {{"angle", 2.0}}, 0, 2},
                    MakeCase{"ellipsoid", "ellipsoid", {}, 2, 0},
                    MakeCase{"long_ellipsoid", "ellipsoid", {{"pole-radius", 200.0}}, 2, 0}),
    [](const auto& each) { return each.param.name; });

// Facets have less area than the surface by a part that falls with the square of the edge.
void expect_area_of_order_two(const std::string& kind, const MakeValues& values, double exact) {
    const auto gap = [&](double edge) {
        return 1.0 - area_mm2(make_mandrel(kind, values, {.edge_mm = edge})) / exact;
    };
    const double coarse = gap(8.0);
    const double fine = gap(2.0);
    EXPECT_GT(fine, 0.0);
    EXPECT_LT(fine, 1e-3);
    // Four times finer, so sixteen times nearer; the even count of rows and rings blurs it a
    // little.
    EXPECT_NEAR(coarse / fine, 16.0, 2.5);
}

TEST(MakeMandrel, HasTheAreaOfACylinder) {
    expect_area_of_order_two("cylinder", {{"radius", 50.0}, {"length", 300.0}},
                             2.0 * kPi * 50.0 * 300.0);
}

TEST(MakeMandrel, HasTheAreaOfATorus) {
    expect_area_of_order_two("torus", {{"ring-radius", 200.0}, {"tube-radius", 50.0}},
                             4.0 * kPi * kPi * 200.0 * 50.0);
}

TEST(MakeMandrel, HasTheAreaOfASpheroid) {
    const double e = std::sqrt(1.0 - 0.75 * 0.75);
    expect_area_of_order_two("ellipsoid", {{"equator-radius", 100.0}, {"pole-radius", 75.0}},
                             2.0 * kPi * 100.0 * 100.0 * (1.0 + (1.0 - e * e) / e * std::atanh(e)));
}

TEST(MakeMandrel, PutsElbowLegsOnTheirAxes) {
    const ElbowShape shape{30.0, 100.0, 0.5 * kPi, 80.0, 120.0};
    int first = 0;
    int second = 0;
    for (const Vector3d& p : make_elbow(shape).points_mm) {
        first +=
            std::abs(p.z()) < kOnSurface_mm && std::abs(p.head<2>().norm() - 30.0) < kOnSurface_mm;
        second += std::abs(p.x() - 220.0) < kOnSurface_mm &&
                  std::abs((p - Vector3d(220.0, 0.0, 180.0)).norm() - 30.0) < kOnSurface_mm;
    }
    EXPECT_EQ(first, std::lround(2.0 * kPi * 30.0 / 5.0));
    EXPECT_EQ(second, first);
}

TEST(MakeMandrel, KeepsSharpRingsWhenIrregular) {
    const TriangleSoup soup = make_combination({}, {.irregular = true});
    int lower = 0;
    int upper = 0;
    for (const Vector3d& p : soup.points_mm) {
        lower += std::abs(p.z() - 120.0) < kOnSurface_mm &&
                 std::abs(p.head<2>().norm() - 60.0) < kOnSurface_mm;
        upper += std::abs(p.z() - 180.0) < kOnSurface_mm &&
                 std::abs(p.head<2>().norm() - 40.0) < kOnSurface_mm;
    }
    EXPECT_EQ(lower, std::lround(2.0 * kPi * 60.0 / 5.0));
    EXPECT_EQ(upper, std::lround(2.0 * kPi * 40.0 / 5.0));
}

std::string code_of(const std::string& kind, const MakeValues& values,
                    const MakeOptions& options = {}) {
    try {
        (void)make_mandrel(kind, values, options);
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()), "");
        return error.code();
    }
    return "none";
}

TEST(MakeMandrel, RefusesEveryNonPositiveParameter) {
    for (const MakeKind& kind : make_kinds()) {
        for (const MakeParameter& parameter : kind.parameters) {
            const std::string name(parameter.name);
            const bool may_be_zero = (name == "opening-radius" && kind.name != "isotensoid") ||
                                     name == "upper-opening-radius" || name == "ke" ||
                                     name == "design-radius" || name == "leg1" || name == "leg2" ||
                                     name == "lean";
            const std::string code = may_be_zero ? "make.negative" : "make.not_positive";
            const double negative = name == "upper-opening-radius" ? -2.0 : -1.0;  // -1: as below
            for (const double bad :
                 {negative, std::nan(""), std::numeric_limits<double>::infinity()}) {
                EXPECT_EQ(code_of(std::string(kind.name), {{name, bad}}), code) << name << bad;
            }
            if (!may_be_zero) {
                EXPECT_EQ(code_of(std::string(kind.name), {{name, 0.0}}), code) << name;
                EXPECT_EQ(code_of(std::string(kind.name), {{name, -0.0}}), code) << name;
            }
        }
    }
}

TEST(MakeMandrel, RefusesWhatDoesNotFit) {
    EXPECT_EQ(code_of("vessel", {{"opening-radius", 75.0}}), "make.opening_too_large");
    EXPECT_EQ(code_of("vessel", {{"upper-opening-radius", 75.0}}), "make.opening_too_large");
    EXPECT_EQ(code_of("isotensoid", {{"opening-radius", 75.0}}), "make.opening_too_large");
    EXPECT_EQ(code_of("isotensoid", {{"ke", 0.0}}), "make.opening_too_small");
    EXPECT_EQ(code_of("isotensoid", {{"ke", 1.0}}), "make.stiffness_ratio");
    EXPECT_EQ(code_of("isotensoid", {{"design-radius", 70.0}}), "make.design_radius");
    EXPECT_EQ(code_of("combination", {{"opening-radius", 41.0}}), "make.opening_too_large");
    EXPECT_EQ(code_of("elbow", {{"bend-radius", 40.0}}), "make.bend_too_tight");
    EXPECT_EQ(code_of("elbow", {{"angle", 3.2}}), "make.angle_too_large");
    EXPECT_EQ(code_of("torus", {{"tube-radius", 200.0}}), "make.bend_too_tight");
    EXPECT_EQ(code_of("torus", {{"angle", 6.3}}), "make.angle_too_large");
    EXPECT_EQ(code_of("cylinder", {}, {.edge_mm = 51.0}), "make.edge_too_large");
    EXPECT_EQ(code_of("cylinder", {}, {.edge_mm = 1e-3}), "make.edge_too_small");
    EXPECT_EQ(code_of("cylinder", {{"length", 1e300}}), "make.edge_too_small");
    EXPECT_EQ(code_of("torus", {{"ring-radius", 1e200}}), "make.edge_too_small");
    EXPECT_EQ(code_of("cylinder", {}, {.edge_mm = 0.0}), "make.not_positive");
    EXPECT_EQ(code_of("cylinder", {}, {.solid = true, .wall_mm = 46.0}), "make.wall_too_thick");
    EXPECT_EQ(code_of("cylinder", {}, {.solid = true, .wall_mm = 50.0}), "make.wall_too_thick");
    EXPECT_EQ(code_of("cylinder", {}, {.solid = true, .wall_mm = 0.0}), "make.not_positive");
    EXPECT_EQ(code_of("tee", {}, {.solid = true, .wall_mm = 40.0}), "make.wall_too_thick");
    EXPECT_EQ(code_of("sphere", {}), "make.unknown_kind");
    EXPECT_EQ(code_of("cone", {{"radius", 5.0}}), "make.unknown_parameter");
}

}  // namespace
}  // namespace meshwind
