#include "winding/elbow/elbow_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/roots.h"
#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Steeper lines on the legs would circle on and on; turns stop at 84 degrees, too (turn.cpp).
constexpr double kSteepest_rad = rad_from_deg(82.0);

// Ways around a leg are closed to this: 1e-9 mm on any tube.
constexpr int kHalvings = 48;

// Below this difference of u the closed form loses more digits than its limit.
constexpr double kSameU = 1e-7;

// Runs and angles that are tried, and places along a leg where distances are looked at.
constexpr std::array<double, 9> kRuns{0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0};  // of the leg
constexpr int kAngles = 24;
constexpr int kShares = 10;
constexpr int kPlaces = 24;

// More lines than this many times those that the bend needs would make it too thick.
constexpr double kMaxLines = 1.5;

// A line on a leg, outward from the bend; psi grows outward.
struct LegLine {
    double psi_rad;
    double u;         // 1 / sin(angle)
    double middle_u;  // at half the run
    double end_u;
};

struct Leg {
    double radius_mm;
    double length_mm;
    double sign;  // +1 where psi grows with the number of the line
    std::vector<LegLine> lines;
    double width_mm;  // neighbours farther apart leave a gap
    double slip;      // largest |slip ratio| of the steering
};

// Lines as they run on a leg.
struct SteeredLeg {
    ElbowLeg leg;
    std::vector<LegLine> lines;
    double fibre_mm = 0.0;  // of steered lines
};

// Way around over `dz` while u goes from a to b.
double around(double a, double b, double dz_mm, double radius_mm) {
    if (std::abs(b - a) < kSameU) {
        const double u = 0.5 * (a + b);
        return dz_mm / (radius_mm * std::sqrt(u * u - 1.0));
    }
    return dz_mm / radius_mm * (std::acosh(b) - std::acosh(a)) / (b - a);
}

// Length of the fibre over `dz`: dz / cos(angle).
double fibre_mm(double a, double b, double dz_mm) {
    if (std::abs(b - a) < kSameU) {
        const double u = 0.5 * (a + b);
        return dz_mm * u / std::sqrt(u * u - 1.0);
    }
    return dz_mm * (std::sqrt(b * b - 1.0) - std::sqrt(a * a - 1.0)) / (b - a);
}

struct LegState {
    double psi_rad;
    double u;
    double s_mm;  // since the bend
};

LegState state_at(const LegLine& line, double run_mm, double z_mm, double radius_mm) {
    LegState state{line.psi_rad, line.u, 0.0};
    double z = 0.0;
    // u is linear from node to node.
    const auto go = [&](double to_u, double to_mm) {
        const double dz = std::min(to_mm, z_mm) - z;
        if (dz <= 0.0) {
            return;
        }
        const double u = state.u + dz / (to_mm - z) * (to_u - state.u);
        state = {state.psi_rad + around(state.u, u, dz, radius_mm), u,
                 state.s_mm + fibre_mm(state.u, u, dz)};
        z += dz;
    };
    go(line.middle_u, 0.5 * run_mm);
    go(line.end_u, run_mm);
    if (z_mm > z) {
        const double dz = z_mm - z;
        state.psi_rad += around(state.u, state.u, dz, radius_mm);
        state.s_mm += fibre_mm(state.u, state.u, dz);
    }
    return state;
}

// Where lines shall be at the end of the run: between geodesics and even lines of one angle.
struct Wish {
    double run_mm;
    double end_u;
    double share;

    [[nodiscard]] double u(const LegLine& line) const {
        return share * end_u + (1.0 - share) * line.u;
    }
    [[nodiscard]] double psi(const LegLine& line, double even_rad, double radius_mm) const {
        return share * even_rad +
               (1.0 - share) * (line.psi_rad + around(line.u, line.u, run_mm, radius_mm));
    }
};

struct Range {
    double low = -kInfinite;
    double high = kInfinite;
};

double even_rad(const Leg& leg, std::size_t i) {
    return leg.sign * 2.0 * kPi * static_cast<double>(i) / static_cast<double>(leg.lines.size());
}

// u at half the run that the slip allows.
Range middle_range(const Leg& leg, const LegLine& line, const Wish& wish) {
    const double reach = leg.slip * 0.5 * wish.run_mm / leg.radius_mm;
    const double end = wish.u(line);
    return {std::max(std::max(line.u, end) - reach, 1.0 / std::sin(kSteepest_rad)),
            std::min(line.u, end) + reach};
}

double end_psi(const Leg& leg, const LegLine& line, const Wish& wish, double middle_u) {
    return line.psi_rad + around(line.u, middle_u, 0.5 * wish.run_mm, leg.radius_mm) +
           around(middle_u, wish.u(line), 0.5 * wish.run_mm, leg.radius_mm);
}

