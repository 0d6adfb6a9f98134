#include "postproc/tables/plan_tables.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/tables/motion_csv.h"
#include "postproc/tables/path_csv.h"
#include "tests/support/exact_winding.h"
#include "tests/support/synthetic_paths.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Two pieces on a cylinder, the second with a bridge.
std::vector<Piece> two_pieces() {
    std::vector<Piece> pieces(2);
    const test::ExactCylinder shape;
    for (Piece& piece : pieces) {
        for (int i = 0; i < 5; ++i) {
            PathPoint p;
            p.position_mm = {50.0 * std::cos(0.1 * i), 50.0 * std::sin(0.1 * i), 7.0 / 3.0 * i};
            p.normal = shape.normal(p.position_mm);
            p.tangent = (Vector3d::UnitZ().cross(p.normal) + Vector3d::UnitZ()).normalized();
            piece.path.push_back(p);
            piece.slip.push_back(0.0);
            piece.string.gap_mm.push_back(0.0);
        }
    }
    pieces[1].string.gap_mm[2] = 0.25;
    pieces[1].string.gap_mm[3] = 1e-5;  // the table's rounding
    return pieces;
}

std::string table_of(const std::vector<Piece>& pieces) {
    EyePath path;
    for (std::int32_t p = 0; p < 2; ++p) {
        for (std::int32_t i = 0; i < 5; ++i) {
            EyePoint eye;
            eye.piece = p;
            eye.point = i;
            path.push_back(eye);
        }
    }
    return path_csv(pieces, path);
}

// Code and place of the refusal.
template <class Read>
std::string refusal(const Read& read) {
    try {
        (void)read();
    } catch (const InputError& error) {
        return error.code() + " " + error.place();
    }
    return "none";
}

TEST(ReadPathCsv, ReadsBackWhatWasWritten) {
    const std::vector<Piece> pieces = two_pieces();
    const PlannedFibre fibre = read_path_csv(table_of(pieces), "path.csv");
    ASSERT_EQ(fibre.size(), 10U);
    for (std::size_t i = 0; i < fibre.size(); ++i) {
        const PathPoint& p = pieces[i / 5].path[i % 5];
        EXPECT_EQ(fibre[i].piece, static_cast<std::int32_t>(i / 5));
        EXPECT_EQ(fibre[i].point, static_cast<std::int32_t>(i % 5));
        // Four decimals of positions, seven of directions.
        EXPECT_LE((fibre[i].position_mm - p.position_mm).cwiseAbs().maxCoeff(), 0.51e-4);
        EXPECT_LE((fibre[i].normal - p.normal).cwiseAbs().maxCoeff(), 0.51e-7);
        EXPECT_LE((fibre[i].tangent - p.tangent).cwiseAbs().maxCoeff(), 0.51e-7);
        EXPECT_EQ(fibre[i].lifted, i == 7);
    }
}

TEST(ReadPathCsv, FindsColumnsByNameInAnyOrderAndLineEnding) {
    const PlannedFibre fibre = read_path_csv(
        "bridge_mm,x_mm,y_mm,z_mm,other,point,course,nx,ny,nz,tx,ty,tz\r\n"
        "0.5,1,2,3,word,4,5,1,0,0,0,0,1\r\n"
        "0,1.5,-2,3e1,,6,7,0,1,0,0,0,-1\r\n",
        "path.csv");
    ASSERT_EQ(fibre.size(), 2U);
    EXPECT_EQ(fibre[0].piece, 5);
    EXPECT_EQ(fibre[0].point, 4);
    EXPECT_TRUE(fibre[0].lifted);
    EXPECT_EQ(fibre[1].position_mm, Vector3d(1.5, -2.0, 30.0));
    EXPECT_EQ(fibre[1].normal, Vector3d::UnitY());
    EXPECT_EQ(fibre[1].tangent, Vector3d(-Vector3d::UnitZ()));
    EXPECT_FALSE(fibre[1].lifted);
}

TEST(ReadPathCsv, RefusesWithFileAndLine) {
    const std::string good = table_of(two_pieces());
    const auto read = [](const std::string& text) {
        return refusal([&] { return read_path_csv(text, "out/path.csv"); });
    };
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        return read(text);
    };
    EXPECT_EQ(read(good), "none");
    EXPECT_EQ(with("bridge_mm", "bridge"), "plan.column out/path.csv:1");
    EXPECT_EQ(with("tz", "t"), "plan.column out/path.csv:1");
    // The third line is the second station.
    EXPECT_EQ(with("2.3333", "2.33x3"), "plan.number out/path.csv:3");
    EXPECT_EQ(with("2.3333", ""), "plan.number out/path.csv:3");
    EXPECT_EQ(with("2.3333", "nan"), "plan.number out/path.csv:3");
    EXPECT_EQ(with("2.3333", "1e999"), "plan.number out/path.csv:3");
    EXPECT_EQ(with("2.3333", "2,3333"), "plan.number out/path.csv:3");
    EXPECT_EQ(with("\n0,", "\n1e32,"), "plan.number out/path.csv:2");
    EXPECT_EQ(read(good.substr(0, good.find('\n') + 1)), "plan.empty out/path.csv:1");
    const std::size_t second = good.find('\n', good.find('\n') + 1) + 1;
    EXPECT_EQ(read(good.substr(0, second)), "plan.empty out/path.csv:2");
    EXPECT_EQ(read(good.substr(0, second) + "0,course"), "plan.number out/path.csv:3");
    EXPECT_EQ(read(""), "plan.column out/path.csv:1");
}

