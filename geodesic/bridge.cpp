#include "geodesic/bridge.h"

#include <algorithm>
#include <cmath>

#include "core/roots.h"
#include "geodesic/slip_and_bridging.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Step over the wall in mean edges.
constexpr double kStepEdges = 0.5;

// Least angle by which the wall must stand over the fibre: 1 um at 10 mm.
constexpr double kTouch_rad = 1e-7;

// The wall under a step of the fibre is no longer than so many steps.
constexpr double kMaxDetour = 4.0;

// The place of contact is found to so many halvings of two steps.
constexpr int kContactHalvings = 30;

// Where a path leaves the wall is found to so many halvings of the way between two stations.
constexpr int kHalvings = 14;

// Stations before the first lifted one at which leaving is tried: the string over a path knows
// where only to a station.
constexpr std::size_t kStationsBefore = 2;

// Bridges along one path; more means a wall of spikes.
constexpr int kMaxBridges = 200;

double step_mm(const Surface& surface) {
    return kStepEdges * surface.mean_edge_mm;
}

// The wall under a straight fibre, seen from where the fibre begins.
class Lookout {
public:
    Lookout(const FieldWalker& from, const Vector3d& along)
        : from_mm_(from.position_mm()), along_(along), scout_(from) {}

    // To where the wall is nearest to the fibre; false where there is none.
    bool go(double ahead_mm) { return scout_.move_under(from_mm_ + ahead_mm * along_); }

    [[nodiscard]] double ahead_mm() const { return along_.dot(sight()); }
    // Angle by which the wall stands over the fibre.
    [[nodiscard]] double over_rad() const {
        const Vector3d up = scout_.normal() - along_ * along_.dot(scout_.normal());
        return up.normalized().dot(sight()) / ahead_mm();
    }
    // > 0 where the wall turns away; a fibre touches it where this rises through zero.
    [[nodiscard]] double away_mm() const { return scout_.normal().dot(sight()); }

    [[nodiscard]] Vector3d sight() const { return scout_.position_mm() - from_mm_; }

    // On a line of sight from where the fibre begins, beside the wall here.
    // \param line unit
    [[nodiscard]] Vector3d on_line_mm(const Vector3d& line) const {
        return from_mm_ + line.dot(sight()) * line;
    }
    // Of the line over the wall here.
    [[nodiscard]] double height_mm(const Vector3d& line) const {
        return scout_.normal().dot(on_line_mm(line) - scout_.position_mm());
    }

private:
    Vector3d from_mm_;
    Vector3d along_;
    FieldWalker scout_;
};

// The place ahead that stands highest over a fibre, to a step.
struct Highest {
    double ahead_mm = 0.0;
    double beyond_mm = 0.0;           // a step beyond it, where the wall turns away there
    std::optional<Lookout> before{};  // a step before it
};

// Where the wall stands over a fibre from `from` and turns away again; nothing where it does not.
std::optional<Highest> highest_ahead(const FieldWalker& from, const Vector3d& along,
                                     double reach_mm, double step_mm, const LiftedWall* lifted) {
    Highest found;
    double over_rad = kTouch_rad;
    Vector3d line = along;  // of sight, over all of the wall up to here
    bool asked = false;     // whether anything further on stands over it
    Lookout last(from, along);
    for (double ahead = step_mm; ahead < reach_mm; ahead += step_mm) {
        Lookout here = last;
        if (!here.go(ahead)) {
            break;
        }
        const double over = here.over_rad();
        // Of a stretch along which the fibre lies on the wall, the end.
        if (over > kTouch_rad && over >= over_rad - kTouch_rad) {
            over_rad = std::max(over_rad, over);
            found = {ahead, 0.0, last};
            line = here.sight().normalized();
            asked = false;
        }
        if (found.before && found.beyond_mm == 0.0 && here.away_mm() > 0.0) {
            found.beyond_mm = ahead;
        }
        const bool rises = found.before && found.beyond_mm == 0.0;
        if (lifted != nullptr && !asked && !rises && here.height_mm(line) > lifted->height_mm()) {
            asked = true;
            if (lifted->is_free(here.on_line_mm(line), from.position_mm() + reach_mm * line)) {
                break;
            }
        }
        last = here;
    }
    // Without a step beyond it there is none, or a wall that rises on.
    return found.beyond_mm > 0.0 ? std::optional(found) : std::nullopt;
}

