// How the head twists the band on its way to the wall, and what a job may ask of that.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/wind.h"
#include "tests/support/run_checks.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

TEST(Twist, JobMayLimitItForATape) {
    Job job = test::pipe_job();
    const meshwind::Run head = wind(test::small_pipe(), test::shipped("six_axis"), job);
    const meshwind::Run still = wind(test::small_pipe(), test::shipped("hobby_grbl"), job);
    const double by_head = test::check_of(head, "roller").numbers.at("twist_per_m");
    const double by_still = test::check_of(still, "roller").numbers.at("twist_per_m");
    EXPECT_EQ(test::failed_checks(head), std::vector<std::string>{});
    EXPECT_EQ(test::failed_checks(still), std::vector<std::string>{});
    EXPECT_LT(10.0 * by_head, by_still);  // its roller does not keep to the band
    job.tow.most_twist_per_m = 0.5 * (by_head + by_still);
    EXPECT_TRUE(wind(test::small_pipe(), test::shipped("six_axis"), job).usable);
    const meshwind::Run tape = wind(test::small_pipe(), test::shipped("hobby_grbl"), job);
    EXPECT_EQ(test::failed_checks(tape), std::vector<std::string>{"roller"});
    EXPECT_FALSE(tape.usable);
}

}  // namespace
}  // namespace meshwind
