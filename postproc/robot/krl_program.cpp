#include "postproc/robot/krl_program.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text/decimal_text.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/nc/nc_writer.h"
#include "postproc/robot/krl_reader.h"

namespace meshwind {
namespace {

// Text per block in bytes, to reserve the output once.
constexpr std::size_t kTypicalBlock = 120;

// {A1 .., .., E1 ..}
void append_place(const RobotSource& source, std::size_t block, std::string& text) {
    char before = '{';
    for (std::size_t i = 0; i < source.axes.arm.size(); ++i) {
        text += std::exchange(before, ',');
        text += 'A' + std::to_string(i + 1) + ' ';
        append_robot_axis(source.list, block, source.axes.arm[i], text);
    }
    for (std::size_t i = 0; i < source.axes.external.size(); ++i) {
        if (source.axes.external[i]) {
            text += ',';
            text += kKrlLanguage.external[i];
            text += ' ';
            append_robot_axis(source.list, block, *source.axes.external[i], text);
        }
    }
    text += "}\n";
}

// To the start, and the stop there.
std::string approach_text(const RobotSource& source) {
    std::string text = robot_approach(source) + "PTP ";
    append_place(source, 0, text);
    text += comment_lines(source.flavour, robot_tie_on(source));
    text += "HALT\n";
    for (const std::string_view line : kKrlWindingLines) {
        text += std::string(line) + '\n';
    }
    return text;
}

// A time as text, to six digits at least, in whole nanoseconds, so that a sum is exact in decimals.
// \return what the text says, in nanoseconds
std::int64_t append_seconds(double duration_s, std::string& text) {
    constexpr auto kNanoPerSecond = static_cast<double>(kNanoPerUnit);
    const double nano = std::max(1.0, std::round(duration_s * kNanoPerSecond));
    std::string digits;
    append_significant(digits, nano / kNanoPerSecond);
    NcLine line;
    text += digits;
    return line.nano({'=', digits});
}

// The blocks in splines, with a mark where a course begins.
void append_blocks(const RobotSource& source, std::string& text) {
    const std::size_t last = source.list.moves();
    std::int32_t piece = -1;  // of the last course mark
    for (std::size_t first = 1; first <= last; first += kKrlSegments) {
        const std::size_t end = std::min(first + kKrlSegments - 1, last);
        text += "PTP_SPLINE\nTIME_BLOCK START\n";
        std::int64_t nano = 0;
        for (std::size_t i = first; i <= end; ++i) {
            append_course(source, i, piece, text);
            text += "SPTP ";
            append_place(source, i, text);
            text += "TIME_BLOCK PART=";
            nano += append_seconds(source.list.blocks[i].duration_s, text);
            text += '\n';
        }
        text += "TIME_BLOCK END=";
        append_nano(text, nano, 9);
        text.erase(text.find_last_not_of('0') + 1);
        text += text.back() == '.' ? "0\n" : "\n";
        text += end == last ? "ENDSPLINE\n" : "ENDSPLINE C_SPL\n";
    }
}

}  // namespace

std::string Krl::text_of(const RobotSource& source) const {
    std::string text;
    text.reserve(kTypicalBlock * (source.list.blocks.size() + 40));
    text += "&ACCESS RVP\nDEF program( )\n";
    text += robot_head(source, kKrlLanguage.external);
    for (const std::string_view line : kKrlFirstLines) {
        text += std::string(line) + '\n';
    }
    text += robot_own_lines(source, source.machine.controller.header, check_own_krl_line);
    text += approach_text(source);
    append_blocks(source, text);
    text += robot_own_lines(source, source.machine.controller.footer, check_own_krl_line);
    text += "END\n";
    return text;
}

BlockList Krl::read(std::string_view text, const std::string& file, const Machine& machine) const {
    return read_robot_krl(text, file, machine);
}

std::string Krl::code_of(std::string_view text, const std::string& file) const {
    return code_of_nc(kKrlLanguage.comments, text, file);
}

}  // namespace meshwind
