#include "study/path_reference.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/GeodesicExact.hpp>

#include "core/units.h"
#include "study/helix_law.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kLengthMm = 300.0;
// 1e-10 of the length, as the header promises.
constexpr double kExactMm = 1e-10 * kLengthMm;

// On the surface near `near_mm`, heading `angle` from the way around the z axis towards +z.
CurveState start_on(const PathReference& reference, const Vector3d& near_mm, double angle) {
    const SurfaceFoot foot = reference.foot(near_mm);
    const Vector3d around = Vector3d(-near_mm.y(), near_mm.x(), 0.0).normalized();
    const Vector3d up = foot.normal.cross(around).normalized();
    return {foot.point_mm, std::cos(angle) * around + std::sin(angle) * up};
}

double hoop_moment(const CurveState& state) {
    return state.position_mm.x() * state.tangent.y() - state.position_mm.y() * state.tangent.x();
}

// There and back: the same curve is steered by the opposite ratio the other way.
double return_error_mm(const PathReference& reference, const CurveState& start, double slip_ratio) {
    CurveState end = reference.follow(start, slip_ratio, kLengthMm).states.back();
    end.tangent = -end.tangent;
    const CurveState back = reference.follow(end, -slip_ratio, kLengthMm).states.back();
    return (back.position_mm - start.position_mm).norm();
}

TEST(PathReference, CylinderReachesHoopWhereTheClosedFormSays) {
    constexpr double kRadiusMm = 40.0;
    constexpr double kSlip = 0.2;
    const double alpha = rad_from_deg(30.0);
    // To the right of +z the fibre is laid down towards hoop by a negative ratio.
    const CurveState start{{kRadiusMm, 0.0, 0.0}, {0.0, std::sin(alpha), std::cos(alpha)}};
    const double length = kRadiusMm / std::tan(alpha) / kSlip;
    const CurveState end =
        cylinder_reference(kRadiusMm)->follow(start, -kSlip, length).states.back();
    const double turn = -std::log(std::tan(0.5 * alpha)) / kSlip;
    // Rounding of lengths of 350 mm.
    EXPECT_NEAR(end.position_mm.z(), kRadiusMm / kSlip * (1.0 / std::sin(alpha) - 1.0), 1e-10);
    EXPECT_NEAR(end.position_mm.x(), kRadiusMm * std::cos(turn), 1e-10);
    EXPECT_NEAR(end.position_mm.y(), kRadiusMm * std::sin(turn), 1e-10);
    EXPECT_NEAR(end.tangent.z(), 0.0, 1e-12);
}

TEST(PathReference, CylinderGoesEitherWayAroundAndStraight) {
    const auto reference = cylinder_reference(50.0);
    for (const double angle : {0.3, 1.2, 2.0, kPi - 0.3, -0.7, -2.5}) {
        const CurveState start = start_on(*reference, {50.0, 3.0, 1.0}, angle);
        EXPECT_LT(return_error_mm(*reference, start, 0.2), kExactMm);
        EXPECT_LT(return_error_mm(*reference, start, 0.0), kExactMm);
    }
    const CurveState axial{{50.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    EXPECT_EQ(reference->follow(axial, 0.3, 100.0).states.back().position_mm,
              Vector3d(50.0, 0.0, 100.0));
}

// Between the stored points: cubic, its error stated at kStationMm.
TEST(PathReference, InterpolatesAHelix) {
    const Helix helix{50.0, 0.7};
    const ReferencePath path =
        cylinder_reference(50.0)->follow(helix_state(helix, 0.0), 0.0, kLengthMm);
    for (const double s : {0.0, 0.05, 17.0371, 123.4567, kLengthMm}) {
        const CurveState exact = helix_state(helix, s);
        EXPECT_LT((path.at(s).position_mm - exact.position_mm).norm(), 1e-11);
        // One order less: 0.1^3 / 100 / 50^3.
        EXPECT_LT((path.at(s).tangent - exact.tangent).norm(), 1e-10);
    }
}

TEST(PathReference, TorusKeepsClairautAndReturns) {
    const auto reference = torus_reference({});
    for (const double angle : {0.2, 0.9, 1.5, 2.6}) {
        const CurveState start = start_on(*reference, {180.0, 90.0, 45.0}, angle);
        for (const CurveState& state : reference->follow(start, 0.0, kLengthMm).states) {
            ASSERT_NEAR(hoop_moment(state), hoop_moment(start), kExactMm);
        }
        EXPECT_LT(return_error_mm(*reference, start, 0.2), kExactMm);
    }
}

TEST(PathReference, EllipsoidAgreesWithGeographicLib) {
    const EllipsoidShape shape;
    const double flattening = 1.0 - shape.pole_radius_mm / shape.equator_radius_mm;
    const auto reference = ellipsoid_reference(shape);
    for (const double azimuth_deg : {10.0, 50.0, 85.0, 140.0, -70.0}) {
        constexpr double kLatDeg = 25.0;
        constexpr double kLonDeg = 40.0;
        const GeographicLib::Geocentric earth(shape.equator_radius_mm, flattening);
        CurveState start;
        earth.Forward(kLatDeg, kLonDeg, 0.0, start.position_mm.x(), start.position_mm.y(),
                      start.position_mm.z());
        const double lat = rad_from_deg(kLatDeg);
        const double lon = rad_from_deg(kLonDeg);
        const Vector3d east(-std::sin(lon), std::cos(lon), 0.0);
        const Vector3d north(-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon),
                             std::cos(lat));
        const double azimuth = rad_from_deg(azimuth_deg);
        start.tangent = std::cos(azimuth) * north + std::sin(azimuth) * east;
        double lat2 = 0.0;
        double lon2 = 0.0;
        GeographicLib::GeodesicExact(shape.equator_radius_mm, flattening)
            .Direct(kLatDeg, kLonDeg, azimuth_deg, kLengthMm, lat2, lon2);
        Vector3d end;
        earth.Forward(lat2, lon2, 0.0, end.x(), end.y(), end.z());
        EXPECT_LT((reference->follow(start, 0.0, kLengthMm).states.back().position_mm - end).norm(),
                  kExactMm);
        EXPECT_LT(return_error_mm(*reference, start, 0.2), kExactMm);
    }
}

// Curvature by differences of normals against the closed one: 1e-6 of the length.
TEST(PathReference, DifferencesOfNormalsServeAnyKind) {
    const auto exact = torus_reference({});
    const auto made = made_reference("torus", {});
    for (const double slip_ratio : {0.0, 0.2}) {
        const CurveState start = start_on(*exact, {180.0, 90.0, 45.0}, 0.9);
        const Vector3d a = exact->follow(start, slip_ratio, kLengthMm).states.back().position_mm;
        const Vector3d b = made->follow(start, slip_ratio, kLengthMm).states.back().position_mm;
        EXPECT_LT((a - b).norm(), 1e-6 * kLengthMm);
    }
}

// Across the blend, where the curvature jumps twice.
TEST(PathReference, TeeReturns) {
    const auto reference = made_reference("tee", {});
    for (const double angle : {0.5, 0.8, 1.1}) {
        const CurveState start = start_on(*reference, {20.0, -45.8, -60.0}, angle);
        EXPECT_LT(return_error_mm(*reference, start, 0.0), 1e-6 * kLengthMm);
        EXPECT_LT(return_error_mm(*reference, start, 0.2), 1e-6 * kLengthMm);
    }
}

}  // namespace
}  // namespace meshwind
