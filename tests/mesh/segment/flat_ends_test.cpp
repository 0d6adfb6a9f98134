// Ends of parts as modellers make them: what bounds the end face does not matter.
#include "mesh/segment/flat_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/edge_table.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/repair/weld.h"
#include "mesh/segment/feature_edges.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// (radius, z) over a round lip, turning by a quarter from `from_rad`.
void add_lip(std::vector<Vector2d>& profile, const Vector2d& centre, double lip, double from_rad) {
    constexpr int kSteps = 6;
    for (int i = 0; i <= kSteps; ++i) {
        const double turned = from_rad + 0.5 * kPi * i / kSteps;
        profile.emplace_back(centre + lip * Vector2d(std::cos(turned), std::sin(turned)));
    }
}

std::vector<Vector2d> solid_with_lips(double radius, double length, double lip) {
    std::vector<Vector2d> profile{{0.0, 0.0}};
    add_lip(profile, {radius - lip, lip}, lip, -0.5 * kPi);
    add_lip(profile, {radius - lip, length - lip}, lip, 0.0);
    profile.emplace_back(0.0, length);
    return profile;
}

// A pipe about Z, from z = 0 to `length`, of cells between these radii and as many sectors as
// `segments`; a cell of its upper end face stands higher by what `height_mm` says. A least radius
// of 0 makes it solid. Faces share no vertices: they are welded later.
TriangleSoup pipe_with_cells(const std::vector<double>& radii, double length, int segments,
                             const std::function<double(std::size_t, int)>& height_mm) {
    TriangleSoup soup;
    const auto point = [&](double radius, int s, double z) {
        const double angle = 2.0 * kPi * (s % segments) / segments;
        return Vector3d(radius * std::cos(angle), radius * std::sin(angle), z);
    };
    const auto add = [&](std::array<Vector3d, 4> corners) {
        const auto first = static_cast<std::int32_t>(soup.points_mm.size());
        soup.points_mm.insert(soup.points_mm.end(), corners.begin(), corners.end());
        if (corners[0] != corners[1]) {
            soup.faces.push_back({first, first + 1, first + 2});
        }
        if (corners[2] != corners[3]) {
            soup.faces.push_back({first, first + 2, first + 3});
        }
    };
    // Between two heights, outside in front where the first is the lower one.
    const auto add_flank = [&](const Vector3d& a, const Vector3d& b, double from, double to) {
        if (from != to) {
            const Vector3d up = Vector3d::UnitZ();
            add({a + from * up, b + from * up, b + to * up, a + to * up});
        }
    };
    const auto height = [&](std::size_t cell, int s) {
        return length + height_mm(cell, (s + segments) % segments);
    };
    for (int s = 0; s < segments; ++s) {
        for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
            const double z = height(i, s);
            add({point(radii[i], s, z), point(radii[i + 1], s, z), point(radii[i + 1], s + 1, z),
                 point(radii[i], s + 1, z)});
            add({point(radii[i + 1], s, 0), point(radii[i], s, 0), point(radii[i], s + 1, 0),
                 point(radii[i + 1], s + 1, 0)});
            const double before = height(i, s - 1);
            add_flank(point(radii[i], s, 0), point(radii[i + 1], s, 0), before, z);
            if (i > 0) {
                const double inner = height(i - 1, s);
                add_flank(point(radii[i], s + 1, 0), point(radii[i], s, 0), inner, z);
            }
        }
        const double outer = height(radii.size() - 2, s);
        add_flank(point(radii.back(), s, 0), point(radii.back(), s + 1, 0), 0.0, length);
        add_flank(point(radii.back(), s, 0), point(radii.back(), s + 1, 0), length, outer);
        if (radii.front() > 0.0) {
            const double inner = height(0, s);
            add_flank(point(radii.front(), s + 1, 0), point(radii.front(), s, 0), 0.0, length);
            add_flank(point(radii.front(), s + 1, 0), point(radii.front(), s, 0), length, inner);
        }
    }
    return soup;
}

int count_of(TriangleSoup soup) {
    weld(soup);
    const auto neighbours = face_neighbours(soup.faces);
    std::vector<double> area;
    for (const auto& face : soup.faces) {
        area.push_back(area_mm2(soup.points_mm, face));
    }
    const auto ends = flat_ends(soup, neighbours, steady_normals(soup, neighbours), area);
    return *std::max_element(ends.begin(), ends.end()) + 1;
}

