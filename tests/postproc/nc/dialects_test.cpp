// What every dialect must keep, and the traps of each: lines that its controller would refuse or,
// worse, run wrongly without a word. How controllers behave was measured or taken from their docs.
#include "postproc/nc/nc_dialects.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/text/text_file.h"
#include "postproc/nc/float32_steps.h"
#include "postproc/nc/linuxcnc.h"
#include "postproc/nc/pulses.h"
#include "postproc/robot/dialects.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

using test::add;
using test::empty_list;
using test::end_of_program;
using test::machine_for;
using test::many_circuits;
using test::random_list;
using test::small_program;
using test::split_lines;
using test::Summation;

const std::vector<std::string> kAll = dialect_names();
// Those that are G-code.
const std::vector<std::string> kCode = [] {
    std::vector<std::string> names;
    for (const NcFlavour* flavour : nc_flavours()) {
        names.emplace_back(flavour->dialect);
    }
    return names;
}();
const std::string kPrograms = std::string(MESHWIND_SOURCE_DIR) + "/data/programs/";

ProgramHeader header() {
    return {.version = "test",
            .mandrel = "pipe.stl",
            .mandrel_digest = "sha256/128 " + std::string(32, '0'),
            .job_digest = "sha256/128 " + std::string(32, '1'),
            .fibre_length_mm = 12345.0,
            .tie_on_mm = Eigen::Vector3d(70.0, 0.0, -1.5)};
}

std::string write(const std::string& name, const Machine& machine, const BlockList& list) {
    return make_dialect(name)->write(machine, list, header());
}

std::string refusal(const std::string& name, const std::string& text) {
    try {
        const bool semicolon = name == "marlin" || name == "siemens";
        const std::string ours = test::as_ours(text, semicolon ? ';' : '(');
        (void)make_dialect(name)->read(ours, "p", machine_for(name));
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.code() + " " + error.place();
    }
    return "accepted";
}

std::string write_error(const std::string& name, const Machine& machine, const BlockList& list) {
    try {
        (void)write(name, machine, list);
    } catch (const InputError& error) {
        return error.code();
    }
    return "written";
}

std::string check_error(const std::string& name, const Machine& machine) {
    try {
        make_dialect(name)->check(machine);
    } catch (const InputError& error) {
        return error.code();
    }
    return "taken";
}

bool is_motion(const std::string& line) {
    return line.substr(0, 2) == "G1" && line.size() > 2;
}

std::string feed_of(const std::string& line) {
    return line.substr(line.find('F') + 1);
}

TEST(Dialects, ReadBackWhatTheyWrite) {
    for (const std::string& name : kAll) {
        for (const unsigned seed : {1u, 2u, 3u}) {
            SCOPED_TRACE(name + " " + std::to_string(seed));
            const Machine machine = machine_for(name);
            const auto dialect = make_dialect(name);
            const BlockList planned = dialect->prepare(random_list(machine, seed, 3000));
            EXPECT_EQ(dialect->prepare(planned).nano, planned.nano);
            EXPECT_EQ(dialect->prepare(planned).blocks.size(), planned.blocks.size());
            const std::string text = write(name, machine, planned);
            EXPECT_EQ(text, write(name, machine, planned));
            const BlockList read = dialect->read(text, "p", machine);
            ASSERT_EQ(read.nano, planned.nano);
            ASSERT_EQ(*read.tie_on_mm, Eigen::Vector3d(70.0, 0.0, -1.5));
            for (std::size_t i = 1; i < read.blocks.size(); ++i) {
                ASSERT_NEAR(read.blocks[i].duration_s / planned.blocks[i].duration_s, 1.0, 6e-6);
                ASSERT_EQ(read.blocks[i].piece, planned.blocks[i].piece);
                ASSERT_GE(read.blocks[i].line, read.blocks[i - 1].line);
            }
        }
    }
}

