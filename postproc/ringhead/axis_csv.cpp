#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/units.h"
#include "postproc/ringhead/frame_axis.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::array<std::string_view, 10> kNames = {"x_mm", "y_mm", "z_mm", "tx", "ty",
                                                     "tz",   "rx",   "ry",   "rz", "turn_deg"};
constexpr std::size_t kTangent = 3;
constexpr std::size_t kReference = 6;
constexpr std::size_t kTurn = 9;

// Cosine up to which a reference counts as at a right angle to the tangent (0.06 deg): directions
// with three decimals pass, and what is left is taken away.
constexpr double kRightAngleCosine = 1e-3;

// The shortest vector that still says a direction: directions are unit vectors with a few decimals.
constexpr double kMinDirection = 0.5;

// From farther away than 1 km a position in double precision is no longer good to 1e-9 mm steps.
constexpr double kFarthest_mm = 1e6;

// The lines of a table, cell by cell.
class AxisLines {
public:
    AxisLines(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {}

    // Goes to the next line; false at the end.
    bool next() {
        if (rest_.empty() && line_ > 0) {
            return false;
        }
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        if (!line.empty() && line.back() == '\r') {
            line.remove_suffix(1);
        }
        ++line_;
        cells_.clear();
        for (;;) {
            const std::size_t comma = line.find(',');
            cells_.push_back(line.substr(0, comma));
            if (comma == std::string_view::npos) {
                return true;
            }
            line.remove_prefix(comma + 1);
        }
    }

    [[nodiscard]] const std::vector<std::string_view>& cells() const { return cells_; }
    [[nodiscard]] int line() const { return line_; }

    // At the line that was read last.
    [[noreturn]] void fail(const char* code, const std::string& words) const {
        fail_at(line_, code, words);
    }

    [[noreturn]] void fail_at(int line, const char* code, const std::string& words) const {
        throw InputError(code, file_ + ":" + std::to_string(line), words);
    }

private:
    std::string_view rest_;
    std::string file_;
    int line_ = 0;
    std::vector<std::string_view> cells_;
};

// Where the columns of kNames stand; those that the table lacks are beyond the last.
struct AxisColumns {
    std::size_t count = 0;
    std::array<std::size_t, kNames.size()> of_name{};

    [[nodiscard]] bool has(std::size_t name) const { return of_name[name] < count; }
};

// Three columns, or none of them unless they must be there.
void require_all_of(std::size_t first, bool must, const AxisColumns& columns,
                    const AxisLines& lines) {
    const int count =
        int(columns.has(first)) + int(columns.has(first + 1)) + int(columns.has(first + 2));
    if (count == 3 || (count == 0 && !must)) {
        return;
    }
    for (std::size_t i = first; i < first + 3; ++i) {
        if (!columns.has(i)) {
            lines.fail("axis.column", "has no column '" + std::string(kNames[i]) + "'; add it" +
                                          (must ? "" : ", or remove the other two"));
        }
    }
}

// Of the first line.
AxisColumns read_columns(AxisLines& lines) {
    lines.next();
    const std::vector<std::string_view>& names = lines.cells();
    if (names.size() == 1 && names[0].empty()) {
        lines.fail("axis.column", "is empty; the first line names the columns, x_mm,y_mm,z_mm");
    }
    for (const std::string_view name : names) {
        if (std::find(kNames.begin(), kNames.end(), name) == kNames.end()) {
            lines.fail("axis.column", "column '" + std::string(name) +
                                          "' is not known; there are x_mm,y_mm,z_mm, tx,ty,tz, "
                                          "rx,ry,rz and turn_deg");
        }
        if (std::count(names.begin(), names.end(), name) > 1) {
            lines.fail("axis.column",
                       "column '" + std::string(name) + "' stands twice; remove one");
        }
    }
    AxisColumns columns{.count = names.size()};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        const auto found = std::find(names.begin(), names.end(), kNames[i]);
        columns.of_name[i] = static_cast<std::size_t>(found - names.begin());
    }
    require_all_of(0, true, columns, lines);
    require_all_of(kTangent, false, columns, lines);
    require_all_of(kReference, false, columns, lines);
    return columns;
}

double number_in(const AxisLines& lines, const AxisColumns& columns, std::size_t name) {
    const std::string_view cell = lines.cells()[columns.of_name[name]];
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value) ||
        std::abs(value) > kFarthest_mm) {
        lines.fail("axis.number", "'" + std::string(cell) + "' in column " +
                                      std::string(kNames[name]) +
                                      " is not a number within +-1e6; mend it");
    }
    return value;
}

Vector3d vector_in(const AxisLines& lines, const AxisColumns& columns, std::size_t first) {
    return {number_in(lines, columns, first), number_in(lines, columns, first + 1),
            number_in(lines, columns, first + 2)};
}

Vector3d direction_in(const AxisLines& lines, const AxisColumns& columns, std::size_t first,
                      const char* code) {
    const Vector3d v = vector_in(lines, columns, first);
    if (v.norm() < kMinDirection) {
        lines.fail(code, std::string(kNames[first]) + " and the two beside it have the length " +
                             std::to_string(v.norm()) + "; give a unit vector");
    }
    return v.normalized();
}

