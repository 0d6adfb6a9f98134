#include "cli/progress.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "cli/phases.h"
#include "core/interrupt.h"

namespace meshwind {
namespace {

// 42 % of which 40 % came in 20 s: 2 % a second, so 58 % take 29 s.
const ProgressState kMidway{"library", 0.42, 0.40, 20.0};

TEST(ProgressBar, HasPhaseShareRateAndTimeLeft) {
    EXPECT_EQ(progress_bar(kMidway, 80), "library [" + std::string(16, '#') + std::string(24, '.') +
                                             "]   42 %  2.0 %/s  0:29 left");
}

TEST(ProgressBar, NeverReachesTheLastColumn) {
    for (const std::string phase : {"a", "library", "layer 12, library of courses"}) {
        for (const double share : {0.0, 0.001, 0.42, 1.0}) {
            for (int columns = 0; columns < 200; ++columns) {
                const std::string bar = progress_bar({phase, share, share, 5000.0}, columns);
                EXPECT_LT(bar.size(), static_cast<std::size_t>(std::max(1, columns)));
            }
        }
    }
}

TEST(ProgressBar, NarrowTerminalsLoseRateThenTimeThenBarThenShare) {
    const auto has = [](int columns, const std::string& part) {
        return progress_bar(kMidway, columns).find(part) != std::string::npos;
    };
    EXPECT_TRUE(has(46, "%/s"));
    EXPECT_FALSE(has(45, "%/s"));
    EXPECT_TRUE(has(45, "left"));
    EXPECT_FALSE(has(30, "left"));
    EXPECT_TRUE(has(30, "["));
    EXPECT_FALSE(has(20, "["));
    EXPECT_TRUE(has(20, "42 %"));
    EXPECT_EQ(progress_bar(kMidway, 8), "library");
    EXPECT_EQ(progress_bar(kMidway, 4), "lib");
    EXPECT_EQ(progress_bar(kMidway, 0), "");
}

TEST(ProgressBar, WithoutAShareShowsTheTimeThatPassed) {
    EXPECT_EQ(progress_bar({"prove", 0.0, 0.0, 0.2}, 24), "prove [...............]");
    EXPECT_EQ(progress_bar({"prove", 0.0, 0.0, 75.0}, 24), "prove [.........]  1:15");
}

TEST(ProgressBar, SharesBeyondTheirRangeAreCut) {
    EXPECT_NE(progress_bar({"prove", 1.7, 0.0, 0.2}, 40).find("100 %"), std::string::npos);
    EXPECT_EQ(progress_bar({"prove", -3.0, 0.0, 0.2}, 24), "prove [...............]");
}

TEST(ProgressTimeLeft, IsThatOfThePhasesRate) {
    EXPECT_DOUBLE_EQ(*time_left_s(kMidway), 29.0);
    EXPECT_FALSE(time_left_s({"a", 0.5, 0.5, 0.9}));     // too soon
    EXPECT_FALSE(time_left_s({"a", 0.5, 0.001, 30.0}));  // too little
    EXPECT_DOUBLE_EQ(*time_left_s({"a", 1.0, 1.0, 30.0}), 0.0);
}

TEST(ProgressLine, NamesThePhaseAndLaterHowFarItIs) {
    EXPECT_EQ(progress_line({"library", 0.0, 0.0, 0.0}), "library ...");
    EXPECT_EQ(progress_line({"route", 0.5, 0.0, 0.0}), "route ...");
    EXPECT_EQ(progress_line(kMidway), "library 42 %, 0:29 left ...");
    EXPECT_EQ(progress_line({"post", 0.0, 0.0, 12.0}), "post, for 0:12 ...");
    EXPECT_EQ(progress_line({"library", 0.02, 0.02, 100.0}), "library 2 %, 1:21:40 left ...");
}

TEST(PhaseText, IsNumberedInPlainWords) {
    EXPECT_EQ(phase_text("import"), "1 of 8: reading the part");
    EXPECT_EQ(phase_text("layer 2, library"), "3 of 8: layer 2, looking for courses");
    EXPECT_EQ(phase_text("cylinder-20"), "cylinder-20");
    for (const char* step :
         {"plan", "route", "prove", "anneal", "post", "verify", "write", "picture"}) {
        EXPECT_NE(phase_text(step), step);
    }
}

TEST(ProgressPhases, CountFromWhereThePhaseBegan) {
    ProgressPhases phases;
    EXPECT_TRUE(phases.report("library", 0.0, 100.0));
    EXPECT_FALSE(phases.report("library", 0.5, 110.0));
    EXPECT_TRUE(phases.report("anneal", 0.2, 120.0));
    EXPECT_FALSE(phases.report("anneal", 0.6, 130.0));
    const ProgressState state = phases.state(131.0);
    EXPECT_EQ(state.phase, "anneal");
    EXPECT_DOUBLE_EQ(state.gained, 0.6 - 0.2);
    EXPECT_DOUBLE_EQ(state.elapsed_s, 11.0);
    EXPECT_TRUE(phases.report("anneal", 0.1, 140.0));  // once more
    EXPECT_DOUBLE_EQ(phases.state(140.0).elapsed_s, 0.0);
}

TEST(Progress, IsACancellationPoint) {
    Progress progress(true);
    request_interrupt(2);
    EXPECT_THROW(progress.show("library", 0.0), Interrupted);
    withdraw_interrupt();
    EXPECT_NO_THROW(progress.show("library", 0.0));
}

}  // namespace
}  // namespace meshwind
