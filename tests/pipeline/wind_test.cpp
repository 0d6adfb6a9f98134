// The main job in memory: mandrel, machine and job in; plan, programs and checks out.
#include "pipeline/wind.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/text/digest.h"
#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make_kinds.h"
#include "pipeline/trials/trials.h"
#include "pipeline/verify_text.h"
#include "postproc/tables/motion_csv.h"
#include "postproc/tables/path_csv.h"
#include "postproc/verify/check_kinds.h"
#include "tests/support/run_checks.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::check_of;
using test::failed_checks;
using test::kPipeLength_mm;
using test::kPipeRadius_mm;
using test::kPipeTow_mm;
using test::quick_job;
using test::Refused;
using test::shipped;
using test::small_pipe;

// The mesh's patches are off the ideal pipe by fourth order in edges of 6 mm.
constexpr double kOnWall_mm = 0.01;

// Of covers: what is asked here does not depend on how long they are improved.
constexpr double kQuick = 0.1;

Machine with_carriage_to(double end_mm) {
    Machine machine = shipped("six_axis");
    machine.eye_chain[0].min = -end_mm;
    machine.eye_chain[0].max = end_mm;
    return machine;
}

std::string path_table(const WoundLayer& layer) {
    return path_csv(layer.plan.pieces, layer.programs.front().made.eyes.path);
}

TEST(Wind, DoesNotWindACoverThatIsTooBare) {
    // No plan covers twice what single courses reach.
    const auto run = wind(small_pipe(), shipped("six_axis"), quick_job(LayerKind::Cover),
                          {.least_covered = 2.0});
    EXPECT_FALSE(run.planned());
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{std::string(check_kind::kPlan.name)});
    const Plan& plan = run.layers.front().plan;
    EXPECT_GT(plan.coverage.fraction, 0.5);
    EXPECT_GE(plan.coverage.reachable, plan.coverage.fraction);
    EXPECT_TRUE(plan.pieces.empty());
    EXPECT_TRUE(run.layers.front().programs.empty());
}

// What fibres join is told apart from what single courses reach: the limit is a share of the wall.
TEST(Wind, DoesNotWindACoverThatFibresJoinTooLittleOf) {
    for (const double least : {0.5, 1.01}) {
        const auto run = wind(small_pipe(), shipped("six_axis"), quick_job(LayerKind::Cover),
                              {.least_joined = least});
        const Plan& plan = run.layers.front().plan;
        EXPECT_EQ(run.planned(), least < 1.0);
        EXPECT_EQ(plan.pieces.empty(), least > 1.0);
        EXPECT_GT(plan.coverage.joinable, 0.5);
    }
}

TEST(Wind, OnlyTheMainJobChoosesABlend) {
    Job job = quick_job();
    job.mandrel.blend_mm.reset();
    EXPECT_EQ(test::refusal_of([&] { (void)mandrel_options(job); }).code, "job.blend_open");
}

