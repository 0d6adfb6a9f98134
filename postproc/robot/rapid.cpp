#include "postproc/robot/rapid.h"

#include <cassert>
#include <charconv>
#include <utility>

#include "core/error.h"
#include "core/text/decimal_text.h"
#include "core/text/text_number.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/nc/nc_writer.h"
#include "postproc/robot/rapid_reader.h"
#include "postproc/robot/rapid_tokens.h"

namespace meshwind {
namespace {

constexpr std::string_view kController = "RAPID";

// Text per line in bytes, to reserve the output once.
constexpr std::size_t kTypicalLine = 130;

// Speed of the way to the start, 50 mm/s, 20 deg/s of the tool, 50 mm/s and 30 deg/s of external
// axes: the head comes near the mandrel. A zone as wide as z10 for the tool and wide enough for the
// turn of a spindle: the controller takes no more than half of a block's way in any case.
constexpr std::string_view kData =
    "CONST speeddata approach:=[50,20,50,30];\n"
    "CONST zonedata corner:=[FALSE,10,15,15,15,15,45];\n";

NcFlavour text_flavour() {
    NcFlavour flavour;
    flavour.comments = NcComments::Exclamation;
    flavour.line_length = 120;  // of comments; no limit of the language is known
    return flavour;
}

// What is written.
struct RapidSource {
    const Machine& machine;
    const BlockList& list;
    const ProgramHeader& header;
    NcFlavour flavour;
    RobotAxes axes;
};

std::string own_lines(const RapidSource& source, const std::vector<std::string>& lines) {
    const Machine& machine = source.machine;
    const LineValues values =
        line_values(source.flavour, machine, source.list, source.header, source.list.duration_s());
    std::string text;
    for (const std::string& line : filled_lines(lines, values, machine.name)) {
        check_own_rapid_line(machine, line);
        text += line + '\n';
    }
    return text;
}

void append_axis(const BlockList& list, std::size_t block, std::size_t axis, std::string& text) {
    append_nano(text, list.row(block)[axis], decimals_of(list.axes[axis].resolution_nano));
}

// The jointtarget of a block's end.
void append_target(const RapidSource& source, std::size_t block, std::string& text) {
    char before = '[';
    text += '[';
    for (const std::size_t axis : source.axes.arm) {
        text += std::exchange(before, ',');
        append_axis(source.list, block, axis, text);
    }
    text += "],";
    before = '[';
    for (const std::optional<std::size_t> axis : source.axes.external) {
        text += std::exchange(before, ',');
        if (axis) {
            append_axis(source.list, block, *axis, text);
        } else {
            text += "9E9";
        }
    }
    text += "]]";
}

std::string head_text(const RapidSource& source) {
    std::vector<std::string> comments = head_comments(source.flavour, source.machine, source.list,
                                                      source.header, source.list.duration_s());
    comments.push_back(robot_axes_words(source.axes, source.machine, kRapidExternal));
    for (const std::string& note : float32_notes(source.list)) {
        comments.push_back("note: " + note);
    }
    std::string text;
    for (std::string& words : comments) {
        text += comment_lines(source.flavour, std::move(words));
    }
    return text;
}

// To the start, and the stop there.
std::string approach_text(const RapidSource& source) {
    const bool continues_fibre = !source.header.goes_on_from.empty();
    std::string text = comment_lines(source.flavour, "approach: all axes move together;");
    text += comment_lines(source.flavour,
                          continues_fibre
                              ? "the eye stands nearly there, the fibre stays on"
                              : "bring the eye clear of the mandrel by hand before the start");
    text += "MoveAbsJ ";
    append_target(source, 0, text);
    text += "\\NoEOffs,approach,fine,tool0;\nTPWrite \"";
    text += source.header.in_the_air ? "no fibre for this run in the air, start again"
            : continues_fibre        ? "the fibre is on already, start again"
                                     : "tie the fibre on at the landing point, then start again";
    return text + "\";\nStop;\n";
}

// The blocks, with a mark where a course begins.
void append_blocks(const RapidSource& source, std::string& text) {
    const BlockList& list = source.list;
    std::int32_t piece = -1;  // of the last course mark
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        if (list.blocks[i].piece != piece) {
            piece = list.blocks[i].piece;
            text += comment_lines(source.flavour, "course " + std::to_string(piece));
        }
        text += "MoveAbsJ ";
        append_target(source, i, text);
        text += "\\NoEOffs,v1000\\T:=";
        append_significant(text, list.blocks[i].duration_s);
        text += i + 1 == list.blocks.size() ? ",fine,tool0;\n" : ",corner,tool0;\n";
    }
}

// A number as short as it can be, so that 9E9 is 9E+09 and 90.000 is 90.
std::string short_number(std::string_view number) {
    double value = 0.0;
    const char* const last = number.data() + number.size();
    const auto [end, error] = std::from_chars(number.data(), last, value);
    if (error != std::errc{} || end != last) {
        return std::string(number);
    }
    std::string shortest;
    append_shortest(shortest, value);
    return shortest;
}

}  // namespace

std::vector<double> Rapid::run_times_s(const Machine& machine, const BlockList& list) const {
    return nc_run_times_s(text_flavour(), machine, list);
}

BlockList Rapid::prepare(BlockList list) const {
    check_float32(list, std::string(kController));
    return list;
}

std::string Rapid::write(const Machine& machine, const BlockList& list, const ProgramLayout& layout,
                         const ProgramHeader& header) const {
    assert(!list.blocks.empty() && list.axes.size() == machine.axis_count());
    assert(layout.main.empty());
    (void)layout;
    if (machine.controller.feed != FeedMode::InverseTime) {
        throw InputError("dialect.feed", machine.name,
                         "a block of RAPID has its time, no feed per minute; choose "
                         "\"inverse-time\"");
    }
    const RapidSource source{machine, list, header, text_flavour(), robot_axes(machine)};
    check_moves(list);
    std::string text;
    text.reserve(kTypicalLine * (list.blocks.size() + 40));
    text += "MODULE meshwind\n";
    text += head_text(source);
    text += kData;
    text += "PROC main()\n";
    text += own_lines(source, machine.controller.header);
    text += approach_text(source);
    append_blocks(source, text);
    text += own_lines(source, machine.controller.footer);
    text += "ENDPROC\nENDMODULE\n";
    return text;
}

BlockList Rapid::read(std::string_view text, const std::string& file,
                      const Machine& machine) const {
    return read_rapid(text, file, machine);
}

std::string Rapid::code_of(std::string_view text, const std::string& /*file*/) const {
    std::string code;
    bool begins = true;
    RapidTokens tokens(text, [&](std::string_view comment, std::int32_t) {
        if (is_code_comment(comment)) {
            code += (begins ? "" : "\n") + std::string(comment) + '\n';
            begins = true;
        }
    });
    for (RapidToken token = tokens.next(); token.kind != RapidToken::Kind::End;
         token = tokens.next()) {
        code += begins ? "" : " ";
        code += token.kind == RapidToken::Kind::Number ? short_number(token.text)
                : token.kind == RapidToken::Kind::Word ? lower_case(token.text)
                                                       : std::string(token.text);
        begins = token.is(";");
        code += begins ? "\n" : "";
    }
    return code + (begins ? "" : "\n");
}

}  // namespace meshwind
