#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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
    const bool brackets = has_brackets(flavour.comments);
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

constexpr std::string_view kTieOn = "tie on";
constexpr std::string_view kPins = "pins at rim ";

bool begins_with(std::string_view comment, std::string_view words) {
    return comment.substr(0, words.size()) == words;
}

constexpr std::string_view kTpRemark = "! ";
constexpr std::string_view kTpGoesOn = "!+";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = std::min(text.find_first_not_of(" \t"), text.size());
    const std::size_t end = text.find_last_not_of(" \t") + 1;
    return text.substr(first, end > first ? end - first : 0);
}

// More pins at a ring, or mm of one, than anything has.
constexpr double kMaxOfPins = 1e4;

[[noreturn]] void bad_tie_on(const NcLine& line) {
    line.fail("nc.tie_on",
              "a comment \"tie on\" must read (tie on at X1.000 Y2.000 Z3.000 on the mandrel)");
}

[[noreturn]] void bad_pins(const NcLine& line) {
    line.fail(
        "nc.pins",
        "a comment \"pins at rim\" must read (pins at rim 0: N36 D2.0 H2.5 S0.69 Z8.0 A0.0): "
        "pins, diameter, height, radius of the strand, mm from the rim, degrees to the first");
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
    const bool brackets = has_brackets(flavour.comments);
    const std::string opens = {brackets ? '(' : line_comment(flavour.comments), ' '};
    make_plain(flavour, words);
    std::string text;
    const std::size_t width = flavour.line_length - kAroundComment;
    for (std::size_t i = 0; i == 0 || i < words.size(); i += width) {
        text +=
            brackets ? '(' + words.substr(i, width) + ")\n" : opens + words.substr(i, width) + '\n';
    }
    return text;
}

void NcMarks::read(const NcLine& line, BlockList& list) {
    for (std::string_view comment : line.comments) {
        tie_on(line, comment, list);
        pins(line, comment, list);
        head(comment, list);
        constexpr std::string_view kCourse = "course ";
        if (comment.substr(0, kCourse.size()) == kCourse) {
            comment.remove_prefix(kCourse.size());
            std::int32_t piece = 0;
            const auto [end, error] =
                std::from_chars(comment.data(), comment.data() + comment.size(), piece);
            if (error == std::errc{} && end == comment.data() + comment.size()) {
                piece_ = piece;
            }
        }
    }
}

void NcMarks::head(std::string_view comment, BlockList& list) {
    if (!list.head) {
        return;
    }
    if (begins_with(comment, kCodeDigest)) {
        list.head->code_digest = comment.substr(kCodeDigest.size());
    }
    if (begins_with(comment, kJobDigest)) {
        list.head->job_digest = comment.substr(kJobDigest.size());
    }
}

void NcMarks::tie_on(const NcLine& line, std::string_view comment, BlockList& list) {
    static constexpr std::array<std::string_view, 3> kBefore = {"tie on at X", " Y", " Z"};
    if (comment.substr(0, kTieOn.size()) != kTieOn) {
        return;
    }
    if (list.tie_on_mm) {
        line.fail("nc.tie_on", "a second place to tie the fibre on; keep one");
    }
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kBefore.size(); ++i) {
        const bool key = comment.substr(0, kBefore[i].size()) == kBefore[i];
        comment.remove_prefix(key ? kBefore[i].size() : comment.size());
        double& value = place[static_cast<Eigen::Index>(i)];
        const auto [end, error] = std::from_chars(comment.data(), comment.data() + comment.size(),
                                                  value, std::chars_format::fixed);
        if (error != std::errc{} || !std::isfinite(value)) {
            bad_tie_on(line);
        }
        comment.remove_prefix(static_cast<std::size_t>(end - comment.data()));
    }
    if (comment != " on the mandrel") {
        bad_tie_on(line);
    }
    list.tie_on_mm = place;
}

