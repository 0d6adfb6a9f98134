#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/text/csv_table.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/profile/profile_file.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

constexpr CsvErrors kErrors = {"profile.column", "profile.number",
                               "write columns x and r, or x_mm and r_mm, in the first line"};

constexpr std::size_t kMaxPoints = 100'000;

// Where the outline turns by more at one point, it is no smooth curve.
constexpr double kCreaseTurn_rad = 30.0 * kPi / 180.0;

// A chord that is so many times as long as those beside it is a line: points of a curve are spread
// evenly, or closer where it is bent more.
constexpr double kLongChord = 3.0;

// Chords that turn by less lie on one line.
constexpr double kSameLine_rad = 1e-9;

// Beside a line: what the first chord of a curve may turn more than the next one does. A curve that
// starts along the line turns by half of that at its first point.
constexpr double kSpareTurn_rad = 1.0 * kPi / 180.0;

// Two lines that turn by more meet in a crease.
constexpr double kLinesTurn_rad = 0.5 * kPi / 180.0;

struct OutlinePoint {
    Vector2d at;  // radius, along the axis
    bool crease = false;
    bool line = false;  // to the next point
    int row = 0;        // of the file
};

class Outline {
public:
    Outline(std::string_view text, const std::string& file)
        : file_(file), table_(text, file, kErrors) {
        read();
        if (points_.size() < 2) {
            throw InputError(
                "profile.points", file_,
                "has " + std::to_string(points_.size()) + " points; a profile needs two or more");
        }
        go_up();
        find_lines();
    }

    [[nodiscard]] ProfileFile profile() const {
        ProfileFile profile;
        profile.stated_unit_mm = in_mm_ ? 1.0 : 0.0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            MeridianNode& node = profile.nodes.emplace_back();
            node.radius_mm = points_[i].at.x();
            node.z_mm = points_[i].at.y();
            node.crease = is_crease(i);
            node.straight = i + 1 < points_.size() && points_[i].line;
        }
        return profile;
    }

private:
    void read() {
        in_mm_ = table_.find("x_mm").has_value();
        const std::size_t x = table_.column(in_mm_ ? "x_mm" : "x");
        const std::size_t r = table_.column(in_mm_ ? "r_mm" : "r");
        const auto crease = table_.find("crease");
        const auto line = table_.find("line");
        while (table_.next()) {
            OutlinePoint point{.at = {table_.number(r), table_.number(x)}, .row = table_.line()};
            point.crease = crease && flag(*crease);
            point.line = line && flag(*line);
            check(point);
            points_.push_back(point);
        }
    }

    [[nodiscard]] bool flag(std::size_t column) const {
        const double value = table_.number(column);
        if (value != 0.0 && value != 1.0) {
            table_.fail("profile.number", "has " + fixed(value, 3) +
                                              " where 1 says yes and 0 says no; write one of them");
        }
        return value == 1.0;
    }

    void check(const OutlinePoint& point) const {
        if (point.at.x() < 0.0) {
            table_.fail("profile.radius", "has a radius of " + fixed(point.at.x(), 3) +
                                              "; give the distance from the axis");
        }
        if (points_.empty()) {
            return;
        }
        if (points_.size() == kMaxPoints) {
            table_.fail("profile.points", "is the point after 100,000; give fewer");
        }
        if (point.at == points_.back().at) {
            table_.fail(
                "profile.same_point",
                "is the same point as line " + std::to_string(points_.back().row) + "; remove one");
        }
        if (points_.size() > 1 && points_.back().at.x() == 0.0) {
            throw InputError("profile.radius", file_ + ":" + std::to_string(points_.back().row),
                             "lies on the axis between the ends; end the profile there");
        }
    }

    // Outside is on the right of the way up.
    void go_up() {
        const double rise = points_.back().at.y() - points_.front().at.y();
        if (rise == 0.0) {
            throw InputError("profile.ends", file_,
                             "begins and ends at the same place along the axis; give an outline "
                             "from one end to the other");
        }
        if (rise > 0.0) {
            return;
        }
        std::reverse(points_.begin(), points_.end());
        for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
            points_[i].line = points_[i + 1].line;
        }
        points_.back().line = false;
    }

    [[nodiscard]] Vector2d chord(std::size_t i) const { return points_[i + 1].at - points_[i].at; }

    // At a point between the ends, without sign.
    [[nodiscard]] double turn_rad(std::size_t i) const {
        const Vector2d a = chord(i - 1);
        const Vector2d b = chord(i);
        return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
    }

    void find_lines() {
        const std::size_t chords = points_.size() - 1;
        for (std::size_t i = 0; i < chords; ++i) {
            const double before = i > 0 ? chord(i - 1).norm() : 0.0;
            const double behind = i + 1 < chords ? chord(i + 1).norm() : 0.0;
            const bool same_line = (i > 0 && turn_rad(i) < kSameLine_rad) ||
                                   (i + 1 < chords && turn_rad(i + 1) < kSameLine_rad);
            points_[i].line = points_[i].line || same_line ||
                              chord(i).norm() > kLongChord * std::max(before, behind);
        }
    }

    [[nodiscard]] bool is_crease(std::size_t i) const {
        if (i == 0 || i + 1 == points_.size()) {
            return false;
        }
        const double turn = turn_rad(i);
        if (points_[i].crease || turn > kCreaseTurn_rad) {
            return true;
        }
        const bool before = points_[i - 1].line;
        const bool behind = points_[i].line;
        if (before == behind) {
            return before && turn > kLinesTurn_rad;
        }
        // A line beside a curve: as much as the curve's own next turn is along the line.
        const std::size_t next = before ? i + 1 : i - 1;
        const double own = next > 0 && next + 1 < points_.size() ? turn_rad(next) : 0.0;
        return turn > own + kSpareTurn_rad;
    }

    std::string file_;
    CsvTable table_;
    bool in_mm_ = false;
    std::vector<OutlinePoint> points_;
};

}  // namespace

ProfileFile read_profile_csv(std::string_view text, const std::string& file) {
    return Outline(text, file).profile();
}

}  // namespace meshwind
