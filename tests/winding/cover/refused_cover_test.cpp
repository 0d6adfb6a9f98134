// Covers of which the machine refuses courses, turns or whole plans.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/any_machine.h"
#include "tests/support/cover_plans.h"
#include "winding/cover/cover.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

TEST(PlanCover, SaysWhenTheMachineRefusesEverything) {
    CoverOptions options;
    options.tow.width_mm = 12.0;
    options.candidates = 200;
    options.rounds = 0;
    test::AnyMachine machine;
    machine.follow_rule = [](std::span<const Piece>) { return CourseFault::AxisTravel; };
    const Plan plan = plan_cover(test::wound_cylinder(),
                                 test::obstacles_of(test::wound_cylinder(), 100.0, test::kTable_mm),
                                 options, &machine)
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
    options.context.effort = test::kQuickEffort;
    return options;
}

Plan cover_cylinder(const CoverOptions& options, const Windability* machine = nullptr) {
    return plan_cover(test::wound_cylinder(),
                      test::obstacles_of(test::wound_cylinder(), 100.0, test::kTable_mm), options,
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
    test::expect_continuous(plan);
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
    test::expect_continuous(plan);
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
    test::expect_continuous(plan);
}

}  // namespace
}  // namespace meshwind