void expect_ends(const Mandrel& mandrel, double radius, double low, double high) {
    ASSERT_EQ(mandrel.rims.size(), 2U);
    for (const Rim& rim : mandrel.rims) {
        EXPECT_NEAR(rim.radius_mm, radius, 2e-3 * radius);
        EXPECT_LT(rim.circularity_mm, 2e-3 * radius);
        const Vector3d centre = mandrel.file_to_mandrel.inverse() * rim.centre_mm;
        const Vector3d axis = mandrel.file_to_mandrel.inverse().linear() * rim.axis;
        EXPECT_NEAR((centre - Vector3d(0, 0, axis.z() > 0.0 ? high : low)).norm(), 0.0, 1e-3);
        EXPECT_NEAR(std::abs(axis.z()), 1.0, 1e-6);
    }
}

TEST(FlatEnds, FaceOfASolidEndIsPartedFromItsRoundLip) {
    for (const double lip : {0.5, 1.5, 4.0}) {
        const TriangleSoup soup = test::revolve(solid_with_lips(20.0, 80.0, lip), 48);
        expect_ends(build_mandrel(soup, "lips"), 20.0, lip, 80.0 - lip);
    }
}

TEST(FlatEnds, TabsBelongToTheEndTheyStandOn) {
    const auto tabs = [](std::size_t ring, int s) { return ring == 2 && s % 16 < 3 ? 3.0 : 0.0; };
    for (const double bore : {0.0, 12.0}) {
        // Inside the wall, and flush with it.
        const TriangleSoup inside = pipe_with_cells({bore, 15.0, 16.0, 18.5, 20.0}, 80.0, 48, tabs);
        expect_ends(build_mandrel(inside, "tabs"), 20.0, 0.0, 80.0);
        const TriangleSoup flush = pipe_with_cells({bore, 15.0, 17.0, 20.0}, 80.0, 48, tabs);
        expect_ends(build_mandrel(flush, "flush tabs"), 20.0, 0.0, 80.0);
    }
}

// The ring between leg and spigot looks like an end, but the part goes on before it.
TEST(FlatEnds, ShouldersAndPilotsAreNoEnds) {
    const std::vector<Vector2d> stepped{{0.0, 0.0},   {20.0, 0.0},  {20.0, 60.0},
                                        {12.0, 60.0}, {12.0, 66.0}, {0.0, 66.0}};
    EXPECT_EQ(count_of(test::revolve(stepped, 48)), 2);
    const Mandrel mandrel = build_mandrel(test::revolve(stepped, 48), "spigot");
    ASSERT_EQ(mandrel.rims.size(), 2U);
    EXPECT_NEAR(std::min(mandrel.rims[0].radius_mm, mandrel.rims[1].radius_mm), 12.0, 1e-3);
}

TEST(FlatEnds, BottomsOfHolesAreNoEnds) {
    const std::vector<Vector2d> blind{{0.0, 0.0},   {20.0, 0.0},  {20.0, 60.0},
                                      {12.0, 60.0}, {12.0, 30.0}, {0.0, 30.0}};
    EXPECT_EQ(count_of(test::revolve(blind, 48)), 2);
}

TEST(FlatEnds, DomesAndBoxesHaveNone) {
    std::vector<Vector2d> ball;
    for (int i = 0; i <= 12; ++i) {
        ball.emplace_back(20.0 * std::sin(kPi * i / 12), -20.0 * std::cos(kPi * i / 12));
    }
    ball.front().x() = ball.back().x() = 0.0;
    EXPECT_EQ(count_of(test::revolve(ball, 24)), 0);
    std::vector<Vector2d> ring;
    for (int i = 0; i <= 12; ++i) {
        const double turned = kPi * (2 * i + 1) / 12;  // flats at top and bottom
        ring.emplace_back(50.0 + 20.0 * std::cos(turned), 20.0 * std::sin(turned));
    }
    ring.back() = ring.front();
    EXPECT_EQ(count_of(test::revolve(ring, 48)), 0);
    EXPECT_EQ(count_of(test::box({0, 0, 0}, {10, 10, 40})), 0);
}

}  // namespace
}  // namespace meshwind
