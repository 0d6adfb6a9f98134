#include "winding/elbow/elbow_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

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
constexpr double kMostLines = 1.5;

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

class LegDesigner {
public:
    LegDesigner(const Leg& leg, double width_mm, double slip)
        : leg_(leg), width_mm_(width_mm), slip_(slip) {}

    // Lines steered, and what they are then.
    std::pair<ElbowLeg, std::vector<LegLine>> best() {
        std::pair<ElbowLeg, std::vector<LegLine>> best = kept();
        const auto [least, most] =
            std::minmax_element(leg_.lines.begin(), leg_.lines.end(),
                                [](const LegLine& a, const LegLine& b) { return a.u < b.u; });
        if (leg_.length_mm <= 0.0 || slip_ <= 0.0) {
            return best;
        }
        // Evenness comes first: without it the leg is the worse the longer it is.
        for (int share = kShares; share > 0 && best.first.even == 0.0; --share) {
            for (const double run : kRuns) {
                for (int i = 0; i <= kAngles; ++i) {
                    const double u = least->u + (most->u - least->u) * i / kAngles;
                    offer({run * leg_.length_mm, u, static_cast<double>(share) / kShares}, best);
                }
            }
        }
        return best;
    }

private:
    [[nodiscard]] std::pair<ElbowLeg, std::vector<LegLine>> kept() const {
        std::vector<LegLine> lines = leg_.lines;
        for (LegLine& line : lines) {
            line.middle_u = line.u;
            line.end_u = line.u;
        }
        ElbowLeg leg;
        leg.angle_rad = std::asin(1.0 / lines.front().u);
        look_at(lines, leg);
        return {leg, lines};
    }

    void offer(const Wish& wish, std::pair<ElbowLeg, std::vector<LegLine>>& best) {
        const std::optional<double> offset = offset_for(wish);
        if (!offset) {
            return;
        }
        ElbowLeg leg;
        leg.run_mm = wish.run_mm;
        leg.angle_rad = std::asin(1.0 / wish.end_u);
        leg.even = wish.share;
        std::vector<LegLine> lines = leg_.lines;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            steer(lines[i], wish, even_rad(i) + *offset);
            const double half = 0.5 * wish.run_mm;
            leg.slip = std::max(
                {leg.slip, leg_.radius_mm * std::abs(lines[i].middle_u - lines[i].u) / half,
                 leg_.radius_mm * std::abs(lines[i].end_u - lines[i].middle_u) / half});
        }
        look_at(lines, leg);
        double fibre = 0.0;
        for (const LegLine& line : lines) {
            fibre += state_at(line, leg.run_mm, leg_.length_mm, leg_.radius_mm).s_mm;
        }
        if (best.first.even == 0.0 || better(leg, fibre, best.first)) {
            best_fibre_mm_ = fibre;
            best = {leg, std::move(lines)};
        }
    }

    // No gaps come first, then the least fibre; where there are gaps, the least of them.
    [[nodiscard]] bool better(const ElbowLeg& leg, double its_fibre_mm,
                              const ElbowLeg& best) const {
        const bool closed = leg.widest_mm <= width_mm_;
        if (closed != (best.widest_mm <= width_mm_)) {
            return closed;
        }
        return closed ? its_fibre_mm < best_fibre_mm_ : leg.widest_mm < best.widest_mm;
    }

    [[nodiscard]] double even_rad(std::size_t i) const {
        return leg_.sign * 2.0 * kPi * static_cast<double>(i) /
               static_cast<double>(leg_.lines.size());
    }

    // u at half the run that the slip allows.
    [[nodiscard]] Range middle_range(const LegLine& line, const Wish& wish) const {
        const double reach = slip_ * 0.5 * wish.run_mm / leg_.radius_mm;
        const double end = wish.u(line);
        return {std::max(std::max(line.u, end) - reach, 1.0 / std::sin(kSteepest_rad)),
                std::min(line.u, end) + reach};
    }

    [[nodiscard]] double end_psi(const LegLine& line, const Wish& wish, double middle_u) const {
        return line.psi_rad + around(line.u, middle_u, 0.5 * wish.run_mm, leg_.radius_mm) +
               around(middle_u, wish.u(line), 0.5 * wish.run_mm, leg_.radius_mm);
    }

    // Of the even places: where each line can get to its own; the middle of all such.
    [[nodiscard]] std::optional<double> offset_for(const Wish& wish) const {
        Range all;
        for (std::size_t i = 0; i < leg_.lines.size(); ++i) {
            const LegLine& line = leg_.lines[i];
            const Range middle = middle_range(line, wish);
            if (!(middle.low <= middle.high)) {
                return std::nullopt;
            }
            const auto offset = [&](double middle_u) {
                const double kept = wish.psi(line, 0.0, leg_.radius_mm);
                return (end_psi(line, wish, middle_u) - kept) / wish.share - even_rad(i);
            };
            // The flatter a line runs the less it goes around.
            all.low = std::max(all.low, offset(middle.high));
            all.high = std::min(all.high, offset(middle.low));
        }
        return all.low <= all.high ? std::optional(0.5 * (all.low + all.high)) : std::nullopt;
    }

    void steer(LegLine& line, const Wish& wish, double even) const {
        const double target = wish.psi(line, even, leg_.radius_mm);
        Range middle = middle_range(line, wish);
        for (int i = 0; i < kHalvings; ++i) {
            const double u = 0.5 * (middle.low + middle.high);
            (end_psi(line, wish, u) > target ? middle.low : middle.high) = u;
        }
        line.end_u = wish.u(line);
        line.middle_u = 0.5 * (middle.low + middle.high);
    }

    // Distances of neighbours along the leg.
    void look_at(const std::vector<LegLine>& lines, ElbowLeg& leg) const {
        bool closed = true;
        for (int place = 0; place <= kPlaces; ++place) {
            const double z = leg_.length_mm * place / kPlaces;
            double widest = 0.0;
            for (std::size_t i = 0; i < lines.size(); ++i) {
                const bool last = i + 1 == lines.size();
                const LegState a = state_at(lines[i], leg.run_mm, z, leg_.radius_mm);
                const LegState b = state_at(lines[last ? 0 : i + 1], leg.run_mm, z, leg_.radius_mm);
                const double apart = leg_.sign * (b.psi_rad - a.psi_rad) + (last ? 2.0 * kPi : 0.0);
                const double u = 0.5 * (a.u + b.u);
                widest = std::max(
                    widest, leg_.radius_mm * std::abs(apart) * std::sqrt(1.0 - 1.0 / (u * u)));
            }
            leg.widest_mm = std::max(leg.widest_mm, widest);
            // Where the bend is just closed so is the leg's first place, but for rounding.
            closed = closed && (place == 0 || widest <= width_mm_);
            if (closed) {
                leg.closed_mm = z;
            }
        }
    }

    const Leg& leg_;
    double width_mm_;
    double slip_;
    double best_fibre_mm_ = 0.0;
};

