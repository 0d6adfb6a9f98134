#include "postproc/motion/choose_blocks.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "tests/support/synthetic_paths.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Nothing but the bound under test shall bind.
constexpr BlockTolerance kLoose{
    .sideways_mm = 1e3, .angle_rad = 10.0, .eye_mm = 1e3, .twist_rad = 10.0};

// Axis values of some 10^4 degrees, back and forth through the kinematics, and landing points by
// secants.
constexpr double kKinematics_mm = 1e-6;

Machine six_axis() {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/six_axis.json");
}

struct Chosen {
    EyePath path;
    JointPath joints;
    BlockChoice choice;
};

Chosen chosen(const Machine& machine, EyePath path, const BlockTolerance& tolerance) {
    Chosen result;
    result.path = std::move(path);
    result.joints = solve_joints(machine, result.path, RedundancyPolicy::CentralAngle);
    result.choice =
        choose_blocks(machine, {.path = result.path, .joints = result.joints}, tolerance);
    return result;
}

std::size_t blocks(const Chosen& result) {
    return result.choice.ends.size() - 1;
}

// The fibre laid by the chosen blocks, by plain search along a reference path that is so dense that
// straight lines between its points are exact enough.
struct Laid {
    double sideways_mm = 0.0;
    double angle_rad = 0.0;
    double eye_mm = 0.0;
};

double distance_to_eyes(const EyePath& reference, std::size_t around, const Vector3d& eye) {
    double least = 1e9;
    const std::size_t first = around > 2000 ? around - 2000 : 0;
    for (std::size_t i = first; i + 1 < reference.size() && i < around + 2000; ++i) {
        const Vector3d step = reference[i + 1].eye_mm - reference[i].eye_mm;
        const Vector3d off = eye - reference[i].eye_mm;
        const double share = std::clamp(off.dot(step) / step.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (off - share * step).norm());
    }
    return least;
}

Laid wind_up(const Machine& machine, const EyePath& reference, const Chosen& result) {
    constexpr int kSamples = 50;
    const auto normal = [&](std::size_t i) {
        return reference[i].tangent.cross(reference[i].binormal);
    };
    const auto height = [&](std::size_t i, const Vector3d& eye) {
        return normal(i).dot(eye - reference[i].landing_mm);
    };
    const auto pull = [&](std::size_t i, const Vector3d& eye) {
        return reference[i].binormal.dot(eye - reference[i].landing_mm);
    };
    Laid worst;
    std::size_t at = 0;
    double laid_mm = 0.0;
    double y = 0.0;
    for (std::size_t k = 1; k < result.choice.ends.size(); ++k) {
        const auto from = result.joints.row(result.choice.ends[k - 1]);
        const auto to = result.joints.row(result.choice.ends[k]);
        for (int sample = 1; sample <= kSamples; ++sample) {
            std::vector<double> q(from.begin(), from.end());
            for (std::size_t a = 0; a < q.size(); ++a) {
                q[a] += (to[a] - from[a]) * sample / kSamples;
            }
            const Vector3d eye = mandrel_from_eye(machine, q).translation();
            while (at + 2 < reference.size() && height(at + 1, eye) <= 0.0) {
                ++at;
            }
            const double low = height(at, eye);
            const double high = height(at + 1, eye);
            const double share = std::clamp(-low / (high - low), 0.0, 1.0);
            const double delta = (1.0 - share) * pull(at, eye) + share * pull(at + 1, eye);
            const double s_mm = (1.0 - share) * reference[at].s_mm + share * reference[at + 1].s_mm;
            const double length = (eye - reference[at].landing_mm).norm();
            if (s_mm > laid_mm) {
                const double angle = (delta - y) / length;
                worst.angle_rad = std::max(worst.angle_rad, std::abs(angle));
                y += angle * (s_mm - laid_mm);
                laid_mm = s_mm;
            }
            worst.sideways_mm = std::max(worst.sideways_mm, std::abs(y));
            if (sample % 10 == 5) {
                worst.eye_mm = std::max(worst.eye_mm, distance_to_eyes(reference, at, eye));
            }
        }
    }
    return worst;
}

TEST(ChooseBlocks, HelixOnACylinderIsOneBlock) {
    const Machine machine = six_axis();
    const Chosen result =
        chosen(machine, test::helix(70.0, rad_from_deg(45.0), 200.0, 2.0, 5000), {});
    EXPECT_EQ(result.choice.ends, (std::vector<std::size_t>{0, 4999}));
    EXPECT_LT(result.choice.worst_pull_mm, kKinematics_mm);
    EXPECT_LT(result.choice.worst_eye_mm, kKinematics_mm);
    EXPECT_NEAR(result.choice.fibre_mm[1], 9998.0, 1e-6);
    EXPECT_EQ(result.choice.beyond, 0U);
}

