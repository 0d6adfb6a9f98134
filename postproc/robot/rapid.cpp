#include "postproc/robot/rapid.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/text/decimal_text.h"
#include "core/text/lower_case.h"
#include "core/text/text_number.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/robot/rapid_reader.h"
#include "postproc/robot/rapid_tokens.h"

namespace meshwind {
namespace {

// Text per line in bytes, to reserve the output once.
constexpr std::size_t kTypicalLine = 130;

// Speed of the way to the start, 50 mm/s, 20 deg/s of the tool, 50 mm/s and 30 deg/s of external
// axes: the head comes near the mandrel. A zone as wide as z10 for the tool and wide enough for the
// turn of a spindle: the controller takes no more than half of a block's way in any case.
constexpr std::string_view kData =
    "CONST speeddata approach:=[50,20,50,30];\n"
    "CONST zonedata corner:=[FALSE,10,15,15,15,15,45];\n";

// The jointtarget of a block's end.
void append_target(const RobotSource& source, std::size_t block, std::string& text) {
    char before = '[';
    text += '[';
    for (const std::size_t axis : source.axes.arm) {
        text += std::exchange(before, ',');
        append_robot_axis(source.list, block, axis, text);
    }
    text += "],";
    before = '[';
    for (const std::optional<std::size_t> axis : source.axes.external) {
        text += std::exchange(before, ',');
        if (axis) {
            append_robot_axis(source.list, block, *axis, text);
        } else {
            text += "9E9";
        }
    }
    text += "]]";
}

// To the start, and the stop there.
std::string approach_text(const RobotSource& source) {
    std::string text = robot_approach(source) + "MoveAbsJ ";
    append_target(source, 0, text);
    return text + "\\NoEOffs,approach,fine,tool0;\nTPWrite \"" + robot_tie_on(source) +
           "\";\nStop;\n";
}

// The blocks, with a mark where a course begins.
void append_blocks(const RobotSource& source, std::string& text) {
    const BlockList& list = source.list;
    std::int32_t piece = -1;  // of the last course mark
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        append_course(source, i, piece, text);
        text += "MoveAbsJ ";
        append_target(source, i, text);
        text += "\\NoEOffs,v1000\\T:=";
        append_significant(text, list.blocks[i].duration_s);
        text += i + 1 == list.blocks.size() ? ",fine,tool0;\n" : ",corner,tool0;\n";
    }
}

// A number as short as it can be, so that 9E9 is 9E+09 and 90.000 is 90.
std::string short_number(const RapidToken& number) {
    const std::optional<double> value = number.value();
    if (!value) {
        return std::string(number.text);
    }
    std::string shortest;
    append_shortest(shortest, *value);
    return shortest;
}

}  // namespace

std::string Rapid::text_of(const RobotSource& source) const {
    std::string text;
    text.reserve(kTypicalLine * (source.list.blocks.size() + 40));
    text += "MODULE meshwind\n";
    text += robot_head(source, kRapidLanguage.external);
    text += kData;
    text += "PROC main()\n";
    text += robot_own_lines(source, source.machine.controller.header, check_own_rapid_line);
    text += approach_text(source);
    append_blocks(source, text);
    text += robot_own_lines(source, source.machine.controller.footer, check_own_rapid_line);
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
        code += token.kind == RapidToken::Kind::Number ? short_number(token)
                : token.kind == RapidToken::Kind::Word ? lower_case(token.text)
                                                       : std::string(token.text);
        begins = token.is(";");
        code += begins ? "\n" : "";
    }
    return code + (begins ? "" : "\n");
}

}  // namespace meshwind
