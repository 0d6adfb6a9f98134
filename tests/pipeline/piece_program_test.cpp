// Pieces of a plan on their way to blocks, and what these lay, against closed forms on a pipe.
#include "pipeline/piece_program.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "pipeline/plan_layer.h"
#include "postproc/robot/dialects.h"
#include "tests/support/any_machine.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::kPipeRadius_mm;

const double kCosine = std::cos(rad_from_deg(test::kPipeAngle_deg));
const double kSine = std::sin(rad_from_deg(test::kPipeAngle_deg));

// The mesh's patches are off the ideal pipe by fourth order in edges of 6 mm.
constexpr double kOnWall_mm = 0.01;

// The machine's axes in the order of its joints.
enum JointOfSixAxis : std::size_t { kC, kZ, kY, kX, kA, kB };

struct Planned {
    meshwind::Setup setup;
    Plan plan;

    [[nodiscard]] PieceProgram program(const PieceProgramOptions& options = {}) const {
        return program_of(setup, plan.pieces, options);
    }
};

Planned planned(const Job& job, const Machine& machine = test::shipped("six_axis")) {
    Planned p{make_setup(test::small_pipe(), machine, job), {}};
    p.plan = plan_layer(p.setup, p.setup.job.layers.front(), test::AnyMachine()).plan;
    EXPECT_EQ(p.plan.failure, "");
    return p;
}

Job with_eye(const EyeLaw& eye) {
    Job job = test::pipe_job();
    job.eye = eye;
    job.redundancy = RedundancyRule::CentralAngle;
    return job;
}

const Check& check_of(const PieceProgram& made, const std::string& name) {
    for (const Check& check : made.verification.checks) {
        if (check.name == name) {
            return check;
        }
    }
    throw std::out_of_range(name);
}

// mm off the helix that each laid station of a course is, beside it on the pipe.
double worst_off_helix_mm(const Plan& plan, const SurfacePath& laid) {
    double worst_mm = 0.0;
    double from_mm = 0.0;
    std::size_t compared = 0;
    for (const Piece& piece : plan.pieces) {
        const double length_mm = piece.path.back().s_mm;
        const PathPoint& start = piece.path.front();
        const double up = start.tangent.z() > 0.0 ? 1.0 : -1.0;
        const Vector3d around = Vector3d::UnitZ().cross(start.position_mm);
        const double hand = around.dot(start.tangent) > 0.0 ? 1.0 : -1.0;
        const double start_rad = std::atan2(start.position_mm.y(), start.position_mm.x());
        for (const PathPoint& at : laid) {
            const double along_mm = at.s_mm - from_mm;
            // Ends belong to turns, where the laid length is up to a mm off the planned one.
            if (piece.kind != PieceKind::Course || along_mm < 2.0 || along_mm > length_mm - 2.0) {
                continue;
            }
            const double rise_mm = up * (at.position_mm.z() - start.position_mm.z());
            const double helix_rad = start_rad + hand * rise_mm * kSine / kCosine / kPipeRadius_mm;
            const double here_rad = std::atan2(at.position_mm.y(), at.position_mm.x());
            const double off_rad = std::remainder(here_rad - helix_rad, 2.0 * kPi);
            worst_mm = std::max(worst_mm, std::abs(off_rad) * kPipeRadius_mm * kCosine);
            ++compared;
        }
        from_mm += length_mm;
    }
    // Blocks are longer than stations: each course has some laid stations at least.
    EXPECT_GT(compared, 10 * static_cast<std::size_t>(plan.courses));
    return worst_mm;
}

TEST(PieceProgram, LaysTheHelixThatWasAskedFor) {
    const Planned p = planned(with_eye({}));
    const PieceProgram made = p.program();
    EXPECT_TRUE(made.refused.empty());
    ASSERT_EQ(made.verification.laid.failure, "");
    const double limit_mm = p.setup.job.tolerance.laydown_mm;
    const double worst_mm = worst_off_helix_mm(p.plan, made.verification.laid.path);
    EXPECT_LT(worst_mm, limit_mm + kOnWall_mm);
    EXPECT_GT(worst_mm, 0.0);
    // What the check tells is measured on all of the fibre.
    ASSERT_TRUE(made.verification.deviation.has_value());
    EXPECT_LE(worst_mm, made.verification.deviation->max_mm + kOnWall_mm);
    double sum_mm = 0.0;
    for (const Piece& piece : p.plan.pieces) {
        sum_mm += piece.path.back().s_mm;
    }
    EXPECT_NEAR(made.eyes.path.back().s_mm, sum_mm, 1e-6);
    EXPECT_NEAR(p.plan.fibre_length_mm, sum_mm, 1e-6);
    // A path that is d beside one which turns on the wall by an angle differs from it by d times
    // the angle: pi - 2 a in each turn.
    const double turned_rad = (kPi - 2.0 * rad_from_deg(test::kPipeAngle_deg)) * p.plan.courses;
    EXPECT_NEAR(made.verification.fibre_length_mm, sum_mm, turned_rad * limit_mm);
}

