// What is refused before planning, with code and figures, and what is not.
#include "pipeline/before_planning.h"
#include "mesh/shapes/make_kinds.h"

#include <algorithm>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/io/import.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make.h"
#include "pipeline/part_words.h"
#include "pipeline/piece_program.h"
#include "pipeline/plan_layer.h"
#include "pipeline/setup.h"
#include "tests/support/any_machine.h"
#include "tests/support/shapes.h"
#include "tests/support/small_pipe.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using test::shipped;
using test::tells;

Mandrel made(const std::string& kind, const MakeValues& values, double scale = 1.0,
             MandrelOptions options = {.unit_mm = 1.0}) {
    TriangleSoup soup = make_mandrel(kind, values, {.edge_mm = 8.0});
    for (Eigen::Vector3d& point : soup.points_mm) {
        point *= scale;
    }
    return build_mandrel(soup, kind + ".stl", options);
}

struct Outcome {
    std::string code;
    std::string place;
    std::string words;
};

Outcome outcome(const Machine& machine, const Mandrel& mandrel, const Job& job = {}) {
    const HeadEnvelope envelope = head_envelope(machine);
    try {
        require_can_be_wound({machine, envelope, mandrel, job, "machine.json", "job.json"});
    } catch (const InputError& error) {
        return {error.code(), error.place(), error.what()};
    }
    return {};
}

std::vector<std::string> remarks_on(const Machine& machine, const Mandrel& mandrel,
                                    const Job& job) {
    const HeadEnvelope envelope = head_envelope(machine);
    std::vector<std::string> found =
        remarks_before_planning({machine, envelope, mandrel, job, {}, {}});
    found.erase(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(mandrel.remarks.size()));
    return found;
}

Job with_kind(LayerKind kind) {
    Job job;
    job.layers.front().kind = kind;
    return job;
}

Job for_hobby() {
    Job job;
    job.eye.rule = EyeRule::Cylinder;
    job.eye.radius_mm = 60.0;
    return job;
}

Machine with_carriage(Machine machine, double min_mm, double max_mm) {
    machine.eye_chain[0].min = min_mm;
    machine.eye_chain[0].max = max_mm;
    return machine;
}

// The wrist of the robot is 1351 mm from its shoulder at most, the eye 358 mm before it.
TEST(BeforePlanning, TellsWhatARobotDoesNotReach) {
    const Machine robot = shipped("robot_winder");
    const Mandrel tube = made("cylinder", {{"radius", 25.0}, {"length", 400.0}});
    EXPECT_EQ(outcome(robot, tube).code, "");
    const Mandrel long_tube = made("cylinder", {{"radius", 25.0}, {"length", 3200.0}});
    const Outcome found = outcome(robot, long_tube);
    EXPECT_EQ(found.code, "plan.travel");
    EXPECT_TRUE(tells(found.words, "axes A B C U V W need -1600.7 to 1600.7 mm")) << found.words;
    EXPECT_EQ(outcome(shipped("robot_track"), long_tube).code, "");
    Machine far = robot;
    for (Axis& axis : far.eye_chain) {
        axis.point_mm.x() += 2000.0;
    }
    far.eye.position_mm.x() += 2000.0;
    const Outcome too_far = outcome(far, tube);
    EXPECT_EQ(too_far.code, "plan.travel");
    EXPECT_TRUE(tells(too_far.words, "comes no nearer to the spindle axis")) << too_far.words;
}

TEST(BeforePlanning, TellsAxisAndMillimetresOfAPartBeyondItsTravel) {
    const Machine four = shipped("four_axis");
    const Mandrel tube = made("cylinder", {{"radius", 25.0}, {"length", 3200.0}});
    const Outcome found = outcome(four, tube);
    EXPECT_EQ(found.code, "plan.travel");
    // Half the length and the least run of a turn: 25 / (0.98 * 0.2) * (1 / sin 84 deg - 1) = 0.7.
    for (const char* figure :
         {"machine.json", "axis Z", "-1600.7", "1600.7", "-1500.0", "1500.0"}) {
        EXPECT_TRUE(tells(found.words, figure)) << found.words;
    }
    const Mandrel shorter = made("cylinder", {{"radius", 25.0}, {"length", 400.0}});
    EXPECT_EQ(outcome(four, shorter).code, "");
    EXPECT_EQ(outcome(with_carriage(four, -150.0, 150.0), shorter).code, "plan.travel");
    // A hand's breadth too short is not decided here: turns lie on the extensions.
    EXPECT_EQ(outcome(with_carriage(four, -200.5, 200.5), shorter).code, "");
}

