#include "postproc/ringhead/ring_cover.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Of the tube's curvature: below that an arm is straight, curvatures of rounding are 1e-10.
constexpr double kStraightShare = 1e-6;
// Of a tow's width: bands that touch cover what is between them.
constexpr double kTouchShare = 1e-9;

struct Span {
    double from_mm = 0.0;
    double to_mm = 0.0;
};

std::vector<Span> bends_of(const TubeSurface& tube) {
    std::vector<Span> bends;
    const int count = static_cast<int>(std::floor(tube.length_mm() / kCurvatureStep_mm));
    bool inside = false;
    for (int i = 0; i <= count; ++i) {
        const double s = i * kCurvatureStep_mm;
        const bool bent = tube.axis_curvature(s).norm() * tube.radius_mm() > kStraightShare;
        if (bent && !inside) {
            bends.push_back({s, s});
        } else if (bent) {
            bends.back().to_mm = s;
        }
        inside = bent;
    }
    return bends;
}

// How far a place is from the nearest bend; 0 within one.
double from_bends(const std::vector<Span>& bends, double s_mm) {
    double least = std::numeric_limits<double>::infinity();
    for (const Span& bend : bends) {
        least = std::min(least, std::max({0.0, bend.from_mm - s_mm, s_mm - bend.to_mm}));
    }
    return least;
}

struct Crossing {
    double round_rad = 0.0;  // 0 .. 2 pi
    double angle_rad = 0.0;  // from the axis, >= 0
};

// Finds where a fibre crosses one row after the other.
class Walk {
public:
    explicit Walk(const RingFibre& fibre) : points_(fibre.points) {
        forth_ = points_.back().s_mm >= points_.front().s_mm;
        next_ = forth_ ? 1 : points_.size() - 1;
    }

    // \pre rows ascend
    std::optional<Crossing> at(double s_mm) {
        while (next_ > 0 && next_ < points_.size() && high().s_mm < s_mm) {
            forth_ ? ++next_ : --next_;
        }
        if (next_ == 0 || next_ == points_.size() || low().s_mm > s_mm) {
            return std::nullopt;
        }
        const double length = high().s_mm - low().s_mm;
        const double share = length > 0.0 ? (s_mm - low().s_mm) / length : 0.0;
        const double round = low().round_rad + share * (high().round_rad - low().round_rad);
        const double angle = low().angle_rad + share * (high().angle_rad - low().angle_rad);
        return Crossing{round - 2.0 * kPi * std::floor(round / (2.0 * kPi)),
                        std::acos(std::abs(std::cos(angle)))};
    }

private:
    [[nodiscard]] const LaidRingPoint& low() const { return points_[forth_ ? next_ - 1 : next_]; }
    [[nodiscard]] const LaidRingPoint& high() const { return points_[forth_ ? next_ : next_ - 1]; }

    const std::vector<LaidRingPoint>& points_;
    bool forth_ = true;
    std::size_t next_ = 1;
};

struct Cell {
    bool covered = false;
    double apart_mm = 0.0;  // of the curves on both sides
    double layers = 0.0;
};

// One ring's fibres around one row.
std::vector<Cell> cells_of(std::vector<Crossing> crossings, double radius_mm, double width_mm) {
    std::vector<Cell> cells(kCoverCells);
    if (crossings.empty()) {
        return cells;
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.round_rad < b.round_rad; });
    std::size_t above = 0;
    for (int i = 0; i < kCoverCells; ++i) {
        const double round = 2.0 * kPi * (i + 0.5) / kCoverCells;
        while (above < crossings.size() && crossings[above].round_rad < round) {
            ++above;
        }
        const bool wrap_low = above == 0;
        const bool wrap_high = above == crossings.size();
        const Crossing& low = wrap_low ? crossings.back() : crossings[above - 1];
        const Crossing& high = wrap_high ? crossings.front() : crossings[above];
        const double low_rad = low.round_rad - (wrap_low ? 2.0 * kPi : 0.0);
        const double high_rad = high.round_rad + (wrap_high ? 2.0 * kPi : 0.0);
        const double reach_mm = (0.5 + kTouchShare) * width_mm;
        Cell& cell = cells[static_cast<std::size_t>(i)];
        cell.covered = radius_mm * (round - low_rad) * std::cos(low.angle_rad) <= reach_mm ||
                       radius_mm * (high_rad - round) * std::cos(high.angle_rad) <= reach_mm;
        // So wide that bands of this width about both curves touch.
        const double apart_mm = 2.0 * radius_mm * (high_rad - low_rad) /
                                (1.0 / std::cos(low.angle_rad) + 1.0 / std::cos(high.angle_rad));
        cell.apart_mm = apart_mm;
        // Curves that cross have no distance; there one tow lies on another.
        cell.layers = apart_mm > 0.0
                          ? std::min(width_mm / apart_mm, static_cast<double>(crossings.size()))
                          : static_cast<double>(crossings.size());
    }
    return cells;
}

