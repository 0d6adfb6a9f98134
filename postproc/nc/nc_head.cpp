#include <numeric>

#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/motion/blend_time.h"
#include "postproc/motion/junction_time.h"
#include "postproc/nc/float32_steps.h"
#include "postproc/nc/made_from.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/nc/nc_writer.h"

namespace meshwind {
namespace {

constexpr double kMmPerM = 1000.0;

void append_if(std::vector<std::string>& to, const std::string& key, const std::string& value) {
    if (!value.empty()) {
        to.push_back(key + value);
    }
}

// The brackets of a comment, or a semicolon and a blank.
constexpr std::size_t kAroundComment = 2;

void make_plain(const NcFlavour& flavour, std::string& words) {
    const bool brackets = flavour.comments != NcComments::Semicolon;
    for (char& c : words) {
        const bool plain =
            c >= ' ' && c <= '~' && flavour.not_in_comments.find(c) == std::string_view::npos;
        c = brackets && c == '(' ? '[' : brackets && c == ')' ? ']' : plain ? c : flavour.stand_in;
    }
}

// As NcMarks reads it.
std::string words_of(const PinRing& ring) {
    return "pins at rim " + std::to_string(ring.rim) + ": N" + std::to_string(ring.count) + " D" +
           fixed(ring.diameter_mm, 4) + " H" + fixed(ring.height_mm, 4) + " S" +
           fixed(ring.strand_mm, 6) + " Z" + fixed(ring.offset_mm, 6) + " A" +
           fixed(deg_from_rad(ring.azimuth_rad), 7);
}

std::string short_number(double value) {
    std::string digits;
    append_shortest(digits, value);
    return digits;
}

double deviation_mm(const NcFlavour& flavour, const Machine& machine) {
    return machine.controller.junction_deviation_mm.value_or(flavour.junction_deviation_mm);
}

// Steps that differ from the machine's, and what float sums lose all the same.
void append_float32(std::vector<std::string>& to, const Machine& machine, const BlockList& list,
                    Float32Text text) {
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        const std::int64_t step = list.axes[a].resolution_nano;
        const std::int64_t own = machine.axis(a).resolution_nano;
        const auto shown = [](std::int64_t nano) {
            return short_number(static_cast<double>(nano) / static_cast<double>(kNanoPerUnit));
        };
        const std::string name = std::string("axis ") + list.axes[a].letter;
        if (step != own) {
            to.push_back(name + " is in steps of " + shown(step) + " instead of " + shown(own) +
                         ", so that sums in 32-bit floats are exact");
        }
        const double error = float32_error(list, a, text);
        if (error > 0.5 * static_cast<double>(own) / static_cast<double>(kNanoPerUnit) &&
            step == own) {
            to.push_back(name + " is off by up to " + fixed(error, 4) +
                         " at the controller, which adds in 32-bit floats");
        }
    }
}

}  // namespace

std::vector<double> nc_run_times_s(const NcFlavour& flavour, const Machine& machine,
                                   const BlockList& list) {
    if (flavour.blends_blocks) {
        const PathMode mode = path_mode_of(flavour, machine);
        return blend_times_s(
            machine, list, {.stops = mode.words.rfind("G61", 0) == 0, .corner_mm = mode.corner_mm});
    }
    if (flavour.junction_deviation_mm > 0.0) {
        return junction_times_s(machine, list, {.deviation_mm = deviation_mm(flavour, machine)});
    }
    std::vector<double> times_s;
    for (const Block& block : list.blocks) {
        times_s.push_back(block.duration_s);
    }
    return times_s;
}

double nc_run_time_s(const NcFlavour& flavour, const Machine& machine, const BlockList& list) {
    const std::vector<double> times_s = nc_run_times_s(flavour, machine, list);
    return std::accumulate(times_s.begin(), times_s.end(), 0.0);
}

std::vector<std::string> head_comments(const NcFlavour& flavour, const Machine& machine,
                                       const BlockList& list, const ProgramHeader& header,
                                       double time_s) {
    std::vector<std::string> lines{"meshwind " + header.version};
    append_if(lines, "mandrel: ", header.mandrel);
    append_if(lines, "mandrel digest: ", header.mandrel_digest);
    lines.push_back("machine: " + machine.name);
    append_made_from(lines, header, flavour.line_length - kAroundComment);
    append_if(lines, std::string(kJobDigest), header.job_digest);
    append_if(lines, std::string(kCodeDigest), header.code_digest);
    lines.push_back("fibre: " + fixed(header.fibre_length_mm / kMmPerM, 3) + " m");
    lines.push_back("time: " + fixed(time_s, 1) + " s");
    const bool plans_corners = flavour.junction_deviation_mm > 0.0;
    if (flavour.blends_blocks || plans_corners) {
        lines.push_back(
            "of these where blocks meet: " + fixed(time_s - list.duration_s(), 1) + " s" +
            (plans_corners ? ", at $11=" + short_number(deviation_mm(flavour, machine)) : ""));
    }
    lines.push_back("blocks: " + std::to_string(list.moves()));
    if (header.tie_on_mm) {
        const Eigen::Vector3d& p = *header.tie_on_mm;
        lines.push_back("tie on at X" + fixed(p.x(), 3) + " Y" + fixed(p.y(), 3) + " Z" +
                        fixed(p.z(), 3) + " on the mandrel");
    }
    for (const PinRing& ring : header.pins) {
        lines.push_back(words_of(ring));
    }
    append_if(lines, "the fibre goes on, do not cut it: run after ", header.goes_on_from);
    for (const std::string& note : header.notes) {
        lines.push_back("note: " + note);
    }
    append_float32(lines, machine, list, flavour.float32);
    return lines;
}

LineValues line_values(const NcFlavour& flavour, const Machine& machine, const BlockList& list,
                       const ProgramHeader& header, double time_s) {
    const auto plain = [&](const std::string& words) {
        std::string line = words.substr(0, flavour.line_length);
        make_plain(flavour, line);
        return line;
    };
    return {.program = std::to_string(machine.controller.program_number.value_or(1)),
            .mandrel = plain(header.mandrel),
            .machine = plain(machine.name),
            .time_s = fixed(time_s, 1),
            .fibre_m = fixed(header.fibre_length_mm / kMmPerM, 3),
            .blocks = std::to_string(list.moves()),
            .version = plain(header.version)};
}

std::string comment_lines(const NcFlavour& flavour, std::string words) {
    const bool brackets = flavour.comments != NcComments::Semicolon;
    make_plain(flavour, words);
    std::string text;
    const std::size_t width = flavour.line_length - kAroundComment;
    for (std::size_t i = 0; i == 0 || i < words.size(); i += width) {
        text +=
            brackets ? '(' + words.substr(i, width) + ")\n" : "; " + words.substr(i, width) + '\n';
    }
    return text;
}

}  // namespace meshwind
