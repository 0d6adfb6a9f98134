#include "cli/make_command.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/error.h"

namespace meshwind {
namespace {

std::filesystem::path output(const char* name) {
    return std::filesystem::path(testing::TempDir()) / name;
}

TEST(RunMake, TakesAnglesInDegrees) {
    MakeRequest request{"elbow", {{"angle", 90.0}}, {}, output("meshwind_elbow.obj")};
    const std::string right_angle = run_make(request);
    request.shown_values.clear();
    EXPECT_EQ(right_angle, run_make(request));
    request.shown_values = {{"angle", 181.0}};
    EXPECT_THROW((void)run_make(request), InputError);
    std::filesystem::remove(request.output);
}

TEST(RunMake, TakesAFullTurnForAClosedTorus) {
    MakeRequest request{
        "torus", {{"angle", 360.0}}, {.edge_mm = 20.0}, output("meshwind_torus.stl")};
    const std::string full_turn = run_make(request);
    request.shown_values.clear();
    EXPECT_EQ(full_turn, run_make(request));
    request.shown_values = {{"angle", 359.0}};
    EXPECT_NE(full_turn, run_make(request));
    std::filesystem::remove(request.output);
}

TEST(RunMake, RefusesWhatItDoesNotKnow) {
    EXPECT_THROW((void)run_make({"cone", {}, {}, "cone.step"}), InputError);
    EXPECT_THROW((void)run_make({"cone", {{"size", 1.0}}, {}, output("cone.stl")}), InputError);
    EXPECT_THROW((void)run_make({"sphere", {}, {}, output("sphere.stl")}), InputError);
    EXPECT_THROW((void)run_make({"cone", {}, {}, output("no_such_folder/cone.stl")}), IoError);
}

TEST(HelpOf, ShowsMeaningUnitAndDefault) {
    const auto kinds = make_kinds();
    EXPECT_EQ(help_of(kinds[0].parameters[0]), "radius, mm [50]");
    EXPECT_EQ(help_of(kinds[4].parameters[2]), "angle of the bend, deg [90]");
}

}  // namespace
}  // namespace meshwind
