#include "mesh/revolution/profile_lines.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "core/small_linear.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Places = std::vector<ProfilePlace>;

// Least squares of the distances; `point(i)` for i in [first, last).
template <class PointAt>
ProfileLine line_through(std::size_t first, std::size_t last, const PointAt& point) {
    Vector2d mean = Vector2d::Zero();
    for (std::size_t i = first; i < last; ++i) {
        mean += point(i);
    }
    mean /= static_cast<double>(last - first);
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (std::size_t i = first; i < last; ++i) {
        const Vector2d arm = point(i) - mean;
        spread += arm * arm.transpose();
    }
    ProfileLine line{mean, principal_axes(spread).vectors.col(1)};
    if (line.along_mm(point(last - 1)) < line.along_mm(point(first))) {
        line.way = -line.way;
    }
    return line;
}

ProfileLine line_of(const Places& places, std::size_t first, std::size_t last) {
    return line_through(first, last + 1, [&](std::size_t i) { return places[i].at_mm; });
}

// Farther off than this many tolerances is no place, except of a few stray vertices: where the axis
// is a little off, the mean of a whole ring is right and a single vertex is not.
constexpr double kFarthest = 3.0;
constexpr std::size_t kStrayPoints = 3;

// All within the tolerance but places with a few of the points.
bool on_line(const Places& places, std::size_t first, std::size_t last, double tolerance_mm) {
    constexpr double kStrayShare = 0.05;
    const ProfileLine line = line_of(places, first, last);
    const auto off = [&](std::size_t i) { return std::abs(line.off_mm(places[i].at_mm)); };
    if (off(first) > tolerance_mm || off(last) > tolerance_mm) {
        return false;
    }
    std::size_t strays = 0;
    for (std::size_t i = first; i <= last; ++i) {
        const std::size_t points = places[i].last - places[i].first;
        if (off(i) > kFarthest * tolerance_mm && points > kStrayPoints) {
            return false;
        }
        strays += off(i) > tolerance_mm ? points : 0;
    }
    return static_cast<double>(strays) <=
           kStrayShare * static_cast<double>(places[last].last - places[first].first);
}

// Whether a whole section is a line but for strays: its parabola is flat.
bool whole_on_line(const Places& places, double tolerance_mm) {
    const ProfileLine line = line_of(places, 0, places.size() - 1);
    const double half = 0.5 * (places.back().arc_mm - places.front().arc_mm);
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    Eigen::Vector3d side = Eigen::Vector3d::Zero();
    for (const ProfilePlace& place : places) {
        const double off = line.off_mm(place.at_mm);
        if (std::abs(off) > kFarthest * tolerance_mm) {
            return false;
        }
        const double u = line.along_mm(place.at_mm) / half;
        const Eigen::Vector3d terms(1.0, u, u * u);
        square += terms * terms.transpose();
        side += off * terms;
    }
    return places.size() == 2 || std::abs(square.ldlt().solve(side)[2]) <= tolerance_mm;
}

class Finder {
public:
    Finder(const Places& places, double tolerance_mm)
        : places_(places), tolerance_mm_(tolerance_mm) {}

    [[nodiscard]] std::size_t longest_from(std::size_t first) const {
        constexpr std::size_t kStraysInARow = 3;
        if (first == 0 && whole_on_line(places_, tolerance_mm_)) {
            return places_.size() - 1;
        }
        std::size_t last = first + 1;
        for (std::size_t next = last + 1; next < places_.size() && next <= last + kStraysInARow;
             ++next) {
            last = on_line(places_, first, next, tolerance_mm_) ? next : last;
        }
        return last;
    }

    [[nodiscard]] bool is_straight(std::size_t first, std::size_t last) const {
        const bool at_start = first == 0;
        const bool at_end = last + 1 == places_.size();
        if (at_start && at_end) {
            return true;
        }
        if (last - first + 1 == 2) {
            return lonely(first, last);
        }
        // Shorter stretches of a curve may be straight by luck.
        const double least_edges = in_rings(first, last) ? 2.0 : 6.0;
        if (length(first, last) < least_edges * places_[first].spacing_mm) {
            return false;
        }
        const ProfileLine line = line_of(places_, first, last);
        return (at_start || bends_away(line, first, last, false)) &&
               (at_end || bends_away(line, first, last, true));
    }

private:
    [[nodiscard]] double length(std::size_t first, std::size_t last) const {
        return places_[last].arc_mm - places_[first].arc_mm;
    }