TEST(Wind, AHelicalLayerIsPlannedWoundAndJudged) {
    std::set<std::string> steps;
    WindOptions options;
    options.mandrel_digest = "sha256 0123";
    options.reading_s = 1.5;
    options.context.progress = [&](const std::string& step, double share) {
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
        steps.insert(step);
    };
    const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), test::pipe_job(), options);
    EXPECT_TRUE(run.planned());
    EXPECT_TRUE(run.usable);
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    EXPECT_EQ(steps, (std::set<std::string>{"plan", "post", "verify"}));
    EXPECT_GE(run.timing_s.at("import"), 1.5);
    EXPECT_GE(run.timing_s.at("total"), run.timing_s.at("import") + run.timing_s.at("plan"));
    ASSERT_EQ(run.layers.size(), 1U);
    const WoundLayer& layer = run.layers.front();
    EXPECT_TRUE(layer.no_pattern.empty());
    EXPECT_FALSE(layer.import.has_value());
    EXPECT_TRUE(layer.build_up_mm.empty());
    ASSERT_EQ(layer.programs.size(), 1U);
    const FibreProgram& program = layer.programs.front();
    EXPECT_EQ(program.file, "program.ngc");
    EXPECT_EQ(layer.duration_s(), program.made.duration_s);
    // The text is that of the blocks, its head names what it was made from.
    const BlockList read =
        layer.setup.dialect->read(program.text, program.file, layer.setup.machine);
    EXPECT_EQ(read.nano, program.made.blocks.nano);
    ASSERT_TRUE(read.tie_on_mm.has_value());
    EXPECT_LT((*read.tie_on_mm - layer.plan.pieces.front().path.front().position_mm).norm(),
              std::sqrt(3.0) * 0.0005);  // three decimals
    EXPECT_NE(program.text.find("sha256 0123"), std::string::npos);
    EXPECT_NE(program.text.find(short_digest(job_text(layer.setup.job))), std::string::npos);
    // Courses are helices; the table's last arc length is that of all of the fibre.
    double courses_mm = 0.0;
    double all_mm = 0.0;
    for (const Piece& piece : layer.plan.pieces) {
        all_mm += piece.path.back().s_mm;
        courses_mm += piece.kind == PieceKind::Course ? piece.path.back().s_mm : 0.0;
    }
    const double helix_mm = kPipeLength_mm / std::cos(rad_from_deg(test::kPipeAngle_deg));
    EXPECT_NEAR(courses_mm, helix_mm * layer.plan.courses, kOnWall_mm * layer.plan.courses);
    EXPECT_NEAR(program.made.eyes.path.back().s_mm, all_mm, 1e-6);
    EXPECT_EQ(read_path_csv(path_table(layer), "path.csv").size(), program.made.eyes.path.size());
    // What the checks tell, against the job.
    EXPECT_EQ(check_of(run, "continuity").numbers.at("fibres"), 1.0);
    EXPECT_LT(check_of(run, "laydown").numbers.at("max_deviation_mm"), 0.2);
    EXPECT_LT(check_of(run, "slip").numbers.at("worst"), 0.2);
    EXPECT_GE(check_of(run, "collision").numbers.at("min_clearance_mm"), 5.0);
    EXPECT_GE(check_of(run, "free_length").numbers.at("min_mm"), 30.0);
    EXPECT_LE(check_of(run, "free_length").numbers.at("max_mm"), 400.0);
    ASSERT_TRUE(check_of(run, "slip").place.has_value());
    EXPECT_EQ(check_of(run, "slip").place->layer, 0U);
}

// The carriage ends where the pipe does: the eye is ahead of the fibre by up to 200 cos(50 deg) =
// 129 mm, and no turn of the job's plan can be wound.
TEST(Wind, AFailedCheckMakesProgramsUselessButForForce) {
    for (const bool force : {false, true}) {
        WindOptions options;
        options.force = force;
        const meshwind::Run run = wind(small_pipe(), with_carriage_to(61.0), quick_job(), options);
        EXPECT_TRUE(run.planned());
        EXPECT_FALSE(run.passed());
        EXPECT_EQ(run.usable, force);
        const Check& limits = check_of(run, "limits");
        EXPECT_FALSE(limits.ok);
        // Each of the 11 circuits goes beyond both ends.
        EXPECT_EQ(limits.numbers.at("violations"),
                  static_cast<double>(run.layers.front().plan.courses));
        // What is written in spite of it says so in its head.
        const FibreProgram& program = run.layers.front().programs.front();
        EXPECT_NE(program.text.find("limits"), std::string::npos);
    }
}

TEST(Wind, WithoutAPlanThereAreNoProgramsEvenByForce) {
    Job job = quick_job();
    job.layers.front().pattern = PatternJob{.circuits = 14, .starts = 8};  // at most 14 / 2
    job.layers.push_back(job.layers.front());
    WindOptions options;
    options.force = true;
    const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), job, options);
    EXPECT_FALSE(run.planned());
    EXPECT_FALSE(run.usable);
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{"plan"});
    ASSERT_EQ(run.layers.size(), 1U);
    EXPECT_TRUE(run.layers.front().programs.empty());
}

