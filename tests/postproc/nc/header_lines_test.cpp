#include "postproc/nc/header_lines.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/robot/dialects.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

std::string refusal(const std::string& line) {
    try {
        (void)filled_lines({line}, {}, "winder");
    } catch (const InputError& error) {
        return error.what();
    }
    return "filled";
}

TEST(HeaderLines, PlacesAreFilledIn) {
    const LineValues values{.program = "7",
                            .mandrel = "tee.stl",
                            .machine = "Winder",
                            .time_s = "12.5",
                            .fibre_m = "1.250",
                            .blocks = "3",
                            .version = "0.1.0"};
    EXPECT_EQ(filled_lines({"G64 P0.02", "(O{program} {mandrel}{machine})", ""}, values, "w"),
              (std::vector<std::string>{"G64 P0.02", "(O7 tee.stlWinder)", ""}));
    EXPECT_EQ(filled_lines({"{time_s} {fibre_m} {blocks} {version}"}, values, "w"),
              (std::vector<std::string>{"12.5 1.250 3 0.1.0"}));
}

TEST(HeaderLines, OthersAreRefusedWithThoseThatExist) {
    for (const char* line :
         {"(made on {date})", "({})", "({mandrel)", "({Mandrel})", "({{program}})"}) {
        const std::string words = refusal(line);
        EXPECT_NE(words.find("winder"), std::string::npos) << words;
        EXPECT_NE(words.find("{program}, {mandrel}, {machine}, {time_s}, {fibre_m}, {blocks}, "
                             "{version}"),
                  std::string::npos)
            << words;
    }
    EXPECT_EQ(refusal("(a } alone)"), "filled");
}

TEST(HeaderLines, EveryDialectFillsThemIn) {
    for (const std::string name :
         {"linuxcnc", "fanuc", "siemens", "grbl", "marlin", "pulses", "rapid", "krl", "tp"}) {
        SCOPED_TRACE(name);
        Machine machine = test::machine_for(name);
        const bool brackets = name == "linuxcnc" || name == "fanuc" || name == "grbl";
        const std::string words = "no {program}: {mandrel} on {machine}, {fibre_m} m, {time_s} s";
        const std::string opens = brackets ? "(" : name == "rapid" || name == "tp" ? "! " : "; ";
        const std::string closes = brackets ? ")" : "";
        machine.controller.header = {opens + words + closes};
        machine.controller.footer = {opens + "{blocks} blocks" + closes};
        machine.controller.program_number = 12;
        const auto dialect = make_dialect(name);
        const BlockList list = dialect->prepare(test::random_list(machine, 1, 5));
        const ProgramHeader header{.mandrel = "a.stl", .fibre_length_mm = 1500.0};
        const std::string text = dialect->write(machine, list, header);
        // TP parts remarks.
        const std::string whole = name == "tp" ? tp_text(tp_lines(text)) : text;
        EXPECT_NE(whole.find("no 12: a.stl on " + machine.name + ", 1.500 m, "), std::string::npos);
        EXPECT_NE(whole.find(std::to_string(list.blocks.size() - 1) + " blocks"),
                  std::string::npos);
        EXPECT_EQ(dialect->read(text, "p", machine).nano, list.nano);
        // What is filled in may not open or close a comment, and code is checked as it will stand.
        const ProgramHeader odd{.mandrel = "a) M2 (\n.stl"};
        EXPECT_EQ(dialect->read(dialect->write(machine, list, odd), "p", machine).nano, list.nano);
        machine.controller.footer = {"M{program}"};
        EXPECT_THROW((void)dialect->write(machine, list, header), InputError);
    }
}

}  // namespace
}  // namespace meshwind
