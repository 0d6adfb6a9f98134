#include "report/page_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/text/text_number.h"
#include "core/units.h"
#include "machines/kinematics.h"
#include "mesh/mandrel/extension.h"
#include "report/folder/run_files.h"
#include "report/page/page_arrays.h"
#include "report/report_checks.h"
#include "winding/laminate/wound_angle.h"
#include "winding/turn/pin.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

// A page is to stay below 30 MB, and a browser to draw it: of all fibres together so many stations
// (60 bytes each, before they are packed) and blocks (some 80 bytes) are in it, and so much of the
// programs' text.
constexpr std::size_t kMostStations = 200'000;
constexpr std::size_t kMostBlocks = 100'000;
constexpr std::size_t kMostText = 2'000'000;

// What a page shows of fibre and eye is rounded: below what is seen or read, packed it is half.
constexpr double kShownPlace_mm = 0x1p-8;
constexpr double kShownLength_mm = 0x1p-6;
constexpr double kShownShare = 0x1p-11;  // of a unit vector, of a slip ratio
constexpr double kShownAngle_deg = 0x1p-7;

json vector_json(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

// Limits that are infinite are null.
json limit_json(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}

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

class PageData {
public:
    PageData(const Run& run, const Layup& layup)
        : run_(run), layup_(layup), first_(run.layers.front().setup) {
        std::size_t stations = 0;
        std::size_t blocks = 0;
        for (const WoundLayer& layer : run.layers) {
            for (const FibreProgram& program : layer.programs) {
                stations += program.made.eyes.path.size();
                blocks += program.made.blocks.blocks.size();
                text_ += run.usable ? program.text.size() : 0;
            }
        }
        station_every_ = every_of(stations, kMostStations);
        block_every_ = every_of(blocks, kMostBlocks);
    }

    std::string text(json report) {
        const Mandrel& mandrel = first_.mandrel;
        arrays_.add_points("mandrel/points", mandrel.surface.position_mm);
        arrays_.add_faces("mandrel/faces", mandrel.surface.face);
        arrays_.add<std::int32_t>("mandrel/region", 1, mandrel.surface.region);
        add_layup("total/", layup_.all());
        if (!layup_.walls().asked_layers.empty()) {
            arrays_.add_floats("wall/asked_layers", layup_.walls().asked_layers);
            arrays_.add_floats("wall/laid_layers", layup_.walls().laid_layers);
        }
        json layers = json::array();
        for (std::size_t i = 0; i < run_.layers.size(); ++i) {
            layers.push_back(layer_json(i));
        }
        const Job::TowJob& tow = first_.job.tow;
        report.erase("timing_s");  // the same run writes the same page
        json header = {{"format", "meshwind-page-1"},
                       {"report", std::move(report)},
                       {"check_kinds", check_kinds_report(run_.checks)},
                       {"machine", machine_json()},
                       {"tow",
                        {{"width_mm", tow.width_mm},
                         {"thickness_mm", tow.thickness_mm},
                         {"friction", first_.friction.holds()}}},
                       {"extension", extension_json()},
                       {"layers", layers}};
        return arrays_.behind(std::move(header));
    }

private:
    void add_layup(const std::string& prefix, const LayupArrays& arrays) {
        arrays_.add_floats(prefix + "layers", arrays.layers);
        arrays_.add_floats(prefix + "thickness_mm", arrays.thickness_mm);
        arrays_.add_floats(prefix + "angle_deg", arrays.winding_deg);
    }

    json layer_json(std::size_t number) {
        const WoundLayer& layer = run_.layers[number];
        const std::string name = "layer" + std::to_string(number + 1);
        json report = {{"name", "layer " + std::to_string(number + 1)},
                       {"kind", name_of(layer.job.kind)},
                       {"points", "mandrel/points"}};
        if (number > 0) {
            report["points"] = name + "/points";
            arrays_.add_points(name + "/points", layer.setup.mandrel.surface.position_mm);
        }
        add_layup(name + "/", layup_.each()[number]);
        report["fibres"] = json::array();
        const auto fibres = fibres_of(layer.plan.pieces);
        std::size_t course = 0;
        for (std::size_t fibre = 0; fibre < fibres.size(); ++fibre) {
            report["fibres"].push_back(fibre_json(layer, fibres[fibre], layer.programs[fibre],
                                                  name + "/fibre" + std::to_string(fibre + 1) + "/",
                                                  course));
        }
        return report;
    }

    // \param course the number of the fibre's first course; counted on
    json fibre_json(const WoundLayer& layer, std::span<const Piece> pieces,
                    const FibreProgram& program, const std::string& prefix, std::size_t& course) {
        const ShownStations shown(pieces, station_every_);
        json list = json::array();
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            const Piece& piece = pieces[p];
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
                if (course < layer.plan.family.size()) {
                    entry["family"] = layer.plan.family[course];
                }
                ++course;
            } else {
                entry["course"] = course > 0 ? course - 1 : 0;
            }
            list.push_back(std::move(entry));
        }
        add_stations(layer.setup.mandrel.surface, pieces, program.made.eyes.path, shown, prefix);
        add_blocks(program.made, shown, prefix);
        const std::string_view text = run_.usable ? program.text : std::string_view();
        const std::string_view listed = shown_text(text);
        arrays_.add<char>(prefix + "text", 1, listed);
        json report = {{"program", run_.usable ? json(program.file) : json(nullptr)},
                       {"dialect", layer.setup.machine.controller.dialect},
                       {"prefix", prefix},
                       {"pieces", std::move(list)}};
        if (station_every_ > 1 || block_every_ > 1 || listed.size() < text.size()) {
            report["shortened"] = shortened_words(shown, listed.size() < text.size());
            report["block_every"] = block_every_;
        }
        return report;
    }

    // Whole lines from the beginning, of all programs in proportion.
    [[nodiscard]] std::string_view shown_text(std::string_view text) const {
        if (text_ <= kMostText) {
            return text;
        }
        const double share = static_cast<double>(kMostText) / static_cast<double>(text_);
        const auto most = static_cast<std::size_t>(share * static_cast<double>(text.size()));
        return text.substr(0, text.rfind('\n', most) + 1);
    }

    // What the page leaves out, for who reads it.
    [[nodiscard]] std::string shortened_words(const ShownStations& shown, bool text) const {
        std::string words;
        const auto add = [&words](const std::string& more) {
            words += (words.empty() ? "" : "; ") + more;
        };
        if (text) {
            add("the listing ends early");
        }
        if (block_every_ > 1) {
            add("one block in " + std::to_string(block_every_) + " is shown");
        }
        if (station_every_ > 1) {
            add("fibre is drawn within " + fixed(shown.off_mm(), 2) + " mm");
        }
        return words + "; all of it is in the files";
    }

    void add_stations(const Surface& surface, std::span<const Piece> pieces, const EyePath& eyes,
                      const ShownStations& shown, const std::string& prefix) {
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
            const Piece& piece = pieces[static_cast<std::size_t>(eye.piece)];
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
        arrays_.add_points(prefix + "position_mm", position, kShownPlace_mm);
        arrays_.add_points(prefix + "normal", normal, kShownShare);
        arrays_.add_points(prefix + "tangent", tangent, kShownShare);
        arrays_.add_floats(prefix + "s_mm", s, kShownLength_mm);
        arrays_.add_floats(prefix + "slip", slip, kShownShare);
        arrays_.add_floats(prefix + "bridge_mm", bridge, kShownPlace_mm);
        arrays_.add_floats(prefix + "free_length_mm", free_length, kShownLength_mm);
        arrays_.add_floats(prefix + "angle_deg", angle, kShownAngle_deg);
        arrays_.add<std::uint32_t>(prefix + "piece", 1, piece_of);
    }

    // To the pipe's own axis; to the spindle where the wall is no pipe.
    static double angle_of(const Surface& surface, const PathPoint& station) {
        if (station.at.face >= 0 &&
            station.at.face < static_cast<std::int32_t>(surface.face.size())) {
            if (const auto angle = winding_angle_rad(surface, station)) {
                return *angle;
            }
        }
        const Vector3d meridian = Vector3d::UnitZ() - station.normal.z() * station.normal;
        return std::atan2(meridian.cross(station.tangent).norm(),
                          std::abs(meridian.dot(station.tangent)));
    }

    void add_blocks(const PieceProgram& made, const ShownStations& shown,
                    const std::string& prefix) {
        const BlockList& list = made.blocks;
        const bool has_lines = made.read.blocks.size() == list.blocks.size();
        std::vector<double> time_s;
        std::vector<double> asked_s;  // since the block before, by the program alone
        std::vector<double> axes;
        std::vector<Vector3d> eye;
        std::vector<std::int32_t> station;
        std::vector<std::uint32_t> line;
        const std::vector<double> times_s = first_.dialect->run_times_s(first_.machine, list);
        double now_s = 0.0;
        double since_s = 0.0;
        for (std::size_t b = 0; b < list.blocks.size(); ++b) {
            const Block& block = list.blocks[b];
            now_s += times_s[b];
            since_s += block.duration_s;
            if (b % block_every_ != 0 && b + 1 < list.blocks.size()) {
                continue;
            }
            time_s.push_back(now_s);
            asked_s.push_back(std::exchange(since_s, 0.0));
            for (std::size_t a = 0; a < list.axes.size(); ++a) {
                axes.push_back(list.value(b, a));
            }
            eye.emplace_back(mandrel_from_eye(first_.machine, joints_at(list, b)).translation());
            const bool known = block.piece >= 0 && block.point >= 0;
            station.push_back(known ? static_cast<std::int32_t>(
                                          shown.shown(static_cast<std::size_t>(block.piece),
                                                      static_cast<std::size_t>(block.point)))
                                    : -1);
            line.push_back(has_lines ? static_cast<std::uint32_t>(made.read.blocks[b].line) : 0U);
        }
        arrays_.add<double>(prefix + "time_s", 1, time_s);
        arrays_.add_floats(prefix + "asked_s", asked_s);
        arrays_.add<double>(prefix + "axes", list.axes.size(), axes);
        arrays_.add_points(prefix + "eye_mm", eye, kShownLength_mm);
        arrays_.add<std::int32_t>(prefix + "station", 1, station);
        arrays_.add<std::uint32_t>(prefix + "line", 1, line);
    }

    json extension_json() {
        TriangleSoup all;
        for (const Rim& rim : first_.mandrel.rims) {
            if (first_.job.mandrel.extension_mm > 0.0) {
                const TriangleSoup one = extension_of(rim, first_.job.mandrel.extension_mm);
                append(all, one);
            }
        }
        for (const PinRing& ring : first_.pins) {
            for (const Pin& pin : pins_of(ring, first_.mandrel.rims[std::size_t(ring.rim)])) {
                append(all, mesh_of(pin));
            }
        }
        if (all.faces.empty()) {
            return nullptr;
        }
        return add_mesh("extension", all);
    }

    static void append(TriangleSoup& all, const TriangleSoup& one) {
        const auto before = static_cast<std::int32_t>(all.points_mm.size());
        all.points_mm.insert(all.points_mm.end(), one.points_mm.begin(), one.points_mm.end());
        for (const auto& [a, b, c] : one.faces) {
            all.faces.push_back({a + before, b + before, c + before});
        }
    }

    json add_mesh(const std::string& name, const TriangleSoup& mesh) {
        arrays_.add_points(name + "/points", mesh.points_mm);
        arrays_.add_faces(name + "/faces", mesh.faces);
        return {{"points", name + "/points"}, {"faces", name + "/faces"}};
    }

    json machine_json() {
        const Machine& machine = first_.machine;
        json envelope = json::array();
        for (const EnvelopePart& part : machine.eye.envelope) {
            envelope.push_back(shape_json(part.shape));
            envelope.back()["link"] = std::string(1, part.link);
        }
        json bodies = json::array();
        for (const MachineBody& body : machine.bodies) {
            bodies.push_back(shape_json(body.shape));
            bodies.back()["link"] = body.link ? json(std::string(1, *body.link)) : json(nullptr);
        }
        json report = {{"name", machine.name},
                       {"mandrel_chain", chain_json(machine.mandrel_chain)},
                       {"eye_chain", chain_json(machine.eye_chain)},
                       {"mount", nullptr},
                       {"eye",
                        {{"position", vector_json(machine.eye.position_mm)},
                         {"roller", vector_json(machine.eye.roller)},
                         {"exit", vector_json(machine.eye.exit)},
                         {"envelope", envelope}}},
                       {"bodies", bodies},
                       {"fibre",
                        {{"min_free_length", machine.fibre.min_free_length_mm},
                         {"max_free_length", machine.fibre.max_free_length_mm},
                         {"max_speed", machine.fibre.max_speed_mm_s}}}};
        if (machine.mount) {
            report["mount"] = {{"origin", vector_json(machine.mount->origin_mm)},
                               {"x", vector_json(machine.mount->x)},
                               {"z", vector_json(machine.mount->z)}};
        }
        return report;
    }

    json shape_json(const std::variant<Capsule, EnvelopeMesh>& shape) {
        if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
            return {{"type", "capsule"},
                    {"from", vector_json(capsule->from_mm)},
                    {"to", vector_json(capsule->to_mm)},
                    {"radius", capsule->radius_mm}};
        }
        json report = add_mesh("machine/mesh" + std::to_string(++meshes_),
                               std::get<EnvelopeMesh>(shape).triangles);
        report["type"] = "mesh";
        return report;
    }

    static json chain_json(const std::vector<Axis>& chain) {
        json report = json::array();
        for (const Axis& axis : chain) {
            const bool rotary = axis.type == AxisType::Rotary;
            const auto shown = [rotary](double value) {
                return limit_json(rotary ? deg_from_rad(value) : value);
            };
            report.push_back({{"letter", std::string(1, axis.letter)},
                              {"type", rotary ? "rotary" : "linear"},
                              {"direction", vector_json(axis.direction)},
                              {"point", vector_json(axis.point_mm)},
                              {"min", shown(axis.min)},
                              {"max", shown(axis.max)},
                              {"velocity", shown(axis.velocity)},
                              {"acceleration", shown(axis.acceleration)}});
        }
        return report;
    }

    const Run& run_;
    const Layup& layup_;
    const Setup& first_;
    PageArrays arrays_;
    std::size_t station_every_ = 1;  // in the page
    std::size_t block_every_ = 1;
    std::size_t text_ = 0;  // of all programs
    int meshes_ = 0;
};

}  // namespace

std::string page_data(const Run& run, const Layup& layup, json report) {
    return PageData(run, layup).text(std::move(report));
}

}  // namespace meshwind
