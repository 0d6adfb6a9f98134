#include "postproc/robot/tp_program.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "core/text/decimal_text.h"
#include "core/text/text_number.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/nc/nc_writer.h"
#include "postproc/robot/tp_reader.h"

namespace meshwind {
namespace {

constexpr double kTick_s = 0.001;
constexpr double kCoarseTick_s = 0.1;
// A duration that is a whole number of ticks up to rounding is not one tick more.
constexpr double kWholeTick = 1e-6;

// Characters of a remark.
constexpr std::size_t kRemark = 32;

// Text per position in bytes, to reserve the output once.
constexpr std::size_t kTypicalPosition = 200;

// What a controller computes itself is 0.
constexpr std::string_view kAttributes =
    "OWNER\t\t= MNEDITOR;\nCOMMENT\t\t= \"meshwind\";\nPROG_SIZE\t= 0;\nFILE_NAME\t= ;\n"
    "VERSION\t\t= 0;\n";
constexpr std::string_view kTask =
    "MEMORY_SIZE\t= 0;\nPROTECT\t\t= READ_WRITE;\nTCD:  STACK_SIZE\t= 0,\n"
    "      TASK_PRIORITY\t= 50,\n      TIME_SLICE\t= 0,\n      BUSY_LAMP_OFF\t= 0,\n"
    "      ABORT_REQUEST\t= 0,\n      PAUSE_REQUEST\t= 0;\n";

double whole_s(double duration_s, double tick_s) {
    return std::max(0.0, std::ceil(duration_s / tick_s - kWholeTick)) * tick_s;
}

// The time of a block, sayable.
std::string time_word(double duration_s, std::size_t block) {
    if (duration_s > kTpMost_s) {
        throw InputError("dialect.duration", "block " + std::to_string(block),
                         "takes " + fixed(duration_s, 1) + " s, more than the " +
                             fixed(kTpMost_s, 0) + " s that FANUC's TP can say; wind faster");
    }
    return duration_s > kTpMostFine_s ? fixed(duration_s, 1) + "sec"
                                      : std::to_string(std::llround(duration_s / kTick_s)) + "msec";
}

// "J3 is C + B".
std::string coupling_comment(const RobotSource& source) {
    const int coupling = tp_coupling(source.machine, source.axes);
    const auto letter = [&](std::size_t i) {
        return std::string(1, source.machine.axis(source.axes.arm[i]).letter);
    };
    return coupling == 0
               ? ""
               : comment_lines(source.flavour,
                               "J3 is " + letter(2) + (coupling > 0 ? " + " : " - ") + letter(1));
}

// The instructions without their numbers, a line each; remarks begin with "! ".
std::string instructions_of(const RobotSource& source) {
    const std::size_t last = source.list.moves();
    std::string text = robot_head(source, kTpLanguage.external) + coupling_comment(source);
    for (const std::string_view line : kTpFirstLines) {
        text += std::string(line) + '\n';
    }
    text += robot_own_lines(source, source.machine.controller.header, check_own_tp_line);
    text += robot_approach(source) + "J P[1] 10% FINE\n";
    text += comment_lines(source.flavour, robot_tie_on(source)) + "PAUSE\n";
    std::int32_t piece = -1;  // of the last course mark
    for (std::size_t i = 1; i <= last; ++i) {
        append_course(source, i, piece, text);
        text += "J P[" + std::to_string(i + 1) + "] " +
                time_word(source.list.blocks[i].duration_s, i) +
                (i == last ? " FINE\n" : " CNT100\n");
    }
    return text + robot_own_lines(source, source.machine.controller.footer, check_own_tp_line);
}

// A remark in as many lines as it needs; none ends with a blank, which would be lost, or looks as
// if it went on from the one before.
std::vector<std::string> remarks_of(std::string_view words) {
    std::vector<std::string> lines;
    const char* const first = words.substr(0, 1) == "+" ? "! " : "!";
    for (const char* opens = first; lines.empty() || !words.empty(); opens = "!+") {
        const std::size_t width = kRemark + 1 - std::string_view(opens).size();
        std::size_t end = std::min(width, words.size());
        if (const std::size_t letter = words.substr(0, end).find_last_not_of(' ');
            end < words.size() && letter != std::string_view::npos) {
            end = letter + 1;
        }
        lines.push_back(opens + std::string(words.substr(0, end)));
        words.remove_prefix(end);
    }
    return lines;
}

// The instructions with numbers and semicolons. \param count of them
std::string numbered(const std::string& instructions, std::size_t& count) {
    std::string text;
    const auto append = [&](const std::string& between, std::string_view words, const char* end) {
        const std::string number = std::to_string(++count);
        text += std::string(4 - std::min<std::size_t>(number.size(), 4), ' ') + number + between;
        text += std::string(words) + end;
    };
    for (const std::string_view line : lines_of_text(instructions)) {
        if (line.substr(0, 1) == "!") {
            const std::size_t first = std::min(line.find_first_not_of(' ', 1), line.size());
            for (const std::string& remark : remarks_of(line.substr(first))) {
                append(":  ", remark, " ;\n");
            }
        } else if (line.substr(0, 2) == "J ") {
            append(":", line, "    ;\n");
        } else {
            append(":  ", line, " ;\n");
        }
    }
    return text;
}

// "J1=     -.143 deg", as a controller writes it: no zero before the point.
std::string axis_text(const RobotSource& source, std::size_t block, const TpAxis& axis) {
    const std::size_t joint = axis.joint;
    const std::size_t before = source.axes.arm[1];
    std::int64_t nano = source.list.row(block)[joint];
    int decimals = decimals_of(source.list.axes[joint].resolution_nano);
    if (joint == source.axes.arm[2]) {
        nano += tp_coupling(source.machine, source.axes) * source.list.row(block)[before];
        decimals = std::max(decimals, decimals_of(source.list.axes[before].resolution_nano));
    }
    std::string number;
    append_nano(number, nano, decimals);
    const std::size_t first = number.front() == '-' ? 1 : 0;
    if (nano != 0 && number.compare(first, 2, "0.") == 0) {
        number.erase(first, 1);
    }
    const bool turns = source.list.axes[joint].type == AxisType::Rotary;
    return axis.name + '=' + std::string(10 - std::min<std::size_t>(number.size(), 10), ' ') +
           number + (turns ? " deg" : "  mm");
}

// Small letters without blanks; nothing of a line without others.
std::string packed_line(std::string_view line) {
    std::string code = packed_tp(line);
    code += code.empty() ? "" : "\n";
    return code;
}

// Of remarks those alone that are code.
std::string packed_instructions(std::string_view program) {
    std::string code;
    for (const TpLine& line : tp_lines(program)) {
        const std::string_view text = line.text;
        if (!line.is_whole || text.substr(0, 1) != "!") {
            code += packed_line(text);
        } else if (is_code_comment(text.substr(2))) {
            code += std::string(text.substr(2)) + '\n';
        }
    }
    return code;
}

// Three axes a line, those outside the arm on lines of their own.
void append_group(const RobotSource& source, std::size_t block, const TpGroup& group,
                  std::string& text) {
    text += "   " + group.name + ":\n\tUF : 0, UT : 1,\t";
    for (std::size_t i = 0; i < group.axes.size(); ++i) {
        text += i == 0 ? "\n\t" : i % 3 == 0 ? ",\n\t" : ",\t";
        text += axis_text(source, block, group.axes[i]);
    }
    text += '\n';
}

void append_positions(const RobotSource& source, std::string& text) {
    const std::vector<TpGroup> groups = tp_groups(source.axes);
    for (std::size_t block = 0; block < source.list.blocks.size(); ++block) {
        text += "P[" + std::to_string(block + 1) + "]{\n";
        for (const TpGroup& group : groups) {
            append_group(source, block, group, text);
        }
        text += "};\n";
    }
}

}  // namespace

std::vector<TpGroup> tp_groups(const RobotAxes& axes) {
    std::vector<TpGroup> groups{{"GP1", {}}, {"GP2", {}}};
    for (std::size_t i = 0; i < kArmAxes; ++i) {
        groups[0].axes.push_back({"J" + std::to_string(i + 1), axes.arm[i]});
    }
    for (std::size_t i = 0; i < kMaxExternalAxes; ++i) {
        if (axes.external[i]) {
            const std::string name(kTpLanguage.external[i], 2);  // "J1" of "J1 of GP2"
            groups[i < kTpExtended ? 0 : 1].axes.push_back({name, *axes.external[i]});
        }
    }
    groups.resize(groups[1].axes.empty() ? 1 : 2);
    return groups;
}

int tp_coupling(const Machine& machine, const RobotAxes& axes) {
    constexpr double kParallel = 1.0 - 1e-9;
    const double along =
        machine.axis(axes.arm[1]).direction.dot(machine.axis(axes.arm[2]).direction);
    return std::abs(along) < kParallel ? 0 : along > 0.0 ? 1 : -1;
}

std::string tp_default_group(const RobotAxes& axes) {
    return tp_groups(axes).size() == 1 ? "1,*,*,*,*" : "1,1,*,*,*";
}

double Tp::tick_s() const {
    return kTick_s;
}

double Tp::sayable_s(double duration_s) const {
    const bool fine = whole_s(duration_s, kTick_s) <= kTpMostFine_s;
    return whole_s(duration_s, fine ? kTick_s : kCoarseTick_s);
}

std::string Tp::text_of(const RobotSource& source) const {
    std::size_t count = 0;
    const std::string instructions = numbered(instructions_of(source), count);
    if (count > kTpMostLines) {
        throw InputError("dialect.too_many_lines", source.machine.name,
                         "the program would have " + std::to_string(count) +
                             " lines, and FANUC's TP has at most " + std::to_string(kTpMostLines) +
                             "; wind layer by layer, homing between, or widen tolerance.laydown");
    }
    std::string text = "/PROG  WINDING\n/ATTR\n";
    text += std::string(kAttributes) + "LINE_COUNT\t= " + std::to_string(count) + ";\n";
    text += std::string(kTask) + "DEFAULT_GROUP\t= " + tp_default_group(source.axes) + ";\n";
    text += "CONTROL_CODE\t= 00000000 00000000;\n/MN\n" + instructions + "/POS\n";
    text.reserve(text.size() + kTypicalPosition * source.list.blocks.size());
    append_positions(source, text);
    return text + "/END\n";
}

BlockList Tp::read(std::string_view text, const std::string& file, const Machine& machine) const {
    return read_tp(text, file, machine);
}

std::string Tp::code_of(std::string_view text, const std::string& /*file*/) const {
    std::string code;
    bool behind = false;  // the instructions
    for (const std::string_view line : lines_of_text(text)) {
        const bool kept = line.substr(0, 5) == "/PROG" || line.substr(0, 13) == "DEFAULT_GROUP";
        behind = behind || line == "/POS";
        code += kept || behind ? packed_line(line) : "";
    }
    return packed_instructions(text) + code;
}

}  // namespace meshwind
