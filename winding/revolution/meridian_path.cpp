#include "winding/revolution/meridian_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/roots.h"
#include "core/units.h"
#include "winding/revolution/concave_creases.h"

namespace meshwind {
namespace {

constexpr int kStepsPerStation = 16;

// Ends of a path are found by halving the last step so often: to rounding.
constexpr int kHalvings = 60;

// Angles this near to hoop are hoop.
constexpr double kHoop_rad = 1e-13;

constexpr double kHalf_rad = 0.5 * kPi;

// Beside a bridge stations stand so closely that its ends are known.
constexpr double kBesideBridge = 2.0;
constexpr int kStepsBesideBridge = 2;

struct State {
    double arc_mm = 0.0;
    double azimuth_rad = 0.0;
    double angle_rad = 0.0;
};

State along(const State& a, double h, const State& rate) {
    return {a.arc_mm + h * rate.arc_mm, a.azimuth_rad + h * rate.azimuth_rad,
            a.angle_rad + h * rate.angle_rad};
}

// One direction of a path, within the smooth stretch of the meridian that it is on.
class Follower {
public:
    Follower(const Meridian& meridian, double slip_ratio, double sign)
        : meridian_(meridian), slip_ratio_(slip_ratio), sign_(sign), hollow_(meridian) {
        ends_.push_back(0.0);
        for (const double crease : meridian.creases_mm()) {
            ends_.push_back(crease);
        }
        ends_.push_back(meridian.length_mm());
    }

    MeridianStop follow(State state, double station_mm, double longest_mm,
                        std::vector<MeridianStation>& stations) {
        enter(state.arc_mm);
        double s_mm = 0.0;
        stations.push_back(station(state, s_mm));
        if (state.arc_mm == edge_mm()) {
            if (!enter_next()) {
                return MeridianStop::End;
            }
            stations.push_back(station(state, s_mm));
        }
        const double h = station_mm / kStepsPerStation;
        for (int i = 1; s_mm < longest_mm; ++i) {
            double step = h;
            State next = stepped(state, h);
            const Event event = event_of(next);
            if (event != Event::None) {
                step = cut(state, h);
                next = stepped(state, step);
            }
            state = next;
            s_mm += step;
            if (event == Event::Hoop) {
                state.angle_rad = kHalf_rad;
                stations.push_back(station(state, s_mm));
                return MeridianStop::Hoop;
            }
            if (event == Event::Edge) {
                state.arc_mm = edge_mm();
                stations.push_back(station(state, s_mm));
                if (!enter_next()) {
                    return MeridianStop::End;
                }
                stations.push_back(station(state, s_mm));
                i = 0;
            } else if (i % (bridges(state, kBesideBridge) ? kStepsBesideBridge
                                                          : kStepsPerStation) ==
                       0) {
                stations.push_back(station(state, s_mm));
            }
        }
        return MeridianStop::Length;
    }

private:
    enum class Event { None, Hoop, Edge };

    void enter(double arc_mm) {
        const auto above = std::upper_bound(ends_.begin() + 1, ends_.end() - 1, arc_mm);
        stretch_ = static_cast<std::size_t>(above - ends_.begin()) - 1;
        set_bounds();
    }

    bool enter_next() {
        if ((sign_ > 0.0 && stretch_ + 2 == ends_.size()) || (sign_ < 0.0 && stretch_ == 0)) {
            return false;
        }
        stretch_ += sign_ > 0.0 ? 1 : std::numeric_limits<std::size_t>::max();
        set_bounds();
        return true;
    }

    // Where the path leaves the stretch.
    [[nodiscard]] double edge_mm() const { return sign_ > 0.0 ? high_mm_ : low_mm_; }

    void set_bounds() {
        low_mm_ = ends_[stretch_];
        high_mm_ = ends_[stretch_ + 1];
    }

    // What is asked of the stretch is its own, up to its ends: a crease belongs to the one behind.
    [[nodiscard]] MeridianPlace place(double arc_mm) const {
        const double below =
            stretch_ + 2 == ends_.size() ? high_mm_ : std::nextafter(high_mm_, -1.0);
        return meridian_.at(std::clamp(arc_mm, low_mm_, below));
    }

    [[nodiscard]] MeridianStation station(const State& state, double s_mm) const {
        return {place(state.arc_mm), state.arc_mm, state.azimuth_rad, state.angle_rad,
                sign_ * s_mm};
    }

    [[nodiscard]] State rate(const State& state) const {
        const MeridianPlace at = place(state.arc_mm);
        const double c = std::cos(state.angle_rad);
        const double s = std::sin(state.angle_rad);
        const double kn =
            at.curvature_per_mm * c * c + std::cos(at.slope_rad) * s * s / at.radius_mm;
        const double kg = bridges(state, 1.0) ? 0.0 : slip_ratio_ * std::max(kn, 0.0);
        return {sign_ * c, sign_ * s / at.radius_mm,
                sign_ * (-std::sin(at.slope_rad) * s / at.radius_mm - kg)};
    }