TEST(PieceProgram, TimesAddUpAndSlowFibreTakesItsLength) {
    Job job = with_eye({.rule = EyeRule::EqualFreeLength, .lengths = {}});
    job.speed.fibre_m_min = 1.0;
    const Planned p = planned(job);
    const PieceProgram made = p.program();
    ASSERT_TRUE(made.refused.empty());
    double sum_s = 0.0;
    for (const Block& block : made.blocks.blocks) {
        sum_s += block.duration_s;
    }
    EXPECT_NEAR(made.verification.duration_s, sum_s + made.corner_s, 1e-9 * sum_s);
    EXPECT_LT(std::abs(made.corner_s), 0.001 * sum_s);  // blocks this slow are blended in no time
    // What starting and stopping add: v / a at most of an axis that is at 16.7 mm/s of fibre no
    // faster than 40 deg/s, at 1800 deg/s^2 or more.
    EXPECT_GE(made.duration_s - made.corner_s, sum_s);
    EXPECT_LT(made.duration_s - made.corner_s, sum_s + 2.0 * 40.0 / 1800.0);
    const double speed_mm_s = 1000.0 / 60.0;
    EXPECT_NEAR(made.least_s, p.plan.fibre_length_mm / speed_mm_s, 1e-9 * made.least_s);
    // The axes are tens of times as fast as this fibre: it alone sets the time, so that each
    // block has it at its full speed where it runs fastest.
    ASSERT_EQ(made.binding.size(), 1U);
    EXPECT_EQ(made.binding.front().name, "fibre");
    EXPECT_NEAR(made.binding.front().time_s, sum_s, 1e-9 * sum_s);
    EXPECT_GE(sum_s, made.least_s);
    const double counted_mm =
        std::accumulate(made.choice.fibre_mm.begin(), made.choice.fibre_mm.end(), 0.0);
    EXPECT_NEAR(sum_s, counted_mm / speed_mm_s, 1e-6 * sum_s);
}

// On the cylinder of radius rc about the spindle the helix' free fibre ends where L sin(a) is the
// leg of the right triangle with rho and rc: L = sqrt(rc^2 - rho^2) / sin(a).
TEST(PieceProgram, TheEyeKeepsToItsCylinder) {
    const double eye_mm = 80.0;
    const Planned p =
        planned(with_eye({.rule = EyeRule::Cylinder, .lengths = {}, .radius_mm = eye_mm}));
    const PieceProgram made = p.program();
    EXPECT_TRUE(made.refused.empty());
    EXPECT_TRUE(made.eyes.blocked.empty());
    const double leg_mm = std::sqrt(eye_mm * eye_mm - kPipeRadius_mm * kPipeRadius_mm);
    for (const EyePoint& at : made.eyes.path) {
        const bool course =
            p.plan.pieces[static_cast<std::size_t>(at.piece)].kind == PieceKind::Course;
        EXPECT_NEAR(at.eye_mm.head<2>().norm(), eye_mm, 1e-9);
        EXPECT_LT((at.landing_mm + at.free_length_mm * at.tangent - at.eye_mm).norm(), 1e-9);
        if (course) {
            // Radius and angle of the path are those of the patches: a relative error of 3e-4.
            EXPECT_NEAR(at.free_length_mm, leg_mm / kSine, 1e-3 * leg_mm);
        }
    }
    // X and Y alone carry the eye of this machine across, to steps of 0.001 mm.
    for (std::size_t b = 0; b < made.blocks.blocks.size(); ++b) {
        EXPECT_NEAR(std::hypot(made.blocks.value(b, kX), made.blocks.value(b, kY)), eye_mm, 0.001);
    }
}

