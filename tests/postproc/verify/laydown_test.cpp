#include "postproc/verify/laydown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "geodesic/bridge.h"
#include "geodesic/slip_and_bridging.h"
#include "mesh/shapes/make.h"
#include "tests/support/block_lists.h"
#include "tests/support/exact_winding.h"
#include "tests/support/fixtures.h"
#include "tests/support/hourglass.h"
#include "tests/support/shapes.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::ExactCurve;

constexpr double kFree_mm = 200.0;

// Blocks of 0.5 mm of fibre.
constexpr double kFine_mm = 0.5;
constexpr double kFineDeviation_mm = 1e-3;

const Surface& torus() {
    static const Surface kSurface = test::frozen(make_torus(
        {.ring_radius_mm = 200.0, .tube_radius_mm = 50.0}, {.edge_mm = 5.0, .irregular = true}));
    return kSurface;
}

const Surface& cylinder() {
    static const Surface kSurface =
        test::made_cylinder(test::ExactCylinder{}.radius_mm, 400.0, 5.0).surface;
    return kSurface;
}

const Surface& hourglass() {
    static const Surface kSurface = test::Hourglass{}.surface(1.5);
    return kSurface;
}

// On the outside of the tube, at an angle to the meridian; up to where it is still pressed on.
ExactCurve torus_curve(double slip_ratio, double step_mm) {
    const double angle = rad_from_deg(50.0);
    return test::exact_curve(
        test::ExactTorus{},
        test::CurveState{Vector3d(250.0, 0.0, 0.0), {0.0, std::sin(angle), std::cos(angle)}},
        slip_ratio, step_mm, 120.0);
}

ExactCurve helix(double step_mm, double length_mm = 240.0) {
    const double angle = rad_from_deg(50.0);
    return test::exact_curve(
        test::ExactCylinder{},
        test::CurveState{Vector3d(50.0, 0.0, -120.0), {0.0, std::sin(angle), std::cos(angle)}}, 0.0,
        step_mm, length_mm);
}

LaidPath lay(const Surface& surface, const EyePath& path,
             RedundancyPolicy policy = RedundancyPolicy::CentralAngle,
             const LaydownOptions& options = {}, double bridge_reach_mm = kBridgeReach_mm) {
    const Machine machine = test::fine_machine();
    return lay_down(LaydownSurface(surface, bridge_reach_mm), machine,
                    test::program(machine, path, policy), path.front().landing_mm, options);
}

LaidPath lay(const Surface& surface, const ExactCurve& curve,
             RedundancyPolicy policy = RedundancyPolicy::CentralAngle,
             const LaydownOptions& options = {}) {
    return lay(surface, test::eye_path(curve, kFree_mm), policy, options);
}

// What holds for every result: finite, ordered, as long as its neighbours.
void expect_sound(const LaidPath& laid, const BlockList& list) {
    ASSERT_FALSE(laid.path.empty());
    ASSERT_EQ(laid.at.size(), laid.path.size());
    ASSERT_EQ(laid.time_s.size(), laid.samples.size());
    ASSERT_EQ(laid.block.size(), laid.samples.size());
    ASSERT_EQ(laid.joints.size(), laid.samples.size());
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        const PathPoint& p = laid.path[i];
        ASSERT_TRUE(p.position_mm.allFinite() && p.normal.allFinite() && p.tangent.allFinite());
        ASSERT_TRUE(std::isfinite(p.s_mm) && std::isfinite(laid.at[i].gap_mm));
        ASSERT_GE(p.s_mm, i > 0 ? laid.path[i - 1].s_mm : 0.0);
        ASSERT_GE(laid.at[i].block, i > 0 ? laid.at[i - 1].block : 0U);
        ASSERT_LT(laid.at[i].block, list.blocks.size());
    }
    for (const EyePoint& p : laid.samples) {
        ASSERT_TRUE(p.landing_mm.allFinite() && p.tangent.allFinite() && p.eye_mm.allFinite());
        ASSERT_GE(p.free_length_mm, 0.0);
    }
    ASSERT_TRUE(std::isfinite(laid.peeled_mm));
    ASSERT_EQ(laid.failure.empty(), laid.failed_block == 0);
}