// Of the even places: where each line can get to its own; the middle of all such.
std::optional<double> offset_for(const Leg& leg, const Wish& wish) {
    Range all;
    for (std::size_t i = 0; i < leg.lines.size(); ++i) {
        const LegLine& line = leg.lines[i];
        const Range middle = middle_range(leg, line, wish);
        if (!(middle.low <= middle.high)) {
            return std::nullopt;
        }
        const auto offset = [&](double middle_u) {
            const double kept = wish.psi(line, 0.0, leg.radius_mm);
            return (end_psi(leg, line, wish, middle_u) - kept) / wish.share - even_rad(leg, i);
        };
        // The flatter a line runs the less it goes around.
        all.low = std::max(all.low, offset(middle.high));
        all.high = std::min(all.high, offset(middle.low));
    }
    return all.low <= all.high ? std::optional(0.5 * (all.low + all.high)) : std::nullopt;
}

void steer(const Leg& leg, const Wish& wish, double even, LegLine& line) {
    const double target = wish.psi(line, even, leg.radius_mm);
    const Range middle = middle_range(leg, line, wish);
    const auto is_beyond = [&](double u) { return end_psi(leg, line, wish, u) > target; };
    line.middle_u =
        halve({.holds = middle.low, .fails = middle.high}, kHalvings, is_beyond).middle();
    line.end_u = wish.u(line);
}

// Largest distance of neighbours at a distance from the bend, square to them.
double widest_mm(const Leg& leg, const std::vector<LegLine>& lines, double run_mm, double z_mm) {
    double widest = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool last = i + 1 == lines.size();
        const LegState a = state_at(lines[i], run_mm, z_mm, leg.radius_mm);
        const LegState b = state_at(lines[last ? 0 : i + 1], run_mm, z_mm, leg.radius_mm);
        const double apart = leg.sign * (b.psi_rad - a.psi_rad) + (last ? 2.0 * kPi : 0.0);
        const double u = 0.5 * (a.u + b.u);
        widest = std::max(widest, leg.radius_mm * std::abs(apart) * std::sqrt(1.0 - 1.0 / (u * u)));
    }
    return widest;
}

// Fills in the distances of neighbours along the leg.
void measure_distances(const Leg& leg, const std::vector<LegLine>& lines, ElbowLeg& measured) {
    bool closed = true;
    for (int place = 0; place <= kPlaces; ++place) {
        const double z = leg.length_mm * place / kPlaces;
        const double widest = widest_mm(leg, lines, measured.run_mm, z);
        measured.widest_mm = std::max(measured.widest_mm, widest);
        // Where the bend is just closed so is the leg's first place, but for rounding.
        closed = closed && (place == 0 || widest <= leg.width_mm);
        if (closed) {
            measured.closed_mm = z;
        }
    }
}

// The lines as geodesics.
SteeredLeg unsteered(const Leg& leg) {
    SteeredLeg kept{{}, leg.lines};
    for (LegLine& line : kept.lines) {
        line.middle_u = line.u;
        line.end_u = line.u;
    }
    kept.leg.angle_rad = std::asin(1.0 / kept.lines.front().u);
    measure_distances(leg, kept.lines, kept.leg);
    return kept;
}

// The lines as wished for, with the even places turned by an offset.
SteeredLeg steered(const Leg& leg, const Wish& wish, double offset_rad) {
    SteeredLeg result{{}, leg.lines};
    result.leg.run_mm = wish.run_mm;
    result.leg.angle_rad = std::asin(1.0 / wish.end_u);
    result.leg.even = wish.share;
    for (std::size_t i = 0; i < result.lines.size(); ++i) {
        LegLine& line = result.lines[i];
        steer(leg, wish, even_rad(leg, i) + offset_rad, line);
        const double half = 0.5 * wish.run_mm;
        result.leg.slip =
            std::max({result.leg.slip, leg.radius_mm * std::abs(line.middle_u - line.u) / half,
                      leg.radius_mm * std::abs(line.end_u - line.middle_u) / half});
    }
    measure_distances(leg, result.lines, result.leg);
    for (const LegLine& line : result.lines) {
        result.fibre_mm += state_at(line, result.leg.run_mm, leg.length_mm, leg.radius_mm).s_mm;
    }
    return result;
}

// No gaps come first, then the least fibre; where there are gaps, the least of them.
bool closes_better(const SteeredLeg& one, const SteeredLeg& other, double width_mm) {
    const bool closed = one.leg.widest_mm <= width_mm;
    if (closed != (other.leg.widest_mm <= width_mm)) {
        return closed;
    }
    return closed ? one.fibre_mm < other.fibre_mm : one.leg.widest_mm < other.leg.widest_mm;
}

