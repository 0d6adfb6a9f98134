// Ends as real parts have them: what is no part of the leg goes, and nothing else.
#include "mesh/even/square_ends.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Outside up, over a round lip of the wall's half thickness into the bore, and the same below.
std::vector<Vector2d> pipe_with_lips(double outer, double inner, double length, int steps) {
    const double lip = 0.5 * (outer - inner);
    const double middle = 0.5 * (outer + inner);
    std::vector<Vector2d> profile;
    for (int i = 0; i <= 2 * steps; ++i) {
        const double turned = kPi * i / (2 * steps);
        profile.emplace_back(middle + lip * std::cos(turned),
                             length - lip + lip * std::sin(turned));
    }
    for (int i = 0; i <= 2 * steps; ++i) {
        const double turned = kPi * (1.0 + static_cast<double>(i) / (2 * steps));
        profile.emplace_back(middle + lip * std::cos(turned), lip + lip * std::sin(turned));
    }
    profile.push_back(profile.front());
    return profile;
}

TEST(SquareEnds, RoundLipsAreCutWhereTheLegEnds) {
    const TriangleSoup soup = test::revolve(pipe_with_lips(15.0, 12.0, 90.0, 6), 64);
    for (const auto mesh : {MandrelOptions::Mesh::File, MandrelOptions::Mesh::Even}) {
        const Mandrel mandrel = build_mandrel(soup, "lips", {.mesh = mesh});
        ASSERT_EQ(mandrel.rims.size(), 2U);
        for (const Rim& rim : mandrel.rims) {
            EXPECT_NEAR(rim.radius_mm, 15.0, 1e-3);
            EXPECT_LT(rim.circularity_mm, 5e-3);
            EXPECT_NEAR(std::abs(rim.centre_mm.z()), 43.5, 1e-6);
            EXPECT_NEAR(rim.cut_off_mm, 1.5, 1e-6);
        }
        EXPECT_EQ(mandrel.axis.rule, "coaxial-rims");
    }
}

// A fillet of 1 mm between the leg and its flat end: the face runs into the wall, and the wall ends
// at the bore.
Mandrel filleted_pipe(int steps) {
    std::vector<Vector2d> profile{{15.0, 1.0}, {15.0, 59.0}};
    for (int i = 1; i <= steps; ++i) {
        const double turned = 0.5 * kPi * i / steps;
        profile.emplace_back(14.0 + std::cos(turned), 59.0 + std::sin(turned));
    }
    profile.insert(profile.end(), {{13.5, 60.0}, {13.5, 0.0}, {14.0, 0.0}});
    for (int i = 1; i <= steps; ++i) {
        const double turned = -0.5 * kPi + 0.5 * kPi * i / steps;
        profile.emplace_back(14.0 + std::cos(turned), 1.0 + std::sin(turned));
    }
    return build_mandrel(test::revolve(profile, 64), "fillets");
}

TEST(SquareEnds, FilletsAtEndFacesAreCut) {
    const Mandrel mandrel = filleted_pipe(6);
    ASSERT_EQ(mandrel.rims.size(), 2U);
    for (const Rim& rim : mandrel.rims) {
        EXPECT_NEAR(rim.radius_mm, 15.0, 2e-3);
        EXPECT_LT(rim.circularity_mm, 5e-3);
        EXPECT_NEAR(rim.cut_off_mm, 1.0, 1e-6);
    }
}

// The last vertices of a fine fillet are on the leg but for rounding; its normals lean there.
TEST(SquareEnds, FineFilletsAreCutWhereTheirNormalsNoLongerLean) {
    const Mandrel mandrel = filleted_pipe(32);
    ASSERT_EQ(mandrel.rims.size(), 2U);
    for (const Rim& rim : mandrel.rims) {
        EXPECT_NEAR(rim.cut_off_mm, 1.0, 3e-3);
    }
}

// Tabs stand 2.6 mm out of one end, a notch goes 2 mm into the other.
TEST(SquareEnds, TabsAndNotchesAreCut) {
    TriangleSoup soup = test::tube(13.0, 80.0, 72, 20);
    for (Vector3d& p : soup.points_mm) {
        const double at = std::atan2(p.y(), p.x());
        if (p.z() == 80.0 && std::abs(at) < 0.3) {
            p.z() += 2.6;
        } else if (p.z() == 0.0 && std::abs(at - 1.0) < 0.2) {
            p.z() += 2.0;
        }
    }
    const Mandrel mandrel = build_mandrel(soup, "tabs");
    ASSERT_EQ(mandrel.rims.size(), 2U);
    for (const Rim& rim : mandrel.rims) {
        EXPECT_NEAR(rim.radius_mm, 13.0, 1e-3);
        EXPECT_LT(rim.circularity_mm, 5e-3);
        EXPECT_NEAR(rim.cut_off_mm, rim.axis.z() > 0.0 ? 2.6 : 2.0, 1e-6);
    }
    EXPECT_NEAR(std::abs(mandrel.rims[0].centre_mm.z() - mandrel.rims[1].centre_mm.z()), 78.0,
                1e-6);
}

TEST(SquareEnds, PartsWithCleanEndsStayAsTheyAre) {
    for (const MakeKind& kind : make_kinds()) {
        const Mandrel mandrel =
            build_mandrel(make_mandrel(kind.name, {}, {.edge_mm = 8.0}), std::string(kind.name));
        for (const Rim& rim : mandrel.rims) {
            EXPECT_EQ(rim.cut_off_mm, 0.0) << kind.name;
        }
    }
}

TEST(SquareEnds, SoMuchIsCutAsIsAskedFor) {
    const TriangleSoup soup = test::tube(20.0, 100.0, 48, 20);
    const Mandrel cut = build_mandrel(soup, "cut", {.cut_ends_mm = 7.5});
    ASSERT_EQ(cut.rims.size(), 2U);
    for (const Rim& rim : cut.rims) {
        EXPECT_NEAR(std::abs(rim.centre_mm.z()), 42.5, 1e-6);
        EXPECT_NEAR(rim.radius_mm, 20.0, 1e-3);
        EXPECT_EQ(rim.cut_off_mm, 7.5);
    }
    EXPECT_EQ(build_mandrel(test::revolve(pipe_with_lips(15.0, 12.0, 90.0, 6), 64), "lips",
                            {.cut_ends_mm = 0.0})
                  .rims.at(0)
                  .cut_off_mm,
              0.0);
    EXPECT_THROW((void)build_mandrel(soup, "gone", {.cut_ends_mm = 200.0}), InputError);
}

}  // namespace
}  // namespace meshwind