void expect_lays(const Surface& surface, const ExactCurve& curve, RedundancyPolicy policy,
                 double tolerance_mm) {
    const LaidPath laid = lay(surface, curve, policy);
    EXPECT_EQ(laid.failure, "");
    EXPECT_EQ(laid.peeled_mm, 0.0);
    EXPECT_LT(test::farthest_mm(laid, curve), tolerance_mm);
    // Along the fibre: the chord of the eye's way over its arc, of the same order.
    EXPECT_NEAR(laid.path.back().s_mm, curve.step_mm * static_cast<double>(curve.states.size() - 1),
                10.0 * tolerance_mm);
    for (const LaidAt& at : laid.at) {
        ASSERT_FALSE(at.lifted);
    }
}

// With the central angle the eye of a helix runs exactly along its own: what is left is the
// patches' error.
TEST(LayDown, CylinderHelixWithTheCentralAngleIsExactForAnyBlocks) {
    for (const double step_mm : {4.0, 1.0}) {
        expect_lays(cylinder(), helix(step_mm), RedundancyPolicy::CentralAngle, 2e-5);
    }
}

TEST(LayDown, FineBlocksLayTheCurveThatTheyWereMadeFor) {
    expect_lays(cylinder(), helix(kFine_mm), RedundancyPolicy::Hold, kFineDeviation_mm);
    for (const double slip_ratio : {0.0, 0.15, -0.15}) {
        const ExactCurve curve = torus_curve(slip_ratio, kFine_mm);
        expect_lays(torus(), curve, RedundancyPolicy::Hold, kFineDeviation_mm);
        expect_lays(torus(), curve, RedundancyPolicy::CentralAngle, kFineDeviation_mm);
    }
}

// Between the ends of blocks the eye is off its curve by their square: on halving, a quarter.
TEST(LayDown, DeviationIsOfSecondOrderInTheBlocksLength) {
    const auto expect_quarters = [](const Surface& surface, const auto& curve_of) {
        double before = 0.0;
        for (const double step_mm : {4.0, 2.0, 1.0}) {
            const ExactCurve curve = curve_of(step_mm);
            const double off =
                test::farthest_mm(lay(surface, curve, RedundancyPolicy::Hold), curve);
            if (before > 0.0) {
                EXPECT_NEAR(before / off, 4.0, 1.0) << step_mm;
            }
            before = off;
        }
    };
    expect_quarters(cylinder(), [](double step_mm) { return helix(step_mm); });
    expect_quarters(torus(), [](double step_mm) { return torus_curve(0.0, step_mm); });
    expect_quarters(torus(), [](double step_mm) { return torus_curve(0.15, step_mm); });
}

// The cubic through four positions of the eye is of fourth order in the samples.
TEST(LayDown, DoesNotDependOnTheSamples) {
    const ExactCurve curve = torus_curve(0.0, 4.0);
    const LaidPath coarse = lay(torus(), curve);
    const LaidPath fine =
        lay(torus(), curve, RedundancyPolicy::CentralAngle, {.sample_mm = 1.0, .sample_rad = 0.01});
    ASSERT_GT(fine.samples.size(), 2 * coarse.samples.size());
    // 10 mm of the eye's way, on a circle of 200 mm and more: (10 / 200)^4 / 128 of that, 1e-5 mm.
    EXPECT_LT((fine.path.back().position_mm - coarse.path.back().position_mm).norm(), 1e-5);
}

TEST(LayDown, SamplesFollowTheBlocksInTime) {
    const Machine machine = test::fine_machine();
    const ExactCurve curve = helix(2.0);
    const BlockList list =
        test::program(machine, test::eye_path(curve, kFree_mm), RedundancyPolicy::CentralAngle);
    const LaidPath laid =
        lay_down(LaydownSurface(cylinder()), machine, list, curve.states[0].position_mm);
    expect_sound(laid, list);
    EXPECT_NEAR(laid.time_s.back(), list.duration_s(), 1e-9);
    for (const EyePoint& sample : laid.samples) {
        // Free length of a helix whose eye runs exactly.
        ASSERT_NEAR(sample.free_length_mm, kFree_mm, 0.02);
        ASSERT_NEAR(sample.tangent.z(), std::cos(rad_from_deg(50.0)), 1e-4);
    }
    EXPECT_EQ(laid.block.back(), list.blocks.size() - 1);
}

