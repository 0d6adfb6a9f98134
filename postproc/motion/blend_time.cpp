#include "postproc/motion/blend_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string_view>
#include <utility>

#include <Eigen/Core>

#include "core/units.h"

namespace meshwind {
namespace {

// Shares of a block's length and speed that count as none: cycles end blocks to rounding.
constexpr double kEnd = 1e-9;

// Of the acceleration, for each of two blocks that run at once.
constexpr double kShareInBlends = 0.5;

// Where a block speeds up for long several cycles are run as one: so many of a ramp are enough.
constexpr double kCyclesOfRamp = 300.0;

// Where corners turn back on themselves a blend has no side to leave them on.
constexpr double kMinCosine = 1e-3;

struct Segment {
    double length = 0.0;        // of X Y Z; of U V W where these rest; else of A B C: mm or deg
    double speed = 0.0;         // that the program asks for, per second
    double acceleration = 0.0;  // that it may have, per second^2
    Eigen::Vector3d along = Eigen::Vector3d::Zero();  // of X Y Z, unit or none

    [[nodiscard]] double top_speed() const {
        return std::min(speed, std::sqrt(acceleration * length));
    }
};

Segment segment_of(const Machine& machine, const BlockList& list, std::size_t block) {
    constexpr std::string_view kMain = "XYZ";
    Eigen::Vector3d main = Eigen::Vector3d::Zero();
    double second2 = 0.0;
    double rotary2 = 0.0;
    double time2 = 0.0;  // way over acceleration, of the axis that needs most
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        const double way = list.value(block, a) - list.value(block - 1, a);
        const char letter = list.axes[a].letter;
        const std::size_t xyz = kMain.find(letter);
        if (xyz != std::string_view::npos) {
            main[static_cast<Eigen::Index>(xyz)] = way;
        } else {
            (letter >= 'A' && letter <= 'C' ? rotary2 : second2) += way * way;
        }
        const Axis& axis = machine.axis(a);
        const double acceleration =
            axis.type == AxisType::Rotary ? deg_from_rad(axis.acceleration) : axis.acceleration;
        time2 = std::max(time2, std::abs(way) / acceleration);
    }
    Segment segment;
    segment.length = main.norm() > 0.0 ? main.norm() : std::sqrt(second2 > 0.0 ? second2 : rotary2);
    if (segment.length > 0.0) {
        segment.speed = segment.length / list.blocks[block].duration_s;
        segment.acceleration = segment.length / time2;
        segment.along = main.norm() > 0.0 ? Eigen::Vector3d(main.normalized()) : main;
    }
    return segment;
}

// Speeds at which a block and the next one may share their time.
struct BlendSpeeds {
    double here = 0.0;
    double next = 0.0;
};

BlendSpeeds blend_speeds(const Segment& here, const Segment& next, double corner_mm) {
    const double top_here = here.top_speed();
    const double top_next = next.top_speed();
    const double longest_s = std::min(here.length / top_here, next.length / top_next);
    const double blend_s =
        std::min(longest_s, std::max(top_here / here.acceleration, top_next / next.acceleration));
    BlendSpeeds speeds{std::min(top_here, blend_s * here.acceleration),
                       std::min(top_next, blend_s * next.acceleration)};
    const bool turns = here.along.norm() > 0.0 && next.along.norm() > 0.0;
    const double cosine =
        std::sqrt(std::max(0.0, 0.5 * (1.0 - here.along.dot(next.along))));  // of half the corner
    if (turns && std::isfinite(corner_mm) && cosine > kMinCosine) {
        const double most = 2.0 * std::sqrt(here.acceleration * corner_mm / cosine);
        speeds = {std::min(speeds.here, most), std::min(speeds.next, most)};
    }
    return speeds;
}

// What has been run of a block.
struct Running {
    double way = 0.0;
    double speed = 0.0;
    bool slows_down = false;  // for its end
};

void run_cycle(const Segment& segment, double wanted, double cycle_s, Running& state) {
    const double left = segment.length - state.way;
    const double half_step = 0.5 * segment.acceleration * cycle_s;
    const double root =
        segment.acceleration * (2.0 * left - state.speed * cycle_s) + half_step * half_step;
    const double fastest = root > half_step * half_step ? std::sqrt(root) - half_step
                           : root < 0.0                 ? 0.0
                                                        : -half_step;
    const double change = std::clamp((std::min(fastest, wanted) - state.speed) / cycle_s,
                                     -segment.acceleration, segment.acceleration);
    const double speed = std::max(0.0, state.speed + change * cycle_s);
    state.way = std::min(segment.length, state.way + 0.5 * (state.speed + speed) * cycle_s);
    state.speed = speed;
    state.slows_down = change < 0.0 && std::abs(fastest - speed) <= kEnd * (1.0 + segment.speed);
}

// Whole cycles at the speed that is wanted, as many as are left before the block slows down.
double cruising_cycles(const Segment& segment, double cycle_s, const Running& state) {
    if (state.speed < segment.speed) {
        return 0.0;
    }
    const double brakes_for = 0.5 * state.speed * state.speed / segment.acceleration;
    const double left = segment.length - state.way - brakes_for;
    return std::max(0.0, std::floor(left / (state.speed * cycle_s)) - 2.0);
}

// From rest to rest.
double stopped_s(const Segment& segment) {
    const double top = segment.top_speed();
    return segment.length / top + top / segment.acceleration;
}

// Blends block by block, cycle by cycle. \return seconds per segment
std::vector<double> blended_s(const std::vector<Segment>& segments, const BlendPlanner& planner) {
    std::vector<double> times_s;
    Running state;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const Segment& here = segments[i];
        const bool blends = i + 1 < segments.size();
        const BlendSpeeds speeds =
            blends ? blend_speeds(here, segments[i + 1], planner.corner_mm) : BlendSpeeds{};
        Running next;
        double begun_at = 0.0;  // speed when the blend begins; 0: it has not
        double& time_s = times_s.emplace_back(0.0);
        const double ramp_s = here.top_speed() / here.acceleration;
        const double cycle_s = std::max(planner.cycle_s, ramp_s / kCyclesOfRamp);
        while (here.length - state.way > kEnd * here.length) {
            const double cycles = cruising_cycles(here, cycle_s, state);
            state.way += cycles * state.speed * cycle_s;
            time_s += cycles * cycle_s;
            const double before = state.way;
            run_cycle(here, here.speed, cycle_s, state);
            if (state.way <= before) {
                break;  // as near to its end as cycles come
            }
            time_s += cycle_s;
            if (begun_at <= 0.0 && blends && state.slows_down && state.speed < speeds.here) {
                begun_at = state.speed;
            }
            if (begun_at > 0.0) {
                const double share = std::clamp(1.0 - state.speed / begun_at, 0.0, 1.0);
                run_cycle(segments[i + 1], share * speeds.next * begun_at / speeds.here, cycle_s,
                          next);
            }
        }
        state = next;
    }
    return times_s;
}

}  // namespace

std::vector<double> blend_times_s(const Machine& machine, const BlockList& list,
                                  const BlendPlanner& planner) {
    std::vector<Segment> segments;
    std::vector<std::size_t> block;  // of each segment
    std::vector<double> stops_s;
    for (std::size_t b = 1; b < list.blocks.size(); ++b) {
        Segment segment = segment_of(machine, list, b);
        if (segment.length > 0.0) {
            stops_s.push_back(stopped_s(segment));
            segment.acceleration *= kShareInBlends;
            segments.push_back(segment);
            block.push_back(b);
        }
    }
    const auto sum = [](const std::vector<double>& times_s) {
        return std::accumulate(times_s.begin(), times_s.end(), 0.0);
    };
    std::vector<double> best_s = planner.stops ? stops_s : blended_s(segments, planner);
    if (sum(stops_s) < sum(best_s)) {
        best_s = std::move(stops_s);
    }
    std::vector<double> times_s(list.blocks.size(), 0.0);
    for (std::size_t i = 0; i < block.size(); ++i) {
        times_s[block[i]] = best_s[i];
    }
    return times_s;
}

}  // namespace meshwind