// N circuits of a tow w wide and t thick on a pipe are 2 N w t / (2 pi R cos(a)) thick all over.
TEST(Wind, TheNextLayerIsWoundOnTheOneBefore) {
    Job job = quick_job();
    job.layers.push_back(quick_job(LayerKind::Hoop).layers.front());
    std::set<std::string> steps;
    WindOptions options;
    options.context.progress = [&](const std::string& step, double) { steps.insert(step); };
    const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), job, options);
    EXPECT_TRUE(run.usable);
    ASSERT_EQ(run.layers.size(), 2U);
    const WoundLayer& first = run.layers[0];
    const WoundLayer& second = run.layers[1];
    const double thick_mm =
        2.0 * static_cast<double>(first.plan.pattern()->pattern.circuits) * kPipeTow_mm *
        job.tow.thickness_mm /
        (2.0 * kPi * kPipeRadius_mm * std::cos(rad_from_deg(test::kPipeAngle_deg)));
    for (const double built_mm : first.build_up_mm) {
        EXPECT_NEAR(built_mm, thick_mm, 1e-3 * thick_mm);
    }
    ASSERT_EQ(first.build_up_mm.size(), first.setup.mandrel.surface.position_mm.size());
    for (const Vector3d& p : second.setup.mandrel.surface.position_mm) {
        EXPECT_NEAR(p.head<2>().norm(), kPipeRadius_mm + thick_mm, 1e-3);
    }
    // Hoops on it: whole turns at both ends and a pitch of a tow at most between, of which each is
    // 2 pi (R + thickness) long; what leads there from the first layer comes on top.
    const Piece* hoops = nullptr;
    for (const Piece& piece : second.plan.pieces) {
        hoops = piece.kind == PieceKind::Course ? &piece : hoops;
    }
    ASSERT_NE(hoops, nullptr);
    const double least_turns = (kPipeLength_mm - kPipeTow_mm) / kPipeTow_mm + 2.0;
    const double turns = hoops->path.back().s_mm / (2.0 * kPi * (kPipeRadius_mm + thick_mm));
    EXPECT_GE(turns, least_turns);
    EXPECT_LT(turns, least_turns + 1.0);
    // One fibre goes on from layer to layer, or it is said why not.
    ASSERT_TRUE(second.plan.continues_fibre);
    EXPECT_EQ(second.plan.cut_reason, "");
    const PathPoint& end = first.plan.pieces.back().path.back();
    const Vector3d& begin = second.plan.pieces.front().path.front().position_mm;
    EXPECT_LT((begin - end.position_mm - thick_mm * end.normal).norm(), 2.0 * kOnWall_mm);
    const BlockList& before = first.programs.back().made.blocks;
    const double spindle_deg =
        second.programs.front().made.blocks.value(0, 0) - before.value(before.blocks.size() - 1, 0);
    EXPECT_LE(std::abs(spindle_deg), 180.0 + 0.001);
    EXPECT_NE(second.programs.front().text.find("program.ngc"), std::string::npos);
    EXPECT_EQ(second.programs.front().file, "program-layer-2.ngc");
    // Each check of the first layer has one of the second, but for the pattern's closure.
    std::set<std::string> names;
    for (const Check& check : run.checks) {
        EXPECT_TRUE(names.insert(check.name).second) << check.name;
    }
    for (const Check& check : first.checks) {
        EXPECT_EQ(names.contains(check.name + "-layer-2"), check.name != "closure") << check.name;
    }
    ASSERT_TRUE(check_of(run, "slip-layer-2").place.has_value());
    EXPECT_EQ(check_of(run, "slip-layer-2").place->layer, 1U);
    EXPECT_TRUE(steps.contains("layer 1, plan") && steps.contains("layer 2, plan"));
}

// Of a pipe it is patterns, each on the one before. What is asked for is there nearly everywhere,
// and hardly more: circuits are a whole number, which may lay a quarter more.
TEST(Wind, AWallIsWoundInStagesUntilItIsThick) {
    Job job = quick_job(LayerKind::Wall);
    job.layers.front().wall = WallJob{.amount = {.thickness_mm = 2.0}};
    job.layers.push_back(quick_job(LayerKind::Hoop).layers.front());
    const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), job);
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    EXPECT_TRUE(run.usable);
    ASSERT_EQ(run.layers.size(), 3U);  // 4 % of 30 mm are four layers a stage; then the hoops
    ASSERT_EQ(run.walls.size(), 1U);
    EXPECT_EQ(run.walls.front().first, 0U);
    EXPECT_EQ(run.walls.front().last, 1U);
    const WallFigures& figures = run.walls.front().figures;
    EXPECT_EQ(figures.asked_layers, 8.0);
    EXPECT_LE(figures.below_share, kMaxBelow);
    EXPECT_GE(figures.mean_ratio, 1.0);
    EXPECT_LE(figures.mean_ratio, 1.25);
    EXPECT_EQ(check_of(run, "wall").numbers.at("below"), figures.below_share);
    const double grown_mm =
        run.layers[2].setup.mandrel.surface.position_mm.front().head<2>().norm();
    EXPECT_GE(grown_mm, kPipeRadius_mm + 2.0 - kOnWall_mm);
    EXPECT_LE(grown_mm, kPipeRadius_mm + 2.5);
}

