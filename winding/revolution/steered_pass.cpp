#include "winding/revolution/steered_pass.h"

#include <algorithm>
#include <cmath>

#include "core/roots.h"
#include "winding/revolution/concave_creases.h"

namespace meshwind {
namespace {

// As the steps of pass_through at stations of 4 mm.
constexpr double kStep_mm = 0.25;

// Halvings of an interval of the meridian: to rounding.
constexpr int kHalvings = 60;

// A step of the meridian between two places is at least this share of a longer one: what is left
// of a step by rounding is none.
constexpr double kMinStep_mm = 1e-12;

// Radii of turns are met within this, by the pass: below what any axis resolves.
constexpr double kSameTurn_mm = 1e-6;

// The pass steps over joints, where kn jumps, so that its turns are a little beside those that were
// aimed at; aims corrected by it are met after two or three.
constexpr int kCorrections = 8;

constexpr int kBits = 50;

// A path between two nodes of the meridian.
class Stretch {
public:
    Stretch(const Meridian& meridian, const ConcaveCreases& hollow, double from_mm, double to_mm,
            double slip_ratio)
        : meridian_(meridian),
          hollow_(hollow),
          from_mm_(from_mm),
          to_mm_(to_mm),
          slip_ratio_(slip_ratio) {}

    [[nodiscard]] MeridianPlace place(double arc_mm) const {
        // At a crease the meridian answers for the piece behind it.
        const double high = std::max(from_mm_, to_mm_);
        return meridian_.at(
            arc_mm >= high && high < meridian_.length_mm() ? std::nextafter(high, -1.0) : arc_mm);
    }

    [[nodiscard]] double stepped(double arc_mm, double c_mm, double h_mm) const {
        const double k1 = rate(arc_mm, c_mm);
        const double k2 = rate(arc_mm + 0.5 * h_mm, c_mm + 0.5 * h_mm * k1);
        const double k3 = rate(arc_mm + 0.5 * h_mm, c_mm + 0.5 * h_mm * k2);
        const double k4 = rate(arc_mm + h_mm, c_mm + h_mm * k3);
        return c_mm + h_mm / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }

    // Of the angle to the meridian; 1 or more where the body is too narrow for it.
    [[nodiscard]] double sine(double arc_mm, double c_mm) const {
        return c_mm / place(arc_mm).radius_mm;
    }

private:
    [[nodiscard]] double rate(double arc_mm, double c_mm) const {
        const MeridianPlace at = place(arc_mm);
        const double c = std::min(c_mm, at.radius_mm);
        const double sine = at.radius_mm > 0.0 ? c / at.radius_mm : 1.0;
        if (hollow_.near_bridge(at, arc_mm, std::asin(sine), 1.0)) {
            return 0.0;
        }
        const double bent = at.curvature_per_mm * (1.0 - sine * sine) * at.radius_mm;
        const double round = std::cos(at.slope_rad) * sine * sine;
        return -slip_ratio_ * std::max(bent + round, 0.0);
    }

    const Meridian& meridian_;
    const ConcaveCreases& hollow_;
    double from_mm_;
    double to_mm_;
    double slip_ratio_;
};

// Follows c over one stretch; true where it turns there.
bool follow(const Stretch& stretch, double to_mm, SteeredEnd& at) {
    const double sign = to_mm > at.arc_mm ? 1.0 : -1.0;
    const int steps =
        std::max(1, static_cast<int>(std::ceil(std::abs(to_mm - at.arc_mm) / kStep_mm)));
    const double h = std::abs(to_mm - at.arc_mm) / steps;
    const double from = at.arc_mm;
    for (int i = 0; i < steps; ++i) {
        const double arc = i + 1 == steps ? to_mm : from + sign * h * (i + 1);
        const double step = arc - at.arc_mm;
        if (std::abs(step) < kMinStep_mm) {
            continue;
        }
        const double c = stretch.stepped(at.arc_mm, at.turning_mm, step);
        const double sine = stretch.sine(arc, c);
        if (sine < 1.0) {
            at.arc_mm = arc;
            at.turning_mm = c;
            at.most_sine = std::max(at.most_sine, sine);
            continue;
        }
        const auto goes_on = [&](double part) {
            const double c_there = stretch.stepped(at.arc_mm, at.turning_mm, part);
            return stretch.sine(at.arc_mm + part, c_there) < 1.0;
        };
        const double left = halve({.holds = 0.0, .fails = step}, kHalvings, goes_on).holds;
        at.turning_mm = stretch.stepped(at.arc_mm, at.turning_mm, left);
        at.arc_mm += left;
        at.turned = true;
        at.most_sine = 1.0;
        return true;
    }
    return false;
}

// Nodes between two places, in the direction from one to the other, and the end.
std::vector<double> ways(const Meridian& meridian, double from_mm, double to_mm) {
    std::vector<double> way;
    const double low = std::min(from_mm, to_mm);
    const double high = std::max(from_mm, to_mm);
    for (const double node : meridian.nodes_mm()) {
        if (node > low && node < high) {
            way.push_back(node);
        }
    }
    if (to_mm < from_mm) {
        std::reverse(way.begin(), way.end());
    }
    way.push_back(to_mm);
    return way;
}

// Turns aimed at, and how a path leads from the lower one upward.
class Aim {
public:
    Aim(const Meridian& meridian, double lower_mm, double upper_mm)
        : meridian_(meridian),
          lower_mm_(lower_mm),
          upper_mm_(upper_mm),
          widest_mm_(meridian.widest_mm()),
          low_arc_mm_(narrow_place_mm(meridian, lower_mm, false)),
          high_arc_mm_(narrow_place_mm(meridian, upper_mm, true)) {}

