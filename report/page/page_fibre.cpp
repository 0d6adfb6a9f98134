#include "report/page/page_fibre.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text/text_number.h"
#include "core/units.h"
#include "machines/kinematics.h"
#include "winding/laminate/wound_angle.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

// A page is to stay below 30 MB, and a browser to draw it: of all fibres together so many stations
// (60 bytes each, before they are packed) and blocks (some 80 bytes) are in it, and so much of the
// programs' text.
constexpr std::size_t kMaxStations = 200'000;
constexpr std::size_t kMaxBlocks = 100'000;
constexpr std::size_t kMaxText = 2'000'000;

// What a page shows of fibre and eye is rounded: below what is seen or read, packed it is half.
constexpr double kShownPlace_mm = 0x1p-8;
constexpr double kShownLength_mm = 0x1p-6;
constexpr double kShownShare = 0x1p-11;  // of a unit vector, of a slip ratio
constexpr double kShownAngle_deg = 0x1p-7;

// A chord whose square is less has no direction.
constexpr double kShort_mm2 = 1e-12;

// 1: all of them.
std::size_t every_of(std::size_t count, std::size_t most) {
    return (count + most - 1) / std::max<std::size_t>(most, 1);
}

// Stations of a fibre that the page shows.
class ShownStations {
public:
    // Every so many, and both ends of each piece.
    ShownStations(std::span<const Piece> pieces, std::size_t every) {
        std::size_t first = 0;
        for (const Piece& piece : pieces) {
            first_.push_back(station_.size());
            piece_first_.push_back(first);
            for (std::size_t i = 0; i < piece.path.size(); ++i) {
                if (i % every == 0 || i + 1 == piece.path.size()) {
                    keep(piece, first, i);
                }
            }
            first += piece.path.size();
        }
        first_.push_back(station_.size());
    }

    [[nodiscard]] const std::vector<std::size_t>& all() const { return station_; }
    [[nodiscard]] std::size_t first(std::size_t piece) const { return first_[piece]; }
    [[nodiscard]] std::size_t count(std::size_t piece) const {
        return first_[piece + 1] - first_[piece];
    }

    // That which a point of a piece is shown by: itself or the next one.
    [[nodiscard]] std::size_t shown(std::size_t piece, std::size_t point) const {
        const auto at =
            std::lower_bound(station_.begin(), station_.end(), piece_first_[piece] + point);
        return static_cast<std::size_t>(at - station_.begin());
    }

    // How far the stations that are left out are from the lines between those shown.
    [[nodiscard]] double off_mm() const { return off_mm_; }

private:
    void keep(const Piece& piece, std::size_t first, std::size_t i) {
        const std::size_t before = i > 0 ? station_.back() - first : i;
        const Vector3d& from = piece.path[before].position_mm;
        const Vector3d chord = piece.path[i].position_mm - from;
        for (std::size_t k = before + 1; k < i; ++k) {
            const Vector3d to = piece.path[k].position_mm - from;
            const double share =
                std::clamp(to.dot(chord) / std::max(chord.squaredNorm(), kShort_mm2), 0.0, 1.0);
            off_mm_ = std::max(off_mm_, (to - share * chord).norm());
        }
        station_.push_back(first + i);
    }

    std::vector<std::size_t> station_;      // of the fibre, ascending
    std::vector<std::size_t> first_;        // per piece: in station_; and the end
    std::vector<std::size_t> piece_first_;  // per piece: its first station
    double off_mm_ = 0.0;
};

json pieces_json(const ShownFibre& fibre, const ShownStations& shown) {
    const std::vector<std::int32_t>& family = fibre.layer.plan.family;
    std::size_t course = fibre.first_course;
    json list = json::array();
    for (std::size_t p = 0; p < fibre.pieces.size(); ++p) {
        const Piece& piece = fibre.pieces[p];
        const bool is_course = piece.kind == PieceKind::Course;
        json entry = {{"kind", is_course ? "course" : "transition"},
                      {"course", course},
                      {"family", -1},
                      {"first", shown.first(p)},
                      {"count", shown.count(p)},
                      {"length_mm", piece.path.back().s_mm - piece.path.front().s_mm},
                      {"worst_slip", piece.worst_slip},
                      {"start_rim", piece.start_rim},
                      {"end_rim", piece.end_rim}};
        if (is_course) {
            if (course < family.size()) {
                entry["family"] = family[course];
            }
            ++course;
        } else {
            entry["course"] = course > 0 ? course - 1 : 0;
        }
        list.push_back(std::move(entry));
    }
    return list;
}