// A pipe cut 45 degrees off square: its end is an ellipse of 25 and 25 sqrt(2) mm.
TEST(BeforePlanning, ARimOffItsCircleIsRefusedWithItsPlace) {
    const auto cut_off_square = [](double slope) {
        TriangleSoup pipe =
            make_mandrel("cylinder", {{"radius", 25.0}, {"length", 200.0}}, {.edge_mm = 5.0});
        for (Eigen::Vector3d& p : pipe.points_mm) {
            p.z() += p.z() > 0.0 ? slope * p.x() * p.z() / 100.0 : 0.0;
        }
        return build_mandrel(pipe, "oblique.stl");
    };
    const Outcome found = outcome(shipped("six_axis"), cut_off_square(1.0));
    EXPECT_EQ(found.code, "mesh.rim_not_round");
    for (const char* word : {"oblique.stl", "rim ", "oblique", "square to its leg"}) {
        EXPECT_NE(found.words.find(word), std::string::npos) << found.words;
    }
    const std::vector<std::string>& remarks = cut_off_square(1.0).remarks;
    EXPECT_TRUE(std::any_of(remarks.begin(), remarks.end(), [](const std::string& remark) {
        return remark.find("the main job refuses it") != std::string::npos;
    }));
    // 17 degrees: 0.5 (1 / cos - 1) = 0.022 of the radius.
    EXPECT_EQ(outcome(shipped("six_axis"), cut_off_square(0.3)).code, "");
}

// A rod of radius 20 that goes over into a bar of square section, or of a round one.
TriangleSoup rod_with_bar(double half_width_mm, bool square) {
    constexpr int kAround = 64;  // with points in the corners
    TriangleSoup soup;
    const auto ring = [&](double z, double radius, bool angular) {
        for (int k = 0; k < kAround; ++k) {
            const double angle = 2.0 * kPi * k / kAround;
            const Eigen::Vector2d u(std::cos(angle), std::sin(angle));
            const double reach = angular ? radius / u.cwiseAbs().maxCoeff() : radius;
            soup.points_mm.emplace_back(reach * u.x(), reach * u.y(), z);
        }
    };
    ring(-80.0, 20.0, false);
    ring(0.0, 20.0, false);
    ring(0.0, half_width_mm, square);
    ring(60.0, half_width_mm, square);
    soup.points_mm.emplace_back(0.0, 0.0, -80.0);
    soup.points_mm.emplace_back(0.0, 0.0, 60.0);
    for (int k = 0; k < kAround; ++k) {
        const int next = (k + 1) % kAround;
        for (int r = 0; r < 3; ++r) {
            const int low = r * kAround;
            const int high = low + kAround;
            soup.faces.push_back({low + k, low + next, high + next});
            soup.faces.push_back({high + next, high + k, low + k});
        }
        soup.faces.push_back({4 * kAround, next, k});
        soup.faces.push_back({4 * kAround + 1, 3 * kAround + k, 3 * kAround + next});
    }
    return soup;
}

TEST(BeforePlanning, ALegOfSquareSectionIsRefusedWithItsPlace) {
    const Mandrel bar = build_mandrel(rod_with_bar(25.0, true), "bar.stl");
    const Outcome found = outcome(shipped("six_axis"), bar);
    EXPECT_EQ(found.code, "mesh.end_not_round");
    ASSERT_EQ(bar.angular_ends.size(), 1U);
    const AngularEnd& end = bar.angular_ends.front();
    EXPECT_NEAR(end.area_mm2, 50.0 * 50.0, 1e-6);
    const Eigen::Vector3d in_file = bar.file_to_mandrel.inverse() * end.middle_mm;
    EXPECT_LT((in_file - Eigen::Vector3d(0.0, 0.0, 60.0)).norm(), 1e-6);
    EXPECT_TRUE(tells(found.words, "region " + std::to_string(end.region))) << found.words;

    MandrelOptions named;
    for (const Region& region : bar.regions) {
        if (region.kept) {
            named.keep_regions.push_back(region.id);
        }
    }
    EXPECT_TRUE(build_mandrel(rod_with_bar(25.0, true), "bar.stl", named).angular_ends.empty());
    // A round bar ends in a circle, and a small square one is a pad.
    EXPECT_TRUE(build_mandrel(rod_with_bar(25.0, false), "bar.stl").angular_ends.empty());
    EXPECT_TRUE(build_mandrel(rod_with_bar(8.0, true), "bar.stl").angular_ends.empty());
}

