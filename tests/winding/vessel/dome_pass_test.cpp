#include "winding/vessel/dome_pass.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "tests/support/gas_cylinder.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;

// Angles and lengths were found by another quadrature to about 1e-10.
TEST(GeodesicPass, HasThePublishedVesselsGeodesics) {
    const Json ref = test::gas_cylinder();
    ASSERT_EQ(ref["geodesics"].size(), 8U);
    for (const Json& row : ref["geodesics"]) {
        SCOPED_TRACE(row.dump());
        const double angle = rad_from_deg(row["angle_deg"]);
        const double radius = ref["radius"];
        const double length = ref["length"];
        const IsotensoidDome dome = test::published_dome(ref, row["dome"]);
        const DomePass pass = geodesic_pass(dome, radius * std::sin(angle));
        EXPECT_NEAR(pass.turn_rad, row["dome_turn_rad"].get<double>(), 1e-9);
        EXPECT_NEAR(pass.length_mm, row["pass_length"].get<double>(), 1e-9);
        const double turn = 2.0 * (pass.turn_rad + length * std::tan(angle) / radius);
        EXPECT_NEAR(std::fmod(turn, 2.0 * kPi), row["circuit_turn_rad"].get<double>(), 1e-8);
        EXPECT_NEAR(2.0 * length / std::cos(angle) + 4.0 * pass.length_mm,
                    row["circuit_length"].get<double>(), 1e-8);
    }
}

// Half great circles, whatever the angle; the dome is off the sphere by less than twice 1e-6.
TEST(GeodesicPass, GoesHalfAroundASphere) {
    const IsotensoidDome dome({100.0, 30.0, 1.0 - 1e-6});
    for (const double clairaut : {35.0, 60.0, 95.0, 99.9}) {
        const DomePass pass = geodesic_pass(dome, clairaut);
        EXPECT_NEAR(pass.turn_rad, kPi, 2e-5) << clairaut;
        EXPECT_NEAR(pass.length_mm, 50.0 * kPi, 2e-3) << clairaut;
    }
}

// Beside the least radius, a closed geodesic, a fibre circles longer and longer: by the neck's
// hyperbolic law half the logarithm of the distance, so for each tenth equally much more.
TEST(GeodesicPass, CirclesAtTheNeck) {
    const IsotensoidDome dome({40.0, 15.0, 0.0});
    double last = 0.0;
    double added = 0.0;
    for (const double off : {1e-3, 1e-4, 1e-5, 1e-6}) {
        const double turn = geodesic_pass(dome, dome.least_radius_mm() + off).turn_rad;
        if (last > 0.0) {
            EXPECT_GT(turn, last + 0.1);
            if (added > 0.0) {
                EXPECT_NEAR(turn - last, added, 0.01 * added);
            }
            added = turn - last;
        }
        last = turn;
    }
}

// A fibre over any body of revolution by any law of its angle, and its curvatures by differences of
// its points: Y = 3 + sin(z) / 2, alpha = 0.4 + 0.3 z.
class AnyFibre {
public:
    static double radius(double z) { return 3.0 + 0.5 * std::sin(z); }
    static double slope(double z) { return 0.5 * std::cos(z); }
    static double angle(double z) { return 0.4 + 0.3 * z; }
    static double length_rate(double z) { return std::hypot(1.0, slope(z)) / std::cos(angle(z)); }
    // Five places at steps of h around z: positions relative to the middle meridian.
    static Vector3d point(double z, double turn) {
        return {radius(z) * std::cos(turn), radius(z) * std::sin(turn), z};
    }
    static double turn_rate(double z) { return length_rate(z) * std::sin(angle(z)) / radius(z); }
    static Vector3d tangent(double z, double turn) {
        const double c = std::cos(turn);
        const double s = std::sin(turn);
        const Vector3d meridian = Vector3d(slope(z) * c, slope(z) * s, 1.0).normalized();
        return std::cos(angle(z)) * meridian + std::sin(angle(z)) * Vector3d(-s, c, 0.0);
    }
};

TEST(SlipRatio, IsThatOfTheCurvatures) {
    constexpr double kStep = 1e-4;  // errors of its square
    for (const double z : {-1.5, -0.3, 0.0, 0.8, 1.4}) {
        // Turns to both sides by Simpson's rule.
        const auto turn = [&](double h) {
            return h / 6.0 *
                   (AnyFibre::turn_rate(z) + 4.0 * AnyFibre::turn_rate(z + 0.5 * h) +
                    AnyFibre::turn_rate(z + h));
        };
        const Vector3d after = AnyFibre::tangent(z + kStep, turn(kStep));
        const Vector3d before = AnyFibre::tangent(z - kStep, turn(-kStep));
        // The tangent is that of the points.
        const Vector3d chord =
            AnyFibre::point(z + kStep, turn(kStep)) - AnyFibre::point(z - kStep, turn(-kStep));
        ASSERT_LT((chord.normalized() - AnyFibre::tangent(z, 0.0)).norm(), 1e-7);
        const Vector3d bend = (after - before) / (2.0 * kStep * AnyFibre::length_rate(z));
        const double slope = AnyFibre::slope(z);
        const double angle = AnyFibre::angle(z);
        const Vector3d normal = Vector3d(1.0, 0.0, -slope).normalized();
        const Vector3d meridian = Vector3d(slope, 0.0, 1.0).normalized();
        const Vector3d to_hoop = -std::sin(angle) * meridian + std::cos(angle) * Vector3d::UnitY();
        const double exact = bend.dot(to_hoop) / -bend.dot(normal);
        const MeridianFibre fibre{AnyFibre::radius(z), slope, -0.5 * std::sin(z), angle,
                                  0.3 / AnyFibre::length_rate(z)};
        EXPECT_NEAR(slip_ratio(fibre), exact, 1e-6) << z;
    }
}

