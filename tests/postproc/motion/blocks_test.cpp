#include "postproc/motion/block.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/text/decimal_text.h"
#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "postproc/tables/motion_csv.h"
#include "tests/support/synthetic_paths.h"

namespace meshwind {
namespace {

Machine six_axis() {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/six_axis.json");
}

BlockList blocks_of(const Machine& machine, const EyePath& path) {
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    return make_blocks(machine, path, joints, fibre_moved_mm(path)).list;
}

TEST(Blocks, NoDriftOverAHundredThousandBlocks) {
    const Machine machine = six_axis();
    const EyePath path = test::helix(70.0, rad_from_deg(45.0), 200.0, 0.02, 100'000);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    const BlockList list = make_blocks(machine, path, joints, fibre_moved_mm(path)).list;
    ASSERT_EQ(list.blocks.size(), path.size());
    std::vector<std::int64_t> sum(list.row(0).begin(), list.row(0).end());
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        for (std::size_t a = 0; a < sum.size(); ++a) {
            sum[a] += list.row(i)[a] - list.row(i - 1)[a];
            const double plan = machine.axis(a).type == AxisType::Rotary
                                    ? deg_from_rad(joints.row(i)[a])
                                    : joints.row(i)[a];
            // Half a step of 0.001 and the rounding of a double at 1600 deg.
            ASSERT_LE(std::abs(static_cast<double>(sum[a]) * 1e-9 - plan), 0.0005 + 1e-11);
        }
    }
}

TEST(Blocks, StepsBelowTheResolutionAreMergedWithTheirTime) {
    const Machine machine = six_axis();
    // 0.0002 mm per step are 1.4e-4 mm of Z and 1.2e-4 deg of C: several steps make one block.
    const EyePath path = test::helix(70.0, rad_from_deg(45.0), 200.0, 0.0002, 5000);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    const auto [list, time] = make_blocks(machine, path, joints, fibre_moved_mm(path));
    EXPECT_LT(list.blocks.size(), path.size() / 2);
    EXPECT_NEAR(list.duration_s(), time.duration_s - time.ramp_s, 1e-12);
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        EXPECT_FALSE(std::equal(list.row(i).begin(), list.row(i).end(), list.row(i - 1).begin()));
    }
}

TEST(Blocks, MarksFollowThePieces) {
    const BlockList list = blocks_of(six_axis(), test::strokes(70.0, 200.0, 2.0, 100.0, 2));
    EXPECT_EQ(list.blocks.front().piece, 0);
    EXPECT_EQ(list.blocks.back().piece, 3);
    EXPECT_EQ(list.blocks[1].point, 1);
}

TEST(Blocks, TooFarIsRefused) {
    EyePath path = test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 2);
    path[1].eye_mm.z() = 1e10;
    EXPECT_THROW((void)blocks_of(six_axis(), path), InputError);
}

TEST(DecimalText, PrintsNanoUnitsExactly) {
    const auto text = [](std::int64_t nano, int decimals) {
        std::string out;
        append_nano(out, nano, decimals);
        return out;
    };
    EXPECT_EQ(text(0, 3), "0.000");
    EXPECT_EQ(text(-1'000'000, 3), "-0.001");
    EXPECT_EQ(text(1'234'567'000'000, 3), "1234.567");
    EXPECT_EQ(text(-15'625'000, 6), "-0.015625");
    EXPECT_EQ(text(-7'000'000'000, 0), "-7");
    EXPECT_EQ(text(std::numeric_limits<std::int64_t>::min(), 9), "-9223372036.854775808");
}

TEST(DecimalText, KeepsSixSignificantDigitsWithoutExponent) {
    const auto text = [](double value) {
        std::string out;
        append_significant(out, value);
        return out;
    };
    EXPECT_EQ(text(6000.0), "6000");
    EXPECT_EQ(text(0.012345678), "0.0123457");
    EXPECT_EQ(text(123456789.0), "123456789");
    EXPECT_EQ(text(600.06), "600.06");
    EXPECT_EQ(text(999999.6), "1000000");
    for (const double value : {1e-12, 3.3333333e-7, 1e-3, 1.0, 1e12, 2.5e17}) {
        const std::string out = text(value);
        EXPECT_EQ(out.find_first_not_of("0123456789."), std::string::npos) << out;
        EXPECT_NEAR(std::stod(out) / value, 1.0, 6e-6) << out;
    }
}

TEST(Decimals, ComeFromTheResolution) {
    EXPECT_EQ(decimals_of(1'000'000), 3);
    EXPECT_EQ(decimals_of(500'000), 4);
    EXPECT_EQ(decimals_of(15'625'000), 6);
    EXPECT_EQ(decimals_of(1'000'000'000), 0);
    EXPECT_EQ(decimals_of(1), 9);
}

TEST(MotionCsv, HasOneRowPerBlockWithTheEyeInTheMandrelFrame) {
    const Machine machine = six_axis();
    const EyePath path = test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 3);
    const std::string text = motion_csv(machine, blocks_of(machine, path));
    EXPECT_EQ(text.find("block,time_s,C,Z,Y,X,A,B,ex_mm,ey_mm,ez_mm,rx,ry,rz,course,point\n"
                        "0,0.000000,-63.666,141.421,0.000,157.797,"),
              0u)
        << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
    const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
    EXPECT_EQ(text.substr(last, 2), "2,");
    EXPECT_EQ(text.substr(text.size() - 5), ",0,2\n");
}

}  // namespace
}  // namespace meshwind
