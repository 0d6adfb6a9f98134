#include "winding/revolution/connecting_passes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/roots.h"
#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

// A slip ratio is halved so often: to rounding.
constexpr int kHalvings = 60;

// Parallels nearer to each other are one.
constexpr double kSame_mm = 1e-9;

// From polar to hoop takes some ten passes on a slender vessel; far more circle for ever.
constexpr int kMaxPasses = 40;

// A pass this long goes round more often than anyone would wind it.
constexpr double kLongest_mm = 2e4;

// Slip ratios over a rim are tried from none to the whole friction in so many steps to a side.
constexpr int kRimSteps = 8;

class Connector {
    using Kind = ConnectingGoal::Kind;

public:
    Connector(const Meridian& meridian, const ConnectingRequest& request)
        : meridian_(meridian), request_(request) {}

    ConnectingPasses run() {
        double arc_mm = request_.from_arc_mm;
        end_ = arc_mm < 0.5 * meridian_.length_mm() ? 0 : 1;
        while (!arrived_at(arc_mm)) {
            if (way_.passes.size() == kMaxPasses) {
                way_.failure = "after " + std::to_string(kMaxPasses) +
                               " passes with all the friction the fibre turns at radius " +
                               fixed(meridian_.at(arc_mm).radius_mm, 1) +
                               " mm, not where it should";
                return std::move(way_);
            }
            const std::optional<MeridianPass> pass = next_pass(arc_mm);
            if (!pass) {
                way_.failure = "from a parallel of radius " +
                               fixed(meridian_.at(arc_mm).radius_mm, 1) + " mm no friction up to " +
                               fixed(request_.friction, 3) + " leads it to the other end and round";
                return std::move(way_);
            }
            const bool upward = end_ == 0;
            append(upward ? pass->stations : way_back(*pass));
            const MeridianStation& stop = stop_of(*pass, upward);
            end_ = 1 - end_;
            arc_mm = stop.arc_mm;
            if (over_rim(*pass, upward)) {
                break;  // only where that is what is wanted
            }
        }
        way_.end = end_;
        return std::move(way_);
    }

private:
    [[nodiscard]] bool arrived_at(double arc_mm) const {
        const ConnectingGoal& goal = request_.goal[end_];
        return goal.kind == Kind::Parallel && std::abs(goal.arc_mm - arc_mm) < kSame_mm;
    }

    [[nodiscard]] MeridianPass pass(double arc_mm, double slip_ratio) const {
        return pass_from(meridian_, arc_mm, end_ == 0, slip_ratio, request_.station_mm,
                         kLongest_mm);
    }

    static const MeridianStation& stop_of(const MeridianPass& pass, bool upward) {
        return upward ? pass.stations.back() : pass.stations.front();
    }

    static bool over_rim(const MeridianPass& pass, bool upward) {
        return (upward ? pass.upper : pass.lower) == MeridianStop::End;
    }

    // How far a pass goes: the arc from its own end, beyond a rim by the angle that it has left.
    [[nodiscard]] double reach_mm(const MeridianPass& pass) const {
        const bool upward = end_ == 0;
        const MeridianStation& stop = stop_of(pass, upward);
        const double arc_mm = upward ? stop.arc_mm : meridian_.length_mm() - stop.arc_mm;
        const double left = 0.5 * kPi - stop.angle_rad;
        return arc_mm + (over_rim(pass, upward) ? left * stop.place.radius_mm : 0.0);
    }

