#include "cli/usage.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

const CommandWords kProgram{
    "meshwind",
    {{"--machine"}, {"--units"}, {"--quiet", false}, {"-o"}, {"--set"}},
    {{"wind", {{"--machine"}, {"--effort"}, {"--set"}}, {}},
     {"inspect", {{"--refine"}}, {}},
     {"verify", {{"--plan"}}, {}},
     {"make",
      {{"--edge"}},
      {{"tee", {{"--run-radius"}}, {}}, {"torus", {{"--bend-radius"}}, {}}}}}};

struct Case {
    std::vector<std::string> arguments;
    std::string code;
    std::string has;  // in the line
};

TEST(UsageError, NamesTheWordAndWhatMayBeMeant) {
    const std::vector<Case> cases = {
        {{"tee.stl", "--machin", "six_axis.json"}, "cli.unknown_option", "--machine?"},
        {{"--machin=six_axis.json", "tee.stl"}, "cli.unknown_option", "--machine?"},
        {{"wind", "tee.stl", "--efort", "4"}, "cli.unknown_option", "meshwind wind --help"},
        {{"tee.stl", "--nothing-alike"}, "cli.unknown_option", "meshwind --help"},
        {{"tee.stl", "--friction", "0.3"}, "cli.unknown_option", "--set tow.friction=VALUE"},
        {{"wind", "tee.stl", "--tow-width=3"}, "cli.unknown_option", "--set tow.width=VALUE"},
        {{"inspect", "tee.stl", "--friction"}, "cli.unknown_option", "meshwind inspect --help"},
        {{"wnd", "tee.stl"}, "cli.unknown_command", "\"wind\""},
        {{"inspct"}, "cli.unknown_command", "\"inspect\""},
        {{"--quiet", "verfy", "a.ngc"}, "cli.unknown_command", "\"verify\""},
        {{"tee.stl", "inspect"}, "cli.extra", "meshwind inspect tee.stl"},
        {{"make", "tea", "-o", "t.stl"}, "make.unknown_kind", "\"tee\""},
        {{"make", "-o", "t.stl", "sphere"}, "make.unknown_kind", "tee, torus"},
        {{"make", "tee", "--run-radus", "5"}, "make.unknown_parameter", "--run-radius?"},
        {{"make", "torus", "--height", "5"},
         "make.unknown_parameter",
         "meshwind make torus --help"},
        {{"make"}, "cli.usage", "tee, torus"},
        {{"wind"}, "cli.usage", "parser words"}};
    for (const Case& each : cases) {
        const InputError error = usage_error(kProgram, each.arguments, "parser words");
        EXPECT_EQ(error.code(), each.code) << error.what();
        EXPECT_NE(std::string(error.what()).find(each.has), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
}

TEST(UsageError, TakesNoFileForACommand) {
    EXPECT_EQ(command_meant(kProgram, "wind.stl"), "");
    EXPECT_EQ(command_meant(kProgram, "./wnd"), "");
    EXPECT_EQ(command_meant(kProgram, "part"), "");
    EXPECT_EQ(command_meant(kProgram, "wnd"), "wind");
}

TEST(WhyNoChoice, ProposesTheNearestWord) {
    const std::vector<std::string_view> units = {"auto", "um", "mm", "cm", "m", "in"};
    EXPECT_EQ(why_no_choice("in", units), "");
    EXPECT_NE(why_no_choice("inch", units).find("did you mean \"in\"?"), std::string::npos);
    EXPECT_NE(why_no_choice("MM", units).find("auto, um, mm"), std::string::npos);
    EXPECT_EQ(why_no_choice("parsec", units).find("did you mean"), std::string::npos);
}

TEST(HelpAsACommand, IsTheOptionOfTheCommandBehindIt) {
    using Words = std::vector<std::string>;
    EXPECT_EQ(with_help_as_option({"help"}), Words{"--help"});
    EXPECT_EQ(with_help_as_option({"help", "make", "tee"}), (Words{"make", "tee", "--help"}));
    EXPECT_EQ(with_help_as_option({"part.stl", "help"}), (Words{"part.stl", "help"}));
}

}  // namespace
}  // namespace meshwind
