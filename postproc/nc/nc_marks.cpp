#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/units.h"
#include "postproc/nc/nc_reader.h"

namespace meshwind {
namespace {

constexpr std::string_view kTieOn = "tie on";
constexpr std::string_view kPins = "pins at rim ";

bool begins_with(std::string_view comment, std::string_view words) {
    return comment.substr(0, words.size()) == words;
}

// More pins at a ring, or mm of one, than anything has.
constexpr double kMostOfPins = 1e4;

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
            (i + 1 < kBefore.size() && value[i] < 0.0) || value[i] > kMostOfPins) {
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
            if (begins_with(comment, kTieOn) || begins_with(comment, kPins)) {
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

}  // namespace meshwind