// A place on the dome as the paper sees it: Z grows from the opening to the equator.
MeridianFibre on_meridian(const IsotensoidDome& dome, double radius) {
    const double t = dome.parameter_at(radius);
    const Eigen::Vector2d rate = dome.rate_mm(t);
    MeridianFibre fibre;
    fibre.radius_mm = radius;
    fibre.slope = -rate.x() / rate.y();
    fibre.bend_per_mm =
        -dome.curvatures(t).meridian_per_mm * std::pow(1.0 + fibre.slope * fibre.slope, 1.5);
    return fibre;
}

// A geodesic has no slip, and eq. (18), which takes dalpha/ds for nothing, gives it much.
TEST(SlipRatio, IsZeroOnGeodesicsWhereEq18IsNot) {
    const Json ref = test::gas_cylinder();
    const IsotensoidDome dome = test::published_dome(ref, "literal");
    ASSERT_EQ(ref["slip"]["geodesic_of_18"].size(), 4U);
    for (const Json& row : ref["slip"]["geodesic_of_18"]) {
        MeridianFibre fibre = on_meridian(dome, row["radius"]);
        const double y = fibre.radius_mm;
        const double clairaut =
            ref["radius"].get<double>() * std::sin(rad_from_deg(row["angle_deg"]));
        fibre.angle_rad = std::asin(clairaut / y);
        EXPECT_NEAR(slip_ratio(fibre), row["of_18"].get<double>(), 1e-5) << row;
        // By Y sin(alpha) = const; dY/ds = Y' cos(alpha) / A.
        const double along = fibre.slope * std::cos(fibre.angle_rad) / std::hypot(1.0, fibre.slope);
        fibre.angle_rate_per_mm = -along * clairaut / (y * y * std::cos(fibre.angle_rad));
        EXPECT_NEAR(slip_ratio(fibre), 0.0, 1e-14) << row;
    }
}

// The speed law v_z = k sqrt(Z) at a constant speed of the fibre: cos(alpha) = A v_z / v. The paper
// takes 0.3 for enough; it needs 0.90.
TEST(SlipRatio, OfThePublishedSpeedLaw) {
    const Json ref = test::gas_cylinder();
    const IsotensoidDome dome = test::published_dome(ref, "literal");
    const double on_cylinder = rad_from_deg(ref["slip"]["candidate"]["angle_deg"]);
    const double top = dome.height_mm(dome.parameter_at(ref["opening"]));
    const auto z_at = [&](double radius) {
        return top - dome.height_mm(dome.parameter_at(radius));
    };
    const auto angle_at = [&](double radius) {
        const double a = std::hypot(1.0, on_meridian(dome, radius).slope);
        return std::acos(a * std::sqrt(z_at(radius) / top) * std::cos(on_cylinder));
    };
    double largest = 0.0;
    for (const Json& row : ref["slip"]["candidate"]["rows"]) {
        SCOPED_TRACE(row.dump());
        MeridianFibre fibre = on_meridian(dome, row["radius"]);
        fibre.angle_rad = angle_at(fibre.radius_mm);
        EXPECT_NEAR(deg_from_rad(fibre.angle_rad), row["winding_deg"].get<double>(), 1e-4);
        EXPECT_NEAR(slip_ratio(fibre), row["of_18"].get<double>(), 1e-4);
        const double h = 1e-5;
        const double along = fibre.slope * std::cos(fibre.angle_rad) / std::hypot(1.0, fibre.slope);
        fibre.angle_rate_per_mm =
            (angle_at(fibre.radius_mm + h) - angle_at(fibre.radius_mm - h)) / (2.0 * h) * along;
        EXPECT_NEAR(slip_ratio(fibre), row["slip"].get<double>(), 1e-4);
        largest = std::max(largest, slip_ratio(fibre));
    }
    EXPECT_GT(largest, 0.9);
}

// On a sphere the moment grows by slip R sin(latitude): slip = (c - m) / sqrt(R^2 - c^2).
TEST(SlipToTurn, HasTheSpheresClosedForm) {
    const IsotensoidDome dome({100.0, 30.0, 1.0 - 1e-6});
    for (const double clairaut : {20.0, 40.0, 49.0}) {
        const double exact = (50.0 - clairaut) / std::sqrt(7500.0);
        const auto slip = slip_to_turn(dome, clairaut, 50.0);
        ASSERT_TRUE(slip);
        EXPECT_NEAR(*slip, exact, 1e-5);
    }
    EXPECT_EQ(slip_to_turn(dome, 50.0, 50.0), 0.0);
    EXPECT_FALSE(slip_to_turn(dome, 1.0, 80.0));  // 79 / 60 > 1
}

}  // namespace
}  // namespace meshwind