struct Mean {
    double weight = 0.0;
    double sum = 0.0;
    double squares = 0.0;

    void add(double value, double part = 1.0) {
        weight += part;
        sum += part * value;
        squares += part * value * value;
    }
    [[nodiscard]] double mean() const { return weight > 0.0 ? sum / weight : 0.0; }
    [[nodiscard]] double cv() const {
        if (!(weight > 0.0) || !(sum > 0.0)) {
            return 0.0;
        }
        return std::sqrt(std::max(0.0, squares / weight - mean() * mean())) / mean();
    }
};

bool in_middle(const std::vector<Span>& bends, double s_mm) {
    return std::any_of(bends.begin(), bends.end(), [&](const Span& bend) {
        const double quarter = 0.25 * (bend.to_mm - bend.from_mm);
        return s_mm >= bend.from_mm + quarter && s_mm <= bend.to_mm - quarter;
    });
}

// Sums over the rows of the zone.
struct Sums {
    Mean covered;
    Mean layers;
    Mean regular;
    Mean inside;
    Mean outside;
};

std::size_t cell_at(double round_rad) {
    const double turns = round_rad / (2.0 * kPi);
    const int cell = static_cast<int>(kCoverCells * (turns - std::floor(turns)));
    return static_cast<std::size_t>(std::min(cell, kCoverCells - 1));
}

// Slip of one fibre at its stations, over chords of a given length.
class Chords {
public:
    Chords(const RingFibre& fibre, double length_mm) : points_(fibre.points), length_(length_mm) {
        along_.push_back(0.0);
        for (std::size_t i = 1; i < points_.size(); ++i) {
            along_.push_back(along_.back() +
                             (points_[i].point_mm - points_[i - 1].point_mm).norm());
        }
    }

    // Nothing nearer than a chord to an end. \pre i ascends
    std::optional<double> slip(std::size_t i) {
        while (low_ + 1 < i && along_[i] - along_[low_ + 1] >= length_) {
            ++low_;
        }
        while (high_ < points_.size() && along_[high_] - along_[i] < length_) {
            ++high_;
        }
        if (along_[i] - along_[low_] < length_ || high_ == points_.size()) {
            return std::nullopt;
        }
        const Vector3d before = points_[i].point_mm - points_[low_].point_mm;
        const Vector3d after = points_[high_].point_mm - points_[i].point_mm;
        const Vector3d bend =
            (after.normalized() - before.normalized()) / (0.5 * (before.norm() + after.norm()));
        const Vector3d& normal = points_[i].normal;
        const Vector3d along = (before.normalized() + after.normalized()).normalized();
        const double kn = -bend.dot(normal);
        const double kg = bend.dot(normal.cross(along));
        // Over a hollow nothing presses; that is a bridge.
        return kn > 0.0 ? std::optional(std::abs(kg) / kn) : std::nullopt;
    }

private:
    const std::vector<LaidRingPoint>& points_;
    double length_;
    std::vector<double> along_;
    std::size_t low_ = 0;
    std::size_t high_ = 0;
};

}  // namespace

