#include "winding/cover/cover.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/mandrel/thicken.h"
#include "tests/support/any_machine.h"
#include "tests/support/fixtures.h"
#include "winding/laminate/build_up.h"
#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kExtension_mm = 120.0;
constexpr double kTable_mm = 60.0;

// The rules of a plan do not depend on how long it is improved.
constexpr double kQuick = 0.2;

CoverOptions quick_options(const Mandrel& mandrel, int candidates) {
    CoverOptions options;
    options.tow.width_mm = 12.0;
    options.tow.friction = 0.25;
    options.turns.rule.extension_mm = kExtension_mm;
    options.free_fibre.min_mm = 40.0;
    options.free_fibre.start_mm = 2.0 * mandrel.surface.mean_edge_mm;
    options.candidates = candidates;
    options.rounds = 1;
    options.aimed_candidates = candidates / 4;
    options.scarce_candidates = candidates / 4;
    options.context.effort = kQuick;
    return options;
}

Plan cover(const Mandrel& mandrel, int candidates, int fibres = 1, double min_free_mm = 40.0,
           const StageAsk* stage = nullptr) {
    CoverOptions options = quick_options(mandrel, candidates);
    options.fibres = fibres;
    options.stage = stage;
    options.free_fibre.min_mm = min_free_mm;
    return plan_cover(mandrel, test::obstacles_of(mandrel, kExtension_mm, kTable_mm), options).plan;
}

const Mandrel& cylinder() {
    static const Mandrel mandrel = test::made_cylinder(30.0, 160.0, 5.0);
    return mandrel;
}

const Mandrel& tee() {
    static const Mandrel mandrel = test::small_tee(3.5);
    return mandrel;
}

// Joints within 0.2 mm and 0.5 degrees: a course ends on a chord of the rim, the turn begins on
// its circle. The sagitta is up to edge^2 / (8 R), here 0.1 mm.
void expect_continuous(const Plan& plan) {
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
        const Piece& piece = plan.pieces[i];
        ASSERT_GE(piece.path.size(), 2U);
        ASSERT_EQ(piece.path.size(), piece.slip.size());
        ASSERT_EQ(piece.path.size(), piece.string.gap_mm.size());
        ASSERT_EQ(piece.path.size(), piece.string.slope.size());
        if (piece.starts_fibre) {
            continue;
        }
        ASSERT_GT(i, 0U);
        const PathPoint& end = plan.pieces[i - 1].path.back();
        const PathPoint& start = piece.path.front();
        EXPECT_LT((start.position_mm - end.position_mm).norm(), 0.2) << "piece " << i;
        EXPECT_GT(start.tangent.dot(end.tangent), std::cos(rad_from_deg(0.5))) << "piece " << i;
        EXPECT_EQ(plan.pieces[i - 1].end_rim, piece.start_rim);
        EXPECT_NE(plan.pieces[i - 1].kind, piece.kind);
    }
}

void expect_books_to_balance(const Mandrel& mandrel, const Plan& plan) {
    int courses = 0;
    int fibres = 0;
    double length = 0.0;
    for (const Piece& piece : plan.pieces) {
        courses += piece.kind == PieceKind::Course ? 1 : 0;
        fibres += piece.starts_fibre ? 1 : 0;
        length += piece.path.back().s_mm;
        EXPECT_LE(piece.worst_slip, 0.25);
        EXPECT_LE(piece.worst_slip, plan.worst_slip);
        EXPECT_LE(piece.string.worst_gap_mm, 0.5);
    }
    EXPECT_EQ(courses, plan.courses);
    EXPECT_EQ(fibres, plan.fibres);
    EXPECT_NEAR(length, plan.fibre_length_mm, 1e-6);
    EXPECT_LE(plan.coverage.fraction, plan.coverage.reachable + 1e-12);
    EXPECT_LE(plan.coverage.mean_layers, plan.coverage.max_layers);
    double bare = 0.0;
    for (const Uncovered& u : plan.uncovered) {
        EXPECT_FALSE(u.reason.empty());
        bare += u.area_mm2;
    }
    const double area = test::wall_area_mm2(mandrel.surface);
    EXPECT_NEAR(bare / area, 1.0 - plan.coverage.fraction, 1e-6);
    ASSERT_EQ(plan.face_layers.size(), mandrel.surface.face.size());
}

