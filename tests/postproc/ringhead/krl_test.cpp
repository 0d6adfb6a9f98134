#include "postproc/ringhead/krl.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "postproc/ringhead/ring_head.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;

Isometry3d pose_of_numbers(double x, double y, double z, const EulerZyx& angles) {
    Isometry3d pose = Isometry3d::Identity();
    pose.linear() = angles.matrix();
    pose.translation() = Eigen::Vector3d(x, y, z);
    return pose;
}

KrlProgram small_program() {
    KrlProgram program;
    program.name = "small";
    program.base = krl_frame(Isometry3d::Identity());
    program.tool = krl_frame(pose_of_numbers(0.0, 0.0, 12.5, {}));
    program.start_nano = {10'000'000'000, -90'000'000'000, 90'000'000'000, 0, -10'000, 5'000'000};
    const auto move = [](double x, double a_deg, double m_s) {
        return KrlMove{krl_frame(pose_of_numbers(x, -0.00004, 990.0, {rad_from_deg(a_deg), 0, 0})),
                       krl_path_speed(m_s), krl_turn_speed(400.0)};
    };
    program.moves = {move(-1000.0, 179.999999, 0.02), move(-990.12345, 170.5, 0.02),
                     move(-980.0, 161.0, 0.0123456789)};
    return program;
}

TEST(Krl, WritesThisProgram) {
    EXPECT_EQ(write_krl(small_program(), {"meshwind 0.1.0", "axis: a\nb.csv"}, {"; cell 7"}),
              "&ACCESS RVP\n"
              "DEF small( )\n"
              "; meshwind 0.1.0\n"
              "; axis: a?b.csv\n"
              "BAS(#INITMOV,0)\n"
              "$BASE={X 0.0000,Y 0.0000,Z 0.0000,A 0.00000,B 0.00000,C 0.00000}\n"
              "$TOOL={X 0.0000,Y 0.0000,Z 12.5000,A 0.00000,B 0.00000,C 0.00000}\n"
              "$ADVANCE=3\n"
              "$ORI_TYPE=#VAR\n"
              "$APO.CDIS=0.5000\n"
              ";  cell 7\n"
              "; the way to the start is free, by hand if it is not\n"
              "PTP {A1 10.00000,A2 -90.00000,A3 90.00000,A4 0.00000,A5 -0.00001,A6 0.00500}\n"
              "$VEL.CP=0.020000\n"
              "$VEL.ORI1=400.0000\n"
              "$VEL.ORI2=400.0000\n"
              "LIN {X -1000.0000,Y 0.0000,Z 990.0000,A 180.00000,B 0.00000,C 0.00000}\n"
              "; tie the fibre on, then start again; the rings turn from here on\n"
              "HALT\n"
              "LIN {X -990.1235,Y 0.0000,Z 990.0000,A 170.50000,B 0.00000,C 0.00000} C_DIS\n"
              "$VEL.CP=0.012346\n"
              "LIN {X -980.0000,Y 0.0000,Z 990.0000,A 161.00000,B 0.00000,C 0.00000}\n"
              "END\n");
}

TEST(Krl, ReadsBackToTheLastDigit) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-3000.0, 3000.0);
    std::uniform_real_distribution<double> angle(-kPi, kPi);
    std::uniform_real_distribution<double> speed(0.0, 2.0);
    KrlProgram program = small_program();
    for (int i = 0; i < 5000; ++i) {
        const Isometry3d pose = pose_of_numbers(place(random), place(random), place(random),
                                                {angle(random), angle(random), angle(random)});
        const KrlFrame frame = krl_frame(pose);
        ASSERT_LT((pose_of(frame).translation() - pose.translation()).norm(), 0.9e-4);
        ASSERT_LT(turn_between(pose_of(frame), pose), rad_from_deg(1.5e-5));
        program.moves.push_back(
            {frame, krl_path_speed(speed(random)), krl_turn_speed(200.0 * speed(random))});
    }
    const std::string text = write_krl(program, {"a comment"});
    const KrlProgram read = read_krl(text, "small.src");
    EXPECT_EQ(read, program);
    EXPECT_EQ(read.moves[0].line, 15);
    EXPECT_EQ(write_krl(read, {"a comment"}), text);
    EXPECT_EQ(durations_s(read), durations_s(program));
}

