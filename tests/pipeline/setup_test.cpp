// What follows from machine, job and mandrel before anything is planned.
#include "pipeline/setup.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/margins.h"
#include "machines/eye_inverse.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::refusal_of;
using test::Refused;
using test::shipped;
using test::small_pipe;

const InputFiles kFiles{.machine = "machine.json", .job = "job.json"};

// Sagitta of the polygons that stand for the pipe, see small_pipe().
constexpr double kFacets_mm = 0.15;

// Chords of 6 mm, and what the table's rays are off (1e-7 of some 500 mm).
constexpr double kHit_mm = kFacets_mm + 1e-3;

Job with_extension(double extension_mm) {
    Job job = test::pipe_job();
    job.mandrel.extension_mm = extension_mm;
    return job;
}

// From 50 mm off the pipe straight to the spindle; infinite where nothing is in the way.
double inward_hit_mm(const RayQuery& obstacles, double z_mm, double azimuth_rad = 0.0) {
    const Vector3d outward(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
    const double from_mm = test::kPipeRadius_mm + 50.0;
    const double hit_mm = obstacles.first_hit_mm(from_mm * outward + z_mm * Vector3d::UnitZ(),
                                                 -outward, 2.0 * from_mm);
    return hit_mm < 2.0 * from_mm ? hit_mm : HUGE_VAL;
}

TEST(MandrelOptions, AreWhatTheJobSaysOfThePart) {
    Job job;
    EXPECT_EQ(mandrel_options(job).unit_mm, 0.0);  // to be found
    EXPECT_FALSE(mandrel_options(job).axis.has_value());
    EXPECT_TRUE(mandrel_options(job).keep_regions.empty());
    job.mandrel.units = LengthUnit::Inch;
    job.mandrel.axis = Job::MandrelAxis{Vector3d(1.0, 2.0, 3.0), Vector3d(0.0, 5.0, 0.0)};
    job.mandrel.keep_regions = {4, 2};
    const MandrelOptions options = mandrel_options(job);
    EXPECT_EQ(options.unit_mm, 25.4);
    ASSERT_TRUE(options.axis.has_value());
    EXPECT_EQ(options.axis->origin, Vector3d(1.0, 2.0, 3.0));
    EXPECT_EQ(options.axis->direction, Vector3d(0.0, 5.0, 0.0));
    EXPECT_EQ(options.keep_regions, (std::vector<std::int32_t>{4, 2}));
    EXPECT_EQ(mandrel_options(job, 1000.0).unit_mm, 1000.0);
}

// machines/six_axis.json: the eye's ring (0 to 0.5 mm, radius 3.5) swings with B, the tube (8 to
// 130, radius 4) turns with A about itself, the arm (160 to 800, radius 25) does not turn.
TEST(Setup, HeadIsABallOfWhatSwingsAndAnArmOfWhatDoesNot) {
    const meshwind::Setup six = make_setup(small_pipe(), shipped("six_axis"), with_extension(5.0));
    const FreeFibreRule& free = six.rule.free_fibre;
    EXPECT_DOUBLE_EQ(free.head_radius_mm, 4.0);
    ASSERT_EQ(free.arm.size(), 2U);
    EXPECT_DOUBLE_EQ(free.arm[0].from_mm, 8.0);
    EXPECT_DOUBLE_EQ(free.arm[0].to_mm, 130.0);
    EXPECT_DOUBLE_EQ(free.arm[0].radius_mm, 4.0);
    EXPECT_DOUBLE_EQ(free.arm[1].from_mm, 160.0);
    EXPECT_DOUBLE_EQ(free.arm[1].to_mm, 800.0);
    EXPECT_DOUBLE_EQ(free.arm[1].radius_mm, 25.0);
}

TEST(Setup, FreeLengthsAreTheMachinesAndTheJobs) {
    Job job = with_extension(5.0);
    job.eye.free_length_mm = 120.0;
    job.tolerance.clearance_mm = 7.0;
    const meshwind::Setup setup = make_setup(small_pipe(), shipped("six_axis"), job);
    const FreeFibreRule& free = setup.rule.free_fibre;
    EXPECT_EQ(free.min_mm, 30.0);
    EXPECT_EQ(free.max_mm, 400.0);
    EXPECT_EQ(free.preferred_mm, 120.0);
    EXPECT_EQ(setup.rule.clearance_mm, 7.0);
    EXPECT_EQ(free.clearance_mm, 7.0 + margin::kBetweenBlocks_mm);
    // Two edges, but for half the shortest free fibre.
    EXPECT_NEAR(free.start_mm, std::min(2.0 * setup.mandrel.surface.mean_edge_mm, 15.0), 1e-12);
    Machine close = shipped("six_axis");
    close.fibre.min_free_length_mm = 4.0;
    EXPECT_EQ(make_setup(small_pipe(), close, job).rule.free_fibre.start_mm, 2.0);
}

TEST(Setup, FreeLengthsThatTheMachineCannotWindWithAreRefused) {
    const auto refused = [](const Job& job) {
        return refusal_of(
            [&] { (void)make_setup(small_pipe(), shipped("six_axis"), job, kFiles); });
    };
    Job job = with_extension(5.0);
    for (const double length_mm : {29.9, 400.1}) {
        job.eye.free_length_mm = length_mm;
        EXPECT_EQ(refused(job), (Refused{"job.free_length", "job.json: /eye/free_length"}));
    }
    job.eye.free_length_mm = 200.0;
    job.eye.rule = EyeRule::EqualFreeLength;
    job.eye.lengths = {{.piece = 0, .free_length_mm = 400.0}, {.piece = 1, .free_length_mm = 20.0}};
    EXPECT_EQ(refused(job), (Refused{"job.free_length", "job.json: /eye/lengths/1/free_length"}));
    // Rules that give the eye its place do not read it.
    job.eye = {
        .rule = EyeRule::Cylinder, .free_length_mm = 20.0, .lengths = {}, .radius_mm = 100.0};
    EXPECT_EQ(refused(job), Refused{});
}

// machines/two_axis.json keeps its eye 58.31 mm from the spindle.
TEST(Setup, AMachineThatKeepsItsEyeGivesTheRule) {
    const Machine two = shipped("two_axis");
    const auto setup_of = [&](const EyeLaw& eye) {
        Job job = with_extension(5.0);
        job.eye = eye;
        return make_setup(test::made_cylinder(10.0, 30.0, 4.0), two, job);
    };
    const meshwind::Setup plain = setup_of({});
    EXPECT_TRUE(plain.rule_of_machine);
    EXPECT_EQ(plain.job.eye.rule, EyeRule::Cylinder);
    EXPECT_DOUBLE_EQ(plain.job.eye.radius_mm, 58.31);
    // A job that says it itself is within the digits that it is written with.
    const meshwind::Setup same =
        setup_of({.rule = EyeRule::Cylinder, .lengths = {}, .radius_mm = 58.3105});
    EXPECT_FALSE(same.rule_of_machine);
    EXPECT_DOUBLE_EQ(same.job.eye.radius_mm, 58.31);
}

TEST(Setup, LeastTimeIsForMachinesThatLeaveTheTurnFree) {
    const auto wants = [](const std::string& machine, RedundancyRule redundancy) {
        meshwind::Setup setup;
        setup.machine = shipped(machine);
        setup.job.redundancy = redundancy;
        return wants_least_time(setup);
    };
    EXPECT_TRUE(wants("six_axis", RedundancyRule::Optimal));
    EXPECT_FALSE(wants("six_axis", RedundancyRule::CentralAngle));
    EXPECT_FALSE(wants("six_axis", RedundancyRule::Hold));
    // Without a height axis, and without a cross-feed, the place of the eye forces the turn.
    EXPECT_FALSE(wants("four_axis", RedundancyRule::Optimal));
    EXPECT_FALSE(wants("two_axis", RedundancyRule::Optimal));
}

TEST(Setup, ObstaclesAreThePartItsExtensionsAndWhatTurnsWithThem) {
    Machine machine = shipped("six_axis");
    MachineBody chuck;
    chuck.link = 'C';
    chuck.shape = Capsule{{0.0, 0.0, 150.0}, {0.0, 0.0, 250.0}, 20.0};
    MachineBody bed;
    bed.shape = Capsule{{0.0, 0.0, -250.0}, {0.0, 0.0, -150.0}, 20.0};
    machine.bodies = {chuck, bed};
    const double extension_mm = 40.0;
    const meshwind::Setup setup = make_setup(small_pipe(), machine, with_extension(extension_mm));
    const RayQuery& obstacles = *setup.obstacles;
    const double rim_mm = 0.5 * test::kPipeLength_mm;
    for (const double z_mm : {0.0, rim_mm + extension_mm - 1.0, 1.0 - rim_mm - extension_mm}) {
        EXPECT_NEAR(inward_hit_mm(obstacles, z_mm), 50.0, kHit_mm) << z_mm;
    }
    EXPECT_EQ(inward_hit_mm(obstacles, rim_mm + extension_mm + 1.0), HUGE_VAL);
    EXPECT_EQ(inward_hit_mm(obstacles, -rim_mm - extension_mm - 1.0), HUGE_VAL);
    EXPECT_NEAR(inward_hit_mm(obstacles, 200.0), 60.0, kBodyMesh_mm + 1e-3);
    // What stands on the base does not turn with the part: it belongs to the envelope.
    EXPECT_EQ(inward_hit_mm(obstacles, -200.0), HUGE_VAL);
    ASSERT_EQ(setup.envelope.bodies.size(), 1U);
    EXPECT_EQ(setup.envelope.bodies.front().link, kBaseLink);
    // What fibre is laid on ends where the extensions do.
    const double area_mm2 =
        2.0 * kPi * test::kPipeRadius_mm * (test::kPipeLength_mm + 2.0 * extension_mm);
    // Chords of 32 or more edges around: 1 - sin(x) / x with x = pi / 32 is 0.16 %.
    EXPECT_NEAR(test::wall_area_mm2(setup.wall->surface()), area_mm2, 0.002 * area_mm2);
    const meshwind::Setup bare = make_setup(small_pipe(), machine, with_extension(0.0));
    EXPECT_EQ(inward_hit_mm(*bare.obstacles, rim_mm + 1.0), HUGE_VAL);
}

TEST(Setup, PinsStandOnTheExtension) {
    meshwind::Setup setup = make_setup(small_pipe(), shipped("six_axis"), with_extension(40.0));
    PinRing ring;
    ring.rim = 0;
    ring.count = 12;
    ring.diameter_mm = 2.0;
    ring.height_mm = 5.0;
    ring.offset_mm = 10.0;
    ASSERT_TRUE(setup.wall->pins().empty());
    put_pins(setup, {&ring, 1});
    const std::vector<Pin>& pins = setup.wall->pins();
    ASSERT_EQ(pins.size(), 12U);
    const double away = setup.mandrel.rims[0].axis.z() > 0.0 ? 1.0 : -1.0;
    for (const Pin& pin : pins) {
        // The rim is a polygon, the circle through it is found by least squares.
        EXPECT_NEAR(pin.base_mm.head<2>().norm(), test::kPipeRadius_mm, kFacets_mm);
        const double z_mm = away * (0.5 * test::kPipeLength_mm + ring.offset_mm);
        EXPECT_NEAR(pin.base_mm.z(), z_mm, 1e-6);
        const double azimuth_rad = std::atan2(pin.base_mm.y(), pin.base_mm.x());
        EXPECT_NEAR(inward_hit_mm(*setup.obstacles, z_mm, azimuth_rad), 45.0, kHit_mm);
        EXPECT_NEAR(inward_hit_mm(*setup.obstacles, z_mm, azimuth_rad + kPi / 12.0), 50.0, kHit_mm);
        EXPECT_NEAR(inward_hit_mm(*setup.obstacles, -z_mm, azimuth_rad), 50.0, kHit_mm);
    }
}

TEST(Setup, LookAheadComesBeforeWhatTakesLongAndMayRefuse) {
    int calls = 0;
    const auto look = [&](const meshwind::Setup& setup) {
        ++calls;
        EXPECT_EQ(setup.obstacles, nullptr);
        EXPECT_EQ(setup.wall, nullptr);
        EXPECT_EQ(setup.mandrel.rims.size(), 2U);
        EXPECT_EQ(setup.envelope.parts.size(), 3U);
        EXPECT_EQ(setup.dialect->name(), "linuxcnc");
        throw InputError("made.up", "here", "no");
    };
    EXPECT_EQ(refusal_of([&] {
                  (void)make_setup(small_pipe(), shipped("six_axis"), Job{}, kFiles, look);
              }),
              (Refused{"made.up", "here"}));
    EXPECT_EQ(calls, 1);
}

TEST(Setup, DialectsThatWriteNoProgramsAreRefusedWithTheirPlace) {
    Machine unknown = shipped("six_axis");
    unknown.controller.dialect = "fortran";
    for (const Machine& machine : {unknown, shipped("robot_kr16")}) {  // krl of a carried frame
        EXPECT_EQ(refusal_of([&] { (void)make_setup(small_pipe(), machine, Job{}, kFiles); }),
                  (Refused{"dialect.unknown", "machine.json: /controller/dialect"}))
            << machine.controller.dialect;
    }
}

TEST(Setup, ForAnotherMandrelMachineAndJobAreKept) {
    Job job = with_extension(20.0);
    job.tow.friction = 0.3;
    const meshwind::Setup first = make_setup(small_pipe(), shipped("two_axis"), job);
    const double wider_mm = test::kPipeRadius_mm + 5.0;
    const meshwind::Setup next =
        setup_for(first, test::made_cylinder(wider_mm, test::kPipeLength_mm, 6.0), 1);
    EXPECT_EQ(job_text(next.job), job_text(first.job));
    EXPECT_EQ(next.rule_of_machine, first.rule_of_machine);
    EXPECT_EQ(next.machine.name, first.machine.name);
    EXPECT_EQ(next.dialect->name(), first.dialect->name());
    EXPECT_EQ(next.rule.free_fibre.preferred_mm, first.rule.free_fibre.preferred_mm);
    const double rim_mm = 0.5 * test::kPipeLength_mm;
    for (const double z_mm : {0.0, rim_mm + 19.0}) {
        EXPECT_NEAR(inward_hit_mm(*next.obstacles, z_mm), 45.0, kHit_mm);
    }
}

}  // namespace
}  // namespace meshwind