    [[nodiscard]] bool in_rings(std::size_t first, std::size_t last) const {
        constexpr double kTogether = 0.05;  // of the mean step
        const double step = length(first, last) / static_cast<double>(last - first);
        return std::all_of(places_.begin() + static_cast<std::ptrdiff_t>(first),
                           places_.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                           [&](const ProfilePlace& place) {
                               return place.high_mm - place.low_mm <= kTogether * step;
                           });
    }

    // Two rings far apart with none between: a surface that bends has rings where it does.
    [[nodiscard]] bool lonely(std::size_t first, std::size_t last) const {
        constexpr double kMuchLonger = 3.0;
        const double gap = length(first, last);
        if (gap < kMuchLonger * std::max(places_[first].spacing_mm, places_[last].spacing_mm)) {
            return false;
        }
        const bool start = first == 0 || gap > kMuchLonger * length(first - 1, first);
        const bool end = last + 1 == places_.size() || gap > kMuchLonger * length(last, last + 1);
        return (start && end) || (bulges_too_much(first) && !goes_on_bending(first));
    }

    // How the bands of facets before and behind a place turn, > 0 where convex.
    [[nodiscard]] double turn_rad(std::size_t place) const {
        const Vector2d before = places_[place].at_mm - places_[place - 1].at_mm;
        const Vector2d behind = places_[place + 1].at_mm - places_[place].at_mm;
        return std::atan2(before.x() * behind.y() - before.y() * behind.x(), before.dot(behind));
    }

    [[nodiscard]] double bend_per_mm(std::size_t place) const {
        return 2.0 * turn_rad(place) / length(place - 1, place + 1);
    }

    [[nodiscard]] bool is_inside(std::size_t place) const {
        return place > 0 && place + 1 < places_.size();
    }

    // Whether a curve through the rings would stand off the band behind `first` by much more than
    // the wall stands off its facets about the axis: no export is so much coarser one way.
    [[nodiscard]] bool bulges_too_much(std::size_t first) const {
        constexpr double kMuchMore = 5.0;
        double round = 0.0;
        for (const ProfilePlace& place : places_) {
            if (place.at_mm.x() > place.spacing_mm) {
                round = std::max(round, place.spacing_mm * place.spacing_mm / place.at_mm.x() / 8);
            }
        }
        double turn = 0.0;
        for (const std::size_t place : {first, first + 1}) {
            turn = is_inside(place) ? std::max(turn, std::abs(turn_rad(place))) : turn;
        }
        return turn * length(first, first + 1) / 8.0 > kMuchMore * round;
    }

    // Whether the profile bends alike at both ends of the band behind `first`, or at the one that
    // is inside and the next: a curve does so.
    [[nodiscard]] bool goes_on_bending(std::size_t first) const {
        constexpr double kAlike = 4.0;
        std::size_t a = first;
        std::size_t b = first + 1;
        if (!is_inside(a)) {
            a = first + 2;
        } else if (!is_inside(b)) {
            b = first - 1;
        }
        if (!is_inside(a) || !is_inside(b)) {
            return false;
        }
        const double share = bend_per_mm(a) / bend_per_mm(b);
        return share > 1.0 / kAlike && share < kAlike;
    }

    // Whether the curve beyond the stretch leaves the line so clearly that the stretch, bent like
    // it, would not be within the tolerance. At half its length beyond, a circle is off by eight
    // times what it is within the stretch.
    [[nodiscard]] bool bends_away(const ProfileLine& line, std::size_t first, std::size_t last,
                                  bool behind) const {
        constexpr double kClearly = 20.0;
        constexpr double kAtLeast = 2.0;
        const double half = 0.5 * length(first, last);
        std::size_t there = behind ? last + 1 : first - 1;
        const auto away = [&](std::size_t i) {
            return behind ? length(last, i) : length(i, first);
        };
        while (away(there) < half && there > 0 && there + 1 < places_.size()) {
            there = behind ? there + 1 : there - 1;
        }
        const double share = std::min(1.0, away(there) / half);
        const double wanted = std::max(kAtLeast, kClearly * share * share) * tolerance_mm_;
        return std::abs(line.off_mm(places_[there].at_mm)) > wanted;
    }