class Designer {
public:
    Designer(const ElbowTube& tube, const ElbowOptions& options)
        : tube_(tube), options_(options), width_mm_(options.width_mm / options.layers) {
        result_.bend = {tube.ring_radius_mm, tube.tube_radius_mm, tube.span_rad,
                        options.alpha0_rad};
        result_.theta_cycle_rad = torus_cycle(result_.bend).theta_rad;
        result_.needed = lines_for_tape(result_.bend, width_mm_);
    }

    ElbowLines run() {
        const int most = static_cast<int>(kMostLines * result_.needed);
        int count = result_.needed;
        for (;;) {
            design(count);
            const double widest = std::max(result_.leg[0].widest_mm, result_.leg[1].widest_mm);
            // Distances are nearly as 1 to the number of lines.
            const int wanted =
                std::max(count + 1, static_cast<int>(std::ceil(count * widest / width_mm_)));
            if (widest <= width_mm_ || count == most) {
                break;
            }
            count = std::min(wanted, most);
        }
        for (int i = 0; i < count; ++i) {
            lay(static_cast<std::size_t>(i));
        }
        return std::move(result_);
    }

private:
    void design(int count) {
        lines_ = torus_lines(result_.bend, count);
        for (std::size_t end = 0; end < 2; ++end) {
            Leg leg{tube_.tube_radius_mm, tube_.leg_mm[end], end == 0 ? 1.0 : -1.0, {}};
            for (const TorusLine& line : lines_) {
                const double phi = end == 0 ? line.phi_minus_rad : line.phi_plus_rad;
                const double rho = tube_.ring_radius_mm + tube_.tube_radius_mm * std::cos(phi);
                const double cosine = result_.bend.clairaut_mm() / rho;
                leg.lines.push_back(
                    {end == 0 ? -phi : phi, 1.0 / std::sqrt(1.0 - cosine * cosine), 0.0, 0.0});
            }
            std::tie(result_.leg[end], legs_[end]) =
                LegDesigner(leg, width_mm_, options_.slip).best();
        }
    }