TEST(PlanCover, CoversACylinderWithOneFibre) {
    const Plan plan = cover(cylinder(), 2000);
    ASSERT_EQ(plan.failure, "");
    EXPECT_GT(plan.coverage.fraction, 0.97);
    EXPECT_EQ(plan.fibres, 1);
    expect_continuous(plan);
    expect_books_to_balance(cylinder(), plan);
}

TEST(PlanCover, CoversASmallTee) {
    const Plan plan = cover(tee(), 4000);
    ASSERT_EQ(plan.failure, "");
    // 0.77 with this small library: a single fibre gives up what it could not come back from.
    EXPECT_EQ(plan.fibres, 1);
    EXPECT_GT(plan.coverage.fraction, 0.7);
    expect_continuous(plan);
    expect_books_to_balance(tee(), plan);
}

// Where friction turns few courses round on a short extension, pins turn more; no word of pins
// where they are there already.
TEST(PlanCover, SaysWhatTurnsOnPinsWouldReach) {
    constexpr double kShort_mm = 30.0;
    CoverOptions options = quick_options(tee(), 600);
    options.tow.friction = 0.1;
    options.turns.rule.extension_mm = kShort_mm;
    const RayQuery obstacles = test::obstacles_of(tee(), kShort_mm, kTable_mm);
    const auto with_pins = [](const Plan& plan) {
        const auto found = std::find_if(
            plan.what_if.begin(), plan.what_if.end(),
            [](const RelaxedRule& what) { return what.rule == RelaxedRule::Rule::Pins; });
        return found == plan.what_if.end() ? 0.0 : found->reachable;
    };
    const Plan by_friction = plan_cover(tee(), obstacles, options).plan;
    EXPECT_GT(with_pins(by_friction), by_friction.coverage.reachable + 0.05);
    std::string failure;
    options.turns.pins = stand_pins(tee().rims, {}, options.tow, kShort_mm, failure);
    ASSERT_EQ(failure, "");
    const Plan on_pins = plan_cover(tee(), obstacles, options).plan;
    EXPECT_EQ(with_pins(on_pins), 0.0);
    EXPECT_GT(on_pins.coverage.reachable, by_friction.coverage.reachable + 0.05);
}

// With so long a free fibre one that has gone to the branch cannot come back; others may follow it.
constexpr double kLongFree_mm = 120.0;

TEST(PlanCover, CoversMoreOfASmallTeeWithMoreFibres) {
    const Plan one = cover(tee(), 4000, 1, kLongFree_mm);
    const Plan more = cover(tee(), 4000, 4, kLongFree_mm);
    ASSERT_GE(one.reach_of_fibres.size(), 2U);
    EXPECT_EQ(one.reach_of_fibres, more.reach_of_fibres);
    EXPECT_TRUE(std::is_sorted(one.reach_of_fibres.begin(), one.reach_of_fibres.end()));
    EXPECT_GT(more.fibres, 1);
    EXPECT_LE(more.fibres, 4);
    EXPECT_GT(more.coverage.fraction, one.coverage.fraction);
    EXPECT_EQ(fibres_of(more.pieces).size(), static_cast<std::size_t>(more.fibres));
    expect_continuous(more);
    expect_books_to_balance(tee(), more);
}

