#include "postproc/eye/repeated_path.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kRadius_mm = 50.0;
constexpr double kFree_mm = 100.0;
constexpr std::int32_t kPieces = 4;  // of a circuit

// Helices up and down with half hoops between, `circuits` of them; the mandrel turns on so that the
// eye stays at y = 0. One piece more is in front that is like no other.
class Pattern {
public:
    explicit Pattern(int circuits) {
        add(40.0, 7, 0.0);
        for (int i = 0; i < circuits; ++i) {
            add(300.0, 30, 200.0);
            add(150.0, 10, 0.0);
            add(300.0, 30, -200.0);
            add(170.0, 10, 0.0);
        }
    }

    EyePath path;

private:
    // \param around_mm, up_mm of the piece
    void add(double around_mm, int steps, double up_mm) {
        const double length = std::hypot(around_mm, up_mm);
        for (int i = 0; i <= steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            const double at = azimuth_ + share * around_mm / kRadius_mm;
            EyePoint point;
            point.piece = piece_;
            point.point = i;
            point.s_mm = s_mm_ + share * length;
            point.landing_mm = {kRadius_mm * std::cos(at), kRadius_mm * std::sin(at),
                                z_mm_ + share * up_mm};
            const Eigen::Vector3d along(-std::sin(at), std::cos(at), 0.0);
            point.tangent = (around_mm * along + up_mm * Eigen::Vector3d::UnitZ()) / length;
            const Eigen::Vector3d normal(std::cos(at), std::sin(at), 0.0);
            point.binormal = normal.cross(point.tangent);
            set_eye(point, kFree_mm);
            point.turn_rad = -at;
            path.push_back(point);
        }
        azimuth_ += around_mm / kRadius_mm;
        z_mm_ += up_mm;
        s_mm_ += length;
        ++piece_;
    }

    std::int32_t piece_ = 0;
    double azimuth_ = 0.0;
    double z_mm_ = 0.0;
    double s_mm_ = 0.0;
};

double largest_step_mm(const EyePath& path) {
    double largest = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        largest = std::max(largest, (path[i].landing_mm - path[i - 1].landing_mm).norm());
    }
    return largest;
}

TEST(RepeatedPath, KeepsAFewCircuitsAsOneFibre) {
    const Pattern pattern(40);
    const std::vector<double> ahead(pattern.path.size(), 0.0);
    const RepeatedPath repeated(pattern.path, ahead);
    const EyePath& few = repeated.few();
    EXPECT_EQ(few.size(), Pattern(kKeptCircuits).path.size());
    EXPECT_EQ(repeated.few_ahead_mm().size(), few.size());
    // Where circuits were left out the fibre runs on, and the mandrel with it.
    EXPECT_NEAR(largest_step_mm(few), largest_step_mm(pattern.path), 1e-9);
    for (std::size_t i = 1; i < few.size(); ++i) {
        EXPECT_GE(few[i].s_mm, few[i - 1].s_mm);
        EXPECT_LT(std::abs(few[i].turn_rad - few[i - 1].turn_rad), 0.5) << i;
        EXPECT_NEAR((few[i].eye_mm - few[i].landing_mm - kFree_mm * few[i].tangent).norm(), 0.0,
                    1e-9);
    }
}

TEST(RepeatedPath, PutsTheMotionItWasGivenBackUnchanged) {
    const Pattern pattern(40);
    const RepeatedPath repeated(pattern.path, std::vector<double>(pattern.path.size(), 0.0));
    const EyePath all = repeated.all(pattern.path, repeated.few());
    ASSERT_EQ(all.size(), pattern.path.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_NEAR(all[i].turn_rad, pattern.path[i].turn_rad, 1e-9) << i;
        EXPECT_NEAR((all[i].eye_mm - pattern.path[i].eye_mm).norm(), 0.0, 1e-9) << i;
        const EyePoint& stands = repeated.few()[repeated.few_of(i)];
        EXPECT_EQ(stands.point, pattern.path[i].point);
        EXPECT_NEAR(stands.landing_mm.z(), pattern.path[i].landing_mm.z(), 1e-9);
    }
}

// A choice that has not settled: lengths and turns grow all along the few.
TEST(RepeatedPath, RepeatsWhatWasChosenWithoutASeam) {
    const Pattern pattern(40);
    const RepeatedPath repeated(pattern.path, std::vector<double>(pattern.path.size(), 0.0));
    EyePath chosen = repeated.few();
    for (EyePoint& point : chosen) {
        point.turn_rad += 2e-5 * point.s_mm + 0.1 * std::sin(0.01 * point.s_mm);
        set_eye(point, kFree_mm + 0.003 * point.s_mm);
    }
    const EyePath all = repeated.all(pattern.path, chosen);
    for (std::size_t i = 1; i < all.size(); ++i) {
        const double ds = all[i].s_mm - all[i - 1].s_mm;
        EXPECT_LT(std::abs(all[i].free_length_mm - all[i - 1].free_length_mm), 0.01 * ds + 1e-9);
        const double more = (all[i].turn_rad - pattern.path[i].turn_rad) -
                            (all[i - 1].turn_rad - pattern.path[i - 1].turn_rad);
        EXPECT_LT(std::abs(more), 0.002 * ds + 1e-9) << i;
        if (all[i].piece >= 1 + 10 * kPieces && all[i].piece < 1 + 30 * kPieces) {
            const std::size_t circuit = (pattern.path.size() - 8) / 40;
            EXPECT_NEAR(all[i].free_length_mm, all[i + circuit].free_length_mm, 1e-9) << i;
        }
    }
    EXPECT_EQ(all.back().free_length_mm, chosen.back().free_length_mm);
}

TEST(RepeatedPath, LeavesWhatDoesNotRepeat) {
    Pattern pattern(40);
    for (EyePoint& point : pattern.path) {
        point.landing_mm.x() *= 1.001;  // an oval
    }
    const RepeatedPath repeated(pattern.path, std::vector<double>(pattern.path.size(), 0.0));
    EXPECT_EQ(repeated.few().size(), pattern.path.size());
    EXPECT_EQ(repeated.few_of(1234), 1234U);
}

}  // namespace
}  // namespace meshwind