// Two pipes that do not touch: nothing goes from one to the other. A crumb is left out instead.
TEST(BeforePlanning, AWallInPiecesIsRefusedWithTheirPlaces) {
    const auto pipe_at = [](double radius, double length, double x) {
        TriangleSoup pipe = make_mandrel("cylinder", {{"radius", radius}, {"length", length}},
                                         {.edge_mm = radius / 5.0});
        for (Eigen::Vector3d& p : pipe.points_mm) {
            p.x() += x;
        }
        return pipe;
    };
    TriangleSoup two = pipe_at(25.0, 200.0, 0.0);
    test::add(two, pipe_at(20.0, 100.0, 90.0));
    const Outcome found = outcome(shipped("six_axis"), build_mandrel(two, "two.stl"));
    EXPECT_EQ(found.code, "mesh.pieces");
    // 2 pi 25 200 and 2 pi 20 100 mm2 less the chords, and the first one's region.
    for (const char* figure : {"two.stl", "2 pieces", "313.", "125.", "[0]"}) {
        EXPECT_NE(found.words.find(figure), std::string::npos) << found.words;
    }
    TriangleSoup crumb = pipe_at(25.0, 200.0, 0.0);
    test::add(crumb, pipe_at(2.0, 4.0, 90.0));
    const Mandrel mandrel = build_mandrel(crumb, "crumb.stl");
    EXPECT_EQ(mandrel.pieces.size(), 1U);
    EXPECT_EQ(mandrel.rims.size(), 2U);
    EXPECT_EQ(outcome(shipped("six_axis"), mandrel).code, "");
}

// A sharp crotch is worth a word, a round one is not.
TEST(BeforePlanning, ABlendIsProposedForASharpCrotch) {
    const auto proposed = [](double blend_mm) {
        std::vector<std::string> remarks;
        propose_blend(made("tee", {{"blend-radius", blend_mm}}), 6.0, remarks);
        return std::any_of(remarks.begin(), remarks.end(), [](const std::string& remark) {
            return remark.find("mandrel.blend=6.0") != std::string::npos;
        });
    };
    EXPECT_TRUE(proposed(0.5));
    EXPECT_FALSE(proposed(15.0));
}

TEST(BeforePlanning, OneEndBeyondTheTravelStopsPatternsAndPlainTubes) {
    const Mandrel tube = made("cylinder", {{"radius", 25.0}, {"length", 400.0}});
    const Machine one_side = with_carriage(shipped("four_axis"), -300.0, 100.0);
    for (const LayerKind kind : {LayerKind::Helical, LayerKind::Auto, LayerKind::Cover}) {
        EXPECT_EQ(outcome(one_side, tube, with_kind(kind)).code, "plan.travel");
    }
    // 5 % of the wall beyond: courses may do without.
    const Machine nearly = with_carriage(shipped("four_axis"), -300.0, 180.0);
    EXPECT_EQ(outcome(nearly, tube, with_kind(LayerKind::Helical)).code, "plan.travel");
    EXPECT_EQ(outcome(nearly, tube, with_kind(LayerKind::Cover)).code, "");
}

TEST(BeforePlanning, PartsOfTheWrongUnitAreAskedAfter) {
    const MakeValues pipe = {{"radius", 50.0}, {"length", 500.0}};
    for (const double scale : {25.4, 1e4, 1e5}) {
        const Mandrel large = made("cylinder", pipe, scale, {});
        for (const char* name : {"four_axis", "six_axis"}) {
            const Outcome found = outcome(shipped(name), large);
            EXPECT_EQ(found.code, "plan.travel") << name << scale;
            EXPECT_NE(found.words.find(unit_question(large)), std::string::npos) << found.words;
        }
    }
    const Mandrel inches = made("cylinder", {{"radius", 25.0}, {"length", 400.0}}, 1.0 / 25.4, {});
    const Outcome found = outcome(shipped("six_axis"), inches);
    EXPECT_EQ(found.code, "plan.tow_width");
    EXPECT_NE(found.words.find(unit_question(inches)), std::string::npos) << found.words;
}