TEST(Krl, AMoveTakesTheLongerOfWayAndTurn) {
    KrlProgram program = small_program();
    const auto at = [](double x, double a_deg) {
        return krl_frame(pose_of_numbers(x, 0.0, 0.0, {rad_from_deg(a_deg), 0.0, 0.0}));
    };
    program.moves = {{at(0, 0), krl_path_speed(0.05), krl_turn_speed(20.0)},
                     {at(100, 10), krl_path_speed(0.05), krl_turn_speed(20.0)},
                     {at(100, 50), krl_path_speed(0.05), krl_turn_speed(20.0)}};
    const std::vector<double> durations = durations_s(program);
    EXPECT_EQ(durations[0], 0.0);
    EXPECT_NEAR(durations[1], 2.0, 1e-9);
    EXPECT_NEAR(durations[2], 2.0, 1e-6);
}

TEST(Krl, SpeedsAreRoundedUpAndNeverNothing) {
    EXPECT_EQ(krl_path_speed(0.02), 20'000'000);
    EXPECT_EQ(krl_path_speed(0.0123456789), 12'346'000);
    EXPECT_EQ(krl_path_speed(0.0), 1'000);
    EXPECT_EQ(krl_turn_speed(1e-9), 100'000);
}

std::string refusal(const std::string& text) {
    try {
        (void)read_krl(text, "p.src");
    } catch (const InputError& error) {
        return error.code() + " " + error.place();
    }
    return "accepted";
}

TEST(Krl, RefusesWhatItDoesNotWrite) {
    const std::string good = write_krl(small_program(), {});
    const auto with = [&](const std::string& what, const std::string& instead) {
        std::string text = good;
        text.replace(text.find(what), what.size(), instead);
        return refusal(text);
    };
    EXPECT_EQ(refusal(good), "accepted");
    EXPECT_EQ(refusal(""), "krl.no_end p.src:0");
    EXPECT_EQ(refusal(good.substr(0, good.size() - 4)), "krl.no_end p.src:19");
    EXPECT_EQ(with("DEF small( )", "DEF 7small( )"), "krl.not_understood p.src:2");
    EXPECT_EQ(with("BAS(#INITMOV,0)", "BAS(#VEL_CP,1)"), "krl.not_understood p.src:3");
    EXPECT_EQ(with("LIN {X -1000", "SLIN {X -1000"), "krl.not_understood p.src:14");
    EXPECT_EQ(with("X -1000.0000", "X -1000.0e0"), "krl.number p.src:14");
    EXPECT_EQ(with("X -1000.0000", "X"), "krl.not_understood p.src:14");
    EXPECT_EQ(with("} C_DIS", "} C_PTP"), "krl.not_understood p.src:17");
    EXPECT_EQ(with("$VEL.CP=0.020000\n", ""), "krl.no_motion p.src:13");
    EXPECT_EQ(with("$VEL.CP=0.020000", "$VEL.CP=-0.02"), "krl.number p.src:11");
    EXPECT_EQ(with("ORI2=400", "ORI2=300"), "krl.not_understood p.src:13");
    KrlProgram name = small_program();
    name.name = "a program";
    EXPECT_THROW((void)write_krl(name, {}), InputError);
    EXPECT_THROW((void)write_krl(small_program(), {}, {"$OUT[1]=TRUE"}), InputError);
    EXPECT_THROW((void)krl_frame(pose_of_numbers(2e6, 0.0, 0.0, {})), InputError);
}

}  // namespace
}  // namespace meshwind
