// What stands before the first feed move, path modes, the roller: changed in the text of a program
// that is right, a helix at 45 degrees on a pipe (data/programs/pipe_helix.ngc in its own form).
#include "postproc/verify/verify_head.h"

#include <csignal>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "postproc/robot/dialects.h"
#include "postproc/verify/check_kinds.h"
#include "postproc/verify/roller_check.h"
#include "tests/support/exact_winding.h"
#include "tests/support/fixtures.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

const std::string kMaker = "(meshwind test)\n";
const std::string kTieOn = "(tie on at X50.000 Y0.000 Z-60.000 on the mandrel)\n";
const std::string kMode = "G64 P2 Q0.01\n";
const std::string kTurn = "G90 G0 A71.565 B0 C-70.529\n";
const std::string kGo = "G90 G0 X150 Y0 Z81.421\n";
const std::string kStop = "M0\n";
const std::string kQuarter = "G1 C-90 Z78.540 F20\n";
const std::string kHelix = kMaker + kTieOn + "G21 G90 G94\n" + kMode + kTurn + kGo + kStop +
                           "G91 G93\n" + kQuarter + "M2\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

struct World {
    Machine machine = test::true_machine();
    Mandrel mandrel = test::made_cylinder(50.0, 200.0, 5.0);
    LaydownSurface wall{extended_surface(mandrel, 100.0)};
    RayQuery obstacles = test::obstacles_of(mandrel, 100.0);
    HeadEnvelope envelope = head_envelope(machine);
};

const World& world() {
    static const World kWorld;
    return kWorld;
}

Verification verified(const std::string& text, const PlannedFibre& plan = {}) {
    const World& w = world();
    const auto dialect = make_dialect("linuxcnc");
    const BlockList list = dialect->read(text, "p", w.machine);
    VerifyRules rules;
    rules.collision.free_fibre.min_mm = w.machine.fibre.min_free_length_mm;
    rules.collision.free_fibre.max_mm = w.machine.fibre.max_free_length_mm;
    rules.path_mode = dialect->path_mode(w.machine);
    return verify({.program = list,
                   .machine = w.machine,
                   .envelope = w.envelope,
                   .wall = w.wall,
                   .obstacles = w.obstacles,
                   .rules = rules,
                   .plan = plan});
}

// What fails.
std::vector<Check> failures(const Verification& found) {
    std::vector<Check> all;
    for (const Check& check : found.checks) {
        if (!check.ok) {
            all.push_back(check);
        }
    }
    EXPECT_EQ(all.empty(), !found.first_wrong_block.has_value());
    return all;
}

// Names of what fails, each with a blank behind it.
std::string failed(const Verification& found) {
    std::string names;
    for (const Check& check : failures(found)) {
        names += check.name + " ";
    }
    return names;
}

// The one check that fails, with figures or code words in what it says.
Check expect_fails(const Verification& found, const std::string& name,
                   const std::vector<std::string>& figures = {}) {
    EXPECT_EQ(failed(found), name + " ");
    for (Check& check : failures(found)) {
        for (const std::string& figure : figures) {
            EXPECT_TRUE(test::tells(check.words, figure)) << check.words;
        }
        return std::move(check);
    }
    return Check(check_kind::kTieOn);  // none has failed, which the names have told
}

Check expect_fails(const std::string& text, const std::string& name,
                   const std::vector<std::string>& figures = {}) {
    return expect_fails(verified(text), name, figures);
}

TEST(VerifyHead, AProgramInItsFormPasses) {
    EXPECT_EQ(failed(verified(kHelix)), "");
}