    [[nodiscard]] std::optional<MeridianPass> next_pass(double arc_mm) const {
        const ConnectingGoal& goal = request_.goal[1 - end_];
        if (goal.kind != Kind::Parallel) {
            return goal.kind == Kind::Rim ? pass_over_rim(arc_mm) : farthest_pass(arc_mm);
        }
        const double wanted_mm = end_ == 0 ? goal.arc_mm : meridian_.length_mm() - goal.arc_mm;
        double low = -request_.friction;
        double high = request_.friction;
        MeridianPass at_low = pass(arc_mm, low);
        MeridianPass at_high = pass(arc_mm, high);
        if (reach_mm(at_low) > reach_mm(at_high)) {
            std::swap(low, high);
            std::swap(at_low, at_high);
        }
        if (wanted_mm <= reach_mm(at_low)) {
            return followable(at_low);
        }
        if (wanted_mm >= reach_mm(at_high)) {
            return followable(at_high);
        }
        const auto is_short = [&](double slip) {
            MeridianPass tried = pass(arc_mm, slip);
            const bool stops_short = !(reach_mm(tried) > wanted_mm);
            if (stops_short) {
                at_low = std::move(tried);
            }
            return stops_short;
        };
        // Both stop at the parallel, but for rounding; the one short of it ends in itself.
        halve({.holds = low, .fails = high}, kHalvings, is_short);
        return followable(at_low);
    }

    // A pass after which another can follow.
    [[nodiscard]] std::optional<MeridianPass> followable(const MeridianPass& pass) const {
        const bool upward = end_ == 0;
        const bool moved = pass.stations.size() > 1 && pass.length_mm() > request_.station_mm;
        const MeridianStop stop = upward ? pass.upper : pass.lower;
        const bool across = upward ? stop_of(pass, true).arc_mm > 0.5 * meridian_.length_mm()
                                   : stop_of(pass, false).arc_mm < 0.5 * meridian_.length_mm();
        return moved && across && stop == MeridianStop::Hoop ? std::optional(pass) : std::nullopt;
    }

    // Over the rim of the other end, steered as little as it takes to be turned there.
    [[nodiscard]] std::optional<MeridianPass> pass_over_rim(double arc_mm) const {
        for (int step = 0; step <= kRimSteps; ++step) {
            for (const double sign : {1.0, -1.0}) {
                MeridianPass tried = pass(arc_mm, sign * request_.friction * step / kRimSteps);
                const bool upward = end_ == 0;
                if (over_rim(tried, upward) &&
                    request_.can_turn(1 - end_, stop_of(tried, upward))) {
                    return tried;
                }
            }
        }
        return farthest_pass(arc_mm);
    }

    // Nearest to the other end, by all the friction: the next one will cross its rim more steeply.
    [[nodiscard]] std::optional<MeridianPass> farthest_pass(double arc_mm) const {
        std::optional<MeridianPass> best;
        for (const double slip : {request_.friction, -request_.friction, 0.0}) {
            std::optional<MeridianPass> next = followable(pass(arc_mm, slip));
            if (next && (!best || reach_mm(*next) > reach_mm(*best))) {
                best = std::move(next);
            }
        }
        return best;
    }

    void append(std::vector<MeridianStation> stations) {
        const double from_rad = way_.passes.empty() ? 0.0 : way_.passes.back().back().azimuth_rad;
        const double shift_rad = from_rad - stations.front().azimuth_rad;
        for (MeridianStation& station : stations) {
            station.azimuth_rad += shift_rad;
        }
        way_.passes.push_back(std::move(stations));
    }

    const Meridian& meridian_;
    const ConnectingRequest& request_;
    std::size_t end_ = 0;  // where the fibre is
    ConnectingPasses way_;
};

}  // namespace

ConnectingPasses connecting_passes(const Meridian& meridian, const ConnectingRequest& request) {
    return Connector(meridian, request).run();
}

std::vector<std::vector<MeridianStation>> other_way_round(const ConnectingPasses& way) {
    std::vector<std::vector<MeridianStation>> other;
    const double end_rad = way.passes.empty() ? 0.0 : way.passes.back().back().azimuth_rad;
    for (auto pass = way.passes.rbegin(); pass != way.passes.rend(); ++pass) {
        std::vector<MeridianStation>& turned = other.emplace_back(pass->rbegin(), pass->rend());
        const double end_mm = pass->back().s_mm;
        for (MeridianStation& station : turned) {
            station.angle_rad = kPi - station.angle_rad;
            station.azimuth_rad = end_rad - station.azimuth_rad;
            station.s_mm = end_mm - station.s_mm;
            station.slope = -station.slope;
        }
    }
    return other;
}

}  // namespace meshwind