    [[nodiscard]] bool bridges(const State& state, double times) const {
        return hollow_.near_bridge(place(state.arc_mm), state.arc_mm, state.angle_rad, times);
    }

    [[nodiscard]] State stepped(const State& from, double h) const {
        const State k1 = rate(from);
        const State k2 = rate(along(from, 0.5 * h, k1));
        const State k3 = rate(along(from, 0.5 * h, k2));
        const State k4 = rate(along(from, h, k3));
        return along(along(along(along(from, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3), h / 6.0, k4);
    }

    [[nodiscard]] Event event_of(const State& state) const {
        if (state.angle_rad > kHalf_rad - kHoop_rad) {
            return Event::Hoop;
        }
        return state.arc_mm >= high_mm_ || state.arc_mm <= low_mm_ ? Event::Edge : Event::None;
    }

    // The part of a step up to where it leaves the stretch or turns.
    [[nodiscard]] double cut(const State& from, double h) const {
        const auto goes_on = [&](double part) {
            return event_of(stepped(from, part)) == Event::None;
        };
        return halve({.holds = 0.0, .fails = h}, kHalvings, goes_on).holds;
    }

    const Meridian& meridian_;
    double slip_ratio_;
    double sign_;
    std::vector<double> ends_;  // of the smooth stretches
    ConcaveCreases hollow_;
    std::size_t stretch_ = 0;
    double low_mm_ = 0.0;
    double high_mm_ = 0.0;
};

}  // namespace

MeridianPass pass_through(const Meridian& meridian, double arc_mm, double angle_rad,
                          const HalfSlips& slip, double station_mm, double longest_mm) {
    const State start{arc_mm, 0.0, angle_rad};
    std::vector<MeridianStation> down;
    MeridianPass pass;
    pass.lower = Follower(meridian, slip.below, -1.0).follow(start, station_mm, longest_mm, down);
    pass.stations.assign(down.rbegin(), down.rend());
    pass.stations.pop_back();
    pass.upper =
        Follower(meridian, slip.above, 1.0).follow(start, station_mm, longest_mm, pass.stations);
    const double s0 = pass.stations.front().s_mm;
    for (MeridianStation& station : pass.stations) {
        station.s_mm -= s0;
    }
    return pass;
}

MeridianPass pass_through(const Meridian& meridian, double arc_mm, double angle_rad,
                          double slip_ratio, double station_mm, double longest_mm) {
    return pass_through(meridian, arc_mm, angle_rad, HalfSlips{slip_ratio, slip_ratio}, station_mm,
                        longest_mm);
}

MeridianPass pass_from(const Meridian& meridian, double arc_mm, bool upward, double slip_ratio,
                       double station_mm, double longest_mm) {
    MeridianPass pass;
    const MeridianStop stop =
        Follower(meridian, slip_ratio, upward ? 1.0 : -1.0)
            .follow({arc_mm, 0.0, kHalf_rad}, station_mm, longest_mm, pass.stations);
    (upward ? pass.upper : pass.lower) = stop;
    (upward ? pass.lower : pass.upper) = MeridianStop::Hoop;
    if (!upward) {
        std::reverse(pass.stations.begin(), pass.stations.end());
        const double s0 = pass.stations.front().s_mm;
        for (MeridianStation& station : pass.stations) {
            station.s_mm -= s0;
        }
    }
    return pass;
}

std::vector<MeridianStation> way_back(const MeridianPass& pass) {
    std::vector<MeridianStation> back(pass.stations.rbegin(), pass.stations.rend());
    const MeridianStation end = pass.stations.back();
    for (MeridianStation& station : back) {
        station.angle_rad = kPi - station.angle_rad;
        station.azimuth_rad = end.azimuth_rad - station.azimuth_rad;
        station.s_mm = end.s_mm - station.s_mm;
        station.slope = -station.slope;
    }
    return back;
}

PathPoint swept(const MeridianStation& station, double turn_rad) {
    const double azimuth = station.azimuth_rad + turn_rad;
    const MeridianPlace& at = station.place;
    const Eigen::Vector3d radial(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Eigen::Vector3d around(-radial.y(), radial.x(), 0.0);
    const Eigen::Vector3d up =
        std::sin(at.slope_rad) * radial + std::cos(at.slope_rad) * Eigen::Vector3d::UnitZ();
    const double c = std::cos(station.angle_rad);
    const double s = std::sin(station.angle_rad);
    PathPoint point;
    point.position_mm = at.radius_mm * radial + at.z_mm * Eigen::Vector3d::UnitZ();
    point.normal =
        std::cos(at.slope_rad) * radial - std::sin(at.slope_rad) * Eigen::Vector3d::UnitZ();
    point.tangent = c * up + s * around;
    point.s_mm = station.s_mm;
    point.kn_per_mm = at.curvature_per_mm * c * c + std::cos(at.slope_rad) * s * s / at.radius_mm;
    return point;
}

}  // namespace meshwind