TEST(VerifyHead, RapidMovesThroughThePartAreSeen) {
    expect_fails(replaced(kHelix, kTurn, kTurn + "G90 G0 X-300 Y0 Z0\n"), "approach", {"line 6"});
    expect_fails(replaced(kHelix, kTurn, kTurn + "G90 G0 X20 Y400 Z0\nG90 G0 Y-400\n"), "approach",
                 {"line 7"});
    expect_fails(replaced(kHelix, kGo, kGo + "G90 G0 X20\nG90 G0 X150\n"), "approach", {"line 7"});
    // Clear of everything.
    EXPECT_EQ(
        failed(verified(replaced(kHelix, kTurn, kTurn + "G90 G0 X350 Y0 Z0\nG90 G0 Z81.421\n"))),
        "");
}

TEST(VerifyHead, RapidMovesPastTheEndOfAnAxisAreSeen) {
    expect_fails(replaced(kHelix, kTurn, kTurn + "G90 G0 X-1\n"), "approach",
                 {"axis X", "-1.00 mm", "0.00 mm"});
}

TEST(VerifyHead, ExchangedApproachLinesAreSeen) {
    expect_fails(replaced(replaced(kHelix, kTurn, ""), kGo, kGo + kTurn), "approach", {"line 6"});
}

TEST(VerifyHead, AMissingStopIsSeen) {
    for (const std::string& text :
         {replaced(kHelix, kStop, ""), replaced(kHelix, kStop, "M1\n"),
          replaced(replaced(kHelix, kStop, ""), kQuarter, kQuarter + kStop)}) {
        EXPECT_EQ(expect_fails(text, "approach", {"M0"}).numbers.at("stops"), 0.0);
    }
}

TEST(VerifyHead, AnotherPathModeIsSeen) {
    for (const std::string other :
         {"", "G64 P50\n", "G61\n", "G64\n", "G64 P2\n", "G64 P1 Q0.01\n"}) {
        expect_fails(replaced(kHelix, kMode, other), "path_mode", {"G64 P2 Q0.01"});
    }
    const std::string half = "G1 C-45 Z39.270 F40\n";
    const std::string halves = replaced(kHelix, kQuarter, half + half);
    EXPECT_EQ(failed(verified(halves)), "");
    expect_fails(replaced(halves, half, half + "G64\n"), "path_mode", {"block 2 (line 11)"});
    EXPECT_EQ(verified(replaced(halves, half, half + "G64\n")).first_wrong_block, 2U);
    // Behind the last block nothing runs in it.
    EXPECT_EQ(failed(verified(replaced(kHelix, "M2\n", "G64\nM2\n"))), "");
}

TEST(VerifyHead, CornersAreThoseThatTheTextAllows) {
    // Half way along 1 mm aside and back, which cuts a little of the corner.
    const std::string bent =
        replaced(kHelix, kQuarter, "G1 C-45 Z39.270 Y1 F40\nG1 C-45 Z39.270 Y-1 F40\n");
    const double cut = [&] {
        for (const Check& check : verified(bent).checks) {
            if (check.name == "limits") {
                EXPECT_EQ(check.numbers.at("limit_corner_mm"), 2.0);
                return std::max(check.numbers.at("corner_mm"), check.numbers.at("corner_eye_mm"));
            }
        }
        return 0.0;
    }();
    ASSERT_GT(cut, 1e-5);
    std::string text = replaced(bent, kMaker, "");
    const std::string most = std::to_string(0.5 * cut).substr(0, 8);
    text = replaced(text, kMode, "G64 P" + most + "\n");
    const Verification found = verified(text);
    EXPECT_EQ(failed(found), "limits ");
    const std::map<std::string, double> numbers = failures(found).front().numbers;
    EXPECT_NEAR(numbers.at("limit_corner_mm"), 0.5 * cut, 1e-6);
    EXPECT_GT(std::max(numbers.at("corner_mm"), numbers.at("corner_eye_mm")),
              numbers.at("limit_corner_mm"));
}