    const Places& places_;
    double tolerance_mm_;
};

// The stretch without the places at its ends that are off the line of its middle by more than the
// middle's own scatter: the start of a curve is within the tolerance for a while.
struct Trimmed {
    std::size_t first, last;
    ProfileLine line;
};

Trimmed trimmed(std::span<const ProfilePoint> points, const Places& places, std::size_t first,
                std::size_t last, double precision_mm) {
    constexpr std::size_t kFewest = 8;
    constexpr double kScatters = 6.0;  // largest of some hundred, and some more
    const auto fit = [&](std::size_t a, std::size_t b) {
        return line_through(places[a].first, places[b].last,
                            [&](std::size_t i) { return points[i].at_mm; });
    };
    if (last - first < kFewest || (first == 0 && last + 1 == places.size())) {
        return {first, last, fit(first, last)};
    }
    const std::size_t margin = (last - first) / 8;
    const ProfileLine middle = fit(first + margin, last - margin);
    double square = 0.0;
    for (std::size_t i = first + margin; i <= last - margin; ++i) {
        square += std::pow(middle.off_mm(places[i].at_mm), 2);
    }
    const double scatter = std::sqrt(square / static_cast<double>(last - first + 1 - 2 * margin));
    const double within = std::max(kScatters * scatter, precision_mm);
    while (std::abs(middle.off_mm(places[first].at_mm)) > within) {
        ++first;
    }
    while (std::abs(middle.off_mm(places[last].at_mm)) > within) {
        --last;
    }
    return {first, last, middle};
}

void set_exact(ProfileLine& line, double length_mm, double tolerance_mm) {
    if (std::abs(line.way.x()) * length_mm <= tolerance_mm) {
        line.way = {0.0, line.way.y() < 0.0 ? -1.0 : 1.0};
    } else if (std::abs(line.way.y()) * length_mm <= tolerance_mm) {
        line.way = {line.way.x() < 0.0 ? -1.0 : 1.0, 0.0};
    }
}

// Appends how far each place is off the quartic through three neighbours on either side.
void append_off_neighbours(const Places& places, std::vector<double>& off) {
    constexpr std::size_t kBeside = 3;
    for (std::size_t i = kBeside; i + kBeside < places.size(); ++i) {
        const ProfileLine line = line_of(places, i - kBeside, i + kBeside);
        Eigen::Matrix<double, 2 * kBeside, 5> terms;
        Eigen::Matrix<double, 2 * kBeside, 1> value;
        for (std::size_t k = 0; k < 2 * kBeside; ++k) {
            const Vector2d& p = places[i - kBeside + k + (k < kBeside ? 0 : 1)].at_mm;
            const double x = line.along_mm(p) - line.along_mm(places[i].at_mm);
            const auto row = static_cast<Eigen::Index>(k);
            const double u =
                x / line.along_mm(places[i + kBeside].at_mm - places[i].at_mm + line.origin_mm);
            terms.row(row) << 1.0, u, u * u, u * u * u, u * u * u * u;
            value[row] = line.off_mm(p);
        }
        const Eigen::Matrix<double, 5, 1> fit = terms.colPivHouseholderQr().solve(value);
        off.push_back(std::abs(line.off_mm(places[i].at_mm) - fit[0]));
    }
}

double as_a_rule(std::vector<double>& off) {
    constexpr double kRule = 0.6;  // share that is better
    const auto rule =
        off.begin() + static_cast<std::ptrdiff_t>(kRule * static_cast<double>(off.size() - 1));
    std::nth_element(off.begin(), rule, off.end());
    return *rule;
}

// So many vertices at one place are a ring.
constexpr std::size_t kRing = 6;