RingCover ring_cover(const TubeSurface& tube, const std::vector<RingFibre>& fibres,
                     const RingCoverTask& task) {
    assert(task.from_mm < task.to_mm && task.tow_width_mm > 0.0);
    const std::vector<Span> bends = bends_of(tube);
    std::vector<Walk> walks(fibres.begin(), fibres.end());
    const int rows = std::max(1, static_cast<int>((task.to_mm - task.from_mm) / kCoverRow_mm));
    Sums sums;
    RingCover cover;
    for (int row = 0; row < rows; ++row) {
        const double s = task.from_mm + (task.to_mm - task.from_mm) * (row + 0.5) / rows;
        std::array<std::vector<Crossing>, 2> crossings;
        for (std::size_t i = 0; i < fibres.size(); ++i) {
            if (const auto crossing = walks[i].at(s)) {
                crossings[static_cast<std::size_t>(fibres[i].ring)].push_back(*crossing);
            }
        }
        const auto first = cells_of(crossings[0], tube.radius_mm(), task.tow_width_mm);
        const auto second = cells_of(crossings[1], tube.radius_mm(), task.tow_width_mm);
        const AxisFrame frame = tube.axis_at(s);
        const Vector3d curvature = tube.axis_curvature(s);
        const double x = curvature.dot(frame.reference);
        const double y = curvature.dot(frame.tangent.cross(frame.reference));
        const bool regular = from_bends(bends, s) > task.settle_mm;
        cover.regular_mm += regular ? (task.to_mm - task.from_mm) / rows : 0.0;
        const auto layers = [&](std::size_t i) { return first[i].layers + second[i].layers; };
        for (std::size_t i = 0; i < first.size(); ++i) {
            const double round = 2.0 * kPi * (static_cast<double>(i) + 0.5) / kCoverCells;
            const double area =
                1.0 - tube.radius_mm() * (x * std::cos(round) + y * std::sin(round));
            sums.covered.add(first[i].covered && second[i].covered ? 1.0 : 0.0, area);
            sums.layers.add(layers(i), area);
            cover.widest_mm = std::max({cover.widest_mm, first[i].apart_mm, second[i].apart_mm});
            if (regular) {
                sums.regular.add(layers(i));
            }
        }
        if (in_middle(bends, s)) {
            const double inside = std::atan2(y, x);
            sums.inside.add(layers(cell_at(inside)));
            sums.outside.add(layers(cell_at(inside + kPi)));
        }
    }
    cover.covered = sums.covered.mean();
    cover.mean_layers = sums.layers.mean();
    cover.regular_cv = sums.regular.cv();
    cover.inside_layers = sums.inside.mean();
    cover.outside_layers = sums.outside.mean();
    return cover;
}

RingQuality ring_quality(const TubeSurface& tube, const std::vector<RingFibre>& fibres,
                         const RingCoverTask& task) {
    const std::vector<Span> bends = bends_of(tube);
    RingQuality worst;
    worst.outside_rad = 0.5 * kPi;
    for (const RingFibre& fibre : fibres) {
        Chords chords(fibre, task.tow_width_mm);
        const double low = std::min(fibre.points.front().s_mm, fibre.points.back().s_mm);
        const double high = std::max(fibre.points.front().s_mm, fibre.points.back().s_mm);
        worst.ends_short_mm =
            std::max({worst.ends_short_mm, low - task.from_mm, task.to_mm - high});
        for (std::size_t i = 0; i < fibre.points.size(); ++i) {
            const LaidRingPoint& point = fibre.points[i];
            if (point.s_mm < task.from_mm || point.s_mm > task.to_mm) {
                continue;
            }
            const double angle = std::acos(std::abs(std::cos(point.angle_rad)));
            const double away = from_bends(bends, point.s_mm);
            if (away > task.settle_mm) {
                const double off = std::abs(angle - task.angle_rad);
                if (off > worst.arm_off_rad) {
                    worst.arm_off_rad = off;
                    worst.arm_s_mm = point.s_mm;
                }
            } else {
                const double off =
                    std::abs(angle - std::atan(std::tan(task.angle_rad) / point.stretch));
                if (off > worst.bend_off_rad) {
                    worst.bend_off_rad = off;
                    worst.bend_s_mm = point.s_mm;
                }
                worst.inside_rad = std::max(worst.inside_rad, angle);
                worst.outside_rad = std::min(worst.outside_rad, angle);
            }
            if (point.kn_per_mm < worst.least_kn_per_mm) {
                worst.least_kn_per_mm = point.kn_per_mm;
                worst.least_kn_s_mm = point.s_mm;
            }
            const auto slip = chords.slip(i);
            if (slip && *slip > worst.slip) {
                worst.slip = *slip;
                worst.slip_s_mm = point.s_mm;
            }
        }
    }
    return worst;
}

double tightest_bend_mm(const TubeSurface& tube) {
    double curvature = 0.0;
    for (double s = 0.0; s <= tube.length_mm(); s += kCurvatureStep_mm) {
        curvature = std::max(curvature, tube.axis_curvature(s).norm());
    }
    return curvature * tube.radius_mm() > kStraightShare ? 1.0 / curvature
                                                         : std::numeric_limits<double>::infinity();
}

}  // namespace meshwind