TEST(PlanCover, IsTheSameForAnyNumberOfThreads) {
    const Mandrel tee = test::small_tee(6.0);
    set_thread_count(1);
    const Plan one = cover(tee, 1500);
    set_thread_count(2);
    const Plan two = cover(tee, 1500);
    set_thread_count(0);
    EXPECT_EQ(one.coverage.fraction, two.coverage.fraction);
    ASSERT_EQ(one.pieces.size(), two.pieces.size());
    for (std::size_t i = 0; i < one.pieces.size(); ++i) {
        ASSERT_EQ(one.pieces[i].path.size(), two.pieces[i].path.size());
        for (std::size_t k = 0; k < one.pieces[i].path.size(); ++k) {
            ASSERT_EQ(one.pieces[i].path[k].position_mm, two.pieces[i].path[k].position_mm);
        }
    }
    EXPECT_EQ(one.face_layers, two.face_layers);
    EXPECT_EQ(one.effort.refusals, two.effort.refusals);
}

TEST(PlanCover, SaysWhyAClosedBodyCannotBeWound) {
    const Mandrel torus = test::made("torus", {{"ring-radius", 60.0}, {"tube-radius", 20.0}}, 8.0);
    ASSERT_TRUE(torus.rims.empty());
    const Plan plan = cover(torus, 100);
    EXPECT_NE(plan.failure, "");
    EXPECT_TRUE(plan.pieces.empty());
}

TEST(PlanCover, SaysWhyNothingIsAdmissible) {
    CoverOptions options;
    options.tow.friction = 0.0;  // nothing can be turned
    options.candidates = 50;
    options.rounds = 0;
    const Plan plan =
        plan_cover(cylinder(), test::obstacles_of(cylinder(), 100.0, kTable_mm), options).plan;
    EXPECT_NE(plan.failure, "");
    const auto refused = [&](CandidateFault reason) {
        return plan.effort.refusals[static_cast<std::size_t>(reason)];
    };
    EXPECT_EQ(refused(CandidateFault::NotTurnable) + refused(CandidateFault::NoRim),
              plan.effort.candidates);
    EXPECT_GT(refused(CandidateFault::NotTurnable), refused(CandidateFault::NoRim));
    EXPECT_TRUE(plan.pieces.empty());
}

TEST(PlanCover, SaysWhenTheMachineRefusesEverything) {
    CoverOptions options;
    options.tow.width_mm = 12.0;
    options.candidates = 200;
    options.rounds = 0;
    test::AnyMachine machine;
    machine.follow_rule = [](std::span<const Piece>) { return CourseFault::AxisTravel; };
    const Plan plan =
        plan_cover(cylinder(), test::obstacles_of(cylinder(), 100.0, kTable_mm), options, &machine)
            .plan;
    const std::string reason = name_of(CourseFault::AxisTravel);
    EXPECT_NE(plan.failure.find(reason), std::string::npos) << plan.failure;
    const auto refused = [&](CourseFault why) {
        return plan.effort.rejections[static_cast<std::size_t>(why)];
    };
    // A few sketches do not hold before the machine is asked.
    EXPECT_EQ(refused(CourseFault::AxisTravel) + refused(CourseFault::Path),
              plan.effort.rejected_courses);
    EXPECT_GT(refused(CourseFault::AxisTravel), 100 * refused(CourseFault::Path));
    EXPECT_TRUE(plan.pieces.empty());
    double bare_mm2 = 0.0;
    for (const Uncovered& u : plan.uncovered) {
        bare_mm2 += u.reason.find(reason) == std::string::npos ? 0.0 : u.area_mm2;
    }
    EXPECT_GT(bare_mm2, 0.0);
}

// How directly a course leaves its rim.
double steepness(const Piece& piece) {
    return std::abs(piece.path.front().tangent.z());
}

CoverOptions few_courses() {
    CoverOptions options;
    options.tow.width_mm = 8.0;
    options.candidates = 1500;
    options.rounds = 1;
    options.aimed_candidates = 500;
    options.scarce_candidates = 500;
    options.context.effort = kQuick;
    return options;
}

Plan cover_cylinder(const CoverOptions& options, const Windability* machine = nullptr) {
    return plan_cover(cylinder(), test::obstacles_of(cylinder(), 100.0, kTable_mm), options,
                      machine)
        .plan;
}