TEST(PieceProgram, TheEyeKeepsToItsPlane) {
    for (const bool vertical : {true, false}) {
        EyeLaw eye{.rule = vertical ? EyeRule::VerticalPlane : EyeRule::HorizontalPlane,
                   .lengths = {},
                   .plane_x_mm = 90.0,
                   .plane_y_mm = -90.0};
        const Planned p = planned(with_eye(eye));
        PieceProgramOptions options;
        options.ignore_limits = true;  // whatever the head hits then
        const PieceProgram made = p.program(options);
        ASSERT_GT(made.blocks.blocks.size(), 100U);
        for (std::size_t b = 0; b < made.blocks.blocks.size(); ++b) {
            // Half a step of the axis.
            EXPECT_NEAR(made.blocks.value(b, vertical ? kX : kY), vertical ? 90.0 : -90.0, 0.0005);
        }
    }
}

TEST(PieceProgram, EqualFreeLengthsAreThoseOfTheJob) {
    const EyeLaw eye{.rule = EyeRule::EqualFreeLength, .free_length_mm = 150.0, .lengths = {}};
    const Planned p = planned(with_eye(eye));
    const PieceProgram made = p.program();
    for (const EyePoint& at : made.eyes.path) {
        EXPECT_EQ(at.free_length_mm, 150.0);
    }
    EXPECT_EQ(made.eyes.shortest_mm, 150.0);
    EXPECT_EQ(made.eyes.longest_mm, 150.0);
}

// The eye is ahead of a course by L cos(a) = 129 mm, so upward courses take the carriage to 189
// mm, where they end, and downward ones to -189. Turns begin where the course before ends.
TEST(PieceProgram, PiecesBeyondTheTravelAreRefusedAndNoOthers) {
    Machine machine = test::shipped("six_axis");
    machine.eye_chain[0].max = 150.0;
    const Planned p = planned(with_eye({.rule = EyeRule::EqualFreeLength, .lengths = {}}), machine);
    const double length_mm = p.setup.job.eye.free_length_mm;
    std::set<std::size_t> beyond;
    for (std::size_t i = 0; i < p.plan.pieces.size(); ++i) {
        double top_mm = -HUGE_VAL;
        for (const PathPoint& at : p.plan.pieces[i].path) {
            top_mm = std::max(top_mm, at.position_mm.z() + length_mm * at.tangent.z());
        }
        // None is near the limit, so that the check between stations says the same.
        ASSERT_GT(std::abs(top_mm - 150.0), 5.0);
        if (top_mm > 150.0) {
            beyond.insert(i);
        }
    }
    EXPECT_NEAR(static_cast<double>(beyond.size()), 0.5 * static_cast<double>(p.plan.pieces.size()),
                1.0);
    const std::map<std::size_t, CourseFault> refused = refused_by_machine(p.setup, p.plan.pieces);
    std::set<std::size_t> named;
    for (const auto& [piece, reason] : refused) {
        EXPECT_EQ(reason, CourseFault::AxisTravel) << piece;
        named.insert(piece);
    }
    // Each run of pieces beyond it is refused by its worst.
    EXPECT_TRUE(std::includes(beyond.begin(), beyond.end(), named.begin(), named.end()));
    bool run_named = true;
    for (std::size_t i = 0; i <= p.plan.pieces.size(); ++i) {
        if (!beyond.contains(i)) {
            EXPECT_TRUE(run_named) << "before piece " << i;
            run_named = true;
        } else {
            run_named = named.contains(i) || (beyond.contains(i - 1) && run_named);
        }
    }
    const PieceProgram none = p.program();
    EXPECT_EQ(none.refused, refused);
    EXPECT_TRUE(none.blocks.blocks.empty());
    PieceProgramOptions options;
    options.ignore_limits = true;
    const PieceProgram made = p.program(options);
    double top_mm = -HUGE_VAL;
    for (std::size_t b = 0; b < made.blocks.blocks.size(); ++b) {
        top_mm = std::max(top_mm, made.blocks.value(b, kZ));
    }
    // Where a course ends, or a bit further on in the turn, that climbs as the fibre lies flatter.
    EXPECT_GT(top_mm, 0.5 * test::kPipeLength_mm + length_mm * kCosine - 1.0);
}