// About z, narrowing upwards by 45 deg.
struct ExactCone {
    [[nodiscard]] static Vector3d normal(const Vector3d& p) {
        return (Vector3d(p.x(), p.y(), 0.0).normalized() + Vector3d::UnitZ()).normalized();
    }
    [[nodiscard]] static Eigen::Matrix3d shape_operator_per_mm(const Vector3d& p) {
        const Vector3d around = Vector3d::UnitZ().cross(normal(p)).normalized();
        return std::sqrt(0.5) / p.head<2>().norm() * around * around.transpose();
    }
};

// A cylinder up to z = 0, a cone of 45 deg from there: the fibre crosses the ring as it would the
// unfolded surfaces, at the same angle to the ring.
TEST(LayDown, CrossesACreaseAtTheSameAngle) {
    std::vector<Eigen::Vector2d> profile;
    for (int i = -20; i <= 12; ++i) {
        profile.emplace_back(60.0 - 2.5 * std::max(0, i), i < 0 ? 4.0 * i : 2.5 * i);
    }
    const Surface surface = test::frozen(test::revolve(profile, 96));
    const double angle = rad_from_deg(30.0);
    const Vector3d ring(60.0, 0.0, 0.0);
    const Vector3d in(0.0, std::sin(angle), std::cos(angle));
    const Vector3d out(-std::sqrt(0.5) * in.z(), in.y(), std::sqrt(0.5) * in.z());
    // The cylinder's curve backwards from the ring.
    const test::ExactCylinder tube{60.0};
    const ExactCurve back = test::exact_curve(tube, {ring, -in}, 0.0, kFine_mm, 40.0);
    ExactCurve before{kFine_mm, {}, {}};
    for (std::size_t i = back.states.size(); i-- > 0;) {
        before.add({back.states[i].position_mm, -back.states[i].tangent}, back.normals[i]);
    }
    const ExactCurve after = test::exact_curve(ExactCone{}, {ring, out}, 0.0, kFine_mm, 24.0);
    ExactCurve whole = before;
    constexpr int kTurns = 20;
    for (int i = 1; i < kTurns; ++i) {
        const double fold = rad_from_deg(45.0) * i / kTurns;
        const Eigen::AngleAxisd turn(-fold, Vector3d::UnitY());
        whole.add({ring, turn * in}, turn * Vector3d::UnitX());
    }
    for (std::size_t i = 0; i < after.states.size(); ++i) {
        whole.add(after.states[i], after.normals[i]);
    }
    const LaidPath laid = lay(surface, whole);
    EXPECT_EQ(laid.failure, "");
    double off_mm = 0.0;
    std::size_t crossing = 0;
    for (const PathPoint& p : laid.path) {
        const bool over = p.position_mm.z() > 0.0;
        off_mm = std::max(off_mm, over ? after.distance_mm(p.position_mm, p.s_mm - 40.0)
                                       : before.distance_mm(p.position_mm, p.s_mm));
        crossing += (p.position_mm - ring).norm() < 0.05 ? 1 : 0;
    }
    EXPECT_LT(off_mm, kFineDeviation_mm);
    EXPECT_GE(crossing, 2U);  // a station on either side of the crease
    // At one length to the last digit, by which a path is known to be unfolded there.
    for (std::size_t i = 1; i < laid.path.size(); ++i) {
        if (laid.path[i].normal.dot(laid.path[i - 1].normal) < 0.9) {
            EXPECT_EQ(laid.path[i].s_mm, laid.path[i - 1].s_mm);
        }
    }
    const SlipMeasure slip = measure_slip(surface, laid.path, taut_string(laid.path),
                                          {.window_mm = 6.0, .method = TraceMethod::Patches});
    EXPECT_LT(slip.worst, 0.02);
    EXPECT_LT((laid.path.back().position_mm - after.states.back().position_mm).norm(),
              kFineDeviation_mm);
    EXPECT_NEAR(laid.path.back().s_mm, 64.0, kFineDeviation_mm);
}