// Steeper than this is a quarter of the courses that are wound when nothing forbids it.
double steep() {
    std::vector<double> all;
    for (const Piece& piece : cover_cylinder(few_courses()).pieces) {
        if (piece.kind == PieceKind::Course) {
            all.push_back(steepness(piece));
        }
    }
    std::sort(all.begin(), all.end());
    return all[all.size() * 3 / 4];
}

void expect_no_course_steeper(const Plan& plan, double limit, CourseFault reason) {
    ASSERT_EQ(plan.failure, "");
    EXPECT_GT(plan.effort.rejections[static_cast<std::size_t>(reason)], 0);
    EXPECT_GT(plan.coverage.fraction, 0.9);
    for (const Piece& piece : plan.pieces) {
        if (piece.kind == PieceKind::Course) {
            EXPECT_LE(steepness(piece), limit);
        }
    }
}

// Before anything is chosen, and when what was chosen is not laid as planned by its own program.
TEST(PlanCover, IsGivenUpWhereItCannotCoverEnough) {
    CoverOptions options = few_courses();
    options.least_covered = 0.5;
    test::AnyMachine machine;
    machine.alone_rule = [](std::span<const Piece>) { return CourseFault::Laydown; };
    const Plan lost = cover_cylinder(options, &machine);
    EXPECT_NE(lost.failure.find("courses cover only"), std::string::npos) << lost.failure;
    EXPECT_LT(lost.coverage.fraction, 0.5);
    EXPECT_GT(lost.coverage.reachable, 0.9);
    EXPECT_TRUE(lost.pieces.empty());
    options.least_covered = 1.1;
    const Plan none = cover_cylinder(options);
    EXPECT_NE(none.failure.find("can join reach only"), std::string::npos) << none.failure;
    EXPECT_EQ(none.effort.proposals, 0);
    EXPECT_GT(none.coverage.fraction, 0.9);
}

TEST(PlanCover, KeepsOnlyCoursesWhoseOwnProgramHolds) {
    const double limit = steep();
    test::AnyMachine machine;
    machine.alone_rule = [limit](std::span<const Piece> pieces) {
        const bool steep = std::any_of(pieces.begin(), pieces.end(), [&](const Piece& piece) {
            return piece.kind == PieceKind::Course && steepness(piece) > limit;
        });
        return steep ? CourseFault::Laydown : CourseFault::None;
    };
    expect_no_course_steeper(cover_cylinder(few_courses(), &machine), limit, CourseFault::Laydown);
}

// Others that are as steep come in their place: replacing them has no end, leaving them out has.
TEST(PlanCover, LeavesOutWhatIsRefusedAgainAndAgain) {
    const double limit = steep();
    test::AnyMachine machine;
    machine.refused_rule = [limit](std::span<const Piece> pieces) {
        std::vector<std::size_t> refused;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (pieces[i].kind == PieceKind::Course && steepness(pieces[i]) > limit) {
                refused.push_back(i);
            }
        }
        return refused;
    };
    expect_no_course_steeper(cover_cylinder(few_courses(), &machine), limit,
                             CourseFault::InItsPlace);
}

// By where it leaves and arrives.
using TurnPlaces = std::array<double, 6>;

