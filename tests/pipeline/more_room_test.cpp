// What a job is loosened by follows from what the plan says, and from what the job leaves open.
#include "pipeline/trials/more_room.h"

#include <gtest/gtest.h>

namespace meshwind {
namespace {

Plan plan_that_reaches(std::vector<double> of_fibres, double with_longer_extensions) {
    Plan plan;
    plan.coverage.reachable = 0.9;
    plan.reach_of_fibres = std::move(of_fibres);
    plan.what_if = {{RelaxedRule::Rule::Friction, 1.5, 0.99},
                    {RelaxedRule::Rule::Extension, 1.5, with_longer_extensions}};
    return plan;
}

TEST(MoreRoom, IsAsManyFibresAsReachMore) {
    const auto more = more_room(Job(), plan_that_reaches({0.6, 0.7, 0.855, 0.86}, 0.9));
    ASSERT_TRUE(more);
    EXPECT_EQ(more->fibres, 3);
    EXPECT_EQ(more->mandrel.extension_mm, Job().mandrel.extension_mm);
    EXPECT_FALSE(more_room(*more, plan_that_reaches({0.6, 0.7, 0.855, 0.86}, 0.9)));
}

TEST(MoreRoom, IsLongerExtensionsWhereTheyReachMore) {
    const auto more = more_room(Job(), plan_that_reaches({0.9}, 0.92));
    ASSERT_TRUE(more);
    EXPECT_EQ(more->fibres, 1);
    EXPECT_EQ(more->mandrel.extension_mm, 1.5 * Job().mandrel.extension_mm);
    EXPECT_FALSE(more_room(Job(), plan_that_reaches({0.9}, 0.905)));
    EXPECT_FALSE(more_room(Job(), plan_that_reaches({}, 0.9)));
}

// What covers and yet fails has turns that do not hold; what nearly covers lacks courses.
TEST(MoreRoom, IsFibresToSpareWhereThePlanNearlyCovers) {
    Plan plan = plan_that_reaches({0.9, 0.9}, 0.9);
    EXPECT_FALSE(more_room(Job(), plan)) << "nothing is covered";
    plan.coverage.fraction = 0.89;
    const auto more = more_room(Job(), plan);
    ASSERT_TRUE(more);
    EXPECT_EQ(more->fibres, 2);
    EXPECT_FALSE(more_room(*more, plan)) << "it is tried once";
    plan.effort.turns_refused = 3;
    EXPECT_EQ(more_room(Job(), plan)->fibres, 4) << "one for each turn";
    plan.effort.turns_refused = 40;
    EXPECT_EQ(more_room(Job(), plan)->fibres, 5) << "each stops the machine";
    Job many;
    many.fibres = 7;
    plan.reach_of_fibres = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.9};
    EXPECT_EQ(more_room(many, plan)->fibres, kMaxFibres);
    plan.reach_of_fibres = {0.9, 0.9};
    plan.effort.turns_refused = 0;
    EXPECT_FALSE(more_room(parse_job(R"({"fibres": 1})", "job"), plan));
    plan.coverage.fraction = 0.75;  // 0.81 is asked for
    EXPECT_FALSE(more_room(Job(), plan));
    plan.coverage.fraction = 0.78;
    plan.failure = "too bare to be wound";
    EXPECT_TRUE(more_room(Job(), plan));
}

// A plan that stands has them where it cannot join what it reaches.
TEST(MoreFibres, AreThoseThatJoinMore) {
    Plan plan = plan_that_reaches({0.6, 0.7, 0.855, 0.86}, 0.9);
    EXPECT_FALSE(more_fibres(Job(), plan)) << "no cover";
    plan.coverage.joinable = 0.895;
    EXPECT_FALSE(more_fibres(Job(), plan)) << "it joins what is in reach";
    plan.coverage.joinable = 0.6;
    ASSERT_TRUE(more_fibres(Job(), plan));
    EXPECT_EQ(more_fibres(Job(), plan)->fibres, 3);
    EXPECT_FALSE(more_fibres(parse_job(R"({"fibres": 1})", "job"), plan));
    Job enough;
    enough.fibres = 3;
    EXPECT_FALSE(more_fibres(enough, plan));
}

TEST(MoreRoom, LeavesWhatTheJobGives) {
    const Plan plan = plan_that_reaches({0.6, 0.9}, 0.95);
    const Job all = parse_job(R"({"fibres": 1, "mandrel": {"extension": 100}})", "job");
    EXPECT_FALSE(more_room(all, plan));
    const Job fibres = parse_job(R"({"fibres": 1})", "job");
    ASSERT_TRUE(more_room(fibres, plan));
    EXPECT_EQ(more_room(fibres, plan)->fibres, 1);
    const Job extension = parse_job(R"({"mandrel": {"extension": 100}})", "job");
    ASSERT_TRUE(more_room(extension, plan));
    EXPECT_EQ(more_room(extension, plan)->mandrel.extension_mm, 100.0);
}

}  // namespace
}  // namespace meshwind
