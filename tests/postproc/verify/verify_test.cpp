#include "postproc/verify/verify.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/support/exact_winding.h"
#include "tests/support/fixtures.h"
#include "tests/support/hourglass.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::ExactCurve;

constexpr double kStep_mm = 2.0;
constexpr double kFree_mm = 200.0;
constexpr double kExtension_mm = 60.0;
constexpr double kHeading_rad = rad_from_deg(50.0);
constexpr std::int32_t kFirstLine = 10;

const Mandrel& mandrel() {
    static const Mandrel kCylinder = test::made_cylinder(50.0, 300.0, 5.0);
    return kCylinder;
}

const LaydownSurface& cylinder_wall() {
    static const LaydownSurface kWall(extended_surface(mandrel(), kExtension_mm));
    return kWall;
}

const RayQuery& cylinder_obstacles() {
    static const RayQuery kQuery = test::obstacles_of(mandrel(), kExtension_mm);
    return kQuery;
}

// From (50, 0, -120), at 50 deg to the axis.
ExactCurve helix(double length_mm, double slip_ratio = 0.0) {
    return test::exact_curve(
        test::ExactCylinder{},
        test::CurveState{Vector3d(50.0, 0.0, -120.0),
                         {0.0, std::sin(kHeading_rad), std::cos(kHeading_rad)}},
        slip_ratio, kStep_mm, length_mm);
}

// A program with everything that its verification needs; what a test breaks is changed in place.
struct Job {
    explicit Job(const EyePath& path) : machine(test::true_machine()) {
        program = test::program(machine, path, RedundancyPolicy::CentralAngle);
        program.tie_on_mm = path.front().landing_mm;
        for (std::size_t b = 0; b < program.blocks.size(); ++b) {
            program.blocks[b].line = kFirstLine + static_cast<std::int32_t>(b);
        }
        envelope = head_envelope(machine);
        rules.collision.free_fibre.min_mm = machine.fibre.min_free_length_mm;
        rules.collision.free_fibre.max_mm = machine.fibre.max_free_length_mm;
    }
    explicit Job(const ExactCurve& curve) : Job(test::eye_path(curve, kFree_mm)) {
        plan = test::planned_fibre(curve);
    }

    [[nodiscard]] Verification verified() const {
        return verify({.program = program,
                       .machine = machine,
                       .envelope = envelope,
                       .wall = *wall,
                       .obstacles = *obstacles,
                       .rules = rules,
                       .plan = plan});
    }

    Machine machine;  // the program was made for it as it is in its file
    BlockList program;
    HeadEnvelope envelope;
    const LaydownSurface* wall = &cylinder_wall();
    const RayQuery* obstacles = &cylinder_obstacles();
    VerifyRules rules;
    PlannedFibre plan;
};

const Check& check_of(const Verification& found, const std::string& name) {
    for (const Check& check : found.checks) {
        if (check.name == name) {
            return check;
        }
    }
    throw std::logic_error(name);
}

// The names of what failed.
std::string failed(const Verification& found) {
    std::string names;
    for (const Check& check : found.checks) {
        EXPECT_EQ(check.ok, check.words.empty()) << check.name;
        names += check.ok ? "" : check.name + " ";
    }
    EXPECT_EQ(names.empty(), !found.first_wrong_block.has_value());
    return names;
}

// One check alone fails; its words have the figure, and name the first wrong block with its line.
std::size_t expect_fails(const Job& job, const std::string& name, const std::string& figure = "") {
    const Verification found = job.verified();
    EXPECT_EQ(failed(found), name + " ");
    const Check& check = check_of(found, name);
    EXPECT_TRUE(figure.empty() || test::tells(check.words, figure)) << check.words;
    const std::size_t block = found.first_wrong_block.value_or(99999);
    EXPECT_NE(check.words.find("block " + std::to_string(block) + " (line " +
                               std::to_string(static_cast<std::size_t>(kFirstLine) + block) + ")"),
              std::string::npos)
        << check.words;
    return block;
}

