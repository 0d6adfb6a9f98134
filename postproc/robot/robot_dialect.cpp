#include "postproc/robot/robot_dialect.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>

#include "core/error.h"
#include "postproc/nc/nc_flavour.h"
#include "postproc/nc/nc_writer.h"
#include "postproc/robot/float32_positions.h"

namespace meshwind {
namespace {

NcFlavour comments_of(const RobotLanguage& language) {
    NcFlavour flavour;
    flavour.comments = language.comments;
    flavour.not_in_comments = language.not_in_comments;
    flavour.stand_in = language.stand_in;
    flavour.line_length = 120;  // of comments; the controllers read longer lines
    return flavour;
}

// No language of robots has a word for a block without time or motion.
void check_moves(const BlockList& list) {
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        const std::span<const std::int64_t> now = list.row(i);
        const bool rests = std::equal(now.begin(), now.end(), list.row(i - 1).begin());
        if (rests || !(list.blocks[i].duration_s > 0.0)) {
            throw InputError("dialect.duration", "block " + std::to_string(i),
                             rests ? "moves no axis, so that it would last no time; join it with "
                                     "the next one"
                                   : "takes no time; give every block a duration above 0");
        }
    }
}

}  // namespace

std::vector<double> RobotDialect::run_times_s(const Machine& machine, const BlockList& list) const {
    return nc_run_times_s(comments_of(language_), machine, list);
}

BlockList RobotDialect::prepare(BlockList list) const {
    check_float32(list, language_.title);
    for (Block& block : list.blocks) {
        block.duration_s = sayable_s(block.duration_s);
    }
    return list;
}

std::string RobotDialect::write(const Machine& machine, const BlockList& list,
                                const ProgramLayout& layout, const ProgramHeader& header) const {
    assert(!list.blocks.empty() && list.axes.size() == machine.axis_count());
    assert(layout.main.empty());
    (void)layout;
    if (machine.controller.feed != FeedMode::InverseTime) {
        throw InputError("dialect.feed", machine.name,
                         std::string("a block of ") + language_.title +
                             " has its time, no feed per minute; choose \"inverse-time\"");
    }
    const RobotSource source{machine, list, header, comments_of(language_), robot_axes(machine)};
    check_moves(list);
    return text_of(source);
}

}  // namespace meshwind
