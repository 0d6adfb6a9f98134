#include "winding/revolution/regular_parts.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make.h"

namespace meshwind {
namespace {

// Layers go as 1 / (r cos a); on a cone 1 / sin(a) is linear in the radius.
TEST(RegularParts, LayersOfAConeHaveAClosedForm) {
    const RevolutionFinding found =
        find_revolution(build_mandrel(make_cone({60.0, 30.0, 200.0}), "made.stl"));
    ASSERT_TRUE(found.body);
    const Meridian& meridian = found.body->meridian;
    const double slip = 0.16;
    const double sine = std::sin(rad_from_deg(55.0));
    const bool narrows = meridian.at(0.0).radius_mm > 45.0;
    const MeridianPass pass = pass_through(meridian, meridian.widest_mm(), rad_from_deg(55.0),
                                           slip * (narrows ? 1 : -1), 4.0, 1e4);
    PlanZones zones;
    regular_parts(*found.body, pass, {0.0, meridian.length_mm()}, 6.0, zones);
    ASSERT_TRUE(zones.regular && zones.meant);
    for (const double arc : {20.0, 80.0, 170.0}) {
        const MeridianPlace at = meridian.at(arc);
        const double share = at.radius_mm / 60.0;
        const double here = 1.0 / (share / sine + slip / 0.15 * (1.0 - share));
        const Eigen::Vector3d place(at.radius_mm, 0.0, at.z_mm);
        EXPECT_TRUE(zones.regular(place));
        // Linear between stations 4 mm apart: c turns by 1e-4 / mm^2.
        EXPECT_NEAR(zones.meant(place) * at.radius_mm * std::sqrt(1.0 - here * here), 1.0, 1e-4);
    }
    const MeridianPlace edge = meridian.at(11.0);
    EXPECT_FALSE(zones.regular(Eigen::Vector3d(edge.radius_mm, 0.0, edge.z_mm)));
}

TEST(ShareBetween, OfAConeHasAClosedForm) {
    const RevolutionFinding found =
        find_revolution(build_mandrel(make_cone({60.0, 30.0, 200.0}), "made.stl"));
    ASSERT_TRUE(found.body);
    const Meridian& meridian = found.body->meridian;
    const double from_mm = meridian.at(0.0).radius_mm;
    for (const double part : {0.1, 0.5, 0.93}) {
        const double to_mm = meridian.at(part * meridian.length_mm()).radius_mm;
        const double share = part * (from_mm + to_mm) / (60.0 + 30.0);
        const double arc_mm = part * meridian.length_mm();
        EXPECT_NEAR(share_between(meridian, {-1.0, arc_mm}), share, 1e-3);
        EXPECT_NEAR(share_between(meridian, {arc_mm, 1e3}), 1.0 - share, 1e-3);
    }
}

TEST(RegularParts, DomesAreNone) {
    const RevolutionFinding found = find_revolution(build_mandrel(make_ellipsoid({}), "made.stl"));
    ASSERT_TRUE(found.body);
    PlanZones zones;
    regular_parts(*found.body, {}, {0.0, found.body->meridian.length_mm()}, 6.0, zones);
    EXPECT_FALSE(zones.regular);
}

}  // namespace
}  // namespace meshwind