TEST(LayDown, BridgesTheHourglassBetweenItsShoulders) {
    constexpr double kStep_mm = 0.25;
    const test::Hourglass shape;
    const ExactCurve curve = test::meridian(shape, kStep_mm);
    const LaidPath laid = lay(hourglass(), curve);
    EXPECT_EQ(laid.failure, "");
    double gap_mm = 0.0;
    double lowest = 100.0;
    double highest = -100.0;
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        gap_mm = std::max(gap_mm, laid.at[i].gap_mm);
        if (laid.at[i].lifted) {
            lowest = std::min(lowest, laid.path[i - 1].position_mm.z());
            highest = std::max(highest, laid.path[i + 1].position_mm.z());
        }
        ASSERT_NEAR(laid.path[i].position_mm.y(), 0.0, 1e-3);
    }
    // The station nearest to the middle may miss it by half an edge: 0.75^2 / 50 mm.
    EXPECT_NEAR(gap_mm, shape.gap_mm(), 0.0113);
    // The bridge is seen at the end of a block, by when the landing point has gone on over it.
    EXPECT_GE(lowest, -shape.height_mm - 0.005);
    EXPECT_LE(lowest, -shape.height_mm + kStep_mm);
    // From 0.25 mm beyond the touch, 0.25^2 / 50 mm lower, the line to the far shoulder turns by
    // 5e-5 rad, which moves its end by 25 mm times that.
    EXPECT_NEAR(highest, shape.height_mm, 0.005);
    EXPECT_LT((laid.path.back().position_mm - curve.states.back().position_mm).norm(), 0.005);
}

// A cylinder of 1 m between half ellipsoids.
struct LargeVessel {
    double radius_mm = 1000.0;
    double cylinder_mm = 3000.0;
    double dome_mm = 700.0;

    [[nodiscard]] Vector3d gradient(const Vector3d& p) const {
        const double beyond = std::max(0.0, std::abs(p.z()) - 0.5 * cylinder_mm);
        return {p.x() / (radius_mm * radius_mm), p.y() / (radius_mm * radius_mm),
                std::copysign(beyond / (dome_mm * dome_mm), p.z())};
    }
    [[nodiscard]] Vector3d normal(const Vector3d& p) const { return gradient(p).normalized(); }
    [[nodiscard]] Eigen::Matrix3d shape_operator_per_mm(const Vector3d& p) const {
        const bool dome = std::abs(p.z()) > 0.5 * cylinder_mm;
        const double across = 1.0 / (radius_mm * radius_mm);
        const Vector3d hessian(across, across, dome ? 1.0 / (dome_mm * dome_mm) : 0.0);
        const Vector3d n = normal(p);
        const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - n * n.transpose();
        return flat * hessian.asDiagonal() * flat / gradient(p).norm();
    }
};

// Down a dome and on along the cylinder, nearly along the spindle: both halves from where the two
// meet, so that no step of the integration runs over the jump of curvature.
ExactCurve over_the_seam(const LargeVessel& vessel, double step_mm) {
    const double angle = rad_from_deg(15.0);
    const auto half = [&](double way) {
        const Vector3d t(0.0, std::sin(angle), std::cos(angle));
        return test::exact_curve(vessel,
                                 {{vessel.radius_mm, 0.0, -0.5 * vessel.cylinder_mm}, way * t}, 0.0,
                                 step_mm, 300.0);
    };
    const ExactCurve dome = half(-1.0);
    ExactCurve curve{step_mm, {}, {}};
    for (std::size_t i = dome.states.size(); i-- > 1;) {
        curve.add({dome.states[i].position_mm, -dome.states[i].tangent}, dome.normals[i]);
    }
    const ExactCurve cylinder = half(1.0);
    for (std::size_t i = 0; i < cylinder.states.size(); ++i) {
        curve.add(cylinder.states[i], cylinder.normals[i]);
    }
    return curve;
}

// Patches of 50 mm smooth the jump of curvature to a ridge, 0.16 mm high at most: half the jump,
// 2e-3 / mm, over the square of a quarter of an edge. Fibre that is pressed on by 6e-5 / mm only
// comes down from it up to sqrt(2 0.16 / 6e-5) = 73 mm further on.
TEST(LayDown, GoesOnBehindTheSeamOfALargeVesselsDome) {
    const LargeVessel vessel;
    const Surface surface = test::made("vessel",
                                       {{"radius", vessel.radius_mm},
                                        {"cylinder-length", vessel.cylinder_mm},
                                        {"dome-height", vessel.dome_mm},
                                        {"opening-radius", 250.0}},
                                       50.0)
                                .surface;
    const ExactCurve curve = over_the_seam(vessel, 4.0);
    const LaidPath laid = lay(surface, test::eye_path(curve, 800.0), RedundancyPolicy::CentralAngle,
                              {}, bridge_reach_mm(surface));
    EXPECT_EQ(laid.failure, "");
    EXPECT_LT(test::farthest_mm(laid, curve), 0.16);
    EXPECT_NEAR(laid.path.back().s_mm, 600.0, 73.0);
}

