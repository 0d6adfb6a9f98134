#include "postproc/eye/fibre_curve.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "tests/support/synthetic_paths.h"

namespace meshwind {
namespace {

// Worst distance of the interpolated eye from the true one, and sideways part of it.
double worst_eye_mm(int n) {
    const test::EllipsoidLine line{.swing = 0.6, .waves = 2.0};
    const EyePath coarse = test::on_ellipsoid(line, n + 1);
    constexpr int kFiner = 64;
    const EyePath fine = test::on_ellipsoid(line, kFiner * n + 1);
    double worst = 0.0;
    for (std::size_t i = 0; i + 1 < coarse.size(); ++i) {
        double least = 1e9;
        const Eigen::Vector3d eye = fibre_between(coarse[i], coarse[i + 1], 0.4).eye_mm();
        for (std::size_t k = 0; k < kFiner; ++k) {
            const Eigen::Vector3d& a = fine[i * kFiner + k].eye_mm;
            const Eigen::Vector3d along = (fine[i * kFiner + k + 1].eye_mm - a).normalized();
            least = std::min(least, along.cross(eye - a).norm());
        }
        worst = std::max(worst, least);
    }
    return worst;
}

TEST(FibreCurve, MeetsItsStationsWithOrthogonalFrames) {
    const EyePath path = test::elliptic_helix(200);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        for (const double share : {0.0, 0.3, 1.0}) {
            const FibreFrame at = fibre_between(path[i], path[i + 1], share);
            EXPECT_NEAR(at.tangent.dot(at.normal), 0.0, 1e-14);
            EXPECT_NEAR(at.normal.cross(at.tangent).dot(at.binormal), 1.0, 1e-14);
        }
        const FibreFrame end = fibre_between(path[i], path[i + 1], 1.0);
        EXPECT_NEAR((end.eye_mm() - path[i + 1].eye_mm).norm(), 0.0, 1e-11);
        EXPECT_NEAR((end.binormal - path[i + 1].binormal).norm(), 0.0, 1e-13);
    }
}

TEST(FibreCurve, EyeConvergesWithTheCubeOfTheStep) {
    // The tangent is the cubic's own, of third order, and the free length hands it to the eye.
    const double coarse = worst_eye_mm(100);
    const double fine = worst_eye_mm(200);
    EXPECT_GT(std::log2(coarse / fine), 2.6);
    EXPECT_LT(fine, 0.05);  // stations 5 mm apart
}

TEST(FibreCurve, TurnsEvenlyOverAFeatureEdge) {
    EyePoint before;
    before.landing_mm = {10.0, 0.0, 0.0};
    before.tangent = {0.0, 1.0, 0.0};
    before.binormal = {0.0, 0.0, 1.0};
    before.free_length_mm = 100.0;
    EyePoint after = before;
    after.tangent = {-1.0, 0.0, 0.0};
    const FibreFrame at = fibre_between(before, after, 0.5);
    EXPECT_NEAR((at.landing_mm - before.landing_mm).norm(), 0.0, 1e-15);
    EXPECT_NEAR(at.tangent.x(), -std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(at.tangent.y(), std::sqrt(0.5), 1e-15);
    EXPECT_NEAR((at.binormal - before.binormal).norm(), 0.0, 1e-15);
}

}  // namespace
}  // namespace meshwind