TEST(ChooseBlocks, LongestBlockCutsEvenly) {
    const Machine machine = six_axis();
    BlockTolerance tolerance = kLoose;
    tolerance.most_mm = 300.0;  // of 9,998 mm, in steps of 2
    const Chosen result =
        chosen(machine, test::helix(70.0, rad_from_deg(45.0), 200.0, 2.0, 5000), tolerance);
    EXPECT_EQ(blocks(result), 34U);
    for (std::size_t k = 1; k < result.choice.ends.size(); ++k) {
        EXPECT_NEAR(result.choice.fibre_mm[k], 9998.0 / 34.0, 2.0);
    }
}

TEST(ChooseBlocks, EveryStrokeIsOneBlock) {
    const Machine machine = six_axis();
    const Chosen result = chosen(machine, test::strokes(70.0, 200.0, 2.0, 400.0, 4), {});
    std::vector<int> count(8, 0);
    for (std::size_t k = 1; k < result.choice.ends.size(); ++k) {
        const EyePoint& first = result.path[result.choice.ends[k - 1] + 1];
        const EyePoint& last = result.path[result.choice.ends[k]];
        EXPECT_EQ(first.piece, last.piece) << "a block runs over the end of a piece";
        ++count[static_cast<std::size_t>(last.piece)];
    }
    for (const std::size_t stroke : {0U, 2U, 4U, 6U}) {
        EXPECT_EQ(count[stroke], 1) << "stroke " << stroke;
        EXPECT_GT(count[stroke + 1], 1) << "turn " << stroke + 1;
    }
    EXPECT_LT(blocks(result), result.path.size() / 4);
}

TEST(ChooseBlocks, BlocksFallWithTheRootOfTheTolerance) {
    // A chord is off by the square of its length: four times the tolerance, half the blocks.
    const Machine machine = six_axis();
    const EyePath path = test::on_ellipsoid({.swing = 0.4, .waves = 2.0}, 4000);
    const auto count = [&](double eye_mm, double sideways_mm) {
        BlockTolerance tolerance = kLoose;
        tolerance.eye_mm = eye_mm;
        tolerance.sideways_mm = sideways_mm;
        return static_cast<double>(blocks(chosen(machine, path, tolerance)));
    };
    for (const double tolerance : {0.02, 0.08}) {
        EXPECT_NEAR(count(tolerance, 1e3) / count(4.0 * tolerance, 1e3), 2.0, 0.25);
        EXPECT_GT(count(1e3, tolerance) / count(1e3, 4.0 * tolerance), 1.5);
    }
}

TEST(ChooseBlocks, LaidFibreKeepsTheTolerance) {
    const Machine machine = six_axis();
    std::mt19937_64 random(7);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int round = 0; round < 12; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const test::EllipsoidLine line{.swing = uniform(0.1, 0.6),
                                       .waves = std::floor(uniform(1.0, 4.0)),
                                       .phase_rad = uniform(0.0, 2.0 * kPi),
                                       .free_length_mm = uniform(80.0, 300.0),
                                       .longer_mm = uniform(-20.0, 20.0)};
        BlockTolerance tolerance;
        tolerance.sideways_mm = std::pow(10.0, uniform(-1.7, -0.3));
        tolerance.angle_rad = std::pow(10.0, uniform(-2.8, -1.5));
        tolerance.eye_mm = std::pow(10.0, uniform(-1.0, 0.7));
        const Chosen result = chosen(machine,
                                     refine_path(machine, test::on_ellipsoid(line, 501),
                                                 RedundancyPolicy::CentralAngle, tolerance),
                                     tolerance);
        const Laid laid = wind_up(machine, test::on_ellipsoid(line, 25 * 500 + 1), result);
        // The stations are 1 to 3 mm apart; between them the plan is known to about 0.003 mm.
        constexpr double kPlan_mm = 0.005;
        EXPECT_LE(laid.sideways_mm, tolerance.sideways_mm + kPlan_mm);
        EXPECT_LE(laid.angle_rad, tolerance.angle_rad + 2.0 * kPlan_mm / 60.0);
        EXPECT_LE(laid.eye_mm, 1.01 * tolerance.eye_mm + kPlan_mm);
        // And not by being far inside: one of the bounds is used.
        EXPECT_GT(std::max({laid.sideways_mm / tolerance.sideways_mm,
                            laid.angle_rad / tolerance.angle_rad, laid.eye_mm / tolerance.eye_mm}),
                  0.8);
        EXPECT_NEAR(laid.sideways_mm, result.choice.worst_sideways_mm, kPlan_mm);
        EXPECT_NEAR(laid.eye_mm, result.choice.worst_eye_mm, 0.05 * tolerance.eye_mm + kPlan_mm);
    }
}

