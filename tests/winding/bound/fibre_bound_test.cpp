// The least fibre of small libraries, known by hand.
#include "winding/bound/fibre_bound.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/random.h"

namespace meshwind {
namespace {

// The bound stops within this share of what is found.
constexpr double kNear = 0.011;

// From rim `from` to rim `to`, which it circles the same way on arrival as on departure there.
LibraryCourse course(std::int32_t first, std::int32_t last, double length_mm, std::int32_t from = 0,
                     std::int32_t to = 1) {
    LibraryCourse member;
    member.length_mm = length_mm;
    member.windable_forward = true;
    member.end[0].rim = from;
    member.end[0].sense = -1;
    member.end[1].rim = to;
    member.end[1].sense = 1;
    for (std::int32_t i = first; i <= last; ++i) {
        member.footprint.push_back(i);
    }
    return member;
}

struct Problem {
    std::vector<LibraryCourse> members;
    std::vector<char> allowed = std::vector<char>(members.size(), 1);
    std::vector<std::int32_t> asked = std::vector<std::int32_t>(10, 1);
    std::vector<char> reached = std::vector<char>(asked.size(), 1);
    double most_below = 0.0;

    [[nodiscard]] FibreBound bound() const {
        return bound_fibre({members, allowed, asked, reached, {}, 4, most_below});
    }
};

double times_laid(const FibreBound& bound, std::size_t i) {
    return bound.forward[i] + bound.backward[i];
}

// Three courses of 100 mm that each cover two thirds: each one half is enough.
TEST(FibreBound, TakesCoursesInFractions) {
    Problem problem{{course(0, 5, 100.0), course(3, 8, 100.0), course(6, 8, 100.0)}};
    problem.members[2].footprint = {0, 1, 2, 6, 7, 8};
    for (LibraryCourse& member : problem.members) {
        member.end[1] = member.end[0];
        member.end[1].sense = 1;  // back to where it came from
    }
    problem.asked.assign(9, 1);
    problem.reached.assign(9, 1);
    const FibreBound bound = problem.bound();
    EXPECT_NEAR(bound.solved_mm, 150.0, kNear * 150.0);
    EXPECT_LE(bound.least_mm, bound.solved_mm * (1.0 + 1e-9));
    EXPECT_GE(bound.least_mm, bound.solved_mm * (1.0 - kNear));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(times_laid(bound, i), 0.5, 0.01);
    }
}

// Fibre that is led to the second rim has to come back: a course that covers nothing is laid too.
TEST(FibreBound, LeadsAsMuchFibreToANodeAsAwayFromIt) {
    Problem problem{{course(0, 9, 100.0), course(0, -1, 70.0)}};
    std::swap(problem.members[1].end[0].rim, problem.members[1].end[1].rim);
    ASSERT_EQ(nodes_of(problem.members[0], false).second,
              nodes_of(problem.members[1], false).first);
    const FibreBound bound = problem.bound();
    EXPECT_NEAR(bound.least_mm, 170.0, kNear * 170.0);
    EXPECT_NEAR(times_laid(bound, 1), 1.0, 0.01);
}

// One sample in ten is dear: it may lack where a tenth of the layers may.
TEST(FibreBound, LeavesOutWhatMayLack) {
    Problem problem{{course(0, 8, 100.0, 0, 0), course(9, 9, 500.0, 0, 0)}};
    EXPECT_NEAR(problem.bound().least_mm, 600.0, kNear * 600.0);
    problem.most_below = 0.1;
    const FibreBound bound = problem.bound();
    EXPECT_NEAR(bound.least_mm, 100.0, kNear * 100.0);
    problem.most_below = 0.05;  // half a layer of the dear sample
    EXPECT_NEAR(problem.bound().least_mm, 350.0, kNear * 350.0);
}

TEST(FibreBound, AsksNothingOfPlacesOutOfReachAndTakesOnlyWhatIsAllowed) {
    Problem problem{{course(0, 8, 100.0, 0, 0), course(0, 8, 40.0, 0, 0)}};
    problem.reached.back() = 0;
    problem.allowed[1] = 0;
    EXPECT_NEAR(problem.bound().least_mm, 100.0, kNear * 100.0);
    problem.allowed[1] = 1;
    EXPECT_NEAR(problem.bound().least_mm, 40.0, kNear * 40.0);
}

// As behind stages that piled up all that was asked for: no course, not a crash.
TEST(FibreBound, IsNothingWhereNothingIsAskedFor) {
    Problem problem{{course(0, 9, 100.0), course(0, 9, 90.0)}};
    problem.asked.assign(10, 0);
    const FibreBound bound = problem.bound();
    EXPECT_EQ(bound.least_mm, 0.0);
    EXPECT_EQ(times_laid(bound, 0) + times_laid(bound, 1), 0.0);
    EXPECT_TRUE(whole_courses(bound, problem.members, 1.0).empty());
}

// Twice the layers take twice the fibre, and turns count.
TEST(FibreBound, GrowsWithTheLayers) {
    Problem problem{{course(0, 5, 90.0, 0, 0), course(4, 9, 90.0, 0, 0)}};
    problem.members[0].turn_mm = 10.0;
    problem.members[1].turn_mm = 10.0;
    EXPECT_NEAR(problem.bound().least_mm, 200.0, kNear * 200.0);
    EXPECT_NEAR(problem.bound().turns_mm, 20.0, 1e-6);
    problem.asked.assign(10, 3);
    EXPECT_NEAR(problem.bound().least_mm, 600.0, kNear * 600.0);
}

// No choice of whole courses that covers all takes less: looked for at random.
TEST(FibreBound, IsNoMoreThanAnyCoverTakes) {
    constexpr std::uint64_t kSeed = 5;
    Problem problem;
    for (std::uint64_t k = 0; k < 60; ++k) {
        LibraryCourse& member = problem.members.emplace_back(course(0, -1, 0.0, 0, 0));
        member.length_mm = 50.0 + 100.0 * random_unit(kSeed, 3 * k);
        const auto first = static_cast<std::int32_t>(random_bits(kSeed, 3 * k + 1) % 36);
        for (std::int32_t i = first; i < first + 5; ++i) {
            member.footprint.push_back(i);
        }
    }
    problem.allowed.assign(problem.members.size(), 1);
    problem.asked.assign(40, 0);
    problem.reached.assign(40, 1);
    for (const LibraryCourse& member : problem.members) {
        for (const std::int32_t sample : member.footprint) {
            problem.asked[static_cast<std::size_t>(sample)] = 2;
        }
    }
    const double least_mm = problem.bound().least_mm;
    EXPECT_GT(least_mm, 0.0);
    for (std::uint64_t trial = 0; trial < 500; ++trial) {
        std::vector<std::int32_t> lacks = problem.asked;
        double fibre_mm = 0.0;
        for (std::uint64_t draw = 0;
             std::any_of(lacks.begin(), lacks.end(), [](std::int32_t l) { return l > 0; });
             ++draw) {
            const LibraryCourse& member =
                problem.members[random_bits(kSeed + 1, trial * 100'000 + draw) % 60];
            const auto gain = std::count_if(
                member.footprint.begin(), member.footprint.end(),
                [&](std::int32_t i) { return lacks[static_cast<std::size_t>(i)] > 0; });
            if (gain > static_cast<std::ptrdiff_t>(draw < 500 ? 3 : 0)) {
                fibre_mm += member.length_mm;
                for (const std::int32_t i : member.footprint) {
                    --lacks[static_cast<std::size_t>(i)];
                }
            }
        }
        EXPECT_LE(least_mm, fibre_mm);
    }
}

// Beside courses that cover 50 neighbours of 4000 each there are some that cover the 50 samples,
// ten apart, that stand for all where rows are samples: then 8 of them seem to be enough. By cells
// any cover takes 80.
TEST(FibreBound, CountsSamplesBetweenThoseOfTheRows) {
    Problem problem;
    std::vector<Eigen::Vector3d> position_mm;
    for (std::int32_t i = 0; i < 4000; ++i) {
        position_mm.emplace_back(0.5 * i, 0.0, 0.0);
    }
    for (std::int32_t first = 0; first < 4000; first += 50) {
        problem.members.push_back(course(first, first + 49, 100.0, 0, 0));
    }
    for (std::int32_t first = 0; first < 4000; first += 500) {
        LibraryCourse& member = problem.members.emplace_back(course(0, -1, 100.0, 0, 0));
        for (std::int32_t i = first; i < first + 500; i += 10) {
            member.footprint.push_back(i);
        }
    }
    problem.allowed.assign(problem.members.size(), 1);
    problem.asked.assign(position_mm.size(), 1);
    problem.reached.assign(position_mm.size(), 1);
    BoundTask task{problem.members, problem.allowed, problem.asked, problem.reached, {}, 4};
    EXPECT_LT(bound_fibre(task).least_mm, 10.0 * 100.0);
    task.position_mm = position_mm;
    EXPECT_GE(bound_fibre(task).least_mm, (1.0 - kNear) * 80.0 * 100.0);
}

TEST(FibreBound, GoesOnWithoutWhatDoesNotHold) {
    const Problem problem{{course(0, 9, 100.0, 0, 0), course(0, 9, 130.0, 0, 0)}};
    FibreBoundFinder finder(
        {problem.members, problem.allowed, problem.asked, problem.reached, {}, 4});
    EXPECT_NEAR(finder.find().least_mm, 100.0, kNear * 100.0);
    finder.strike_off(0);
    const FibreBound bound = finder.find();
    EXPECT_NEAR(bound.least_mm, 130.0, kNear * 130.0);
    EXPECT_EQ(times_laid(bound, 0), 0.0);
    EXPECT_NEAR(times_laid(bound, 1), 1.0, 0.01);
}

TEST(FibreBound, RoundsToWholeCoursesByTheirSum) {
    const std::vector<LibraryCourse> members(4, course(0, 1, 100.0, 0, 0));
    FibreBound bound;
    bound.forward = {0.3, 0.3, 0.0, 2.0};
    bound.backward = {0.0, 0.3, 0.28, 0.0};
    // Those laid backward first: sums of 0.8, 1.08, 0.38, 0.68 and 2.68, from 0.5.
    const std::vector<DirectedCourse> all{{2, true}, {3, false}, {3, false}};
    EXPECT_EQ(whole_courses(bound, members, 1.0), all);
    EXPECT_EQ(whole_courses(bound, members, 0.0), std::vector<DirectedCourse>{});
    EXPECT_EQ(whole_courses(bound, members, 10.0).size(), 32U);
}

// By angle, then around the rim.
TEST(FibreBound, RoundsLikeCoursesTogether) {
    std::vector<LibraryCourse> members(4, course(0, 1, 100.0, 0, 0));
    members[0].end[0].angle_rad = 1.0;
    members[1].end[0].azimuth_rad = 2.0;
    members[2].end[0].azimuth_rad = 1.0;
    members[3].end[0].azimuth_rad = 3.0;
    FibreBound bound;
    bound.forward = {0.4, 0.4, 0.4, 0.4};
    bound.backward.assign(4, 0.0);
    // Members 2, 1, 3 and 0; from 0.5, sums of 0.9, 1.3, 0.7 and 1.1.
    const std::vector<DirectedCourse> half{{1, false}, {0, false}};
    EXPECT_EQ(whole_courses(bound, members, 1.0), half);
}

}  // namespace
}  // namespace meshwind
