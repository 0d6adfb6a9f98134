#include "winding/cover/lay_out_plan.h"

#include <gtest/gtest.h>

#include "tests/support/course_scene.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

// Nothing stands beside a pipe, so the free fibre of a half turn meets nothing, also where the
// landing point is said to be half way between two stations, under a wall as round as this.
TEST(HalfTurns, AreNotHiddenByTheWallThatTheyLieOn) {
    for (const double radius_mm : {8.0, 12.0, 30.0}) {
        const test::CourseScene scene(
            test::made_cylinder(radius_mm, 8.0 * radius_mm, 0.2 * radius_mm),
            Tow{}.friction.holds());
        FootprintFinder::Scratch scratch = scene.footprints.make_scratch();
        int tried = 0;
        for (const Candidate& candidate : scene.candidates(200, 5, 0.0)) {
            LibraryCourse member;
            if (judge(scene.rules, candidate, scratch, member) != CandidateFault::None) {
                continue;
            }
            std::vector<Piece> pieces{piece_of(scene.rules, member, false)};
            add_half_turns(scene.rules, member, false, pieces);
            ASSERT_EQ(pieces.size(), 3U);
            for (const Piece* turn : {&pieces.front(), &pieces.back()}) {
                for (std::size_t i = 1; i < turn->path.size(); ++i) {
                    const PathPoint& a = turn->path[i - 1];
                    const PathPoint& b = turn->path[i];
                    const Eigen::Vector3d landing = 0.5 * (a.position_mm + b.position_mm);
                    const Eigen::Vector3d tangent = (a.tangent + b.tangent).normalized();
                    const Eigen::Vector3d normal = (a.normal + b.normal).normalized();
                    ASSERT_EQ(unobstructed_mm(scene.obstacles, landing, normal, tangent,
                                              scene.rules.free_fibre),
                              scene.rules.free_fibre.max_mm)
                        << radius_mm << ": " << b.s_mm - a.s_mm << " mm";
                    ++tried;
                }
            }
        }
        EXPECT_GT(tried, 100);
    }
}

// Three courses of one fibre, and a trial that refuses the turn between the first two.
TEST(RefusedCourses, OfATurnIsTheOneAtWhichMoreTurnsAreClosed) {
    const std::size_t library = 10;
    const std::vector<OrderedCourse> order{
        {{10, false}, false}, {{11, true}, false}, {{12, false}, true}};
    Plan plan;
    plan.pieces.resize(5);
    plan.pieces[1].kind = plan.pieces[3].kind = PieceKind::Transition;
    TrialWinding trial;
    trial.refused = {1};
    const auto refused = [&](const ClosedTurns& closed) {
        const auto courses = refused_courses(trial, plan, order, closed, library);
        EXPECT_EQ(courses.size(), 1U);
        return courses.front().first;
    };
    const std::pair<DirectedCourse, DirectedCourse> here{order[0].course, order[1].course};
    EXPECT_EQ(refused({}), 0U);
    EXPECT_EQ(refused({here, {order[0].course, order[2].course}}), 0U);
    EXPECT_EQ(refused({here, {order[2].course, order[1].course}}), 1U);
    // Towards the same course wound the other way no turn is closed.
    EXPECT_EQ(refused({here, {order[2].course, {11, false}}}), 0U);
    trial.refused = {2};
    EXPECT_EQ(refused({here, {order[2].course, order[1].course}}), 1U);
}

}  // namespace
}  // namespace meshwind