TEST(PieceProgram, ReasonsAreFreeLengthAndHead) {
    const auto reasons = [](const Planned& p) {
        std::set<CourseFault> found;
        for (const auto& [piece, reason] : refused_by_machine(p.setup, p.plan.pieces)) {
            found.insert(reason);
        }
        return found;
    };
    // sqrt(36^2 - 30^2) = 20 mm along hoops, 26 mm along courses: below the machine's 30 mm.
    EXPECT_EQ(
        reasons(planned(with_eye({.rule = EyeRule::Cylinder, .lengths = {}, .radius_mm = 36.0}))),
        std::set{CourseFault::FreeLength});
    // On 40 mm it is long enough, 26 mm along hoops; the ball of 4 mm about the eye leaves 6 mm of
    // clearance.
    Machine patient = test::shipped("six_axis");
    patient.fibre.min_free_length_mm = 20.0;
    Job job = with_eye({.rule = EyeRule::Cylinder, .lengths = {}, .radius_mm = 40.0});
    EXPECT_EQ(reasons(planned(job, patient)), std::set<CourseFault>{});
    job.tolerance.clearance_mm = 7.0;
    EXPECT_EQ(reasons(planned(job, patient)), std::set{CourseFault::HeadHit});
}

TEST(PieceProgram, GoesOnFromTheNearestWholeTurn) {
    const Planned p = planned(with_eye({}));
    const PieceProgram plain = p.program();
    PieceProgramOptions options;
    options.spindle_rad = 1000.0;
    const PieceProgram on = p.program(options);
    ASSERT_EQ(on.blocks.blocks.size(), plain.blocks.blocks.size());
    EXPECT_LE(std::abs(rad_from_deg(on.blocks.value(0, kC)) - 1000.0), kPi + 1e-5);
    const double shift_deg = on.blocks.value(0, kC) - plain.blocks.value(0, kC);
    EXPECT_NEAR(shift_deg, 360.0 * std::round(shift_deg / 360.0), 0.001);
    EXPECT_GT(shift_deg, 360.0);
    for (std::size_t b = 0; b < on.blocks.blocks.size(); ++b) {
        // Rounded to steps of 0.001 deg after the turns are added.
        EXPECT_NEAR(on.blocks.value(b, kC) - plain.blocks.value(b, kC), shift_deg, 0.0021);
        EXPECT_EQ(on.blocks.value(b, kX), plain.blocks.value(b, kX));
    }
}

TEST(PieceProgram, TheChosenMotionSavesTimeAndLaysTheSameFibre) {
    Planned p = planned(with_eye({}));
    p.setup.dialect = make_dialect("siemens");  // which runs blocks as fast as they say
    const PieceProgram plain = p.program();
    PieceProgramOptions options;
    options.optimal = true;
    const PieceProgram fast = p.program(options);
    EXPECT_FALSE(plain.optimal);
    ASSERT_TRUE(fast.optimal);
    EXPECT_TRUE(fast.refused.empty());
    EXPECT_LT(fast.duration_s, plain.duration_s);
    EXPECT_GE(fast.duration_s, fast.least_s);
    ASSERT_EQ(fast.eyes.path.size(), plain.eyes.path.size());
    for (std::size_t i = 0; i < fast.eyes.path.size(); ++i) {
        EXPECT_EQ(fast.eyes.path[i].landing_mm, plain.eyes.path[i].landing_mm);
    }
    EXPECT_LT(worst_off_helix_mm(p.plan, fast.verification.laid.path),
              p.setup.job.tolerance.laydown_mm + kOnWall_mm);
}

TEST(PieceProgram, WhatIsReadFromTheTextIsWoundAgain) {
    const Planned p = planned(with_eye({}));
    int texts = 0;
    PieceProgramOptions options;
    options.round_trip = [&](const PieceProgram& made) {
        ++texts;
        BlockList read = made.blocks;
        read.tie_on_mm = made.eyes.path.front().landing_mm;
        // A program that stops half-way.
        read.blocks.resize(read.blocks.size() / 2);
        read.nano.resize(read.blocks.size() * read.axes.size());
        return read;
    };
    const PieceProgram made = p.program(options);
    EXPECT_GE(texts, 1);
    EXPECT_EQ(made.read.blocks.size(), made.blocks.blocks.size() / 2);
    EXPECT_FALSE(check_of(made, "laydown").ok);
    EXPECT_LT(made.verification.fibre_length_mm, 0.75 * p.plan.fibre_length_mm);
}

}  // namespace
}  // namespace meshwind