void NcMarks::pins(const NcLine& line, std::string_view comment, BlockList& list) {
    static constexpr std::array<std::string_view, 7> kBefore = {kPins, ": N", " D", " H",
                                                                " S",  " Z",  " A"};
    if (!begins_with(comment, kPins)) {
        return;
    }
    std::array<double, kBefore.size()> value{};
    for (std::size_t i = 0; i < kBefore.size(); ++i) {
        comment.remove_prefix(begins_with(comment, kBefore[i]) ? kBefore[i].size()
                                                               : comment.size());
        const auto [end, error] = std::from_chars(comment.data(), comment.data() + comment.size(),
                                                  value[i], std::chars_format::fixed);
        if (error != std::errc{} || !std::isfinite(value[i]) ||
            (i + 1 < kBefore.size() && value[i] < 0.0) || value[i] > kMaxOfPins) {
            bad_pins(line);
        }
        comment.remove_prefix(static_cast<std::size_t>(end - comment.data()));
    }
    PinRing ring;
    ring.rim = static_cast<std::int32_t>(value[0]);
    ring.count = static_cast<int>(value[1]);
    ring.diameter_mm = value[2];
    ring.height_mm = value[3];
    ring.strand_mm = value[4];
    ring.offset_mm = value[5];
    ring.azimuth_rad = rad_from_deg(value[6]);
    const bool whole = ring.rim == value[0] && ring.count == value[1] && ring.count > 0;
    if (!comment.empty() || !whole || !(ring.diameter_mm > 0.0) || !(ring.height_mm > 0.0)) {
        bad_pins(line);
    }
    if (std::any_of(list.pins.begin(), list.pins.end(),
                    [&](const PinRing& other) { return other.rim == ring.rim; })) {
        line.fail("nc.pins", "a second ring of pins at one rim; keep one");
    }
    list.pins.push_back(ring);
}

bool is_code_comment(std::string_view comment) {
    return begins_with(comment, kTieOn) || begins_with(comment, kPins);
}

std::string code_of_nc(NcComments comments, std::string_view text, const std::string& file) {
    NcLine line;
    line.file = &file;
    line.style = comments;
    std::string all;
    for (const std::string_view words : lines_of_text(text)) {
        ++line.number;
        std::string code = line.split_comments(words);
        if (!code.empty() && code.front() == 'n') {
            code.erase(0, std::min(code.find_first_not_of("0123456789", 1), code.size()));
        }
        for (const std::string_view comment : line.comments) {
            if (is_code_comment(comment)) {
                code += comment.substr(0, comment.find_last_not_of(" \t") + 1);
            }
        }
        all += code.empty() || code == "%" ? "" : code + '\n';
    }
    return all;
}

std::vector<std::string_view> lines_of_text(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        if (!line.empty() && line.back() == '\r') {
            line.remove_suffix(1);
        }
        lines.push_back(line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

std::vector<TpLine> tp_lines(std::string_view program) {
    std::vector<TpLine> lines;
    const std::vector<std::string_view> all = lines_of_text(program);
    const auto begin = std::find(all.begin(), all.end(), "/MN");
    for (auto at = begin; at != all.end() && ++at != all.end() && !begins_with(*at, "/");) {
        const std::string_view words = trimmed(*at);
        const std::size_t number = std::min(words.find_first_not_of("0123456789"), words.size());
        const auto line = static_cast<std::int32_t>(at - all.begin()) + 1;
        if (words.empty()) {
            continue;
        }
        if (!begins_with(words.substr(number), ":") || words.back() != ';') {
            lines.push_back({std::string(words), line, false});
            continue;
        }
        const std::string_view text = trimmed(words.substr(number + 1, words.size() - number - 2));
        const bool goes_on = begins_with(text, kTpGoesOn) && !lines.empty() &&
                             begins_with(lines.back().text, kTpRemark);
        if (goes_on) {
            lines.back().text += text.substr(kTpGoesOn.size());
        } else {
            const bool remark = begins_with(text, "!");
            lines.push_back({remark ? std::string(kTpRemark).append(trimmed(text.substr(1)))
                                    : std::string(text),
                             line, true});
        }
    }
    return lines;
}

std::string tp_text(const std::vector<TpLine>& lines) {
    std::string text;
    for (const TpLine& line : lines) {
        text += line.text + '\n';
    }
    return text;
}

}  // namespace meshwind