// Whole lines from the beginning, of all programs in proportion.
std::string_view shown_text(std::string_view text, std::size_t all_bytes) {
    if (all_bytes <= kMaxText) {
        return text;
    }
    const double share = static_cast<double>(kMaxText) / static_cast<double>(all_bytes);
    const auto most = static_cast<std::size_t>(share * static_cast<double>(text.size()));
    return text.substr(0, text.rfind('\n', most) + 1);
}

// What the page leaves out, for who reads it.
std::string shortened_words(const PageExtent& extent, const ShownStations& shown, bool text) {
    std::string words;
    const auto add = [&words](const std::string& more) {
        words += (words.empty() ? "" : "; ") + more;
    };
    if (text) {
        add("the listing ends early");
    }
    if (extent.block_every > 1) {
        add("one block in " + std::to_string(extent.block_every) + " is shown");
    }
    if (extent.station_every > 1) {
        add("fibre is drawn within " + fixed(shown.off_mm(), 2) + " mm");
    }
    return words + "; all of it is in the files";
}

// To the pipe's own axis; to the spindle where the wall is no pipe.
double angle_of(const Surface& surface, const PathPoint& station) {
    if (station.at.face >= 0 && station.at.face < static_cast<std::int32_t>(surface.face.size())) {
        if (const auto angle = winding_angle_rad(surface, station)) {
            return *angle;
        }
    }
    const Vector3d meridian = Vector3d::UnitZ() - station.normal.z() * station.normal;
    return std::atan2(meridian.cross(station.tangent).norm(),
                      std::abs(meridian.dot(station.tangent)));
}

void add_stations(const ShownFibre& fibre, const ShownStations& shown, PageArrays& arrays) {
    const Surface& surface = fibre.layer.setup.mandrel.surface;
    const EyePath& eyes = fibre.program.made.eyes.path;
    const std::string& prefix = fibre.prefix;
    std::vector<Vector3d> position;
    std::vector<Vector3d> normal;
    std::vector<Vector3d> tangent;
    std::vector<double> s;
    std::vector<double> slip;
    std::vector<double> bridge;
    std::vector<double> free_length;
    std::vector<double> angle;
    std::vector<std::uint32_t> piece_of;
    for (const std::size_t shown_station : shown.all()) {
        const EyePoint& eye = eyes[shown_station];
        const Piece& piece = fibre.pieces[static_cast<std::size_t>(eye.piece)];
        const auto i = static_cast<std::size_t>(eye.point);
        const PathPoint& station = piece.path[i];
        position.push_back(piece.string.gap_mm[i] > 0.0 ? eye.landing_mm : station.position_mm);
        normal.push_back(station.normal);
        tangent.push_back(station.tangent);
        s.push_back(eye.s_mm);
        slip.push_back(piece.slip[i]);
        bridge.push_back(piece.string.gap_mm[i]);
        free_length.push_back(eye.free_length_mm);
        angle.push_back(deg_from_rad(angle_of(surface, station)));
        piece_of.push_back(static_cast<std::uint32_t>(eye.piece));
    }
    arrays.add_points(prefix + "position_mm", position, kShownPlace_mm);
    arrays.add_points(prefix + "normal", normal, kShownShare);
    arrays.add_points(prefix + "tangent", tangent, kShownShare);
    arrays.add_floats(prefix + "s_mm", s, kShownLength_mm);
    arrays.add_floats(prefix + "slip", slip, kShownShare);
    arrays.add_floats(prefix + "bridge_mm", bridge, kShownPlace_mm);
    arrays.add_floats(prefix + "free_length_mm", free_length, kShownLength_mm);
    arrays.add_floats(prefix + "angle_deg", angle, kShownAngle_deg);
    arrays.add<std::uint32_t>(prefix + "piece", 1, piece_of);
}