struct Motion {
    Machine machine = test::true_machine();
    BlockList list = test::program(machine, test::helix(50.0, rad_from_deg(50.0), 200.0, 4.0, 40),
                                   RedundancyPolicy::CentralAngle);

    [[nodiscard]] std::vector<PlannedMotion> table() const {
        return read_motion_csv(motion_csv(machine, list), "motion.csv", machine);
    }
    [[nodiscard]] MotionDifference difference(const std::vector<PlannedMotion>& planned) const {
        return first_difference(machine, list, planned);
    }
};

TEST(ReadMotionCsv, ReadsBackWhatWasWritten) {
    const Motion motion;
    const std::vector<PlannedMotion> table = motion.table();
    ASSERT_EQ(table.size(), motion.list.blocks.size());
    for (std::size_t b = 0; b < table.size(); ++b) {
        ASSERT_EQ(table[b].value.size(), 6U);
        for (std::size_t a = 0; a < 6; ++a) {
            EXPECT_NEAR(table[b].value[a], motion.list.value(b, a), 1e-9);
        }
    }
    EXPECT_NEAR(table.back().time_s, motion.list.duration_s(), 1e-6);
    const MotionDifference difference = motion.difference(table);
    EXPECT_EQ(difference.words, "");
}

TEST(ReadMotionCsv, RefusesWithFileAndLine) {
    const Motion motion;
    const std::string good = motion_csv(motion.machine, motion.list);
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        return refusal([&] { return read_motion_csv(text, "m.csv", motion.machine); });
    };
    EXPECT_EQ(with("time_s", "time"), "plan.column m.csv:1");
    EXPECT_EQ(with("ey_mm", "ey"), "plan.column m.csv:1");
    EXPECT_EQ(with(",A,", ",W,"), "plan.column m.csv:1");
    EXPECT_EQ(with("\n5,", "\n5,x"), "plan.number m.csv:7");
    EXPECT_EQ(with("\n5,", "\n5,,"), "plan.number m.csv:7");
}

TEST(FirstDifference, NamesTheBlockAndTheAxis) {
    const Motion planned;
    const std::vector<PlannedMotion> table = planned.table();
    const std::string letters = "CZYXAB";
    for (std::size_t a = 0; a < 6; ++a) {
        Motion other = planned;
        other.list.nano[other.list.axes.size() * 9 + a] += other.list.axes[a].resolution_nano;
        const MotionDifference difference = other.difference(table);
        EXPECT_EQ(difference.block, 9U);
        EXPECT_EQ(difference.words.front(), letters[a]);
        const bool rotary = other.list.axes[a].type == AxisType::Rotary;
        for (const double value : {other.list.value(9, a), table[9].value[a]}) {
            EXPECT_TRUE(test::tells(difference.words, fixed(value, 3) + (rotary ? " deg" : " mm")))
                << difference.words;
        }
    }
}

TEST(FirstDifference, NamesTheFirstOfSeveral) {
    const Motion planned;
    Motion other = planned;
    for (const std::size_t block : {5U, 3U, 11U}) {
        other.list.nano[block * 6 + 1] += 5'000'000;
    }
    EXPECT_EQ(other.difference(planned.table()).block, 3U);
}

TEST(FirstDifference, SeesOtherTimes) {
    const Motion planned;
    Motion other = planned;
    other.list.blocks[12].duration_s *= 1.001;
    const MotionDifference difference = other.difference(planned.table());
    EXPECT_EQ(difference.block, 12U);
    EXPECT_NE(difference.words, "");
    // Six digits of F are no difference.
    other.list.blocks[12].duration_s = planned.list.blocks[12].duration_s * (1.0 + 4e-6);
    EXPECT_EQ(other.difference(planned.table()).words, "");
}

TEST(FirstDifference, SeesAnotherMachine) {
    const Motion planned;
    Motion other = planned;
    other.machine.eye.position_mm += Vector3d(0.0, 0.0, 2e-4);
    const MotionDifference difference = other.difference(planned.table());
    EXPECT_EQ(difference.block, 0U);
    EXPECT_NE(difference.words, "");
}

TEST(FirstDifference, SeesMissingAndFurtherBlocks) {
    const Motion motion;
    std::vector<PlannedMotion> table = motion.table();
    const std::size_t blocks = table.size();
    table.push_back(table.back());
    MotionDifference difference = motion.difference(table);
    EXPECT_EQ(difference.block, blocks);
    // The start is none.
    EXPECT_TRUE(test::tells(difference.words, std::to_string(blocks - 1) + " blocks"));
    EXPECT_TRUE(test::tells(difference.words, std::to_string(blocks)));
    table.resize(blocks - 5);
    difference = motion.difference(table);
    EXPECT_EQ(difference.block, blocks - 5);
    EXPECT_FALSE(difference.words.empty());
}

}  // namespace
}  // namespace meshwind