TurnPlaces places_of_turn(const Piece& from, const Piece& to) {
    const Vector3d& a = from.path.back().position_mm;
    const Vector3d& b = to.path.front().position_mm;
    return {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
}

// Courses come in another order, and none is lost.
TEST(PlanCover, TakesNoTurnThatTheMachineCannotFollow) {
    const auto turns_of = [](const Plan& plan) {
        std::vector<TurnPlaces> turns;
        for (std::size_t i = 0; i + 2 < plan.pieces.size(); ++i) {
            if (plan.pieces[i + 1].kind == PieceKind::Transition) {
                turns.push_back(places_of_turn(plan.pieces[i], plan.pieces[i + 2]));
            }
        }
        return turns;
    };
    const Plan any = cover_cylinder(few_courses());
    const std::vector<TurnPlaces> turns = turns_of(any);
    const std::set<TurnPlaces> shut(turns.begin(), turns.end());
    EXPECT_GT(shut.size(), 3U);
    std::atomic<int> refused = 0;
    test::AnyMachine machine;
    machine.follow_rule = [&](std::span<const Piece> pieces) {
        const bool turn = pieces.size() == 3 && pieces[1].kind == PieceKind::Transition;
        if (!turn || shut.count(places_of_turn(pieces[0], pieces[2])) == 0) {
            return CourseFault::None;
        }
        ++refused;
        return CourseFault::FreeLength;
    };
    const Plan plan = cover_cylinder(few_courses(), &machine);
    EXPECT_GE(refused, static_cast<int>(shut.size()));
    for (const TurnPlaces& turn : turns_of(plan)) {
        EXPECT_EQ(shut.count(turn), 0U);
    }
    EXPECT_EQ(plan.courses, any.courses);
    EXPECT_EQ(plan.fibres, 1);
    expect_continuous(plan);
}

// Behind three of its courses no other can be wound. One fibre may end there, and needs two such
// turns; three fibres need none.
TEST(PlanCover, CutsFibresWhereNoTurnCanBeFollowed) {
    using Place = std::array<double, 3>;
    const auto end_of_course = [](const Piece& course) {
        const Vector3d& p = course.path.back().position_mm;
        return Place{p.x(), p.y(), p.z()};
    };
    CoverOptions options = few_courses();
    options.tow.width_mm = 15.0;
    for (const int fibres : {1, 3}) {
        options.fibres = fibres;
        std::set<Place> shut;
        const Plan any = cover_cylinder(options);
        ASSERT_EQ(any.fibres, 1) << "else they end where they need not be cut";
        for (std::size_t i = 0; i + 2 < any.pieces.size() && shut.size() < 3; ++i) {
            if (any.pieces[i + 1].kind == PieceKind::Transition) {
                shut.insert(end_of_course(any.pieces[i]));
            }
        }
        ASSERT_EQ(shut.size(), 3U);
        test::AnyMachine machine;
        machine.follow_rule = [&](std::span<const Piece> pieces) {
            const bool turn = pieces.size() == 3 && pieces[1].kind == PieceKind::Transition;
            return turn && shut.count(end_of_course(pieces[0])) != 0 ? CourseFault::FreeLength
                                                                     : CourseFault::None;
        };
        const Plan plan = cover_cylinder(options, &machine);
        EXPECT_EQ(plan.courses, any.courses);
        EXPECT_EQ(plan.fibres, fibres);
        int refused = 0;
        for (std::size_t i = 0; i + 1 < plan.pieces.size(); ++i) {
            const bool turn = plan.pieces[i + 1].kind == PieceKind::Transition;
            refused += turn && shut.count(end_of_course(plan.pieces[i])) != 0 ? 1 : 0;
        }
        EXPECT_EQ(plan.effort.turns_refused, refused);
        EXPECT_EQ(refused, 3 - fibres);
    }
}

// Behind courses that end in a third of a rim no other can be wound. The first plan has such ends;
// courses put in their place do not.
TEST(PlanCover, ReplacesCoursesByThoseThatCanBeTurned) {
    const auto ends_in_sector = [](const Piece& course) {
        const Vector3d& p = course.path.back().position_mm;
        return p.z() > 0.0 && std::abs(std::atan2(p.y(), p.x())) < std::numbers::pi / 3.0;
    };
    const auto is_shut = [&](std::span<const Piece> pieces, std::size_t turn) {
        return pieces[turn].kind == PieceKind::Transition && ends_in_sector(pieces[turn - 1]);
    };
    std::vector<std::size_t> refused_at;  // per trial
    test::AnyMachine machine;
    machine.follow_rule = [&](std::span<const Piece> pieces) {
        const bool whole = pieces.size() == 3 && pieces[0].kind == PieceKind::Course;
        return whole && is_shut(pieces, 1) ? CourseFault::FreeLength : CourseFault::None;
    };
    machine.refused_rule = [&](std::span<const Piece> pieces) {
        std::vector<std::size_t> refused;
        for (std::size_t i = 1; i < pieces.size(); ++i) {
            if (is_shut(pieces, i)) {
                refused.push_back(i);
            }
        }
        refused_at.push_back(refused.size());
        return refused;
    };
    const Plan plan = cover_cylinder(few_courses(), &machine);
    EXPECT_EQ(plan.failure, "");
    ASSERT_EQ(refused_at.size(), 2U);
    EXPECT_GT(refused_at[0], 0U) << "else nothing is replaced";
    EXPECT_EQ(refused_at[1], 0U);
    EXPECT_GT(plan.coverage.fraction, 0.9);
    expect_continuous(plan);
}

// Whatever is put in their place, courses are refused: the plan with the fewest of them stands.
TEST(PlanCover, EndsWhereEveryPlanIsRefused) {
    int asked = 0;
    test::AnyMachine machine;
    machine.refused_rule = [&asked](std::span<const Piece> pieces) {
        // Other courses each time, and as many but for the third.
        std::vector<std::size_t> refused;
        const std::size_t many = ++asked == 3 ? 1 : 5;
        for (std::size_t i = 0; i < pieces.size() && refused.size() < many; ++i) {
            if (pieces[i].kind == PieceKind::Course) {
                refused.push_back(i);
            }
        }
        return refused;
    };
    const Plan plan = cover_cylinder(few_courses(), &machine);
    EXPECT_EQ(asked, kMaxAttempts);
    EXPECT_EQ(plan.failure, "");
    // Of the library's members, of which a plan may lay one twice.
    const auto rejected = plan.effort.rejections[static_cast<std::size_t>(CourseFault::InItsPlace)];
    EXPECT_LE(rejected, 5 * (kMaxAttempts - 1) + 1);
    EXPECT_GT(rejected, 3 * (kMaxAttempts - 1));
    EXPECT_GT(plan.coverage.fraction, 0.9);
    expect_continuous(plan);
}

// On what a cover has left, rims and all, the next one joins and covers as well, within what plans
// of one mandrel differ by.
TEST(PlanCover, CoversASecondTime) {
    constexpr double kEdge_mm = 4.0;
    const Mandrel pipe = test::made_cylinder(30.0, 160.0, kEdge_mm);
    const Plan first = cover(pipe, 2000);
    ASSERT_EQ(first.failure, "");
    const auto thickness = build_up_mm(pipe.surface, first.face_layers, 12.0, 0.5);
    const auto [least, most] = std::minmax_element(thickness.begin(), thickness.end());
    EXPECT_GT(*most - *least, 0.1);  // a fifth of a ply
    const Mandrel grown = thicken(pipe, thickness);
    const Plan second = cover(grown, 2000);
    ASSERT_EQ(second.failure, "");
    EXPECT_EQ(second.fibres, 1);
    EXPECT_GT(second.coverage.fraction, first.coverage.fraction - 0.02);
    EXPECT_LT(second.worst_joint_mm, kEdge_mm * kEdge_mm / (8.0 * 30.0));  // the sagitta
    expect_continuous(second);
    expect_books_to_balance(grown, second);
}

// The branch of the small tee leaves its run of 30 mm along x.
bool on_branch(const Eigen::Vector3d& position_mm) {
    return position_mm.x() > 45.0;
}

// A stage that asks for two layers on the branch or on the run, and for none elsewhere.
StageAsk ask_of_tee(bool branch) {
    const auto asked = [&](Stream stream) {
        AskedPlaces places;
        const CoverageSamples samples = plan_samples(tee().surface, 12.0, 1, stream);
        places.at = samples.at;
        for (const Eigen::Vector3d& position : samples.position_mm) {
            places.layers.push_back(on_branch(position) == branch ? 2 : 0);
        }
        return places;
    };
    StageAsk ask;
    ask.measured = asked(Stream::Sampling);
    ask.weighed = asked(Stream::Ground);
    ask.left = ask.measured.layers;
    return ask;
}

// Layers on the branch over those on the run, by the middles of the triangles.
double branch_over_run(const Plan& plan) {
    std::array<double, 2> layers{};
    std::array<double, 2> wall_mm2{};
    const Surface& surface = tee().surface;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const SurfacePoint middle{.face = static_cast<std::int32_t>(f)};
        const std::size_t where = on_branch(position_mm(surface, middle)) ? 1 : 0;
        const double mm2 = area_mm2(surface.position_mm, surface.face[f]);
        wall_mm2[where] += mm2;
        layers[where] += mm2 * plan.face_layers[f];
    }
    return layers[1] / wall_mm2[1] / (layers[0] / wall_mm2[0]);
}