TEST(Dialects, TellWherePinsStand) {
    const PinRing ring{.rim = 1,
                       .count = 120,
                       .diameter_mm = 2.0,
                       .height_mm = 12.25,
                       .strand_mm = 0.690988,
                       .offset_mm = 108.5,
                       .azimuth_rad = rad_from_deg(-123.4567891)};
    for (const std::string& name : kAll) {
        SCOPED_TRACE(name);
        const Machine machine = machine_for(name);
        const auto dialect = make_dialect(name);
        ProgramHeader with = header();
        with.pins = {ring};
        const BlockList planned = dialect->prepare(random_list(machine, 1, 20));
        const BlockList read =
            dialect->read(dialect->write(machine, planned, {}, with), "p", machine);
        ASSERT_EQ(read.pins.size(), 1U);
        EXPECT_EQ(read.pins[0].rim, ring.rim);
        EXPECT_EQ(read.pins[0].count, ring.count);
        EXPECT_EQ(read.pins[0].height_mm, ring.height_mm);
        EXPECT_EQ(read.pins[0].strand_mm, ring.strand_mm);
        EXPECT_EQ(read.pins[0].offset_mm, ring.offset_mm);
        EXPECT_NEAR(read.pins[0].azimuth_rad, ring.azimuth_rad, 1e-12);
    }
}

TEST(Dialects, GoldenPrograms) {
    for (const std::string& name : kAll) {
        SCOPED_TRACE(name);
        const Machine machine = machine_for(name);
        const auto dialect = make_dialect(name);
        const FoldedProgram program = dialect->fold(dialect->prepare(small_program(machine)));
        const std::string text = dialect->write(machine, program.list, program.layout, header());
        const std::string file = kPrograms + name + dialect->extension();
        if (std::getenv("MESHWIND_WRITE_GOLDEN") != nullptr) {
            std::ofstream(file, std::ios::binary) << text;
        }
        EXPECT_EQ(text, read_text_file(file));
        EXPECT_EQ(dialect->read(text, file, machine).nano, program.list.nano);
        EXPECT_EQ(!program.layout.main.empty(),
                  name == "linuxcnc" || name == "fanuc" || name == "siemens");
    }
}

