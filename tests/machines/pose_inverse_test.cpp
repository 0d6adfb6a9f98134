#include "machines/pose_inverse.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"

namespace meshwind {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

const std::string kSource = MESHWIND_SOURCE_DIR;

Machine kr16() {
    return read_machine(kSource + "/machines/robot_kr16.json");
}

class RandomJoints {
public:
    RandomJoints(const Machine& machine, unsigned seed) : machine_(machine), engine_(seed) {}

    std::vector<double> next() {
        std::vector<double> joints;
        for (std::size_t j = 0; j < machine_.axis_count(); ++j) {
            const Axis& axis = machine_.axis(j);
            const double low = std::isfinite(axis.min) ? axis.min : -kPi;
            const double high = std::isfinite(axis.max) ? axis.max : kPi;
            joints.push_back(between(low, high));
        }
        return joints;
    }

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }

private:
    const Machine& machine_;
    std::mt19937 engine_;
};

struct PoseError {
    double mm = 0.0;
    double rad = 0.0;
};

PoseError error_of(const Machine& machine, const std::vector<double>& joints,
                   const Isometry3d& wanted) {
    const Isometry3d found = base_from_mandrel(machine, joints);
    // |R - I| in the Frobenius norm is sqrt(8) sin(angle / 2).
    const double chord = (found.linear() - wanted.linear()).norm();
    return {(found.translation() - wanted.translation()).norm(),
            2.0 * std::asin(std::min(chord / std::sqrt(8.0), 1.0))};
}

void expect_reached(const Machine& machine, const PoseState& state,
                    const std::vector<double>& joints, const Isometry3d& wanted) {
    const PoseError error = error_of(machine, joints, wanted);
    EXPECT_TRUE(state.reached) << state.residual_mm << ' ' << state.residual_rad;
    EXPECT_LT(error.mm, 1e-9);
    EXPECT_LT(error.rad, 1e-9);
}

// Denavit and Hartenberg: Rot(z, theta) Trans(z, d) Trans(x, a) Rot(x, alpha).
Isometry3d link(double theta, double d, double a, double alpha) {
    return AngleAxisd(theta, Vector3d::UnitZ()) * Translation3d(a, 0.0, d) *
           AngleAxisd(alpha, Vector3d::UnitX());
}

// The same robot from its published lengths by another convention. The controller counts A1, A4 and
// A6 against the right hand about axes that point up and out.
Isometry3d flange_by_links(const std::vector<double>& a) {
    constexpr double kQuarter = 0.5 * kPi;
    return link(-a[0], 675.0, 260.0, -kQuarter) * link(a[1], 0.0, 680.0, 0.0) *
           link(a[2] - kQuarter, 0.0, -35.0, -kQuarter) * link(-a[3], 670.0, 0.0, kQuarter) *
           link(a[4], 0.0, 0.0, -kQuarter) * link(-a[5] + kPi, 158.0, 0.0, 0.0);
}