// How far ahead the fibre touches there.
double contact_mm(const Highest& highest, double step_mm) {
    const double before_mm = highest.ahead_mm - step_mm;
    if (before_mm <= 0.0 || highest.before->away_mm() >= 0.0) {
        return highest.ahead_mm;
    }
    Lookout last = *highest.before;  // where it was looked out from last
    const auto rises = [&](double ahead_mm) {
        last = *highest.before;
        return last.go(ahead_mm) && last.away_mm() < 0.0;
    };
    halve({.holds = before_mm, .fails = highest.beyond_mm}, kContactHalvings, rises);
    return last.ahead_mm();
}

// Leads along under the straight fibre through `target`.
AimField shadow(const Vector3d& target, const Vector3d& along, double step) {
    return [&target, &along, step](const Vector3d& x, const Vector3d&) {
        const Vector3d rest = target - x;
        const double left = along.dot(rest);
        return Aim{rest + (step - left) * along, -left, 1.0, 0.0};
    };
}

// Where along a path of stations the taut fibre leaves it: the path up to there and the bridge.
struct Leaving {
    std::size_t station;  // the last one kept
    PathPoint place;      // beyond that station
    Bridge bridge;
};

class TautTracer {
public:
    TautTracer(const Surface& surface, const Steering& steering, const TraceOptions& options,
               const LiftedWall* lifted)
        : surface_(surface), steering_(steering), options_(options), lifted_(lifted) {
        options_.method = TraceMethod::Patches;
    }

    TraceResult run(const SurfacePoint& start, const Vector3d& direction) {
        TraceResult result = stretch(start, direction, options_.max_length_mm);
        std::size_t begin = 0;  // stations before are settled
        for (int bridges = 0; bridges < kMaxBridges; ++bridges) {
            const std::optional<Leaving> leaving = first_leaving(result.path, begin);
            if (!leaving) {
                break;
            }
            result.path.resize(leaving->station + 1);
            result.path.push_back(leaving->place);
            append(result.path, leaving->bridge.under);
            begin = result.path.size() - 1;
            const PathPoint& landing = result.path.back();
            const double left = options_.max_length_mm - landing.s_mm;
            TraceResult rest =
                stretch(landing.at, landing.tangent, std::max(left, surface_.mean_edge_mm));
            rest.path.erase(rest.path.begin());
            append(result.path, rest.path);
            result.stop = rest.stop;
            result.rim = rest.rim;
        }
        return result;
    }

private:
    [[nodiscard]] TraceResult stretch(const SurfacePoint& start, const Vector3d& direction,
                                      double length_mm) const {
        TraceOptions options = options_;
        options.max_length_mm = length_mm;
        return trace(surface_, start, direction, steering_, options);
    }

    static void append(SurfacePath& path, const SurfacePath& more) {
        const double s_mm = path.back().s_mm;
        for (const PathPoint& point : more) {
            path.push_back(point);
            path.back().s_mm += s_mm;
        }
    }

    // The first bridge after station `begin` that is worth it.
    [[nodiscard]] std::optional<Leaving> first_leaving(const SurfacePath& path,
                                                       std::size_t begin) const {
        const SurfacePath rest(path.begin() + static_cast<std::ptrdiff_t>(begin), path.end());
        const TautString string = taut_string(rest);
        for (std::size_t first = 0; first < rest.size(); ++first) {
            if (string.gap_mm[first] <= 0.0) {
                continue;
            }
            std::size_t end = first;
            double worst = 0.0;
            for (; end < rest.size() && string.gap_mm[end] > 0.0; ++end) {
                worst = std::max(worst, string.gap_mm[end]);
            }
            for (std::size_t i = first - std::min(first, kStationsBefore);
                 worst >= kMinBridge_mm && i < end; ++i) {
                if (auto bridge = bridge_at(rest[i])) {
                    Leaving leaving{begin + i, rest[i], std::move(*bridge)};
                    if (i > 0) {
                        refine(rest[i - 1], rest[i].s_mm - rest[i - 1].s_mm, leaving);
                        leaving.station = begin + i - 1;
                        leaving.place.s_mm += path[begin].s_mm - rest[0].s_mm;
                    }
                    return leaving;
                }
            }
            first = end;
        }
        return std::nullopt;
    }