TEST(VerifyHead, APlaceOffTheWallIsSeen) {
    for (const std::string place :
         {"X50.500 Y0.000 Z-60", "X53.000 Y0.000 Z-60", "X49.850 Y0.000 Z-60"}) {
        const std::vector<Check> found =
            failures(verified(replaced(kHelix, "X50.000 Y0.000 Z-60", place)));
        ASSERT_FALSE(found.empty());
        EXPECT_EQ(found.front().name, "tie_on");
        // X is the distance from the spindle.
        const double off_mm = std::abs(std::stod(place.substr(1)) - 50.0);
        EXPECT_NEAR(found.front().numbers.at("off_wall_mm"), off_mm, 0.01);
        EXPECT_GT(off_mm, found.front().numbers.at("limit_mm"));
    }
    EXPECT_EQ(failed(verified(replaced(kHelix, "X50.000", "X50.010"))), "");
}

TEST(VerifyHead, APlaceOffThePlanIsSeen) {
    const test::ExactCurve curve = test::exact_curve(
        test::ExactCylinder{},
        test::CurveState{Eigen::Vector3d(50.0, 0.0, -60.0), {0.0, std::sqrt(0.5), std::sqrt(0.5)}},
        0.0, 2.0, 0.5 * kPi * 50.0 * std::sqrt(2.0));
    const PlannedFibre plan = test::planned_fibre(curve);
    EXPECT_EQ(failed(verified(kHelix, plan)), "");
    const std::vector<Check> found =
        failures(verified(replaced(kHelix, "Z-60.000", "Z-59.800"), plan));
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found.front().name, "tie_on");
    EXPECT_NEAR(found.front().numbers.at("off_plan_mm"), 0.2, 1e-6);
    // With a plan the form is asked for whoever wrote the program.
    const std::string bare = replaced(replaced(replaced(kHelix, kMaker, ""), kStop, ""), kMode, "");
    EXPECT_EQ(failed(verified(bare)), "");
    const std::string names = failed(verified(bare, plan));
    EXPECT_NE(names.find("path_mode "), std::string::npos) << names;
    EXPECT_NE(names.find("approach "), std::string::npos) << names;
}

TEST(VerifyHead, AFibreOffTheSquareToTheRollerIsSeen) {
    const auto leaning = [](const std::string& a) {
        return failed(verified(replaced(kHelix, "A71.565", a)));
    };
    EXPECT_EQ(leaning("A72.565"), "");
    for (const std::string a : {"A75.500", "A67.500", "A30.000"}) {
        EXPECT_EQ(leaning(a).substr(0, 7), "roller ") << leaning(a);
    }
    // From elsewhere it is stated.
    EXPECT_EQ(failed(verified(replaced(replaced(kHelix, kMaker, ""), "A71.565", "A30.000"))), "");
    EXPECT_EQ(leaning("A-108.435"), "");  // half a turn on the roller is the same line
}

TEST(VerifyHead, ProgramsTooLongToHoldAreRefused) {
    std::string many;
    for (int i = 0; i < 20; ++i) {
        many += "G1 C-7200000 F1\n";
    }
    try {
        (void)verified(replaced(kHelix, kQuarter, many));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "verify.too_long");
        EXPECT_NE(std::string(error.what()).find("(line 1"), std::string::npos) << error.what();
    }
}

TEST(VerifyHead, WindingAgainCanBeEnded) {
    request_interrupt(SIGTERM);
    EXPECT_THROW((void)verified(kHelix), Interrupted);
    withdraw_interrupt();
}

// Fibre that slips everywhere asks for finer blocks behind each station: once each, not once for
// every station.
TEST(VerifyHead, ThousandsOfTinyBlocksTakeNoMoreRoomThanTheirFibre) {
    std::string tiny;
    for (int i = 0; i < 20'000; ++i) {
        tiny += "G1 C-0.001 F2000\n";
    }
    const Verification found = verified(replaced(kHelix, kQuarter, tiny));
    EXPECT_LE(found.coarse_blocks.size(), 20'001U);
    EXPECT_LE(found.coarse_blocks.capacity(), 50'000U);
}

}  // namespace
}  // namespace meshwind