void add_blocks(const ShownFibre& fibre, const PageExtent& extent, const ShownStations& shown,
                PageArrays& arrays) {
    const PieceProgram& made = fibre.program.made;
    const std::string& prefix = fibre.prefix;
    const Machine& machine = extent.first.machine;
    const BlockList& list = made.blocks;
    const bool has_lines = made.read.blocks.size() == list.blocks.size();
    std::vector<double> time_s;
    std::vector<double> asked_s;  // since the block before, by the program alone
    std::vector<double> axes;
    std::vector<Vector3d> eye;
    std::vector<std::int32_t> station;
    std::vector<std::uint32_t> line;
    const std::vector<double> times_s = extent.first.dialect->run_times_s(machine, list);
    double now_s = 0.0;
    double since_s = 0.0;
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        const Block& block = list.blocks[b];
        now_s += times_s[b];
        since_s += block.duration_s;
        if (b % extent.block_every != 0 && b + 1 < list.blocks.size()) {
            continue;
        }
        time_s.push_back(now_s);
        asked_s.push_back(std::exchange(since_s, 0.0));
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            axes.push_back(list.value(b, a));
        }
        eye.emplace_back(mandrel_from_eye(machine, joints_at(list, b)).translation());
        const bool known = block.piece >= 0 && block.point >= 0;
        station.push_back(
            known ? static_cast<std::int32_t>(shown.shown(static_cast<std::size_t>(block.piece),
                                                          static_cast<std::size_t>(block.point)))
                  : -1);
        line.push_back(has_lines ? static_cast<std::uint32_t>(made.read.blocks[b].line) : 0U);
    }
    arrays.add<double>(prefix + "time_s", 1, time_s);
    arrays.add_floats(prefix + "asked_s", asked_s);
    arrays.add<double>(prefix + "axes", list.axes.size(), axes);
    arrays.add_points(prefix + "eye_mm", eye, kShownLength_mm);
    arrays.add<std::int32_t>(prefix + "station", 1, station);
    arrays.add<std::uint32_t>(prefix + "line", 1, line);
}

}  // namespace

PageExtent page_extent(const Run& run) {
    std::size_t stations = 0;
    std::size_t blocks = 0;
    std::size_t text_bytes = 0;
    for (const WoundLayer& layer : run.layers) {
        for (const FibreProgram& program : layer.programs) {
            stations += program.made.eyes.path.size();
            blocks += program.made.blocks.blocks.size();
            text_bytes += run.usable ? program.text.size() : 0;
        }
    }
    return {.first = run.layers.front().setup,
            .usable = run.usable,
            .station_every = every_of(stations, kMaxStations),
            .block_every = every_of(blocks, kMaxBlocks),
            .text_bytes = text_bytes};
}

json page_fibre(const ShownFibre& fibre, const PageExtent& extent, PageArrays& arrays) {
    const FibreProgram& program = fibre.program;
    const ShownStations shown(fibre.pieces, extent.station_every);
    json list = pieces_json(fibre, shown);
    add_stations(fibre, shown, arrays);
    add_blocks(fibre, extent, shown, arrays);
    const std::string_view text = extent.usable ? program.text : std::string_view();
    const std::string_view listed = shown_text(text, extent.text_bytes);
    arrays.add<char>(fibre.prefix + "text", 1, listed);
    json report = {{"program", extent.usable ? json(program.file) : json(nullptr)},
                   {"dialect", fibre.layer.setup.machine.controller.dialect},
                   {"prefix", fibre.prefix},
                   {"pieces", std::move(list)}};
    if (extent.station_every > 1 || extent.block_every > 1 || listed.size() < text.size()) {
        report["shortened"] = shortened_words(extent, shown, listed.size() < text.size());
        report["block_every"] = extent.block_every;
    }
    return report;
}

}  // namespace meshwind