    [[nodiscard]] std::optional<Bridge> bridge_at(const PathPoint& place) const {
        return bridge_ahead(surface_, FieldWalker(surface_, place.at), place.tangent,
                            bridge_reach_mm(surface_), lifted_);
    }
    [[nodiscard]] bool is_under_wall(const PathPoint& place) const {
        return highest_ahead(FieldWalker(surface_, place.at), place.tangent,
                             bridge_reach_mm(surface_), step_mm(surface_), lifted_)
            .has_value();
    }

    // Halves the way from a station before a bridge to one after its beginning.
    void refine(const PathPoint& before, double way_mm, Leaving& leaving) const {
        PathPoint first = leaving.place;
        const auto is_beyond = [&](double gone_mm) {
            PathPoint place = stretch(before.at, before.tangent, gone_mm).path.back();
            place.s_mm += before.s_mm;
            const bool beyond = is_under_wall(place);
            if (beyond) {
                first = place;
            }
            return beyond;
        };
        halve({.holds = way_mm, .fails = 0.0}, kHalvings, is_beyond);
        if (auto bridge = bridge_at(first)) {
            leaving.bridge = std::move(*bridge);
            leaving.place = first;
        }
    }

    const Surface& surface_;
    Steering steering_;
    TraceOptions options_;
    const LiftedWall* lifted_;
};

}  // namespace

double bridge_reach_mm(const Surface& surface) {
    return std::max(kBridgeReach_mm, kBridgeReachEdges * surface.mean_edge_mm);
}

std::optional<Bridge> bridge_ahead(const Surface& surface, const FieldWalker& from,
                                   const Vector3d& along, double reach_mm,
                                   const LiftedWall* lifted) {
    const double step = step_mm(surface);
    const std::optional<Highest> highest = highest_ahead(from, along, reach_mm, step, lifted);
    if (!highest) {
        return std::nullopt;
    }
    const double contact = contact_mm(*highest, step);
    Bridge bridge{{}, {}, from};
    const Vector3d& start = from.position_mm();
    double length_mm = 0.0;
    for (double ahead = 0.0; ahead < contact;) {
        ahead = std::min(ahead + step, contact);
        const Vector3d target = start + ahead * along;
        const FieldWalk walk = bridge.far.walk(shadow(target, along, step), kMaxDetour * step, step,
                                               [&](const PathPoint& station) {
                                                   bridge.under.push_back(station);
                                                   bridge.under.back().s_mm += length_mm;
                                               });
        if (walk.stop != FieldStop::Arrived) {
            return std::nullopt;
        }
        length_mm += walk.length_mm;
        bridge.under.push_back(bridge.far.station(along));
        bridge.under.back().s_mm = length_mm;
    }
    const Vector3d chord = bridge.under.back().position_mm - start;
    for (const PathPoint& station : bridge.under) {
        const Vector3d rise = station.position_mm - start;
        bridge.gap_mm.push_back(
            station.normal.dot(rise.dot(chord) / chord.squaredNorm() * chord - rise));
    }
    return bridge;
}

TraceResult trace_taut(const Surface& surface, const SurfacePoint& start, const Vector3d& direction,
                       const Steering& steering, const TraceOptions& options,
                       const LiftedWall* lifted) {
    return TautTracer(surface, steering, options, lifted).run(start, direction);
}

}  // namespace meshwind