TEST(ChooseBlocks, RefinesOnlyWhatNeedsIt) {
    const Machine machine = six_axis();
    const EyePath straight = test::helix(70.0, rad_from_deg(45.0), 200.0, 20.0, 100);
    EXPECT_EQ(refine_path(machine, straight, RedundancyPolicy::CentralAngle, {}).size(), 100U);

    const EyePath coarse = test::on_ellipsoid({.swing = 0.5, .waves = 2.0}, 40);
    EXPECT_GT(chosen(machine, coarse, {}).choice.beyond, 0U);
    const EyePath fine = refine_path(machine, coarse, RedundancyPolicy::CentralAngle, {});
    EXPECT_GT(fine.size(), coarse.size());
    EXPECT_EQ(chosen(machine, fine, {}).choice.beyond, 0U);
    for (std::size_t i = 1; i < fine.size(); ++i) {
        EXPECT_GE(fine[i].point, fine[i - 1].point);
        EXPECT_GT(fine[i].s_mm, fine[i - 1].s_mm);
    }
}

TEST(ChooseBlocks, RoomOfTheHeadMakesBlocksShorterThereAlone) {
    const Machine machine = six_axis();
    const EyePath path = test::on_ellipsoid({.swing = 0.4, .waves = 2.0}, 2000);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    std::vector<double> room_mm(path.size(), 2.0);
    std::fill(room_mm.begin() + 1000, room_mm.end(), 0.01);
    const BlockChoice choice =
        choose_blocks(machine, {.path = path, .joints = joints, .room_mm = room_mm}, kLoose);
    const auto half = std::lower_bound(choice.ends.begin(), choice.ends.end(), 1000U);
    EXPECT_GT(choice.ends.end() - half, 5 * (half - choice.ends.begin()));
}

TEST(ChooseBlocks, FibreLengthCountsTheFastestStretch) {
    const Machine machine = six_axis();
    const Chosen result = chosen(machine, test::elliptic_helix(2000), {});
    double longest = 0.0;
    for (std::size_t k = 1; k < result.choice.ends.size(); ++k) {
        const EyePoint& from = result.path[result.choice.ends[k - 1]];
        const EyePoint& to = result.path[result.choice.ends[k]];
        const double laid = to.s_mm - from.s_mm;
        const double drawn = laid + to.free_length_mm - from.free_length_mm;
        EXPECT_GE(result.choice.fibre_mm[k], std::max(laid, drawn) - 1e-9);
        longest = std::max(longest, result.choice.fibre_mm[k] / std::max(laid, drawn));
    }
    EXPECT_GT(longest, 1.001);
    EXPECT_LT(longest, 1.5);
}

TEST(ChooseBlocks, DegeneratePaths) {
    const Machine machine = six_axis();
    EXPECT_TRUE(chosen(machine, {}, {}).choice.ends.empty());
    const EyePath path = test::on_ellipsoid({}, 200);
    EXPECT_EQ(chosen(machine, {path[0]}, {}).choice.ends, (std::vector<std::size_t>{0}));
    EXPECT_EQ(chosen(machine, {path[0], path[1]}, {}).choice.ends,
              (std::vector<std::size_t>{0, 1}));
    const Chosen rest = chosen(machine, EyePath(50, path[3]), {});
    EXPECT_EQ(rest.choice.ends, (std::vector<std::size_t>{0, 49}));
    EXPECT_EQ(rest.choice.fibre_mm[1], 0.0);
    EXPECT_TRUE(refine_path(machine, {}, RedundancyPolicy::CentralAngle, {}).empty());

    // A dwell in the middle costs nothing and is run over.
    EyePath dwell = test::helix(70.0, rad_from_deg(45.0), 200.0, 2.0, 100);
    dwell.insert(dwell.begin() + 50, 20, dwell[50]);
    EXPECT_EQ(blocks(chosen(machine, dwell, {})), 1U);
}

TEST(ChooseBlocks, SameForAnyNumberOfThreads) {
    const Machine machine = six_axis();
    const EyePath path = test::on_ellipsoid({.swing = 0.6, .waves = 3.0}, 500);
    const auto run = [&](int threads) {
        set_thread_count(threads);
        return chosen(machine, refine_path(machine, path, RedundancyPolicy::CentralAngle, {}), {});
    };
    const Chosen one = run(1);
    const Chosen two = run(2);
    set_thread_count(0);
    EXPECT_EQ(one.choice.ends, two.choice.ends);
    EXPECT_EQ(one.choice.fibre_mm, two.choice.fibre_mm);
}

}  // namespace
}  // namespace meshwind
