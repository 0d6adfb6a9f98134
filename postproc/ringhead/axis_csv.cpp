#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

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
constexpr double kLeastDirection = 0.5;

// From farther away than 1 km a position in double precision is no longer good to 1e-9 mm steps.
constexpr double kFarthest_mm = 1e6;

class AxisReader {
public:
    AxisReader(std::string_view text, const std::string& file) : rest_(text), file_(file) {
        next();
        if (cells_.size() == 1 && cells_[0].empty()) {
            fail("axis.column", "is empty; the first line names the columns, x_mm,y_mm,z_mm");
        }
        names_ = cells_;
        for (const std::string_view name : names_) {
            if (std::find(kNames.begin(), kNames.end(), name) == kNames.end()) {
                fail("axis.column", "column '" + std::string(name) +
                                        "' is not known; there are x_mm,y_mm,z_mm, tx,ty,tz, "
                                        "rx,ry,rz and turn_deg");
            }
            if (std::count(names_.begin(), names_.end(), name) > 1) {
                fail("axis.column", "column '" + std::string(name) + "' stands twice; remove one");
            }
        }
        for (std::size_t i = 0; i < kNames.size(); ++i) {
            const auto found = std::find(names_.begin(), names_.end(), kNames[i]);
            column_[i] = static_cast<std::size_t>(found - names_.begin());
        }
        needs_all_of(0, true);
        needs_all_of(kTangent, false);
        needs_all_of(kReference, false);
    }

    FrameAxis read() {
        while (next()) {
            read_line();
        }
        if (stations_.size() < 2) {
            fail("axis.too_few",
                 "has " + std::to_string(stations_.size()) + " points; an axis has two or more");
        }
        set_tangents();
        set_references();
        return FrameAxis(std::move(stations_));
    }

private:
    [[nodiscard]] bool has(std::size_t name) const { return column_[name] < names_.size(); }

    void needs_all_of(std::size_t first, bool must) const {
        const int count = int(has(first)) + int(has(first + 1)) + int(has(first + 2));
        if (count == 3 || (count == 0 && !must)) {
            return;
        }
        for (std::size_t i = first; i < first + 3; ++i) {
            if (!has(i)) {
                fail("axis.column", "has no column '" + std::string(kNames[i]) + "'; add it" +
                                        (must ? "" : ", or remove the other two"));
            }
        }
    }

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

    [[nodiscard]] double number(std::size_t name) const {
        const std::string_view cell = cells_[column_[name]];
        double value = 0.0;
        const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value) ||
            std::abs(value) > kFarthest_mm) {
            fail("axis.number", "'" + std::string(cell) + "' in column " +
                                    std::string(kNames[name]) +
                                    " is not a number within +-1e6; mend it");
        }
        return value;
    }

    [[nodiscard]] Vector3d vector(std::size_t first) const {
        return {number(first), number(first + 1), number(first + 2)};
    }

    [[nodiscard]] Vector3d direction(std::size_t first, const char* code) const {
        const Vector3d v = vector(first);
        if (v.norm() < kLeastDirection) {
            fail(code, std::string(kNames[first]) + " and the two beside it have the length " +
                           std::to_string(v.norm()) + "; give a unit vector");
        }
        return v.normalized();
    }

    void read_line() {
        if (cells_.size() != names_.size()) {
            fail("axis.number", "has " + std::to_string(cells_.size()) + " cells, the first line " +
                                    std::to_string(names_.size()) + "; one for each column");
        }
        AxisStation station{.point_mm = vector(0)};
        if (!stations_.empty() &&
            (station.point_mm - stations_.back().point_mm).norm() < kSamePoint_mm) {
            fail("axis.same_point", "is the point of the line before; remove one");
        }
        if (has(kTangent)) {
            station.tangent = direction(kTangent, "axis.tangent");
        }
        if (has(kReference)) {
            station.reference = direction(kReference, "axis.reference");
        }
        station.turn_rad = has(kTurn) ? rad_from_deg(number(kTurn)) : 0.0;
        stations_.push_back(station);
        line_of_.push_back(line_);
    }

    void set_tangents() {
        std::vector<Vector3d> points;
        for (const AxisStation& station : stations_) {
            points.push_back(station.point_mm);
        }
        if (!has(kTangent)) {
            const std::vector<Vector3d> tangents = parabola_tangents(points);
            for (std::size_t i = 0; i < points.size(); ++i) {
                stations_[i].tangent = tangents[i];
            }
        }
        for (std::size_t i = 1; i < points.size(); ++i) {
            const Vector3d chord = points[i] - points[i - 1];
            for (const std::size_t end : {i - 1, i}) {
                if (!(stations_[end].tangent.dot(chord) > 0.0)) {
                    line_ = line_of_[end];
                    fail("axis.tangent",
                         "the axis turns by a right angle or more beside this point; give its "
                         "bends in smaller steps, tangents towards the next point");
                }
            }
        }
    }

    void set_references() {
        if (!has(kReference)) {
            const Vector3d& first = stations_.front().tangent;
            Eigen::Index least = 0;
            first.cwiseAbs().minCoeff(&least);
            stations_.front().reference = square_to(first, Vector3d::Unit(least));
            for (std::size_t i = 1; i < stations_.size(); ++i) {
                const AxisStation& from = stations_[i - 1];
                AxisStation& to = stations_[i];
                to.reference = carried_reference(from.point_mm, from.tangent, to.point_mm,
                                                 to.tangent, from.reference);
            }
            return;
        }
        for (std::size_t i = 0; i < stations_.size(); ++i) {
            AxisStation& station = stations_[i];
            if (std::abs(station.tangent.dot(station.reference)) > kRightAngleCosine) {
                line_ = line_of_[i];
                fail("axis.reference", "rx,ry,rz is " +
                                           std::to_string(deg_from_rad(std::acos(
                                               std::abs(station.tangent.dot(station.reference))))) +
                                           " deg from the tangent; give it at a right angle");
            }
            station.reference = square_to(station.tangent, station.reference);
        }
    }

    static Vector3d square_to(const Vector3d& tangent, const Vector3d& v) {
        return (v - v.dot(tangent) * tangent).normalized();
    }

    [[noreturn]] void fail(const char* code, const std::string& words) const {
        throw InputError(code, file_ + ":" + std::to_string(line_), words);
    }

    std::string_view rest_;
    std::string file_;
    int line_ = 0;
    std::vector<std::string_view> names_;
    std::vector<std::string_view> cells_;
    std::array<std::size_t, kNames.size()> column_{};
    std::vector<AxisStation> stations_;
    std::vector<int> line_of_;
};

}  // namespace

FrameAxis read_axis_csv(std::string_view text, const std::string& file) {
    return AxisReader(text, file).read();
}

}  // namespace meshwind