    void lay(std::size_t i) {
        std::vector<ElbowStation> line;
        lay_leg(0, i, line);
        lay_bend(i, line);
        lay_leg(1, i, line);
        result_.line.push_back(std::move(line));
    }

    // Stations at least as close as asked for, with one at each end of a stretch; the one where the
    // last stretch ended is not repeated.
    void lay_leg(std::size_t end, std::size_t i, std::vector<ElbowStation>& out) const {
        const double length = tube_.leg_mm[end];
        if (length <= 0.0) {
            return;
        }
        const LegLine& line = legs_[end][i];
        const double run = result_.leg[end].run_mm;
        std::vector<double> z{0.0};
        const double flattest = std::min({line.u, line.middle_u, line.end_u});
        // Along the fibre dz / cos(angle); the steepest of the line rules.
        const double step = options_.station_mm * std::sqrt(1.0 - 1.0 / (flattest * flattest));
        for (const double to : {0.5 * run, run, length}) {
            const double from = z.back();
            const auto steps = static_cast<int>(std::ceil((to - from) / step));
            for (int k = 1; k <= steps; ++k) {
                z.push_back(from + (to - from) * k / steps);
            }
        }
        if (end == 0) {
            std::reverse(z.begin(), z.end());
        }
        const double before = out.empty() ? 0.0 : out.back().s_mm;
        const double whole = state_at(line, run, length, tube_.tube_radius_mm).s_mm;
        for (const double place : z) {
            const LegState state = state_at(line, run, place, tube_.tube_radius_mm);
            ElbowStation station;
            station.along_mm =
                end == 0 ? length - place : tube_.leg_mm[0] + tube_.bend_mm() + place;
            station.phi_rad = end == 0 ? -state.psi_rad : state.psi_rad;
            station.angle_rad = std::asin(1.0 / state.u);
            station.s_mm = before + (end == 0 ? whole - state.s_mm : state.s_mm);
            station.kn_per_mm = 1.0 / (state.u * state.u * tube_.tube_radius_mm);
            add(station, out);
        }
    }

    void lay_bend(std::size_t i, std::vector<ElbowStation>& out) const {
        const TorusLine& line = lines_[i];
        const double range = line.phi_plus_rad - line.phi_minus_rad;
        // ds/dphi = r / sin(alpha) is largest at the inner equator.
        const double sine = std::sin(least_angle_rad());
        const auto steps = static_cast<int>(
            std::ceil(range * tube_.tube_radius_mm / (sine * options_.station_mm)));
        const double before = out.empty() ? 0.0 : out.back().s_mm;
        const double first = torus_station(result_.bend, line.phi_minus_rad).length_mm;
        for (int k = 0; k <= steps; ++k) {
            const double phi = line.phi_minus_rad + range * k / steps;
            const TorusStation at = torus_station(result_.bend, phi);
            const double theta = k == 0       ? -0.5 * tube_.span_rad
                                 : k == steps ? 0.5 * tube_.span_rad
                                              : line.theta_rad + at.theta_rad;
            const double cosine = std::cos(at.alpha_rad);
            const double sin = std::sin(at.alpha_rad);
            const double rho = tube_.ring_radius_mm + tube_.tube_radius_mm * std::cos(phi);
            ElbowStation station;
            station.along_mm =
                tube_.leg_mm[0] + tube_.ring_radius_mm * (theta + 0.5 * tube_.span_rad);
            station.phi_rad = phi;
            station.angle_rad = at.alpha_rad;
            station.s_mm = before + at.length_mm - first;
            station.kn_per_mm =
                sin * sin / tube_.tube_radius_mm + cosine * cosine * std::cos(phi) / rho;
            add(station, out);
        }
    }

    [[nodiscard]] double least_angle_rad() const {
        return std::acos(result_.bend.clairaut_mm() /
                         (tube_.ring_radius_mm - tube_.tube_radius_mm));
    }

    static void add(ElbowStation station, std::vector<ElbowStation>& out) {
        constexpr double kSame_mm = 1e-9;  // where two stretches meet
        if (!out.empty()) {
            if (station.along_mm - out.back().along_mm < kSame_mm) {
                out.back().kn_per_mm = std::min(out.back().kn_per_mm, station.kn_per_mm);
                return;
            }
        }
        out.push_back(station);
    }

    const ElbowTube& tube_;
    const ElbowOptions& options_;
    double width_mm_;
    std::vector<TorusLine> lines_;
    std::array<std::vector<LegLine>, 2> legs_;
    ElbowLines result_;
};

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
    return Designer(tube, options).run();
}

}  // namespace meshwind