// Of a vessel the first stages touch the openings, where circuits pile up; the last turns back
// beyond what has piled up there. From opening to opening each, the wall cannot be wound.
TEST(Wind, AWallOfAVesselStepsAwayFromItsOpenings) {
    const Mandrel vessel = test::made("vessel",
                                      {{"radius", 30.0},
                                       {"cylinder-length", 40.0},
                                       {"dome-height", 21.0},
                                       {"opening-radius", 8.0}},
                                      6.0);
    Job job = quick_job(LayerKind::Wall);
    job.tow.width_mm = 8.0;
    job.layers.front().wall = WallJob{.amount = {.thickness_mm = 1.5}};
    const meshwind::Run run = wind(vessel, shipped("six_axis"), job);
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    ASSERT_EQ(run.layers.size(), 3U);
    const auto turns_mm = [&](std::size_t layer) {
        return 30.0 * std::sin(run.layers[layer].plan.pattern()->angle_rad);
    };
    EXPECT_NEAR(turns_mm(0), 8.0 + 4.0, 30.0 * rad_from_deg(3.0));
    EXPECT_GT(turns_mm(2), turns_mm(0) + 8.0);
    EXPECT_LE(run.walls.front().figures.below_share, kMaxBelow);
}

// The figures of a wall are those of all its stages, and the bound is below what they take.
TEST(Wind, AWallOfCoversCountsAllItsStages) {
    const auto tee = [](const Job&) {
        const MakeValues sizes{{"run-length", 240.0}, {"branch-length", 140.0}};
        return build_mandrel(make_mandrel("tee", sizes, {.edge_mm = 8.0}), "tee");
    };
    Job job = quick_job(LayerKind::Wall);
    job.mandrel.extension_mm = 120.0;
    job.mandrel.extension_given = true;
    job.fibres_given = true;
    job.tow.width_mm = 20.0;
    job.tow.friction = 0.3;
    job.tow.thickness_mm = 0.8;  // 4 % of the branch's 40 mm: two layers a stage
    job.layers.front().wall = WallJob{.amount = {.layers = 4.0}};
    const meshwind::Run run = wind(tee, shipped("six_axis"), job, {.context = {.effort = kQuick}});
    EXPECT_TRUE(run.planned());
    ASSERT_GE(run.layers.size(), 2U);
    ASSERT_EQ(run.walls.size(), 1U);
    const WallFigures& figures = run.walls.front().figures;
    EXPECT_EQ(figures.stages, static_cast<int>(run.layers.size()));
    double fibre_mm = 0.0;
    for (const WoundLayer& layer : run.layers) {
        EXPECT_EQ(layer.plan.planner, Planner::Cover);
        fibre_mm += layer.plan.fibre_length_mm;
    }
    EXPECT_NEAR(figures.fibre_mm, fibre_mm, 1e-6 * fibre_mm);
    EXPECT_GT(figures.least_factor, 1.0);
    EXPECT_GT(figures.fibre_factor, figures.least_factor);
    EXPECT_EQ(check_of(run, "wall").ok, figures.below_share <= kMaxBelow);
    EXPECT_LT(figures.below_share, 0.1);
}

// The pattern of an `auto` layer is wound on trial before it is taken: as the one that is kept.
TEST(Wind, AnAutoLayerGoesOnWhereTheSpindleStands) {
    Job job = quick_job();
    job.layers.push_back(quick_job(LayerKind::Auto).layers.front());
    const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), job);
    ASSERT_EQ(run.layers.size(), 2U);
    ASSERT_TRUE(run.layers[1].plan.continues_fibre);
    const BlockList& before = run.layers[0].programs.back().made.blocks;
    const BlockList& after = run.layers[1].programs.front().made.blocks;
    // Many turns lie behind it; the nearest whole turn is half a turn away at most.
    EXPECT_GT(std::abs(before.value(before.blocks.size() - 1, 0)), 3600.0);
    EXPECT_LE(std::abs(after.value(0, 0) - before.value(before.blocks.size() - 1, 0)), 180.001);
}