// Of the runs and angles that the slip allows the best.
SteeredLeg best_steering(const Leg& leg) {
    SteeredLeg best = unsteered(leg);
    const auto [least, most] =
        std::minmax_element(leg.lines.begin(), leg.lines.end(),
                            [](const LegLine& a, const LegLine& b) { return a.u < b.u; });
    if (leg.length_mm <= 0.0 || leg.slip <= 0.0) {
        return best;
    }
    // Evenness comes first: without it the leg is the worse the longer it is.
    for (int share = kShares; share > 0 && best.leg.even == 0.0; --share) {
        for (const double run : kRuns) {
            for (int i = 0; i <= kAngles; ++i) {
                const double u = least->u + (most->u - least->u) * i / kAngles;
                const Wish wish{run * leg.length_mm, u, static_cast<double>(share) / kShares};
                const std::optional<double> offset = offset_for(leg, wish);
                if (!offset) {
                    continue;
                }
                SteeredLeg offered = steered(leg, wish, *offset);
                if (best.leg.even == 0.0 || closes_better(offered, best, leg.width_mm)) {
                    best = std::move(offered);
                }
            }
        }
    }
    return best;
}

// Lines through the bend, and how they run on the legs.
struct ElbowCourse {
    std::vector<TorusLine> bend;
    std::array<SteeredLeg, 2> leg;

    [[nodiscard]] double widest_mm() const {
        return std::max(leg[0].leg.widest_mm, leg[1].leg.widest_mm);
    }
};

// With so many lines. \param width_mm of the tow, shared by the layers asked for
ElbowCourse course_of(const ElbowTube& tube, const TorusElbow& bend, int count, double width_mm,
                      double slip) {
    ElbowCourse course{torus_lines(bend, count), {}};
    for (std::size_t end = 0; end < 2; ++end) {
        Leg leg{tube.tube_radius_mm, tube.leg_mm[end], end == 0 ? 1.0 : -1.0, {}, width_mm, slip};
        for (const TorusLine& line : course.bend) {
            const double phi = end == 0 ? line.phi_minus_rad : line.phi_plus_rad;
            const double rho = tube.ring_radius_mm + tube.tube_radius_mm * std::cos(phi);
            const double cosine = bend.clairaut_mm() / rho;
            leg.lines.push_back(
                {end == 0 ? -phi : phi, 1.0 / std::sqrt(1.0 - cosine * cosine), 0.0, 0.0});
        }
        course.leg[end] = best_steering(leg);
    }
    return course;
}

// With as many lines as the bend needs, or more while the legs have gaps.
ElbowCourse closing_course(const ElbowTube& tube, const TorusElbow& bend, int needed,
                           double width_mm, double slip) {
    const int most = static_cast<int>(kMaxLines * needed);
    for (int count = needed;;) {
        ElbowCourse course = course_of(tube, bend, count, width_mm, slip);
        const double widest = course.widest_mm();
        // Distances are nearly as 1 to the number of lines.
        const int wanted =
            std::max(count + 1, static_cast<int>(std::ceil(count * widest / width_mm)));
        if (widest <= width_mm || count == most) {
            return course;
        }
        count = std::min(wanted, most);
    }
}

void add_station(ElbowStation station, std::vector<ElbowStation>& out) {
    constexpr double kSame_mm = 1e-9;  // where two stretches meet
    if (!out.empty()) {
        if (station.along_mm - out.back().along_mm < kSame_mm) {
            out.back().kn_per_mm = std::min(out.back().kn_per_mm, station.kn_per_mm);
            return;
        }
    }
    out.push_back(station);
}

// Distances from the bend, outward, of the stations of a line on a leg.
std::vector<double> leg_places_mm(const LegLine& line, double run_mm, double length_mm,
                                  double station_mm) {
    std::vector<double> z{0.0};
    const double flattest = std::min({line.u, line.middle_u, line.end_u});
    // Along the fibre dz / cos(angle); the steepest of the line rules.
    const double step = station_mm * std::sqrt(1.0 - 1.0 / (flattest * flattest));
    for (const double to : {0.5 * run_mm, run_mm, length_mm}) {
        const double from = z.back();
        const auto steps = static_cast<int>(std::ceil((to - from) / step));
        for (int k = 1; k <= steps; ++k) {
            z.push_back(from + (to - from) * k / steps);
        }
    }
    return z;
}