// \param before the station of the line before; null for the first
AxisStation read_station(const AxisLines& lines, const AxisColumns& columns,
                         const AxisStation* before) {
    if (lines.cells().size() != columns.count) {
        lines.fail("axis.number", "has " + std::to_string(lines.cells().size()) +
                                      " cells, the first line " + std::to_string(columns.count) +
                                      "; one for each column");
    }
    AxisStation station{.point_mm = vector_in(lines, columns, 0)};
    if (before != nullptr && (station.point_mm - before->point_mm).norm() < kSamePoint_mm) {
        lines.fail("axis.same_point", "is the point of the line before; remove one");
    }
    if (columns.has(kTangent)) {
        station.tangent = direction_in(lines, columns, kTangent, "axis.tangent");
    }
    if (columns.has(kReference)) {
        station.reference = direction_in(lines, columns, kReference, "axis.reference");
    }
    station.turn_rad = columns.has(kTurn) ? rad_from_deg(number_in(lines, columns, kTurn)) : 0.0;
    return station;
}

struct AxisTable {
    AxisColumns columns;
    std::vector<AxisStation> stations;
    std::vector<int> line_of;  // per station
};

AxisTable read_table(AxisLines& lines) {
    AxisTable table{.columns = read_columns(lines), .stations = {}, .line_of = {}};
    std::vector<AxisStation>& stations = table.stations;
    while (lines.next()) {
        stations.push_back(
            read_station(lines, table.columns, stations.empty() ? nullptr : &stations.back()));
        table.line_of.push_back(lines.line());
    }
    if (stations.size() < 2) {
        lines.fail("axis.too_few",
                   "has " + std::to_string(stations.size()) + " points; an axis has two or more");
    }
    return table;
}

std::vector<Vector3d> points_of(const std::vector<AxisStation>& stations) {
    std::vector<Vector3d> points;
    points.reserve(stations.size());
    for (const AxisStation& station : stations) {
        points.push_back(station.point_mm);
    }
    return points;
}

// Tangents that the table does not give are those of parabolas through its points.
void set_tangents(std::vector<AxisStation>& stations) {
    const std::vector<Vector3d> tangents = parabola_tangents(points_of(stations));
    for (std::size_t i = 0; i < stations.size(); ++i) {
        stations[i].tangent = tangents[i];
    }
}

void require_small_turns(const AxisTable& table, const AxisLines& lines) {
    const std::vector<AxisStation>& stations = table.stations;
    for (std::size_t i = 1; i < stations.size(); ++i) {
        const Vector3d chord = stations[i].point_mm - stations[i - 1].point_mm;
        for (const std::size_t end : {i - 1, i}) {
            if (!(stations[end].tangent.dot(chord) > 0.0)) {
                lines.fail_at(table.line_of[end], "axis.tangent",
                              "the axis turns by a right angle or more beside this point; give its "
                              "bends in smaller steps, tangents towards the next point");
            }
        }
    }
}

Vector3d square_to(const Vector3d& tangent, const Vector3d& v) {
    return (v - v.dot(tangent) * tangent).normalized();
}

// References that the table does not give are carried along the axis without turning about it.
void carry_references(std::vector<AxisStation>& stations) {
    const Vector3d& first = stations.front().tangent;
    Eigen::Index least = 0;
    first.cwiseAbs().minCoeff(&least);
    stations.front().reference = square_to(first, Vector3d::Unit(least));
    for (std::size_t i = 1; i < stations.size(); ++i) {
        const AxisStation& from = stations[i - 1];
        AxisStation& to = stations[i];
        to.reference =
            carried_reference(from.point_mm, from.tangent, to.point_mm, to.tangent, from.reference);
    }
}

// Those of the table to an exact right angle; refused where they are far from it.
void square_references(AxisTable& table, const AxisLines& lines) {
    for (std::size_t i = 0; i < table.stations.size(); ++i) {
        AxisStation& station = table.stations[i];
        if (std::abs(station.tangent.dot(station.reference)) > kRightAngleCosine) {
            lines.fail_at(table.line_of[i], "axis.reference",
                          "rx,ry,rz is " +
                              std::to_string(deg_from_rad(
                                  std::acos(std::abs(station.tangent.dot(station.reference))))) +
                              " deg from the tangent; give it at a right angle");
        }
        station.reference = square_to(station.tangent, station.reference);
    }
}

}  // namespace

FrameAxis read_axis_csv(std::string_view text, const std::string& file) {
    AxisLines lines(text, file);
    AxisTable table = read_table(lines);
    if (!table.columns.has(kTangent)) {
        set_tangents(table.stations);
    }
    require_small_turns(table, lines);
    if (table.columns.has(kReference)) {
        square_references(table, lines);
    } else {
        carry_references(table.stations);
    }
    return FrameAxis(std::move(table.stations));
}

}  // namespace meshwind