TEST(Kr16, HomePoseIsWhereTheLengthsPutTheFlange) {
    const Machine machine = kr16();
    const std::vector<double> home{0.0, rad_from_deg(-90.0), rad_from_deg(90.0), 0.0, 0.0, 0.0};
    const Isometry3d flange = base_from_mandrel(machine, home);
    // Forward: base 260, forearm 670, flange 158; up: shoulder 675, upper arm 680, less 35.
    EXPECT_LT((flange.translation() - Vector3d(1088.0, 0.0, 1320.0)).norm(), 1e-9);
    EXPECT_LT((flange.linear().col(2) - Vector3d::UnitX()).norm(), 1e-12);
    EXPECT_LT((flange.linear().col(0) + Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(Kr16, AgreesWithALinkTableEverywhere) {
    const Machine machine = kr16();
    RandomJoints random(machine, 3);
    for (int i = 0; i < 2000; ++i) {
        const std::vector<double> joints = random.next();
        const PoseError error = error_of(machine, joints, flange_by_links(joints));
        ASSERT_LT(error.mm, 1e-9);
        ASSERT_LT(error.rad, 1e-12);
    }
}

// The data sheet's reach is the distance of the wrist centre from axis 1 with the arm stretched.
TEST(Kr16, StretchedArmHasThePublishedReach) {
    EXPECT_NEAR(260.0 + 680.0 + std::hypot(670.0, 35.0), 1611.0, 0.5);
    const PoseInverse inverse(kr16());
    ASSERT_TRUE(inverse.closed_form());
    const std::vector<double> previous(6, 0.0);
    std::vector<double> joints(6, 0.0);
    for (const double spare : {1e-3, 1.0, -1.0}) {
        // Wrist at the height of the shoulder, the flange looking down a little.
        const double wrist = 260.0 + 680.0 + std::hypot(670.0, 35.0) - spare;
        Isometry3d pose = Isometry3d::Identity();
        pose.linear() << 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0;
        pose.linear() = AngleAxisd(0.6, Vector3d::UnitY()) * pose.linear();
        pose.translation() = Vector3d(wrist, 0.0, 675.0) + 158.0 * pose.linear().col(2);
        const PoseState state = inverse.solve(pose, previous, joints);
        EXPECT_EQ(state.reached, spare > 0.0) << spare;
        if (spare < 0.0) {
            // One mm short; part of it may be made up by tilting the flange a little.
            EXPECT_LE(state.residual_mm, 1.0 + 1e-6);
            EXPECT_GT(state.residual_mm + 2000.0 * state.residual_rad, 0.1);
        } else {
            EXPECT_LT(state.singular, 0.08);
            EXPECT_EQ(state.nearest, Singularity::Elbow);
        }
    }
}

TEST(PoseInverse, RoundTripOfTheArm) {
    const Machine machine = kr16();
    const PoseInverse inverse(machine);
    ASSERT_TRUE(inverse.closed_form());
    RandomJoints random(machine, 1);
    std::vector<double> joints(machine.axis_count());
    for (int i = 0; i < 4000; ++i) {
        const std::vector<double> wanted = random.next();
        const Isometry3d pose = base_from_mandrel(machine, wanted);
        const PoseState state = inverse.solve(pose, random.next(), joints);
        expect_reached(machine, state, joints, pose);
        EXPECT_TRUE(state.within_limits);
    }
}

// From joints near by it finds the same joints again, unless a singular pose lies between.
TEST(PoseInverse, StaysOnItsBranch) {
    const Machine machine = kr16();
    const PoseInverse inverse(machine);
    RandomJoints random(machine, 2);
    std::vector<double> joints(machine.axis_count());
    int checked = 0;
    for (int i = 0; i < 4000; ++i) {
        const std::vector<double> wanted = random.next();
        std::vector<double> near = wanted;
        for (double& q : near) {
            q += random.between(-0.02, 0.02);
        }
        const PoseState state = inverse.solve(base_from_mandrel(machine, wanted), near, joints);
        if (state.singular < 0.1) {
            continue;
        }
        ++checked;
        EXPECT_FALSE(state.flip);
        for (std::size_t j = 0; j < joints.size(); ++j) {
            EXPECT_NEAR(joints[j], wanted[j], 1e-7);
        }
    }
    EXPECT_GT(checked, 2500);
}

TEST(PoseInverse, AllEightSolutionsOfAnArmReachThePose) {
    const Machine machine = kr16();
    const auto arm = ArmInverse::recognise(machine);
    ASSERT_TRUE(arm);
    RandomJoints random(machine, 4);
    int eights = 0;
    for (int i = 0; i < 500; ++i) {
        const std::vector<double> wanted = random.next();
        const Isometry3d pose = base_from_mandrel(machine, wanted);
        int reached = 0;
        for (const ArmInverse::Joints& found : arm->solve(pose, wanted)) {
            const PoseError error = error_of(machine, {found.begin(), found.end()}, pose);
            reached += error.mm < 1e-6 && error.rad < 1e-9 ? 1 : 0;
        }
        // The shoulder turned over may be out of the forearm's reach, or only just within it.
        EXPECT_TRUE(reached == 4 || reached == 8) << reached;
        eights += reached == 8 ? 1 : 0;
    }
    EXPECT_GT(eights, 10);
}

TEST(PoseInverse, PosesInAndNearSingularOnesAreReachedAndReported) {
    const Machine machine = kr16();
    const PoseInverse inverse(machine);
    RandomJoints random(machine, 5);
    std::vector<double> joints(machine.axis_count());
    for (const double off : {0.0, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4}) {
        for (int i = 0; i < 300; ++i) {
            // Wrist: A5 = 0.
            std::vector<double> wanted = random.next();
            wanted[4] = off;
            Isometry3d pose = base_from_mandrel(machine, wanted);
            PoseState state = inverse.solve(pose, wanted, joints);
            expect_reached(machine, state, joints, pose);
            EXPECT_LE(state.singular, 1.01 * off + 1e-7);
            // Elbow: upper arm and forearm in line; the forearm leans by atan(35 / 670).
            wanted = random.next();
            wanted[2] = -std::atan2(35.0, 670.0) + off;
            pose = base_from_mandrel(machine, wanted);
            state = inverse.solve(pose, wanted, joints);
            expect_reached(machine, state, joints, pose);
            EXPECT_LE(state.singular, 1.01 * off + 1e-6);
        }
    }
}

TEST(PoseInverse, WristCentreOnAxisOneKeepsTheShoulder) {
    const Machine machine = kr16();
    const PoseInverse inverse(machine);
    // Upper arm leaning back until the wrist centre stands above the base: solved for A2 by
    // bisection.
    std::vector<double> joints{0.3, 0.0, rad_from_deg(60.0), 0.2, 0.7, -0.4};
    const auto wrist_x = [&](double a2) {
        std::vector<double> q{0.0, a2, joints[2], 0.0, 0.0, 0.0};
        const Isometry3d flange = base_from_mandrel(machine, q);
        return (flange * Vector3d(0.0, 0.0, -158.0)).x();
    };
    double low = rad_from_deg(-155.0);
    double high = rad_from_deg(-60.0);
    ASSERT_LT(wrist_x(low), 0.0);
    ASSERT_GT(wrist_x(high), 0.0);
    for (int i = 0; i < 100; ++i) {
        (wrist_x(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
    }
    joints[1] = low;
    const Isometry3d pose = base_from_mandrel(machine, joints);
    std::vector<double> found(6);
    const PoseState state = inverse.solve(pose, joints, found);
    expect_reached(machine, state, found, pose);
    EXPECT_EQ(state.nearest, Singularity::Shoulder);
    EXPECT_LT(state.singular, 1e-9);
    EXPECT_NEAR(found[0], 0.3, 1e-6);
}

TEST(PoseInverse, WholeTurnsAndLimitsAreHeeded) {
    const Machine machine = kr16();
    const PoseInverse inverse(machine);
    const std::vector<double> home{0.0, rad_from_deg(-90.0), rad_from_deg(90.0), 0.0, 0.5, 0.0};
    std::vector<double> joints(6);
    // A6 counts on beyond half a turn, as far as its 350 degrees go, and then unwinds.
    std::vector<double> now = home;
    for (int deg = 0; deg <= 340; deg += 10) {
        std::vector<double> wanted = home;
        wanted[5] = rad_from_deg(deg);
        const PoseState state = inverse.solve(base_from_mandrel(machine, wanted), now, now);
        EXPECT_NEAR(now[5], rad_from_deg(deg), 1e-7);
        EXPECT_FALSE(state.flip);
        EXPECT_TRUE(state.within_limits);
    }
    std::vector<double> wanted = home;
    wanted[5] = rad_from_deg(355.0);
    const PoseState state = inverse.solve(base_from_mandrel(machine, wanted), now, joints);
    EXPECT_TRUE(state.within_limits);
    EXPECT_TRUE(state.flip);
    expect_reached(machine, state, joints, base_from_mandrel(machine, wanted));
}

TEST(PoseInverse, OutOfReachIsSaidWithItsDistance) {
    const Machine machine = kr16();
    const PoseInverse inverse(machine);
    const std::vector<double> previous{0.0, -1.0, 1.0, 0.1, 0.5, 0.1};
    std::vector<double> joints(6);
    Isometry3d pose = base_from_mandrel(machine, previous);
    pose.translation() = Vector3d(5000.0, 0.0, 675.0);
    const PoseState state = inverse.solve(pose, previous, joints);
    EXPECT_FALSE(state.reached);
    const PoseError error = error_of(machine, joints, pose);
    EXPECT_NEAR(state.residual_mm, error.mm, 1e-9);
    EXPECT_NEAR(state.residual_rad, error.rad, 1e-9);
    // The flange at best stands 1611 + 158 mm from axis 1 towards it.
    EXPECT_GT(state.residual_mm, 5000.0 - 1611.0 - 158.0 - 1.0);
}

// Published frame through the ring head (petru_2016_frames): two straight arms and a quarter bend
// of 140 mm in which the frame turns by 180 degrees about its axis; the frame's own axes assumed:
// its origin on the flange, the first arm out of it. The axis point at length l stands in the head.
Isometry3d frame_in_head(const Machine& machine, double l) {
    const double radius = 140.0 / (0.5 * kPi);
    const double bend = std::clamp((l - 550.0) / 140.0, 0.0, 1.0);
    const double angle = 0.5 * kPi * bend;
    const Vector3d along(std::sin(angle), 0.0, std::cos(angle));
    const Vector3d corner(radius * (1.0 - std::cos(angle)), 0.0,
                          std::min(l, 550.0) + radius * std::sin(angle));
    const Vector3d point = corner + std::max(l - 690.0, 0.0) * along;
    const Vector3d across = AngleAxisd(-kPi * bend, along) * Vector3d::UnitY();
    Eigen::Matrix3d frame;
    frame << along, across, along.cross(across);
    Eigen::Matrix3d head;
    head << machine.eye.exit, machine.eye.roller, machine.eye.exit.cross(machine.eye.roller);
    Isometry3d pose = Isometry3d::Identity();
    pose.linear() = head * frame.transpose();
    pose.translation() = machine.eye.position_mm - pose.linear() * point;
    return pose;
}

TEST(Kr16, CarriesThePublishedFrameThroughTheHead) {
    const Machine machine = kr16();
    const PoseInverse inverse(machine);
    std::vector<double> joints{-1.5, -1.2, 1.2, 0.0, 0.3, 0.0};
    for (int i = 0; i <= 1050; ++i) {
        const Isometry3d pose = frame_in_head(machine, i);
        const PoseState state = inverse.solve(pose, joints, joints);
        expect_reached(machine, state, joints, pose);
        ASSERT_TRUE(state.within_limits) << i;
        ASSERT_TRUE(i == 0 || !state.flip) << i;
        ASSERT_GT(state.singular, 0.3) << i;
        // By the link table: the axis point is in the head, the frame runs through it.
        const Isometry3d flange = flange_by_links(joints);
        ASSERT_LT((flange.translation() - pose.translation()).norm(), 1e-8);
    }
    // Flange at the published end of the passage, l = 1050: frame_in_head against the recomputed
    // table of the paper.
    const Vector3d last(-360.873231869, 620.873231869, 990.0);
    EXPECT_LT((frame_in_head(machine, 1050.0).translation() - last).norm(), 1e-8);
    const Vector3d bent(-1000.0, 618.069128216, 1405.013355653);  // l = 620
    EXPECT_LT((frame_in_head(machine, 620.0).translation() - bent).norm(), 1e-8);
}

// Without the closed form: the wrist's axes pass each other.
TEST(PoseInverse, RoundTripOfAnArmWithoutSphericalWrist) {
    Machine machine = kr16();
    machine.mandrel_chain[4].point_mm += Vector3d(60.0, 0.0, 25.0);
    const PoseInverse inverse(machine);
    ASSERT_FALSE(inverse.closed_form());
    RandomJoints random(machine, 6);
    std::vector<double> joints(machine.axis_count());
    for (int i = 0; i < 1000; ++i) {
        const std::vector<double> wanted = random.next();
        std::vector<double> near = wanted;
        for (double& q : near) {
            q += random.between(-0.1, 0.1);
        }
        const Isometry3d pose = base_from_mandrel(machine, wanted);
        expect_reached(machine, inverse.solve(pose, near, joints), joints, pose);
    }
    int reached = 0;
    for (int i = 0; i < 200; ++i) {
        const Isometry3d pose = base_from_mandrel(machine, random.next());
        const PoseState state = inverse.solve(pose, random.next(), joints);
        const PoseError error = error_of(machine, joints, pose);
        EXPECT_EQ(state.reached, error.mm < 1e-9 && error.rad < 1e-9);
        reached += state.reached ? 1 : 0;
    }
    EXPECT_GT(reached, 190);
}

// A spindle alone reaches the poses that a spindle can, and says what is missing of the others.
TEST(PoseInverse, FewerAxesGiveTheRest) {
    const Machine machine = read_machine(kSource + "/machines/six_axis.json");
    const PoseInverse inverse(machine);
    std::vector<double> joints(machine.axis_count(), 0.0);
    const std::vector<double> previous(machine.axis_count(), 0.0);
    Isometry3d pose = Isometry3d::Identity();
    pose.linear() = AngleAxisd(1.2, Vector3d::UnitZ()).toRotationMatrix();
    PoseState state = inverse.solve(pose, previous, joints);
    EXPECT_TRUE(state.reached);
    EXPECT_NEAR(joints[0], 1.2, 1e-9);
    pose.translation() = Vector3d(0.0, 0.0, 7.0);
    state = inverse.solve(pose, previous, joints);
    EXPECT_FALSE(state.reached);
    EXPECT_NEAR(state.residual_mm, 7.0, 1e-9);
    EXPECT_NEAR(joints[0], 1.2, 1e-6);
}

}  // namespace
}  // namespace meshwind
