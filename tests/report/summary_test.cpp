#include "report/summary.h"

#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "machines/machine_json.h"
#include "postproc/verify/check.h"

namespace meshwind {
namespace {

constexpr const char* kSixAxis = "six_axis.json";

// A plan that was wound on a machine, by motions of least time or not, one per fibre.
std::string summary(const std::string& machine, RedundancyRule redundancy,
                    const std::vector<bool>& least_time) {
    Run run;
    WoundLayer& layer = run.layers.emplace_back();
    layer.setup.machine = read_machine(MESHWIND_SOURCE_DIR "/machines/" + machine);
    layer.setup.job.redundancy = redundancy;
    layer.setup.mandrel.whole.points_mm = {{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
    for (const bool optimal : least_time) {
        layer.programs.emplace_back().made.optimal = optimal;
    }
    std::ostringstream out;
    print_summary(out, run, "out", Detail::Brief);
    return out.str();
}

bool tells(const std::string& summary, const std::string& words) {
    return summary.find(words) != std::string::npos;
}

TEST(Summary, TellsThatTheMotionIsNotOfLeastTime) {
    EXPECT_TRUE(tells(summary(kSixAxis, RedundancyRule::Optimal, {false}), "\n  motion: "));
    EXPECT_FALSE(tells(summary(kSixAxis, RedundancyRule::Optimal, {true}), "motion"));
}

TEST(Summary, NamesTheFibreWhoseMotionIsNotOfLeastTime) {
    const std::string text = summary(kSixAxis, RedundancyRule::Optimal, {true, false});
    EXPECT_FALSE(tells(text, "fibre 1"));
    EXPECT_TRUE(tells(text, "\n  motion of fibre 2: "));
}

TEST(Summary, SaysNothingOfAMotionThatWasNotAskedFor) {
    EXPECT_FALSE(tells(summary(kSixAxis, RedundancyRule::CentralAngle, {false}), "motion"));
    // The turn is forced.
    EXPECT_FALSE(tells(summary("four_axis.json", RedundancyRule::Optimal, {false}), "motion"));
}

// The table of layers has a line for each stage.
TEST(Summary, NamesTheStagesOfAWallOnDemand) {
    meshwind::Run run;
    for (int stage = 0; stage < 2; ++stage) {
        WoundLayer& layer = run.layers.emplace_back();
        layer.job.kind = LayerKind::Wall;
        layer.setup.machine = read_machine(MESHWIND_SOURCE_DIR "/machines/six_axis.json");
        layer.setup.mandrel.whole.points_mm = {{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
    }
    for (const Detail detail : {Detail::Brief, Detail::Full}) {
        std::ostringstream out;
        print_summary(out, run, "out", detail);
        EXPECT_EQ(tells(out.str(), "layer 2, wall: "), detail == Detail::Full);
        EXPECT_TRUE(tells(out.str(), "\n  2 wall "));
    }
}

// What failed stands there; what passed is counted, and listed on demand.
TEST(Summary, TellsWhatFailedAndCountsTheRest) {
    meshwind::Run run;
    WoundLayer& layer = run.layers.emplace_back();
    layer.setup.machine = read_machine(MESHWIND_SOURCE_DIR "/machines/six_axis.json");
    layer.setup.mandrel.whole.points_mm = {{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
    const CheckKind kind{"slip", "Slip", "friction holds it there"};
    Check failed(kind, false, "0.31 where friction holds 0.2");
    Check passed(kind);
    passed.name = "slip-2";
    run.checks = {passed, failed};
    const auto told = [&](Detail detail) {
        std::ostringstream out;
        print_summary(out, run, "out", detail);
        return out.str();
    };
    EXPECT_TRUE(tells(told(Detail::Brief), "slip: 0.31 where friction holds 0.2\n"));
    EXPECT_TRUE(tells(told(Detail::Brief), "1 of 2"));
    EXPECT_FALSE(tells(told(Detail::Brief), "slip-2"));
    EXPECT_TRUE(tells(told(Detail::Full), "slip-2"));
}

}  // namespace
}  // namespace meshwind