// One behind the ring that starts at `first`, or `first`. The rings of a fillet may be much nearer
// to each other than the vertices of each are, but not than these are off their circle.
std::size_t end_of_ring(std::span<const ProfilePoint> points, std::size_t first) {
    constexpr double kTogether = 0.01;  // of an edge, from one vertex to the next
    constexpr double kApart = 5.0;      // times what a ring is wide, to the next
    constexpr double kWidest = 0.1;     // of an edge: beyond, vertices are scattered
    std::size_t last = first + 1;
    const double spacing = points[first].spacing_mm;
    while (last < points.size() &&
           points[last].arc_mm - points[last - 1].arc_mm <= kTogether * spacing) {
        if (points[last].arc_mm - points[first].arc_mm > kWidest * spacing) {
            return first;
        }
        ++last;
    }
    const double apart = kApart * (points[last - 1].arc_mm - points[first].arc_mm);
    const bool alone =
        (first == 0 || points[first].arc_mm - points[first - 1].arc_mm > apart) &&
        (last == points.size() || points[last].arc_mm - points[last - 1].arc_mm > apart);
    return last - first >= kRing && alone ? last : first;
}

ProfilePlace place_of(std::span<const ProfilePoint> points, std::size_t first, std::size_t last) {
    ProfilePlace place{.low_mm = points[first].arc_mm,
                       .high_mm = points[last - 1].arc_mm,
                       .spacing_mm = points[first].spacing_mm,
                       .first = first,
                       .last = last};
    const auto count = static_cast<double>(last - first);
    for (const ProfilePoint& p : points.subspan(first, last - first)) {
        place.at_mm += p.at_mm / count;
        place.arc_mm += p.arc_mm / count;
    }
    for (const ProfilePoint& p : points.subspan(first, last - first)) {
        place.spread_mm += (p.at_mm - place.at_mm).squaredNorm() / count;
    }
    place.spread_mm = std::sqrt(place.spread_mm);
    return place;
}

}  // namespace

std::vector<ProfilePlace> places_of(std::span<const ProfilePoint> points) {
    constexpr double kOnePlace = 0.25;  // of an edge
    Places places;
    for (std::size_t first = 0; first < points.size();) {
        std::size_t last = end_of_ring(points, first);
        if (last == first) {
            do {
                ++last;
            } while (last < points.size() && end_of_ring(points, last) == last &&
                     points[last].arc_mm - points[first].arc_mm <=
                         kOnePlace * points[first].spacing_mm);
        }
        places.push_back(place_of(points, first, last));
        first = last;
    }
    return places;
}

double scatter_mm(std::span<const Places> sections) {
    std::vector<double> off;
    for (const Places& places : sections) {
        append_off_neighbours(places, off);
    }
    if (off.empty()) {
        return 0.0;
    }
    const double scatter = as_a_rule(off);
    // Fillets of a few rings between lines are off a smooth curve, but not their vertices.
    std::vector<double> spread;
    std::size_t places = 0;
    for (const Places& section : sections) {
        places += section.size();
        for (const ProfilePlace& place : section) {
            if (place.last - place.first >= kRing) {
                spread.push_back(place.spread_mm);
            }
        }
    }
    return 2 * spread.size() > places ? std::min(scatter, as_a_rule(spread)) : scatter;
}

std::vector<ProfileStretch> stretches_of(std::span<const ProfilePoint> points, const Places& places,
                                         double tolerance_mm, double precision_mm) {
    const Finder finder(places, tolerance_mm);
    std::vector<ProfileStretch> stretches;
    std::size_t done = 0;  // all places up to here are in a stretch
    const auto add_curve = [&](std::size_t last) {
        constexpr std::size_t kMeet = 2;  // lines this few places apart meet between them
        const bool lines_meet = !stretches.empty() && last + 1 < places.size();
        if (last > done + (lines_meet ? kMeet : 0)) {
            stretches.push_back({false, done, last, {}});
        }
    };
    for (std::size_t first = 0; first + 1 < places.size();) {
        const std::size_t far = finder.longest_from(first);
        if (!finder.is_straight(first, far)) {
            ++first;
            continue;
        }
        Trimmed stretch = trimmed(points, places, first, far, precision_mm);
        add_curve(stretch.first);
        set_exact(stretch.line, places[stretch.last].arc_mm - places[stretch.first].arc_mm,
                  tolerance_mm);
        stretches.push_back({true, stretch.first, stretch.last, stretch.line});
        first = done = stretch.last;
    }
    if (done + 1 < places.size()) {
        stretches.push_back({false, done, places.size() - 1, {}});
    }
    return stretches;
}

}  // namespace meshwind
