#include "postproc/linuxcnc.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/text_number.h"
#include "postproc/decimal_text.h"

namespace meshwind {
namespace {

constexpr double kSecondsPerMinute = 60.0;
constexpr double kMmPerM = 1000.0;
// The interpreter's floor of length * F is 0.1 mm/min; a block below the first value is split, and
// its linear part then has the second one, clear of the floor by more than F's last digit.
constexpr double kLeastFeed_mm_min = 0.12;
constexpr double kSplitFeed_mm_min = 0.2;
// Numbers of subprograms count from here, clear of those that people give to programs.
constexpr std::size_t kFirstSubprogram = 1001;
// Text per line in bytes, to reserve the output once.
constexpr std::size_t kTypicalLine = 64;

// Length of a block's linear move as the interpreter takes it: X Y Z, or U V W when those rest.
double linear_length_mm(const BlockList& list, std::size_t block) {
    double main = 0.0;
    double second = 0.0;
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        if (list.axes[a].type == AxisType::Linear) {
            const double move = list.value(block, a) - list.value(block - 1, a);
            (list.axes[a].letter >= 'X' ? main : second) += move * move;
        }
    }
    return std::sqrt(main > 0.0 ? main : second);
}

bool turns(const BlockList& list, std::size_t block) {
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        if (list.axes[a].type == AxisType::Rotary && list.row(block)[a] != list.row(block - 1)[a]) {
            return true;
        }
    }
    return false;
}

// True when the interpreter would run this block faster than planned.
bool needs_split(const BlockList& list, std::size_t block) {
    const double length = linear_length_mm(list, block);
    return length > 0.0 &&
           length * kSecondsPerMinute < kLeastFeed_mm_min * list.blocks[block].duration_s &&
           turns(list, block);
}

std::vector<std::size_t> blocks_to_split(const BlockList& list) {
    std::vector<std::size_t> found;
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        if (needs_split(list, i)) {
            found.push_back(i);
        }
    }
    return found;
}

void append_block(BlockList& to, const Block& block, std::span<const std::int64_t> row) {
    to.blocks.push_back(block);
    to.nano.insert(to.nano.end(), row.begin(), row.end());
}

// Whole linear move with its share of the turn, then the rest of the turn.
void append_split(BlockList& to, const BlockList& from, std::size_t block) {
    Block first = from.blocks[block];
    Block second = first;
    first.duration_s = linear_length_mm(from, block) * kSecondsPerMinute / kSplitFeed_mm_min;
    second.duration_s -= first.duration_s;
    const double share = first.duration_s / from.blocks[block].duration_s;
    std::vector<std::int64_t> row(from.row(block).begin(), from.row(block).end());
    for (std::size_t a = 0; a < row.size(); ++a) {
        if (from.axes[a].type == AxisType::Rotary) {
            const std::int64_t before = from.row(block - 1)[a];
            const std::int64_t steps = (row[a] - before) / from.axes[a].resolution_nano;
            // Towards zero, so that something is left to turn in the second block.
            row[a] = before + static_cast<std::int64_t>(share * static_cast<double>(steps)) *
                                  from.axes[a].resolution_nano;
        }
    }
    append_block(to, first, row);
    append_block(to, second, from.row(block));
}

void check_letters(const Machine& machine, const BlockList& list) {
    for (const BlockAxis& axis : list.axes) {
        const bool linear = axis.letter >= 'U' && axis.letter <= 'Z';
        const bool rotary = axis.letter >= 'A' && axis.letter <= 'C';
        if (axis.type == AxisType::Linear ? !linear : !rotary) {
            throw InputError("dialect.axis_letter", machine.name,
                             std::string("axis ") + axis.letter +
                                 " cannot be written; LinuxCNC has X Y Z U V W linear and A B C "
                                 "rotary");
        }
    }
    if (machine.controller.feed != FeedMode::InverseTime) {
        throw InputError("dialect.feed", machine.name,
                         "feed per minute is not written for LinuxCNC, whose F leaves the rotary "
                         "axes out; choose \"inverse-time\"");
    }
}

class Writer {
public:
    Writer(const Machine& machine, const BlockList& list) : machine_(machine), list_(list) {
        for (const BlockAxis& axis : list.axes) {
            decimals_.push_back(decimals_of(axis.resolution_nano));
        }
        // X Y Z A B C U V W is what an operator expects, whatever the order of the chains.
        static constexpr std::string_view kOrder = "XYZABCUVW";
        for (const char letter : kOrder) {
            for (std::size_t a = 0; a < list.axes.size(); ++a) {
                if (list.axes[a].letter == letter) {
                    order_.push_back(a);
                }
            }
        }
        text_.reserve(kTypicalLine * (list.blocks.size() + 40));
    }