TEST(Verify, PassesACorrectHelix) {
    const Job job(helix(240.0));
    const Verification found = job.verified();
    EXPECT_EQ(failed(found), "");
    const char* const names[] = {"laydown",     "slip",   "bridging", "collision",
                                 "free_length", "roller", "limits",   "payout"};
    ASSERT_EQ(found.checks.size(), std::size(names));
    for (std::size_t i = 0; i < std::size(names); ++i) {
        EXPECT_EQ(found.checks[i].name, names[i]);
    }
    EXPECT_TRUE(found.coarse_blocks.empty());
    EXPECT_NEAR(found.fibre_length_mm, 240.0, 0.05);
    EXPECT_EQ(found.duration_s, job.program.duration_s());
    EXPECT_NEAR(found.shortest_free_mm, kFree_mm, 0.1);
    EXPECT_NEAR(found.longest_free_mm, kFree_mm, 0.1);
    ASSERT_TRUE(found.deviation.has_value());
    // Half a step of 0.001 deg on an arm of 160 mm, and of the linear axes.
    EXPECT_LT(found.deviation->max_mm, 5e-3);
    EXPECT_LT(check_of(found, "slip").numbers.at("worst"), 0.02);
    EXPECT_LE(check_of(found, "payout").numbers.at("max_speed_mm_s"),
              job.machine.fibre.max_speed_mm_s * 1.001);
    EXPECT_LE(check_of(found, "limits").numbers.at("acceleration_ratio"), 1.001);
    EXPECT_EQ(found.slip.size(), found.laid.path.size());
}

TEST(Verify, ComparesWithNothingWithoutAPlan) {
    Job job(helix(240.0));
    job.plan.clear();
    const Verification found = job.verified();
    EXPECT_EQ(failed(found), "");
    EXPECT_FALSE(found.deviation.has_value());
    EXPECT_TRUE(check_of(found, "laydown").numbers.empty());
}

TEST(Verify, RefusesAProgramWithoutATieOn) {
    Job job(helix(40.0));
    job.program.tie_on_mm.reset();
    try {
        (void)job.verified();
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "verify.tie_on");
    }
}

// The plan goes on at another angle after 120 mm, block 60.
TEST(Verify, SeesTheFibreLeaveThePlan) {
    Job job(helix(240.0));
    ExactCurve before = helix(120.0);
    const double other = kHeading_rad + 0.02;
    const Vector3d around = Vector3d::UnitZ().cross(before.normals.back());
    const ExactCurve after =
        test::exact_curve(test::ExactCylinder{},
                          {before.states.back().position_mm,
                           std::sin(other) * around + std::cos(other) * Vector3d::UnitZ()},
                          0.0, kStep_mm, 120.0);
    for (std::size_t i = 1; i < after.states.size(); ++i) {
        before.add(after.states[i], after.normals[i]);
    }
    job.plan = test::planned_fibre(before);
    const std::size_t block = expect_fails(job, "laydown");
    EXPECT_NEAR(static_cast<double>(block), 60.0, 1.0);
    const Verification found = job.verified();
    // Where the plan kinks, its cubic with one end turned swings out by a third more.
    EXPECT_GE(found.deviation->max_angle_rad, 0.02 - 1e-4);
    EXPECT_LE(found.deviation->max_angle_rad, 4.0 / 3.0 * 0.02 + 1e-4);
    EXPECT_NEAR(found.deviation->max_mm, 120.0 * std::sin(0.02), 0.05);
    // Finer blocks are asked for from 300 mm of fibre before: from the start.
    ASSERT_FALSE(found.coarse_blocks.empty());
    EXPECT_LE(found.coarse_blocks.front(), 1U);
    EXPECT_EQ(found.coarse_blocks.back(), job.program.blocks.size() - 1);
}

TEST(Verify, SeesTheProgramEndBeforeThePlan) {
    Job job(helix(240.0));
    job.plan = test::planned_fibre(helix(250.0));
    const Verification found = job.verified();
    EXPECT_EQ(failed(found), "laydown ");
    EXPECT_TRUE(test::tells(check_of(found, "laydown").words, "10.0 mm"));
    EXPECT_NEAR(check_of(found, "laydown").numbers.at("end_gap_mm"), 10.0, 0.05);
    EXPECT_EQ(found.first_wrong_block, job.program.blocks.size() - 1);
}

// 330 mm up at 50 deg to the axis, over the end of the extension at z = 210 mm.
TEST(Verify, SeesTheFibreRunOffTheMandrel) {
    const Job job(helix(600.0));
    const std::size_t block = expect_fails(job, "laydown");
    EXPECT_NE(job.verified().laid.failure, "");
    EXPECT_NEAR(static_cast<double>(block), 330.0 / std::cos(kHeading_rad) / kStep_mm, 2.0);
}

TEST(Verify, SeesSlipBeyondTheFriction) {
    Job job(helix(200.0, 0.15));
    EXPECT_EQ(failed(job.verified()), "");
    job.rules.friction = 0.1;
    const std::size_t block = expect_fails(job, "slip");
    // Half an edge at the ends is not measured.
    EXPECT_LE(block, 3U);
    const Check check = check_of(job.verified(), "slip");
    EXPECT_NEAR(check.numbers.at("worst"), 0.15, 0.02);
    EXPECT_EQ(check.numbers.at("limit"), 0.1);
}