TEST(BeforePlanning, AnEyeAtOneDistanceGetsAroundWhatIsNarrower) {
    const Machine hobby = shipped("hobby_grbl");
    const Job job = for_hobby();
    const Mandrel cone = made("cone", {{"radius1", 60.0}, {"radius2", 30.0}, {"length", 200.0}});
    // The narrow rim is left; the plan comes to 64 % of the wall, after a minute.
    EXPECT_EQ(outcome(hobby, cone, job).code, "");
    const std::vector<std::string> remarks = remarks_on(hobby, cone, job);
    ASSERT_EQ(remarks.size(), 1U);
    // Clearance 5, less 1 mm of slack.
    EXPECT_TRUE(tells(remarks.front(), "64.0 mm")) << remarks.front();
    EXPECT_TRUE(tells(remarks.front(), "60.0 mm")) << remarks.front();
    Job helical = job;
    helical.layers.front().kind = LayerKind::Helical;
    helical.layers.front().angle_deg = 45.0;
    EXPECT_EQ(outcome(hobby, cone, helical).code, "plan.travel");
    EXPECT_EQ(outcome(hobby, made("cylinder", {{"radius", 25.0}, {"length", 400.0}}), job).code,
              "");
    EXPECT_EQ(outcome(hobby, made("cylinder", {{"radius", 70.0}, {"length", 500.0}}), job).code,
              "plan.travel");
}

TEST(BeforePlanning, AJobWithoutAnyTurnIsRefused) {
    const Machine six = shipped("six_axis");
    const Mandrel tube = made("cylinder", {{"radius", 25.0}, {"length", 200.0}});
    const Mandrel closed = made("ellipsoid", {});
    Job no_friction;
    no_friction.tow.friction = 0.0;
    EXPECT_EQ(outcome(six, tube, no_friction).code, "plan.no_turn");
    Job no_extension = with_kind(LayerKind::Cover);
    no_extension.mandrel.extension_mm = 2.0;
    const Outcome found = outcome(six, tube, no_extension);
    EXPECT_EQ(found.code, "plan.no_turn");
    EXPECT_TRUE(tells(found.words, "3.7 mm")) << found.words;  // 0.7 + 6 / 2
    EXPECT_EQ(outcome(six, closed, with_kind(LayerKind::Cover)).code, "plan.no_turn");
    EXPECT_EQ(outcome(six, closed).code, "");  // domes turn the fibre by themselves
    no_friction.mandrel.turn = TurnKind::Pins;
    EXPECT_EQ(outcome(six, tube, no_friction).code, "");
}

TEST(BeforePlanning, ABodyInTheWayOfTheTurningPartIsTold) {
    Machine machine = shipped("six_axis");
    MachineBody bed;
    bed.shape = Capsule{{0.0, -90.0, -500.0}, {0.0, -90.0, 500.0}, 20.0};
    machine.bodies.assign(1, bed);
    const Mandrel thin = made("cylinder", {{"radius", 60.0}, {"length", 500.0}});
    const Mandrel thick = made("cylinder", {{"radius", 80.0}, {"length", 500.0}});
    EXPECT_EQ(outcome(machine, thin).code, "");
    const Outcome found = outcome(machine, thick);
    EXPECT_EQ(found.code, "plan.body");
    EXPECT_TRUE(tells(found.words, "70.0 mm")) << found.words;
}

TEST(BeforePlanning, ASpindleOffThePartsOwnAxisIsRemarkedOn) {
    const auto remarks = [&](const Eigen::Vector3d& direction) {
        Job job;
        job.mandrel.axis = Job::MandrelAxis{Eigen::Vector3d::Zero(), direction};
        const MandrelOptions::Axis axis{Eigen::Vector3d::Zero(), direction};
        return remarks_on(shipped("six_axis"),
                          made("cylinder", {{"radius", 25.0}, {"length", 200.0}}, 1.0,
                               {.unit_mm = 1.0, .axis = axis}),
                          job);
    };
    EXPECT_TRUE(remarks(Eigen::Vector3d::UnitZ()).empty());
    ASSERT_EQ(remarks(Eigen::Vector3d::UnitX()).size(), 1U);
    EXPECT_TRUE(tells(remarks(Eigen::Vector3d::UnitX()).front(), "90.0 deg"));
}

