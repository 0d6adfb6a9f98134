#include "postproc/robot/robot_head.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/text/decimal_text.h"
#include "postproc/nc/nc_writer.h"
#include "postproc/robot/float32_positions.h"

namespace meshwind {

std::string robot_head(const RobotSource& source,
                       const std::array<const char*, kMaxExternalAxes>& external) {
    std::vector<std::string> comments = head_comments(source.flavour, source.machine, source.list,
                                                      source.header, source.list.duration_s());
    comments.push_back(robot_axes_words(source.axes, source.machine, external));
    for (const std::string& note : float32_notes(source.list)) {
        comments.push_back("note: " + note);
    }
    std::string text;
    for (std::string& words : comments) {
        text += comment_lines(source.flavour, std::move(words));
    }
    return text;
}

std::string robot_approach(const RobotSource& source) {
    return comment_lines(source.flavour, "approach: all axes move together;") +
           comment_lines(source.flavour,
                         source.header.goes_on_from.empty()
                             ? "bring the eye clear of the mandrel by hand before the start"
                             : "the eye stands nearly there, the fibre stays on");
}

std::string robot_tie_on(const RobotSource& source) {
    return source.header.in_the_air ? "no fibre for this run in the air, start again"
           : source.header.goes_on_from.empty()
               ? "tie the fibre on at the landing point, then start again"
               : "the fibre is on already, start again";
}

std::string robot_own_lines(const RobotSource& source, const std::vector<std::string>& lines,
                            const std::function<void(const Machine&, const std::string&)>& check) {
    const Machine& machine = source.machine;
    const LineValues values =
        line_values(source.flavour, machine, source.list, source.header, source.list.duration_s());
    std::string text;
    for (const std::string& line : filled_lines(lines, values, machine.name)) {
        check(machine, line);
        text += line + '\n';
    }
    return text;
}

void check_robot_line(const Machine& machine, const std::string& line,
                      const std::function<void()>& read) {
    std::string trouble;
    if (!std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; })) {
        trouble = "it has characters that are not plain ASCII";
    } else {
        try {
            read();
        } catch (const InputError& error) {
            trouble = error.words();  // the place is that of the line in no file
        }
    }
    if (!trouble.empty()) {
        throw InputError("dialect.header_line", machine.name,
                         "controller line \"" + line + "\" cannot be used: " + trouble);
    }
}

void append_course(const RobotSource& source, std::size_t block, std::int32_t& piece,
                   std::string& text) {
    const std::int32_t now = source.list.blocks[block].piece;
    if (now != piece) {
        piece = now;
        text += comment_lines(source.flavour, "course " + std::to_string(piece));
    }
}

void append_robot_axis(const BlockList& list, std::size_t block, std::size_t axis,
                       std::string& text) {
    append_nano(text, list.row(block)[axis], decimals_of(list.axes[axis].resolution_nano));
}

}  // namespace meshwind
