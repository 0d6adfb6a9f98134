#include "machines/spindle_frame.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "machines/eye_inverse.h"
#include "machines/kinematics.h"
#include "tests/support/machine_draws.h"

namespace meshwind {
namespace {

using test::Draw;
using test::machine_file;

// The machine as a file has it whose frame stands elsewhere, with the mandrel where it was in it.
Machine seen_from(const Eigen::Isometry3d& pose, Machine machine) {
    for (std::vector<Axis>* chain : {&machine.mandrel_chain, &machine.eye_chain}) {
        for (Axis& axis : *chain) {
            axis.direction = pose.linear() * axis.direction;
            axis.point_mm = pose * axis.point_mm;
        }
    }
    machine.eye.position_mm = pose * machine.eye.position_mm;
    machine.eye.roller = pose.linear() * machine.eye.roller;
    machine.eye.exit = pose.linear() * machine.eye.exit;
    for (EnvelopePart& part : machine.eye.envelope) {
        auto& capsule = std::get<Capsule>(part.shape);
        capsule.from_mm = pose * capsule.from_mm;
        capsule.to_mm = pose * capsule.to_mm;
    }
    machine.mount = MandrelMount{
        .origin_mm = pose.translation(), .x = pose.linear().col(0), .z = pose.linear().col(2)};
    return machine;
}

Eigen::Isometry3d drawn_pose(Draw& draw) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.rotate(Eigen::AngleAxisd(draw.between(0.1, 3.0), draw.direction()));
    pose.pretranslate(1000.0 * draw.direction());
    return pose;
}

TEST(SpindleFrame, IsFoundWhereverTheFrameOfTheFileStands) {
    Draw draw(7);
    for (const char* name :
         {"six_axis", "five_axis", "four_axis", "hobby_grbl", "robot_winder", "robot_track"}) {
        SCOPED_TRACE(name);
        const Machine shipped = machine_file(name);
        for (int i = 0; i < 20; ++i) {
            const Machine machine = in_spindle_frame(seen_from(drawn_pose(draw), shipped));
            EXPECT_EQ(machine_class(machine).words, machine_class(shipped).words);
            const std::vector<double> q = draw.joints(shipped);
            EXPECT_LT(
                (mandrel_from_eye(machine, q).matrix() - mandrel_from_eye(shipped, q).matrix())
                    .cwiseAbs()
                    .maxCoeff(),
                1e-7);
            for (std::size_t k = 0; k < shipped.eye.envelope.size(); ++k) {
                const auto& moved = std::get<Capsule>(machine.eye.envelope[k].shape);
                const auto& was = std::get<Capsule>(shipped.eye.envelope[k].shape);
                const char link = shipped.eye.envelope[k].link;
                EXPECT_LT((base_from_mandrel(machine, q).inverse() *
                               (base_from_link(machine, q, link) * moved.to_mm) -
                           base_from_mandrel(shipped, q).inverse() *
                               (base_from_link(shipped, q, link) * was.to_mm))
                              .norm(),
                          1e-7);
            }
        }
    }
}

TEST(SpindleFrame, IsThatOfTheMandrelWithoutAMount) {
    const Machine gantry = in_spindle_frame(machine_file("gantry"));
    EXPECT_EQ(machine_class(gantry).words,
              "spindle, 3 linear axes, head roll and swing: closed form");
    std::vector<double> q(gantry.axis_count(), 0.0);
    q[1] = 70.0;   // along the spindle
    q[3] = 200.0;  // up
    EXPECT_LT(
        (mandrel_from_eye(gantry, q).translation() - Eigen::Vector3d(200.0, 0.0, 70.0)).norm(),
        1e-12);
    EXPECT_LT((gantry.up - Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST(SpindleFrame, LeavesWhatHasNone) {
    for (const char* name : {"six_axis", "two_axis", "robot_winder", "robot_kr16"}) {
        const Machine machine = machine_file(name);
        const Machine same = in_spindle_frame(machine);
        for (std::size_t j = 0; j < machine.axis_count(); ++j) {
            EXPECT_EQ(same.axis(j).direction, machine.axis(j).direction);
            EXPECT_EQ(same.axis(j).point_mm, machine.axis(j).point_mm);
        }
    }
    Machine leaning = machine_file("gantry");
    leaning.eye.exit = Eigen::Vector3d(0.6, 0.0, -0.8);  // not at a right angle to the spindle
    leaning.eye.roller = Eigen::Vector3d(0.8, 0.0, 0.6);
    const Machine same = in_spindle_frame(leaning);
    EXPECT_EQ(same.mandrel_chain[0].direction, Eigen::Vector3d::UnitX());
    EXPECT_NE(machine_class(same).refusal, "");
}

}  // namespace
}  // namespace meshwind