// Fibre goes where layers lack. Courses to the branch cross the run, so not all of it can.
TEST(PlanCover, AStageLaysFibreWhereItIsAsked) {
    const StageAsk for_branch = ask_of_tee(true);
    const StageAsk for_run = ask_of_tee(false);
    const Plan branch = cover(tee(), 4000, 1, 40.0, &for_branch);
    const Plan run = cover(tee(), 4000, 1, 40.0, &for_run);
    ASSERT_EQ(branch.failure, "");
    ASSERT_EQ(run.failure, "");
    EXPECT_GT(branch_over_run(branch), 1.5 * branch_over_run(run));
    for (const Plan* plan : {&branch, &run}) {
        EXPECT_EQ(plan->reached.size(), for_run.measured.at.size());
        ASSERT_TRUE(plan->least_fibre_mm.has_value());
        EXPECT_GT(*plan->least_fibre_mm, 0.0);
        EXPECT_LT(*plan->least_fibre_mm, plan->fibre_length_mm);
    }
}

// A cylinder that goes over into a cone at a sharp convex edge and back at a sharp concave one:
// courses that run over the edges are geodesics there and hold.
TEST(PlanCover, CoversAReducerWithSharpEdges) {
    constexpr int kAround = 60;
    constexpr std::array<std::array<double, 2>, 4> kProfile{
        {{22.0, 0.0}, {22.0, 60.0}, {14.0, 68.0}, {14.0, 120.0}}};
    TriangleSoup soup;
    std::vector<std::array<double, 2>> rings;
    for (std::size_t k = 0; k + 1 < kProfile.size(); ++k) {
        const auto [r0, z0] = kProfile[k];
        const auto [r1, z1] = kProfile[k + 1];
        const int steps = static_cast<int>(std::ceil(std::hypot(r1 - r0, z1 - z0) / 2.5));
        for (int i = 0; i < steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            rings.push_back({r0 + share * (r1 - r0), z0 + share * (z1 - z0)});
        }
    }
    rings.push_back(kProfile.back());
    for (const auto& [radius, z] : rings) {
        for (int j = 0; j < kAround; ++j) {
            const double angle = 2.0 * kPi * j / kAround;
            soup.points_mm.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
        }
    }
    for (std::int32_t i = 0; i + 1 < static_cast<std::int32_t>(rings.size()); ++i) {
        for (std::int32_t j = 0; j < kAround; ++j) {
            const std::int32_t a = i * kAround + j;
            const std::int32_t b = i * kAround + (j + 1) % kAround;
            soup.faces.push_back({a, b, b + kAround});
            soup.faces.push_back({a, b + kAround, a + kAround});
        }
    }
    const Mandrel mandrel = build_mandrel(soup, "reducer", {.unit_mm = 1.0});
    ASSERT_EQ(mandrel.rims.size(), 2U);
    const Plan plan = cover(mandrel, 3000);
    ASSERT_EQ(plan.failure, "");
    EXPECT_EQ(plan.fibres, 1);
    EXPECT_GT(plan.coverage.fraction, 0.9);
    EXPECT_TRUE(std::any_of(plan.pieces.begin(), plan.pieces.end(), [](const Piece& piece) {
        return piece.kind == PieceKind::Course && piece.start_rim != piece.end_rim;
    }));
    expect_continuous(plan);
    expect_books_to_balance(mandrel, plan);
}

}  // namespace
}  // namespace meshwind