    [[nodiscard]] bool exists() const { return low_arc_mm_ && high_arc_mm_; }

    // By how much it turns at too large a radius above; below 0 it comes by where it should turn.
    [[nodiscard]] double excess_mm(double slip_ratio) const {
        return steer_from(meridian_, *low_arc_mm_, lower_mm_, slip_ratio, *high_arc_mm_)
                   .turning_mm -
               upper_mm_;
    }

    // Where it turns above, if it does.
    [[nodiscard]] double reached_mm(double slip_ratio) const {
        const SteeredEnd end =
            steer_from(meridian_, *low_arc_mm_, lower_mm_, slip_ratio, meridian_.length_mm());
        return end.turned ? end.turning_mm : 0.0;
    }

    [[nodiscard]] double angle_rad(double slip_ratio) const {
        const double c =
            steer_from(meridian_, *low_arc_mm_, lower_mm_, slip_ratio, widest_mm_).turning_mm;
        return std::asin(std::clamp(c / meridian_.at(widest_mm_).radius_mm, 0.0, 1.0));
    }

    // None where no slip of at most this size does.
    [[nodiscard]] std::optional<double> slip(double most_slip) const {
        const double straight = excess_mm(0.0);
        if (std::abs(straight) < kSameTurn_mm) {
            return 0.0;
        }
        const double far = straight > 0.0 ? most_slip : -most_slip;
        const double there = excess_mm(far);
        if ((there > 0.0) == (straight > 0.0) && there != 0.0) {
            return std::nullopt;
        }
        const SignChange ends = far < 0.0 ? SignChange{far, 0.0, there, straight}
                                          : SignChange{0.0, far, straight, there};
        const auto excess = [this](double slip_ratio) { return excess_mm(slip_ratio); };
        return zero_between(ends, excess, {.bits = kBits}).middle();
    }

    [[nodiscard]] double most_reached_mm(double most_slip) const {
        return reached_mm(excess_mm(0.0) > 0.0 ? most_slip : -most_slip);
    }

private:
    const Meridian& meridian_;
    double lower_mm_;
    double upper_mm_;
    double widest_mm_;
    std::optional<double> low_arc_mm_;
    std::optional<double> high_arc_mm_;
};

double turning_mm(const MeridianStation& at) {
    return at.place.radius_mm * std::sin(at.angle_rad);
}

}  // namespace

SteeredEnd steer_from(const Meridian& meridian, double arc_mm, double turning_mm, double slip_ratio,
                      double to_arc_mm) {
    SteeredEnd at{arc_mm, turning_mm, false, turning_mm / meridian.at(arc_mm).radius_mm};
    if (arc_mm == to_arc_mm) {
        return at;
    }
    const ConcaveCreases hollow(meridian);
    for (const double to_mm : ways(meridian, arc_mm, to_arc_mm)) {
        if (follow(Stretch(meridian, hollow, at.arc_mm, to_mm, slip_ratio), to_mm, at)) {
            break;
        }
    }
    return at;
}

std::optional<double> narrow_place_mm(const Meridian& meridian, double radius_mm, bool upper) {
    double arc = meridian.widest_mm();
    if (meridian.at(arc).radius_mm <= radius_mm) {
        return std::nullopt;
    }
    for (const double to_mm : ways(meridian, arc, upper ? meridian.length_mm() : 0.0)) {
        const int steps =
            std::max(1, static_cast<int>(std::ceil(std::abs(to_mm - arc) / kStep_mm)));
        const double from = arc;
        for (int i = 1; i <= steps; ++i) {
            const double next = i == steps ? to_mm : from + (to_mm - from) * i / steps;
            if (meridian.at(next).radius_mm > radius_mm) {
                arc = next;
                continue;
            }
            const auto is_wide = [&](double arc_mm) {
                return meridian.at(arc_mm).radius_mm > radius_mm;
            };
            return halve({.holds = arc, .fails = next}, kHalvings, is_wide).holds;
        }
    }
    return std::nullopt;
}

SteeringFinding steer_between(const Meridian& meridian, const SteeringTask& task) {
    SteeringFinding finding;
    double lower_mm = task.lower_mm;
    double upper_mm = task.upper_mm;
    for (int i = 0; i < kCorrections; ++i) {
        const Aim aim(meridian, lower_mm, upper_mm);
        if (!aim.exists()) {
            return finding;
        }
        const std::optional<double> slip = aim.slip(task.most_slip);
        if (!slip) {
            finding.reached_mm = aim.most_reached_mm(task.most_slip);
            return finding;
        }
        SteeredPass steered;
        steered.slip_ratio = *slip;
        steered.angle_rad = aim.angle_rad(*slip);
        steered.pass = pass_through(meridian, meridian.widest_mm(), steered.angle_rad, *slip,
                                    task.station_mm, task.longest_mm);
        const double low_off = turning_mm(steered.pass.stations.front()) - task.lower_mm;
        const double high_off = turning_mm(steered.pass.stations.back()) - task.upper_mm;
        const bool turns =
            steered.pass.lower == MeridianStop::Hoop && steered.pass.upper == MeridianStop::Hoop;
        if (turns && std::max(std::abs(low_off), std::abs(high_off)) < kSameTurn_mm) {
            finding.found = std::move(steered);
            return finding;
        }
        lower_mm -= low_off;
        upper_mm -= high_off;
    }
    return finding;
}

}  // namespace meshwind