// A reach that ends before the far shoulder: the fibre is not seen to touch it.
TEST(LayDown, WithoutReachDoesNotBridge) {
    const EyePath path = test::eye_path(test::meridian({}, 0.5), kFree_mm);
    const LaidPath laid = lay(hourglass(), path, RedundancyPolicy::CentralAngle, {}, 15.0);
    for (const LaidAt& at : laid.at) {
        ASSERT_FALSE(at.lifted && at.gap_mm > 1.0);
    }
    EXPECT_LT(laid.path.back().position_mm.z(), 0.0);
}

// The eye goes 30 mm of fibre back on its way and forward again.
TEST(LayDown, PeelsOffWhereTheEyeGoesBackAndLaysTheSameAgain) {
    const ExactCurve curve = helix(kFine_mm, 120.0);
    const EyePath there = test::eye_path(curve, kFree_mm);
    EyePath path = there;
    const std::size_t back = 60;
    for (std::size_t i = 1; i <= back; ++i) {
        path.push_back(there[there.size() - 1 - i]);
    }
    const LaidPath peeled = lay(cylinder(), path);
    EXPECT_EQ(peeled.failure, "");
    // 60 stations of 0.5 mm.
    EXPECT_NEAR(peeled.peeled_mm, 30.0, kFineDeviation_mm);
    EXPECT_NEAR(peeled.path.back().s_mm, 90.0, kFineDeviation_mm);
    EXPECT_EQ(peeled.peeled_block, path.size() - 1);
    for (std::size_t i = 1; i <= back; ++i) {
        path.push_back(there[there.size() - 1 - back + i]);
    }
    const LaidPath again = lay(cylinder(), path);
    EXPECT_EQ(again.failure, "");
    EXPECT_EQ(again.peeled_mm, peeled.peeled_mm);
    EXPECT_EQ(again.peeled_block, peeled.peeled_block);
    EXPECT_NEAR(again.path.back().s_mm, 120.0, kFineDeviation_mm);
    EXPECT_LT(test::farthest_mm(again, curve), kFineDeviation_mm);
}

TEST(LayDown, SaysWhereTheFibreRunsOverTheEnd) {
    const ExactCurve curve = helix(4.0, 800.0);
    const Machine machine = test::fine_machine();
    const BlockList list =
        test::program(machine, test::eye_path(curve, kFree_mm), RedundancyPolicy::CentralAngle);
    const LaidPath laid =
        lay_down(LaydownSurface(cylinder()), machine, list, curve.states[0].position_mm);
    expect_sound(laid, list);
    EXPECT_EQ(laid.failure.substr(0, laid.failure.size() - 1),
              "the fibre runs over the end of the extension of rim ");
    EXPECT_NEAR(laid.path.back().position_mm.z(), 200.0, 4.0);
    // 320 mm up at 50 deg, 4 mm a block.
    EXPECT_NEAR(static_cast<double>(laid.failed_block), 320.0 / std::cos(rad_from_deg(50.0)) / 4.0,
                2.0);
}

// Blocks of eye positions in the mandrel frame with the mandrel standing still.
BlockList eye_list(const Machine& machine, const std::vector<Vector3d>& eyes) {
    BlockList list = test::empty_list(machine);
    for (const Vector3d& eye : eyes) {
        list.blocks.push_back({.duration_s = list.blocks.empty() ? 0.0 : 1.0});
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            const char letter = list.axes[a].letter;
            const double value = letter == 'X'   ? eye.x()
                                 : letter == 'Y' ? eye.y()
                                 : letter == 'Z' ? eye.z()
                                                 : 0.0;
            list.nano.push_back(std::llround(value * static_cast<double>(kNanoPerUnit)));
        }
    }
    return list;
}