    std::string program(const ProgramHeader& header, const ProgramLayout& layout) && {
        comments(header);
        text_ += "G21 G90 G94 G17 G40 G49 G80\n";
        raw_lines(machine_.controller.header);
        comment("approach: rotary axes turn first, then the linear axes move together;");
        comment("bring the eye clear of the mandrel by hand before the start");
        start_moves();
        comment("MSG, tie the fibre on at the landing point, then start again");
        text_ += "M0\nG91 G93\n";
        std::vector<ProgramPart> main = layout.main;
        if (main.empty()) {
            main.push_back({.first = 1, .last = list_.blocks.size() - 1});
        }
        parts(main);
        raw_lines(machine_.controller.footer);
        text_ += "M2\n";
        marks_ = false;
        for (std::size_t s = 0; s < layout.subprograms.size(); ++s) {
            text_ += "O" + std::to_string(kFirstSubprogram + s) + '\n';
            parts(layout.subprograms[s]);
            text_ += "M99\n";
        }
        return std::move(text_);
    }

private:
    void comments(const ProgramHeader& header) {
        comment("meshwind " + header.version);
        comment_if("mandrel: ", header.mandrel);
        comment_if("mandrel digest: ", header.mandrel_digest);
        comment("machine: " + machine_.name);
        comment_if("job digest: ", header.job_digest);
        comment("fibre: " + fixed(header.fibre_length_mm / kMmPerM, 3) + " m");
        comment("time: " + fixed(list_.duration_s(), 1) + " s");
        comment("blocks: " + std::to_string(list_.blocks.size() - 1));
        if (header.tie_on_mm) {
            const Eigen::Vector3d& p = *header.tie_on_mm;
            comment("tie on at X" + fixed(p.x(), 3) + " Y" + fixed(p.y(), 3) + " Z" +
                    fixed(p.z(), 3) + " on the mandrel");
        }
        for (const std::string& note : header.notes) {
            comment("note: " + note);
        }
    }

    void comment_if(const std::string& key, const std::string& value) {
        if (!value.empty()) {
            comment(key + value);
        }
    }

    // A comment may hold no brackets or control characters; a long one is cut into lines.
    void comment(std::string words) {
        for (char& c : words) {
            const bool plain = c >= ' ' && c <= '~';
            c = c == '(' ? '[' : c == ')' ? ']' : plain ? c : '?';
        }
        const std::size_t width = kLinuxCncLineLength - 2;
        for (std::size_t i = 0; i == 0 || i < words.size(); i += width) {
            text_ += '(' + words.substr(i, width) + ")\n";
        }
    }

    void raw_lines(const std::vector<std::string>& lines) {
        for (const std::string& line : lines) {
            text_ += line + '\n';
        }
    }

    void start_moves() {
        for (const AxisType type : {AxisType::Rotary, AxisType::Linear}) {
            std::string words;
            for (const std::size_t a : order_) {
                if (list_.axes[a].type == type) {
                    words += std::string(" ") + list_.axes[a].letter;
                    append_nano(words, list_.row(0)[a], decimals_[a]);
                }
            }
            if (!words.empty()) {
                // G90 again: the controller's own header lines may have changed it.
                text_ += "G90 G0" + words + '\n';
            }
        }
    }

    void parts(const std::vector<ProgramPart>& parts) {
        for (const ProgramPart& part : parts) {
            if (part.kind == ProgramPart::Kind::Call) {
                mark(part.first);
                text_ += "M98 P" + std::to_string(kFirstSubprogram + part.subprogram);
                text_ += part.times > 1 ? " L" + std::to_string(part.times) + '\n' : "\n";
                continue;
            }
            for (std::size_t i = part.first; i <= part.last; ++i) {
                mark(i);
                block(i);
            }
        }
    }

    void mark(std::size_t block) {
        if (marks_ && list_.blocks[block].piece != piece_) {
            piece_ = list_.blocks[block].piece;
            text_ += "(course " + std::to_string(piece_) + ")\n";
        }
    }

    void block(std::size_t i) {
        const std::span<const std::int64_t> now = list_.row(i);
        const std::span<const std::int64_t> before = list_.row(i - 1);
        text_ += "G1";
        for (const std::size_t a : order_) {
            if (now[a] != before[a]) {
                text_ += ' ';
                text_ += list_.axes[a].letter;
                append_nano(text_, now[a] - before[a], decimals_[a]);
            }
        }
        const double duration_s = list_.blocks[i].duration_s;
        if (!(duration_s > 0.0)) {
            throw InputError("dialect.duration", "block " + std::to_string(i),
                             "takes no time; give every block a duration above 0");
        }
        text_ += " F";
        append_significant(text_, kSecondsPerMinute / duration_s);
        text_ += '\n';
    }

    const Machine& machine_;
    const BlockList& list_;
    std::vector<int> decimals_;
    std::vector<std::size_t> order_;
    std::string text_;
    std::int32_t piece_ = -1;  // of the last course mark
    bool marks_ = true;
};

}  // namespace

BlockList LinuxCnc::prepare(BlockList list) const {
    const std::vector<std::size_t> split = blocks_to_split(list);
    if (split.empty()) {
        return list;
    }
    BlockList result;
    result.axes = list.axes;
    result.blocks.reserve(list.blocks.size() + split.size());
    result.nano.reserve(list.nano.size() + split.size() * list.axes.size());
    auto next = split.begin();
    for (std::size_t i = 0; i < list.blocks.size(); ++i) {
        if (next != split.end() && *next == i) {
            append_split(result, list, i);
            ++next;
        } else {
            append_block(result, list.blocks[i], list.row(i));
        }
    }
    return result;
}

FoldedProgram LinuxCnc::fold(BlockList list) const {
    FoldedProgram folded = fold_repeats(list);
    // A corrected block might have become one that the interpreter runs too fast.
    if (!blocks_to_split(folded.list).empty()) {
        return {std::move(list), {}};
    }
    return folded;
}

std::string LinuxCnc::write(const Machine& machine, const BlockList& list,
                            const ProgramLayout& layout, const ProgramHeader& header) const {
    assert(!list.blocks.empty() && list.axes.size() == machine.axis_count());
    check_letters(machine, list);
    check_linuxcnc_lines(machine);
    return Writer(machine, list).program(header, layout);
}

}  // namespace meshwind