// Up the hourglass' meridian: the fibre bridges 1.46 mm.
TEST(Verify, SeesBridging) {
    const test::Hourglass shape;
    const LaydownSurface wall(shape.surface(1.5));
    const RayQuery nothing(
        std::vector<TriangleSoup>{test::box({9e3, 9e3, 9e3}, {9001.0, 9001.0, 9001.0})});
    Job job(test::eye_path(test::meridian(shape, 0.5), kFree_mm));
    job.wall = &wall;
    job.obstacles = &nothing;
    job.rules.bridging_tolerance_mm = 2.0;
    EXPECT_EQ(failed(job.verified()), "");
    job.rules.bridging_tolerance_mm = 1.0;
    const std::size_t block = expect_fails(job, "bridging");
    // That in which the free fibre first stands under the far shoulder.
    std::size_t leaving = 0;
    const LaidPath laid = job.verified().laid;
    while (!laid.at[leaving].lifted) {
        ++leaving;
    }
    EXPECT_EQ(block, laid.at[leaving].block);
    EXPECT_NEAR(check_of(job.verified(), "bridging").numbers.at("worst_mm"), shape.gap_mm(), 0.03);
}

TEST(Verify, SeesTheHeadHit) {
    Job job(helix(240.0));
    HeadEnvelope::Part snout;
    snout.link = 'X';
    snout.capsule = {Vector3d::Zero(), Vector3d(-120.0, 0.0, 0.0), 2.0};
    job.envelope.parts.push_back(snout);
    (void)expect_fails(job, "collision", "5.0 mm");  // the clearance
    const Verification found = job.verified();
    EXPECT_GT(check_of(found, "collision").numbers.at("head_hits"), 0.0);
    EXPECT_EQ(check_of(found, "collision").numbers.at("fibre_hits"), 0.0);
    EXPECT_FALSE(found.coarse_blocks.empty());
}

// A post across the free fibre of block 60, halfway to the eye.
TEST(Verify, SeesTheFreeFibreHit) {
    const ExactCurve curve = helix(240.0);
    Job job(curve);
    const Vector3d post = curve.states[60].position_mm + 100.0 * curve.states[60].tangent;
    const Vector3d half(1.0, 1.0, 1.0);
    std::vector<TriangleSoup> parts{mandrel().whole, test::box(post - half, post + half)};
    const RayQuery obstacles(parts);
    job.obstacles = &obstacles;
    const std::size_t block = expect_fails(job, "collision");
    EXPECT_GT(check_of(job.verified(), "collision").numbers.at("fibre_hits"), 0.0);
    EXPECT_EQ(check_of(job.verified(), "collision").numbers.at("head_hits"), 0.0);
    EXPECT_NEAR(static_cast<double>(block), 60.0, 1.0);
    const std::vector<std::size_t> coarse = job.verified().coarse_blocks;
    EXPECT_EQ(coarse.front(), block);
    EXPECT_TRUE(std::is_sorted(coarse.begin(), coarse.end()));
}

TEST(Verify, SeesTooLongAndTooShortAFreeFibre) {
    Job job(helix(240.0));
    job.rules.collision.free_fibre.max_mm = 150.0;
    EXPECT_EQ(expect_fails(job, "free_length", "200.0 mm"), 0U);
    job.rules.collision.free_fibre.max_mm = 400.0;
    job.rules.collision.free_fibre.min_mm = 210.0;
    EXPECT_EQ(expect_fails(job, "free_length", "200.0 mm"), 0U);
}

TEST(Verify, SeesAnAxisPastItsEnd) {
    Job job(helix(240.0));
    const std::size_t z = *job.machine.joint_of('Z');
    Axis& axis = job.machine.eye_chain[z - job.machine.mandrel_chain.size()];
    axis.max = joints_at(job.program, 50)[z];
    const std::size_t block = expect_fails(job, "limits", "axis Z");
    EXPECT_EQ(block, 51U);
    EXPECT_EQ(check_of(job.verified(), "limits").numbers.at("violations"), 1.0);
}

TEST(Verify, SeesTooFastAnAxis) {
    Job job(helix(240.0));
    const double most = check_of(job.verified(), "limits").numbers.at("velocity_ratio");
    EXPECT_LE(most, 1.0);
    for (Axis& axis : job.machine.mandrel_chain) {
        // C turns evenly; now by 1.25 times its velocity.
        axis.velocity *= 1e-3;
    }
    (void)expect_fails(job, "limits", "axis C");
    const std::size_t c = *job.machine.joint_of('C');
    double fastest = 0.0;  // rad/s
    for (std::size_t b = 1; b < job.program.blocks.size(); ++b) {
        const double turned = joints_at(job.program, b)[c] - joints_at(job.program, b - 1)[c];
        fastest = std::max(fastest, std::abs(turned) / job.program.blocks[b].duration_s);
    }
    EXPECT_NEAR(check_of(job.verified(), "limits").numbers.at("velocity_ratio"),
                fastest / job.machine.axis(c).velocity, 1e-9);
}