// 10,000 circuits end within half a step of the exact angle, added up as the controller does it.
TEST(Dialects, NoDriftOver10000Circuits) {
    const double circuit_deg = 360.0 * std::sqrt(2.0);
    for (const std::string& name : kAll) {
        SCOPED_TRACE(name);
        if (name == "grbl" || name == "marlin" || test::is_robots(name)) {
            continue;  // the next test; those of robots have absolute positions
        }
        const Machine machine = machine_for(name);
        const auto many = many_circuits(machine, circuit_deg);
        const auto dialect = make_dialect(name);
        const BlockList prepared = dialect->prepare(many.list);
        const FoldedProgram folded = dialect->fold(prepared);
        EXPECT_EQ(!folded.layout.main.empty(), name != "pulses");
        for (const FoldedProgram& program : {FoldedProgram{prepared, {}}, folded}) {
            const std::string text =
                dialect->write(machine, program.list, program.layout, header());
            double end = 0.0;
            if (name == "pulses") {
                long double pulses = 0.0L;  // C is the first column
                for (const std::string& line : split_lines(text)) {
                    const bool tick = line[0] == '-' || (line[0] >= '0' && line[0] <= '9');
                    pulses += tick ? std::strtold(line.c_str(), nullptr) : 0.0L;
                }
                end = static_cast<double>(pulses * 0.001L);
            } else {
                end = end_of_program(text, machine, Summation::Exact)[0];
            }
            EXPECT_NEAR(end, many.end_deg, 0.0005 + 1e-8);
        }
        // The repeated circuit rounded once would be off by up to half a step a circuit.
        const double once = std::round(circuit_deg * 1000.0) / 1000.0;
        EXPECT_GT(std::abs(once * 10'000.0 - many.end_deg), 1.0);
    }
}

TEST(Dialects, NoDriftOver10000CircuitsAddedInFloats) {
    for (const auto& [name, summation] :
         {std::pair("grbl", Summation::GrblFloats), std::pair("marlin", Summation::MarlinFloats)}) {
        for (const double circuit_deg : {10.0 * std::sqrt(2.6), 60.0 * std::sqrt(2.6)}) {
            SCOPED_TRACE(name + std::to_string(circuit_deg));
            // A machine of decimal steps, and one whose steps are binary as the prepared ones.
            Machine machine = machine_for(name);
            const auto dialect = make_dialect(name);
            const auto many = many_circuits(machine, circuit_deg);
            const BlockList prepared = dialect->prepare(many.list);
            const double step = static_cast<double>(prepared.axes[0].resolution_nano) / 1e9;
            EXPECT_EQ(step, circuit_deg < 20.0 ? 1.0 / 64.0 : 1.0 / 16.0);
            EXPECT_NEAR(end_of_program(write(name, machine, prepared), machine, summation)[0],
                        many.end_deg, 0.5 * step + 0.0005);
            machine.mandrel_chain[0].resolution_nano = prepared.axes[0].resolution_nano;
            const auto own = many_circuits(machine, circuit_deg);
            EXPECT_EQ(dialect->prepare(own.list).axes, own.list.axes);
            EXPECT_NEAR(end_of_program(write(name, machine, own.list), machine, summation)[0],
                        own.end_deg, 0.5 * step + 1e-9);
            // Without the remedy it would be off by degrees.
            const std::string raw = dialect->write(machine_for(name), many.list, {}, header());
            EXPECT_GT(std::abs(end_of_program(raw, machine, summation)[0] - many.end_deg), 2.0);
        }
    }
}

TEST(Dialects, EveryLineIsAsciiAndEveryFeedMeansSomething) {
    for (const std::string& name : kCode) {
        SCOPED_TRACE(name);
        Machine machine = machine_for(name);
        machine.name = "winder (left) ; % ! ~ ? \xc3\xa9" + std::string(300, 'x') + "\nM2";
        BlockList list = random_list(machine, 7, 3000);
        list.blocks[5].duration_s = 3600.0 * 12.0;
        list.blocks[6].duration_s = 2e-4;
        for (const std::string& line : split_lines(write(name, machine, list))) {
            for (const char c : line) {
                ASSERT_TRUE(c >= ' ' && c <= '~') << line;
            }
            const std::string code = line.substr(0, line.find_first_of("(;"));
            ASSERT_EQ(code.find_first_of("abcdefghijklmnopqrstuvwxyz"), std::string::npos) << line;
            ASSERT_LE(line.size(), 252u);
            if (is_motion(line)) {
                const std::string feed = feed_of(line);
                ASSERT_NE(line.find('F'), std::string::npos) << line;
                ASSERT_GT(std::stod(feed), 0.0) << line;
                ASSERT_EQ(feed.find_first_not_of("0123456789."), std::string::npos) << line;
                ASSERT_EQ(line.find("-0.000 "), std::string::npos) << line;
            }
        }
        const BlockList read =
            make_dialect(name)->read(write(name, machine, list), "p", machine_for(name));
        EXPECT_NEAR(read.duration_s(), make_dialect(name)->prepare(list).duration_s(),
                    1e-4 * read.duration_s());  // F has four digits at least
    }
}

TEST(Dialects, SurviveEveryTruncationAndByteChange) {
    for (const std::string& name : kAll) {
        const Machine machine = machine_for(name);
        const auto dialect = make_dialect(name);
        const FoldedProgram program = dialect->fold(dialect->prepare(small_program(machine)));
        const std::string text = dialect->write(machine, program.list, program.layout, header());
        std::mt19937 engine(5);
        for (std::size_t i = 0; i < text.size(); i += 3) {
            for (std::string changed : {text.substr(0, i), text}) {
                const bool cut = changed.size() < text.size();
                if (!cut) {
                    changed[i] = static_cast<char>(engine() % 256);
                }
                try {
                    (void)dialect->code_of(changed, "p");
                    const BlockList read = dialect->read(changed, "p", machine);
                    // Nothing but the last line's end may be missing.
                    EXPECT_FALSE(cut && read.nano != program.list.nano) << name << " cut at " << i;
                } catch (const InputError&) {
                    continue;
                }
            }
        }
    }
}

TEST(Dialects, RefuseLettersAndFeedsTheyDoNotHave) {
    for (const std::string& name : kAll) {
        SCOPED_TRACE(name);
        Machine machine = machine_for(name);
        const BlockList list = random_list(machine, 1, 3);
        EXPECT_EQ(write_error(name, machine, list), "written");
        BlockList other = list;
        other.blocks[2].duration_s = 0.0;
        EXPECT_EQ(write_error(name, machine, other), "dialect.duration");
        other = list;
        const std::size_t axes = other.axes.size();
        std::copy_n(other.nano.begin() + static_cast<std::ptrdiff_t>(axes), axes,
                    other.nano.begin() + static_cast<std::ptrdiff_t>(2 * axes));
        EXPECT_EQ(write_error(name, machine, other),  // steps may be none, moves not
                  name == "pulses" ? "written" : "dialect.duration");
        other = list;
        other.axes[0].letter = 'E';
        EXPECT_EQ(write_error(name, machine, other),
                  name == "pulses" || test::is_robots(name) ? "written" : "dialect.axis_letter");
        machine.mandrel_chain[0].letter = 'U';
        other.axes[0].letter = 'U';  // the spindle
        const bool free = name != "linuxcnc" && name != "grbl" && name != "marlin";
        EXPECT_EQ(write_error(name, machine, other), free ? "written" : "dialect.axis_letter");
        machine = machine_for(name);
        machine.controller.feed = FeedMode::PerMinute;
        const bool per_minute = name == "grbl" || name == "marlin" || name == "pulses";
        EXPECT_EQ(write_error(name, machine, list), per_minute ? "written" : "dialect.feed");
        machine.controller.feed = FeedMode::InverseTime;
        EXPECT_EQ(write_error(name, machine, list), name == "marlin" ? "dialect.feed" : "written");
        machine = machine_for(name);
        machine.controller.junction_deviation_mm = 0.02;
        EXPECT_EQ(check_error(name, machine),
                  name == "grbl" ? "taken" : "dialect.junction_deviation");
    }
}

TEST(Fanuc, Form) {
    Machine machine = machine_for("fanuc");
    machine.controller.program_number = 1001;  // its subprograms are then others
    machine.mandrel_chain[0].resolution_nano = kNanoPerUnit;
    const Fanuc dialect;
    const BlockList list = test::pattern(machine, {.circuits = 30, .advance_deg = 720.0});
    const FoldedProgram folded = dialect.fold(list);
    const std::string text = dialect.write(machine, folded.list, folded.layout, header());
    EXPECT_EQ(text.substr(0, 18), "%\nO1001 (PIPE.STL)");
    EXPECT_EQ(text.substr(text.size() - 6), "M99\n%\n");
    EXPECT_NE(text.find("M98 P1002 L30\n"), std::string::npos);
    EXPECT_NE(text.find("\nM30\nO1002\n"), std::string::npos);
    for (const std::string& line : split_lines(text)) {
        // A number without a point may mean thousandths.
        for (std::size_t i = 0; is_motion(line) && i < line.size(); ++i) {
            if (std::string("XYZABCF").find(line[i]) != std::string::npos) {
                const std::string word = line.substr(i, line.find(' ', i) - i);
                ASSERT_NE(word.find('.'), std::string::npos) << line;
            }
        }
    }
    EXPECT_EQ(dialect.read(text, "p", machine).nano, folded.list.nano);
}

TEST(FanucRead, RefusesWhatMayMeanSomethingElse) {
    const std::string start =
        "%\nO0001 (TITLE)\nG21 G90\nG0 A0. B0. C0.\nG0 X100. Y0. Z0.\nM0\nG91 G93\n";
    const std::string end = "M30\n%\n";
    EXPECT_EQ(refusal("fanuc", start + "G1 X1. F60.\n" + end), "accepted");
    EXPECT_EQ(refusal("fanuc", start + "G05.1 Q1\nG08 P1\nG1 X1. F60.\n" + end), "accepted");
    EXPECT_EQ(refusal("fanuc", start + "G1 X1 F60.\n" + end), "nc.number p:8");
    EXPECT_EQ(refusal("fanuc", start + "G1 X1. F60\n" + end), "nc.number p:8");
    EXPECT_EQ(refusal("fanuc", start + "G1 X1.\n" + end), "nc.feed p:8");
    EXPECT_EQ(refusal("fanuc", start + "G1 X1. F60. ; words\n" + end), "nc.not_understood p:8");
    EXPECT_EQ(refusal("fanuc", start + "o7 call\n" + end), "nc.o_word p:8");
    EXPECT_EQ(refusal("fanuc", start + "G1 X1. F60.\nM98 P0011002\n" + end),
              "nc.no_subprogram p:9");
    EXPECT_EQ(refusal("fanuc", start + "G1 X1. F60.\nM30\n"), "nc.no_end p:9");
    EXPECT_EQ(refusal("fanuc", start.substr(2) + "G1 X1. F60.\n" + end), "nc.not_understood p:9");
    std::string deep = start + "G1 X1. F60.\nM98 P1\nM30\n";
    for (int i = 1; i <= 5; ++i) {
        deep += "O" + std::to_string(i) + "\nM98 P" + std::to_string(i + 1) + "\nM99\n";
    }
    EXPECT_EQ(refusal("fanuc", deep + "O6\nG1 X1. F60.\nM99\n%\n").substr(0, 10), "nc.nesting");
}

TEST(Fanuc, TakesTheTwoAxisWinderOfTheTable) {
    // X turns the mandrel, Y is the carriage (andrianov_2022_machine_path, Table A2).
    Machine machine = machine_for("fanuc");
    machine.mandrel_chain[0].letter = 'X';
    machine.eye_chain = {machine.eye_chain[0]};
    machine.eye_chain[0].letter = 'Y';
    BlockList list = empty_list(machine);
    add(list, {0, 42'430}, 0.0);
    add(list, {12'230, 48'190}, 0.1);
    add(list, {25'280, 53'860}, 0.1);
    const std::string text = write("fanuc", machine, list);
    EXPECT_NE(text.find("G1 X12.230 Y5.760 F600.\nG1 X13.050 Y5.670 F600.\n"), std::string::npos);
    EXPECT_EQ(Fanuc().read(text, "p", machine).nano, list.nano);
}

TEST(Siemens, RepeatsSectionsInTheirPlace) {
    const Machine machine = machine_for("siemens");
    const Siemens dialect;
    const BlockList list = test::pattern(machine, {.circuits = 233, .advance_deg = 1234.56746});
    const FoldedProgram folded = dialect.fold(list);
    const std::string text = dialect.write(machine, folded.list, folded.layout, header());
    EXPECT_NE(text.find("\nCIRCUIT_1:\nG1 "), std::string::npos);
    EXPECT_NE(text.find("\nCIRCUIT_2_END:\nCIRCUIT_1_END:\nREPEAT CIRCUIT_1 CIRCUIT_1_END P=21\n"),
              std::string::npos);
    EXPECT_NE(text.find("REPEAT CIRCUIT_2 CIRCUIT_2_END P=1\n"), std::string::npos);
    EXPECT_EQ(text.find('('), std::string::npos);
    EXPECT_LT(split_lines(text).size(), 150u);
    const BlockList read = dialect.read(text, "p", machine);
    EXPECT_EQ(read.nano, folded.list.nano);
    const auto end = end_of_program(text, machine, Summation::Exact);
    EXPECT_NEAR(end[0], folded.list.value(folded.list.blocks.size() - 1, 0), 1e-6);
}

TEST(SiemensRead, SectionsAndRefusals) {
    const std::string start = "G71 G90\nG0 A0 B0 C0\nG0 X100 Y0 Z0\nM0\nG91 G93\n";
    const std::string one = "A1:\nG1 X1 F60\nB1:\n";
    const auto length = [&](const std::string& text) {
        const Machine machine = machine_for("siemens");
        const BlockList list = Siemens().read(text, "p", machine);
        return list.value(list.blocks.size() - 1, *machine.joint_of('X')) - 100.0;
    };
    EXPECT_EQ(length(start + one + "M30\n"), 1.0);
    EXPECT_EQ(length(start + one + "REPEAT A1 B1 P=4 ; four more\nM30\nREPEAT\n"), 5.0);
    EXPECT_EQ(length(start + one + "REPEAT A1 B1\nG1 X10 F1\nREPEAT A1 B1 P=2\nM30\n"), 14.0);
    EXPECT_EQ(length(start + "A1:\nG1 X1 F60\nA2:\nG1 X2 F60\nB1:\nREPEAT A2 B1\nM30\n"), 5.0);
    EXPECT_EQ(length("SOFT FFWON ADIS=0.1 G642 ; words: (any)\n" + start + one + "M30\n"), 1.0);
    EXPECT_EQ(refusal("siemens", start + one + "REPEAT A1 B2\nM30\n"), "nc.no_subprogram p:9");
    EXPECT_EQ(refusal("siemens", start + one + "REPEAT B1 A1\nM30\n"), "nc.not_closed p:9");
    EXPECT_EQ(refusal("siemens", start + one + "REPEAT A1 B1 P=-1\nM30\n"),
              "nc.not_understood p:9");
    EXPECT_EQ(refusal("siemens", start + one + "REPEATB A1\nM30\n").substr(0, 3), "nc.");
    EXPECT_EQ(refusal("siemens", start + one + one + "M30\n"), "nc.label_twice p:9");
    EXPECT_EQ(refusal("siemens", start + one + "A2:\nREPEAT A1 B1\nB2:\nREPEAT A2 B2\nM30\n"),
              "nc.not_closed p:12");
    EXPECT_EQ(refusal("siemens", start + one), "nc.no_end p:8");
    EXPECT_EQ(refusal("siemens", start + "G1 X1EX3 F60\nM30\n"), "nc.number p:6");
    EXPECT_EQ(refusal("siemens", start + "G1 X=IC(1) F60\nM30\n"), "nc.number p:6");
    EXPECT_EQ(refusal("siemens", start + "G1 X1 (one) F60\nM30\n"), "nc.not_understood p:6");
    EXPECT_EQ(refusal("siemens", "G21\n" + start + one + "M30\n"), "nc.not_understood p:1");
    EXPECT_EQ(refusal("siemens", start + one + "REPEAT A1 B1 P=30000000\nM30\n"),
              "nc.too_many_lines p:9");
}

TEST(Grbl, LinesAndNumbersAreShortEnough) {
    const Machine machine = machine_for("grbl");
    BlockList list = random_list(machine, 3, 2000);
    for (std::size_t i = 0; i < list.blocks.size(); ++i) {
        list.nano[i * 6] += 120'000'000'000 * static_cast<std::int64_t>(i);  // long turns
    }
    for (const FeedMode feed : {FeedMode::InverseTime, FeedMode::PerMinute}) {
        Machine fed = machine;
        fed.controller.feed = feed;
        const std::string text = write("grbl", fed, list);
        const std::vector<std::string> lines = split_lines(text);
        EXPECT_EQ(lines.back(), "M2");
        for (const std::string& line : lines) {
            ASSERT_LE(line.size(), 79u + 6u) << line;  // six blanks are not counted
            ASSERT_EQ(line.find_first_of("%!~?O"), line.find('O')) << line;
            int digits = 0;
            for (const char c : is_motion(line) ? line.substr(2) : std::string()) {
                digits = c >= '0' && c <= '9' ? digits + 1 : c == '.' ? digits : 0;
                ASSERT_LE(digits, 8) << line;
            }
        }
        const BlockList read = Grbl().read(text, "p", fed);
        EXPECT_EQ(read.nano, Grbl().prepare(list).nano);
    }
}

TEST(Grbl, PerMinuteCountsAllAxesAlike) {
    Machine machine = machine_for("grbl");
    machine.controller.feed = FeedMode::PerMinute;
    BlockList list = empty_list(machine);
    add(list, {0, 0, 0, 0, 0, 0}, 0.0);
    add(list, {3000, 4000, 0, 0, 0, 0}, 2.0);  // 5 in 2 s
    EXPECT_NE(write("grbl", machine, list).find("G1 Z4.000 C3.000 F150\n"), std::string::npos);
}

TEST(GrblRead, RefusesWhatTheControllerWould) {
    const std::string start = "G21 G90\nG0 A0 B0 C0\nG0 X100 Y0 Z0\nM0\nG91 G93\n";
    EXPECT_EQ(refusal("grbl", start + "G1 X1 F60\nM2\n"), "accepted");
    EXPECT_EQ(refusal("grbl", start + "g1x1f60 ; words\nM30\n\n"), "accepted");
    EXPECT_EQ(refusal("grbl", "%\n" + start + "G1 X1 F60\nM2\n"), "nc.not_understood p:1");
    for (const char* line : {"G64 P0.1", "M98 P1001 L2", "O1001", "G95", "M62 P1", "G1 U1 F60"}) {
        EXPECT_EQ(refusal("grbl", start + line + "\nM2\n"), "nc.not_understood p:6") << line;
    }
    EXPECT_EQ(refusal("grbl", start + "G1 X1\nM2\n"), "nc.feed p:6");
    EXPECT_EQ(refusal("grbl", start + "G1 X1 F0\nM2\n"), "nc.feed p:6");
    EXPECT_EQ(refusal("grbl", start + "G1 C123.015625 F60\nM2\n"), "nc.digits p:6");
    EXPECT_EQ(refusal("grbl", start + "G1 C23.015625 F60\nM2\n"), "accepted");
    EXPECT_EQ(refusal("grbl", start + "G1 C23.0156 F60\nM2\n"), "nc.resolution p:6");
    EXPECT_EQ(refusal("grbl", start + "G1 X1 F60\n"), "nc.no_end p:6");
    EXPECT_EQ(refusal("grbl", start + "G1 X1 F60\nM2\nG1 X1 F60\n"), "nc.not_understood p:8");
    const std::string blanks(40, ' ');
    EXPECT_EQ(refusal("grbl", start + "G1" + blanks + "X1" + blanks + "F60\nM2\n"), "accepted");
    EXPECT_EQ(refusal("grbl", start + "G1 X" + std::string(80, '0') + "1 F60\nM2\n"),
              "nc.long_line p:6");
}

TEST(Marlin, OneCommandALine) {
    const Machine machine = machine_for("marlin");
    const std::string text = write("marlin", machine, random_list(machine, 3, 2000));
    EXPECT_EQ(text.substr(text.size() - 17), "; end of program\n");
    for (const std::string& line : split_lines(text)) {
        ASSERT_LE(line.size(), 95u);
        if (line[0] == ';') {
            continue;
        }
        ASSERT_EQ(line.find_first_of("GM", 1), std::string::npos) << line;
        ASSERT_EQ(line.find_first_of("GM"), 0u) << line;
        ASSERT_EQ(line.find_first_of("(%N"), std::string::npos) << line;
        ASSERT_NE(line.substr(0, 3), "G93");
        ASSERT_NE(line, "M2");
    }
}

// F is the way of X Y Z alone: a tiny one beside a long turn must not set the pace.
TEST(Marlin, TinyLinearMovesDoNotRunAway) {
    const Machine machine = machine_for("marlin");
    BlockList list = empty_list(machine);
    add(list, {0, 0, 0, 100'000, 0, 0}, 0.0);
    add(list, {60'000, 0, 0, 100'010, 0, 0}, 1.0);   // 0.01 mm beside 60 deg
    add(list, {120'000, 0, 0, 106'010, 0, 0}, 1.2);  // 6 mm: left alone
    add(list, {720'000, 0, 0, 106'010, 0, 0}, 2.0);  // a turn alone: deg/min
    const Marlin dialect;
    const BlockList prepared = dialect.prepare(list);
    ASSERT_EQ(prepared.blocks.size(), 5u);
    EXPECT_NEAR(prepared.duration_s(), list.duration_s(), 1e-12);
    EXPECT_NEAR(prepared.blocks[1].duration_s, 0.01, 1e-12);  // 1 mm/s
    EXPECT_NEAR(prepared.value(1, 0), 0.6, 1e-9);             // its share of the turn
    EXPECT_EQ(dialect.prepare(prepared).nano, prepared.nano);
    const std::string text = write("marlin", machine, list);
    EXPECT_NE(text.find("G1 X0.010 C0.600 F60\nG1 C59.400 F3600\nG1 X6.000 C60.000 F300\n"
                        "G1 C600.000 F18000\n"),
              std::string::npos);
    EXPECT_NEAR(dialect.read(text, "p", machine).duration_s(), list.duration_s(), 1e-5);
}

TEST(MarlinRead, RefusesWhatWouldBeIgnored) {
    const std::string start = "G21\nG90\nG0 A0 B0 C0\nG0 X100 Y0 Z0\nM0\nG91\n";
    const std::string end = "; end of program\n";
    EXPECT_EQ(refusal("marlin", start + "G1 X1 F60\n" + end), "accepted");
    EXPECT_EQ(refusal("marlin", "M204 T500 ; words\n" + start + "G1 X1 F60\n" + end), "accepted");
    for (const char* line : {"G90 G1 X1 F60", "X1 F60", "g1 X1 F60", "N5 G1 X1 F60", "G91 X1",
                             "G93", "G64", "M2", "M30", "(words)", "%", "M98 P1", "G1 E1 F60"}) {
        EXPECT_EQ(refusal("marlin", std::string(start).append(line).append("\n").append(end))
                      .substr(0, 21),
                  "nc.not_understood p:7")
            << line;
    }
    EXPECT_EQ(refusal("marlin", start + "G1 X1 F60\n"), "nc.no_end p:7");
    EXPECT_EQ(refusal("marlin", start + "G1 X1 F60\n" + end + "G1 X1\n"), "nc.not_understood p:9");
}

}  // namespace
}  // namespace meshwind