// Stations at least as close as asked for, with one at each end of a stretch; the one where the
// last stretch ended is not repeated.
void lay_leg(const ElbowTube& tube, std::size_t end, const LegLine& line, double run,
             double station_mm, std::vector<ElbowStation>& out) {
    const double length = tube.leg_mm[end];
    if (length <= 0.0) {
        return;
    }
    std::vector<double> z = leg_places_mm(line, run, length, station_mm);
    if (end == 0) {
        std::reverse(z.begin(), z.end());
    }
    const double before = out.empty() ? 0.0 : out.back().s_mm;
    const double whole = state_at(line, run, length, tube.tube_radius_mm).s_mm;
    for (const double place : z) {
        const LegState state = state_at(line, run, place, tube.tube_radius_mm);
        ElbowStation station;
        station.along_mm = end == 0 ? length - place : tube.leg_mm[0] + tube.bend_mm() + place;
        station.phi_rad = end == 0 ? -state.psi_rad : state.psi_rad;
        station.angle_rad = std::asin(1.0 / state.u);
        station.s_mm = before + (end == 0 ? whole - state.s_mm : state.s_mm);
        station.kn_per_mm = 1.0 / (state.u * state.u * tube.tube_radius_mm);
        add_station(station, out);
    }
}

double least_angle_rad(const ElbowTube& tube, const TorusElbow& bend) {
    return std::acos(bend.clairaut_mm() / (tube.ring_radius_mm - tube.tube_radius_mm));
}

void lay_bend(const ElbowTube& tube, const TorusElbow& bend, const TorusLine& line,
              double station_mm, std::vector<ElbowStation>& out) {
    const double range = line.phi_plus_rad - line.phi_minus_rad;
    // ds/dphi = r / sin(alpha) is largest at the inner equator.
    const double sine = std::sin(least_angle_rad(tube, bend));
    const auto steps =
        static_cast<int>(std::ceil(range * tube.tube_radius_mm / (sine * station_mm)));
    const double before = out.empty() ? 0.0 : out.back().s_mm;
    const double first = torus_station(bend, line.phi_minus_rad).length_mm;
    for (int k = 0; k <= steps; ++k) {
        const double phi = line.phi_minus_rad + range * k / steps;
        const TorusStation at = torus_station(bend, phi);
        const double theta = k == 0       ? -0.5 * tube.span_rad
                             : k == steps ? 0.5 * tube.span_rad
                                          : line.theta_rad + at.theta_rad;
        const double cosine = std::cos(at.alpha_rad);
        const double sin = std::sin(at.alpha_rad);
        const double rho = tube.ring_radius_mm + tube.tube_radius_mm * std::cos(phi);
        ElbowStation station;
        station.along_mm = tube.leg_mm[0] + tube.ring_radius_mm * (theta + 0.5 * tube.span_rad);
        station.phi_rad = phi;
        station.angle_rad = at.alpha_rad;
        station.s_mm = before + at.length_mm - first;
        station.kn_per_mm = sin * sin / tube.tube_radius_mm + cosine * cosine * std::cos(phi) / rho;
        add_station(station, out);
    }
}

// Stations of a line from the first rim to the second.
std::vector<ElbowStation> stations_of(const ElbowTube& tube, const TorusElbow& bend,
                                      const ElbowCourse& course, std::size_t i, double station_mm) {
    std::vector<ElbowStation> line;
    const SteeredLeg& first = course.leg[0];
    const SteeredLeg& second = course.leg[1];
    lay_leg(tube, 0, first.lines[i], first.leg.run_mm, station_mm, line);
    lay_bend(tube, bend, course.bend[i], station_mm, line);
    lay_leg(tube, 1, second.lines[i], second.leg.run_mm, station_mm, line);
    return line;
}

}  // namespace

double ElbowLines::spacing_mm(double phi_rad) const {
    const double rho = bend.ring_radius_mm + bend.tube_radius_mm * std::cos(phi_rad);
    const double c = bend.clairaut_mm();
    return theta_cycle_rad / count() * std::sqrt(rho * rho - c * c);
}

double least_elbow_angle_rad(const ElbowTube& tube) {
    const double inner = tube.ring_radius_mm - tube.tube_radius_mm;
    const double lifts = std::atan(std::sqrt(tube.tube_radius_mm / inner));
    return std::acos(inner * std::cos(lifts) / (tube.ring_radius_mm + tube.tube_radius_mm));
}

ElbowLines elbow_lines(const ElbowTube& tube, const ElbowOptions& options) {
    const double width_mm = options.width_mm / options.layers;
    ElbowLines lines;
    lines.bend = {tube.ring_radius_mm, tube.tube_radius_mm, tube.span_rad, options.alpha0_rad};
    lines.theta_cycle_rad = torus_cycle(lines.bend).theta_rad;
    lines.needed = lines_for_tape(lines.bend, width_mm);
    const ElbowCourse course =
        closing_course(tube, lines.bend, lines.needed, width_mm, options.slip);
    lines.leg = {course.leg[0].leg, course.leg[1].leg};
    for (std::size_t i = 0; i < course.bend.size(); ++i) {
        lines.line.push_back(stations_of(tube, lines.bend, course, i, options.station_mm));
    }
    return lines;
}

}  // namespace meshwind