TEST(Wind, TheNumberOfThreadsChangesNoByte) {
    std::vector<std::vector<std::string>> results;  // program, path, motion
    for (const int threads : {1, 2}) {
        set_thread_count(threads);
        const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), test::pipe_job());
        const WoundLayer& layer = run.layers.front();
        results.push_back({layer.programs.front().text, path_table(layer),
                           motion_csv(layer.setup.machine, layer.programs.front().made.blocks)});
    }
    set_thread_count(0);
    EXPECT_FALSE(results[0].front().empty());
    EXPECT_TRUE(results[0] == results[1]);
}

// `auto` takes the first of 45, 50 .. 80 degrees whose turns the extension has room for. From the
// angle a to the hoop R / k (1 / sin(a) - 1) are needed, and half a tow: with k = 0.192, 0.96 of
// the friction, 70.7 mm at 45 degrees and 53.7 mm at 50.
TEST(Wind, AutoTakesTheFirstAngleThatHolds) {
    Job job = quick_job(LayerKind::Auto);
    for (const auto& [extension_mm, angle_deg] : {std::pair{100.0, 45.0}, {60.0, 50.0}}) {
        job.mandrel.extension_mm = extension_mm;
        WindOptions options;
        options.context.seed = 7;
        const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), job, options);
        EXPECT_TRUE(run.usable);
        EXPECT_EQ(run.seed, 7U);
        const WoundLayer& layer = run.layers.front();
        EXPECT_EQ(layer.plan.planner, Planner::Pattern);
        ASSERT_TRUE(layer.plan.pattern() != nullptr);
        EXPECT_NEAR(deg_from_rad(layer.plan.pattern()->angle_rad), angle_deg, 1e-6);
        EXPECT_EQ(layer.no_pattern, "");
    }
}

TEST(Wind, LandingPointsOfAPlanGiveTheSameFibre) {
    const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), quick_job());
    ASSERT_TRUE(run.usable);
    WindOptions options;
    options.import = ImportRequest{.points = {"path.csv", path_table(run.layers.front())},
                                   .mandrel_frame = true};
    // What the job's layers ask for is not read then, nor are there layers after it.
    Job hoops = quick_job(LayerKind::Hoop);
    hoops.layers.push_back(hoops.layers.front());
    const meshwind::Run again = wind(small_pipe(), shipped("six_axis"), hoops, options);
    EXPECT_TRUE(again.usable) << ::testing::PrintToString(failed_checks(again));
    ASSERT_EQ(again.layers.size(), 1U);
    ASSERT_TRUE(again.layers.front().import.has_value());
    const ImportFit& fit = *again.layers.front().import;
    EXPECT_EQ(check_of(again, "import").numbers.at("worst_mm"), fit.worst_mm);
    EXPECT_LT(fit.worst_mm, kOnWall_mm);
    const EyePath& was = run.layers.front().programs.front().made.eyes.path;
    const EyePath& is = again.layers.front().programs.front().made.eyes.path;
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t i = 0; i < is.size(); ++i) {
        // Back to the patches, and in the direction that the job asks for at least.
        EXPECT_LT((is[i].landing_mm - was[i].landing_mm).norm(), kOnWall_mm) << i;
        EXPECT_LT((is[i].tangent - was[i].tangent).norm(), rad_from_deg(0.3)) << i;
    }
    EXPECT_NEAR(is.back().s_mm, was.back().s_mm, 1e-4 * was.back().s_mm);
    EXPECT_EQ(again.layers.front().plan.courses, run.layers.front().plan.courses);
}

// An imported layer winds its own points; the file's axes are the mandrel's.
TEST(Wind, AnImportedLayerWindsItsPoints) {
    const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), quick_job());
    Job job = quick_job(LayerKind::Imported);
    const Mandrel mandrel = small_pipe();
    ASSERT_TRUE(mandrel.file_to_mandrel.isApprox(Eigen::Affine3d::Identity(), 1e-9));
    job.layers.front().file = "path.csv";
    job.layers.front().points = {"path.csv", path_table(run.layers.front())};
    const meshwind::Run again = wind(mandrel, shipped("six_axis"), job);
    EXPECT_TRUE(again.usable);
    EXPECT_EQ(again.layers.front().plan.planner, Planner::Imported);
    EXPECT_EQ(again.layers.front().plan.courses, run.layers.front().plan.courses);
    job.layers.front().points.text = "x_mm,y_mm\n";
    EXPECT_EQ(test::refusal_of([&] { (void)wind(mandrel, shipped("six_axis"), job); }).code,
              "import.column");
}