TEST(Verify, SeesTooHardAnAcceleration) {
    Job job(helix(240.0));
    for (Axis& axis : job.machine.eye_chain) {
        axis.acceleration *= 0.01;
    }
    (void)expect_fails(job, "limits");
    EXPECT_GT(check_of(job.verified(), "limits").numbers.at("acceleration_ratio"), 1.0);
    EXPECT_LE(check_of(job.verified(), "limits").numbers.at("velocity_ratio"), 1.0);
}

// One block in the middle is run twice as fast, at 1000 mm/s, by axes that could.
Job rushed() {
    Job job(helix(240.0));
    job.machine.fibre.max_speed_mm_s = 600.0;
    for (auto* const chain : {&job.machine.mandrel_chain, &job.machine.eye_chain}) {
        for (Axis& axis : *chain) {
            axis.velocity *= 10.0;
            axis.acceleration *= 1e3;
        }
    }
    EXPECT_EQ(failed(job.verified()), "");
    job.program.blocks[70].duration_s *= 0.5;
    return job;
}

TEST(Verify, SeesCornersThatTheControllerMayNotCut) {
    Job job(helix(240.0));
    const double cut_mm = check_of(job.verified(), "limits").numbers.at("corner_eye_mm");
    EXPECT_GT(cut_mm, 0.0);
    EXPECT_EQ(check_of(job.verified(), "limits").numbers.count("limit_corner_mm"), 0U);
    job.rules.path_mode.corner_mm = 1.01 * cut_mm;
    EXPECT_EQ(failed(job.verified()), "");
    job.rules.path_mode.corner_mm = 0.5 * cut_mm;
    (void)expect_fails(job, "limits");
    EXPECT_NEAR(check_of(job.verified(), "limits").numbers.at("corner_eye_mm"), cut_mm, 1e-9);
    EXPECT_EQ(check_of(job.verified(), "limits").numbers.at("limit_corner_mm"), 0.5 * cut_mm);
}

TEST(Verify, SeesTooFastAFibre) {
    const Job job = rushed();
    EXPECT_EQ(expect_fails(job, "payout", "1000 mm/s"), 70U);
    const Check check = check_of(job.verified(), "payout");
    EXPECT_NEAR(check.numbers.at("max_speed_mm_s"), 1000.0, 0.5);
    EXPECT_EQ(check.numbers.at("limit_mm_s"), 600.0);
}

// 30 mm of fibre back and forth.
TEST(Verify, SeesTheFibreGoSlack) {
    EyePath path = test::eye_path(helix(120.0), kFree_mm);
    const std::size_t there = path.size();
    for (std::size_t i = 1; i <= 15; ++i) {
        path.push_back(path[there - 1 - i]);
    }
    Job job(path);
    EXPECT_EQ(failed(job.verified()), "");
    job.machine.fibre.take_up_mm = 20.0;
    const std::size_t block = expect_fails(job, "payout", "30.0 mm");
    EXPECT_NEAR(static_cast<double>(block), static_cast<double>(there - 1 + 10), 1.0);
    EXPECT_NEAR(check_of(job.verified(), "payout").numbers.at("worst_mm"), 30.0, 0.05);
}

TEST(Verify, NamesTheFirstOfSeveralWrongBlocks) {
    Job job = rushed();
    const std::size_t z = *job.machine.joint_of('Z');
    job.machine.eye_chain[z - job.machine.mandrel_chain.size()].max = joints_at(job.program, 40)[z];
    const Verification found = job.verified();
    EXPECT_EQ(failed(found), "limits payout ");
    EXPECT_EQ(found.first_wrong_block, 41U);
}

TEST(LaidCsv, HasARowPerStation) {
    const Job job(helix(20.0));
    const Verification found = job.verified();
    const std::string text = laid_csv(found, job.program);
    EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')),
              1 + found.laid.path.size());
    // Tied on in block 0, on line 10, where the wall is round by 1 / 50 mm times sin^2 of 50 deg.
    const std::size_t first = text.find('\n') + 1;
    EXPECT_EQ(text.substr(0, first),
              "block,line,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,slip,bridge_mm\n");
    EXPECT_EQ(text.substr(first, 41), "0,10,0.0000,50.0000,0.0000,-120.0000,1.00");
}

}  // namespace
}  // namespace meshwind