TEST(LayDown, SaysThatTheEyeIsInTheMandrel) {
    const Machine machine = test::fine_machine();
    const Vector3d tie_on(50.0, 0.0, 0.0);
    const auto failure = [&](const std::vector<Vector3d>& eyes) {
        const BlockList list = eye_list(machine, eyes);
        const LaidPath laid = lay_down(LaydownSurface(cylinder()), machine, list, tie_on);
        expect_sound(laid, list);
        return laid.failure;
    };
    EXPECT_EQ(failure({{50.0, 100.0, 20.0}, {10.0, 30.0, 20.0}}), "the eye dips into the mandrel");
    EXPECT_EQ(failure({{50.0, 100.0, 0.0}, {50.0, 0.0, 0.0}}), "the eye touches the mandrel");
    EXPECT_EQ(failure({{50.0, 100.0, 20.0}, {-60.0, 20.0, 20.0}}), "");
}

TEST(LayDown, RefusesATieOnOffTheMandrel) {
    const Machine machine = test::fine_machine();
    const BlockList list = eye_list(machine, {{50.0, 100.0, 20.0}, {40.0, 100.0, 20.0}});
    for (const Vector3d& tie_on : {Vector3d(70.0, 0.0, 0.0), Vector3d(50.0, 0.0, 230.0)}) {
        try {
            (void)lay_down(LaydownSurface(cylinder()), machine, list, tie_on);
            FAIL();
        } catch (const InputError& error) {
            EXPECT_EQ(error.code(), "verify.tie_on");
            for (const std::string& figure : {fixed(tie_on.x(), 3), fixed(tie_on.z(), 3),
                                              fixed(2.0 * cylinder().mean_edge_mm, 1) + " mm"}) {
                EXPECT_TRUE(test::tells(error.what(), figure)) << error.what();
            }
        }
    }
    EXPECT_THROW((void)lay_down(LaydownSurface(Surface{}), machine, list, {50.0, 0.0, 0.0}),
                 InputError);
}

// Whatever the axes do: an end in finite numbers, the same one each time.
TEST(LayDown, EndsForAnyMotion) {
    const Machine machine = test::true_machine();
    int failures = 0;
    int bridges = 0;
    int peels = 0;
    const auto wander = [&](const Surface& surface, const Vector3d& tie_on, double radius_mm,
                            std::uint64_t seed) {
        test::Draw draw(seed);
        BlockList list = test::empty_list(machine);
        const std::array<double, 6> reach{400.0, 40.0, 60.0, 80.0, 30.0, 30.0};
        std::vector<double> place = {0.0, tie_on.z(), 20.0, radius_mm + 80.0, 0.0, 0.0};
        for (int b = 0; b < 30; ++b) {
            list.blocks.push_back({.duration_s = b == 0 ? 0.0 : 0.5});
            for (std::size_t a = 0; a < list.axes.size(); ++a) {
                place[a] += b == 0 ? 0.0 : draw.between(-0.5, 0.5) * reach[a];
                list.nano.push_back(std::llround(place[a] * 1e3) * list.axes[a].resolution_nano);
            }
        }
        const LaidPath laid = lay_down(LaydownSurface(surface), machine, list, tie_on);
        expect_sound(laid, list);
        const LaidPath again = lay_down(LaydownSurface(surface), machine, list, tie_on);
        ASSERT_EQ(laid.failure, again.failure);
        ASSERT_EQ(laid.path.size(), again.path.size());
        ASSERT_EQ(laid.path.back().position_mm, again.path.back().position_mm);
        ASSERT_EQ(laid.peeled_mm, again.peeled_mm);
        failures += laid.failure.empty() ? 0 : 1;
        peels += laid.peeled_mm > 1.0 ? 1 : 0;
        for (const LaidAt& at : laid.at) {
            bridges += at.lifted ? 1 : 0;
        }
    };
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE(seed);
        wander(cylinder(), {50.0, 0.0, 0.0}, 50.0, seed);
        wander(hourglass(), {65.0, 0.0, -12.0}, 65.0, seed);
        wander(torus(), {250.0, 0.0, 0.0}, 250.0, seed);
    }
    // The seeds are such that all of it happens.
    EXPECT_GT(failures, 0);
    EXPECT_GT(peels, 0);
    EXPECT_GT(bridges, 0);
}

}  // namespace
}  // namespace meshwind