// By code and place, before anything is planned.
TEST(Wind, WhatCannotBeWoundIsRefused) {
    const auto refused = [](const Job& job, const Machine& machine) {
        WindOptions options;
        options.files = {.machine = "machine.json", .job = "job.json"};
        return test::refusal_of([&] { (void)wind(small_pipe(), machine, job, options); });
    };
    const Machine six = shipped("six_axis");
    const auto not_offered = [](const std::string& pointer) {
        return Refused{"job.not_offered", "job.json: " + pointer};
    };
    Job pins = quick_job();
    pins.mandrel.turn = TurnKind::Pins;
    for (const LayerKind kind : {LayerKind::Hoop, LayerKind::Polar}) {
        pins.layers.front().kind = kind;
        EXPECT_EQ(refused(pins, six), not_offered("/mandrel/turn")) << name_of(kind);
    }
    pins = quick_job();
    pins.mandrel.turn = TurnKind::Pins;
    pins.layers.push_back(pins.layers.front());
    EXPECT_EQ(refused(pins, six), not_offered("/mandrel/turn"));
    Job lengths = quick_job();
    lengths.eye.rule = EyeRule::EqualFreeLength;
    lengths.eye.lengths = {{.piece = 0, .free_length_mm = 150.0}};
    EXPECT_EQ(refused(lengths, six), not_offered("/eye/lengths"));
    lengths.layers.front().kind = LayerKind::Imported;
    lengths.layers.push_back(lengths.layers.front());
    EXPECT_EQ(refused(lengths, six), not_offered("/eye/lengths"));
    for (const RedundancyRule rule : {RedundancyRule::Hold, RedundancyRule::Oscillate}) {
        Job turns = quick_job();
        turns.redundancy = rule;
        EXPECT_EQ(refused(turns, shipped("two_axis")),
                  (Refused{"job.turn_forced", "job.json: /redundancy"}));
    }
    Job elsewhere = quick_job();
    elsewhere.eye.rule = EyeRule::Cylinder;
    elsewhere.eye.radius_mm = 80.0;  // the machine keeps it at 58.31
    EXPECT_EQ(refused(elsewhere, shipped("two_axis")).code, "machine.missing_axis");
    EXPECT_EQ(refused(quick_job(), with_carriage_to(40.0)).code, "plan.travel");
    Job smooth = quick_job(LayerKind::Cover);
    smooth.tow.friction = 0.0;
    EXPECT_EQ(refused(smooth, six).code, "plan.no_turn");
    Machine moving = six;
    moving.controller.header.emplace_back("G1 X10");
    EXPECT_EQ(refused(quick_job(), moving).code, "dialect.header_line");
    Job shorter = quick_job();
    shorter.eye.free_length_mm = 10.0;
    EXPECT_EQ(refused(shorter, six), (Refused{"job.free_length", "job.json: /eye/free_length"}));
}

// Six circuits at 45 degrees leave two thirds bare, and each turn runs behind pins.
TEST(Wind, ALatticeTurnsOnItsPins) {
    Job job = parse_job(R"({"layers": [{"kind": "lattice", "angle": 45, "circuits": 6}],
                            "mandrel": {"turn": "pins"}, "tow": {"width": 3},
                            "redundancy": "central-angle"})",
                        "job.json");
    const meshwind::Run run = wind(small_pipe(), shipped("six_axis"), job);
    EXPECT_TRUE(run.usable) << ::testing::PrintToString(failed_checks(run));
    const WoundLayer& layer = run.layers.front();
    ASSERT_EQ(layer.plan.failure, "");
    ASSERT_EQ(layer.plan.pins.size(), 2U);
    std::size_t pins = 0;
    for (const PinRing& ring : layer.plan.pins) {
        EXPECT_EQ(ring.count % 6, 0) << "each circuit's turn begins alike";
        pins += static_cast<std::size_t>(ring.count);
    }
    EXPECT_EQ(layer.setup.wall->pins().size(), pins);
    EXPECT_EQ(layer.plan.courses, 12);
    // Bare wall is meant: the share is told, and has no limit.
    const Check& coverage = check_of(run, "coverage");
    EXPECT_TRUE(coverage.ok);
    EXPECT_FALSE(coverage.numbers.contains("limit"));
}

}  // namespace
}  // namespace meshwind