// Random parts on machines whose travel ends near theirs: what is refused has no plan that the
// machine can wind, and of what is planned some can be.
TEST(BeforePlanning, RefusesNothingThatCanBeWound) {
    std::mt19937_64 engine(3);
    const auto draw = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    };
    int refused = 0;
    int wound = 0;
    for (int i = 0; i < 16; ++i) {
        const double radius_mm = draw(20.0, 58.0);
        const double length_mm = draw(100.0, 200.0);
        const bool cone = i % 2 == 1;
        MakeValues values{{"length", length_mm}, {cone ? "radius1" : "radius", radius_mm}};
        if (cone) {
            values["radius2"] = draw(0.7, 0.95) * radius_mm;
        }
        const char* const machine = i % 4 < 2 ? "four_axis" : "hobby_grbl";
        meshwind::Setup setup =
            make_setup(made(cone ? "cone" : "cylinder", values), shipped(machine), Job{});
        setup.job.mandrel.extension_mm = 150.0;
        setup.job.layers.front().kind = LayerKind::Helical;
        setup.job.layers.front().angle_deg = draw(45.0, 75.0);
        setup.machine.eye_chain[0].min = -0.5 * length_mm - draw(-20.0, 150.0);
        setup.machine.eye_chain[0].max = 0.5 * length_mm + draw(-20.0, 150.0);
        const bool told = !outcome(setup.machine, setup.mandrel, setup.job).code.empty();
        const Plan plan = plan_layer(setup, setup.job.layers.front(), test::AnyMachine()).plan;
        const bool holds = plan.failure.empty() && program_of(setup, plan.pieces).refused.empty();
        EXPECT_FALSE(told && holds) << machine << " R " << radius_mm << " L " << length_mm;
        refused += told ? 1 : 0;
        wound += holds ? 1 : 0;
    }
    EXPECT_GE(refused, 3);
    EXPECT_GE(wound, 3);
}

// Flat fibre comes off a wide cylinder slowly: with less free fibre than is told the machine
// refuses the plan, and with twice as much it winds it.
TEST(BeforePlanning, FlatFibreOnALongCylinderNeedsFreeLength) {
    meshwind::Setup setup = make_setup(made("cylinder", {{"radius", 60.0}, {"length", 500.0}}),
                                       shipped("six_axis"), Job{});
    setup.job.layers.front().kind = LayerKind::Helical;
    setup.job.layers.front().angle_deg = 15.0;
    setup.job.tow.width_mm = 12.0;
    setup.job.mandrel.extension_mm = 500.0;
    setup.job.tow.friction = 0.4;
    // sqrt(R^2 + (L sin 18 deg)^2) = R + 7.5 mm: 5 of clearance, 3.5 of the ring, 1 of slack.
    const double least_mm = 100.1;
    for (const auto& [longest_mm, told] : {std::pair{95.0, true}, {200.0, false}}) {
        setup.machine.fibre.max_free_length_mm = longest_mm;
        setup.job.eye.free_length_mm = longest_mm;
        const meshwind::Setup trial = setup_for(setup, setup.mandrel, 0);
        const Outcome found = outcome(trial.machine, trial.mandrel, trial.job);
        EXPECT_EQ(found.code, told ? "plan.free_length" : "");
        EXPECT_EQ(tells(found.words, fixed(least_mm, 1) + " mm"), told) << found.words;
        const Plan plan = plan_layer(trial, trial.job.layers.front(), test::AnyMachine()).plan;
        ASSERT_EQ(plan.failure, "");
        EXPECT_EQ(program_of(trial, plan.pieces).refused.empty(), !told);
    }
}

TEST(SizeWords, HaveExtentsAlongTheAxesOfTheFileAndTheUnit) {
    EXPECT_EQ(size_words(made("cylinder", {{"radius", 25.0}, {"length", 200.0}})),
              "50.0 x 50.0 x 200.0 mm (unit mm, given)");
    const Mandrel turned =
        made("cylinder", {{"radius", 25.0}, {"length", 200.0}}, 1.0,
             {.axis = MandrelOptions::Axis{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()}});
    EXPECT_EQ(size_words(turned), "50.0 x 50.0 x 200.0 mm (unit mm, assumed)");
    EXPECT_NE(size_words(made("cylinder", {{"radius", 25.0}, {"length", 200.0}}, 1e-3, {}))
                  .find("(unit m, assumed)"),
              std::string::npos);
}

}  // namespace
}  // namespace meshwind
