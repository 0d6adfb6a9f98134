#include "geodesic/bridge.h"

#include <algorithm>
#include <cmath>

#include "geodesic/measure.h"

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

private:
    [[nodiscard]] Vector3d sight() const { return scout_.position_mm() - from_mm_; }

    Vector3d from_mm_;
    Vector3d along_;
    FieldWalker scout_;
};

// How far ahead a fibre from `from` touches the wall that stands over it; 0 where none does.
double contact_ahead(const FieldWalker& from, const Vector3d& along, double reach_mm,
                     double step_mm) {
    Lookout last(from, along);
    std::optional<Lookout> before;  // a step before the highest place
    double highest = kTouch_rad;
    double highest_at = 0.0;
    double beyond = 0.0;  // a step beyond the highest place, where the wall turns away there
    for (double ahead = step_mm; ahead < reach_mm; ahead += step_mm) {
        Lookout here = last;
        if (!here.go(ahead)) {
            break;
        }
        const double over = here.over_rad();
        // Of a stretch along which the fibre lies on the wall, the end.
        if (over > kTouch_rad && over >= highest - kTouch_rad) {
            highest = std::max(highest, over);
            highest_at = ahead;
            before = last;
            beyond = 0.0;
        }
        if (highest_at > 0.0 && beyond == 0.0 && here.away_mm() > 0.0) {
            beyond = ahead;
        }
        last = here;
    }
    if (beyond == 0.0) {
        return 0.0;  // none, or a wall that rises on
    }
    double low = highest_at - step_mm;
    double high = beyond;
    if (low <= 0.0 || before->away_mm() >= 0.0) {
        return highest_at;
    }
    for (int i = 0; i < kContactHalvings; ++i) {
        const double middle = 0.5 * (low + high);
        last = *before;
        (last.go(middle) && last.away_mm() < 0.0 ? low : high) = middle;
    }
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
    TautTracer(const Surface& surface, const Steering& steering, const TraceOptions& options)
        : surface_(surface), steering_(steering), options_(options) {
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
                 worst >= kLeastBridge_mm && i < end; ++i) {
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
                            bridge_reach_mm(surface_));
    }

    // Halves the way from a station before a bridge to one after its beginning.
    void refine(const PathPoint& before, double way_mm, Leaving& leaving) const {
        double low = 0.0;
        double high = way_mm;
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (low + high);
            PathPoint place = stretch(before.at, before.tangent, middle).path.back();
            place.s_mm += before.s_mm;
            if (auto bridge = bridge_at(place)) {
                leaving.bridge = std::move(*bridge);
                leaving.place = place;
                high = middle;
            } else {
                low = middle;
            }
        }
    }

    const Surface& surface_;
    Steering steering_;
    TraceOptions options_;
};

}  // namespace

double bridge_reach_mm(const Surface& surface) {
    return std::max(kBridgeReach_mm, kBridgeReachEdges * surface.mean_edge_mm);
}

std::optional<Bridge> bridge_ahead(const Surface& surface, const FieldWalker& from,
                                   const Vector3d& along, double reach_mm) {
    const double step = kStepEdges * surface.mean_edge_mm;
    const double contact_mm = contact_ahead(from, along, reach_mm, step);
    if (contact_mm == 0.0) {
        return std::nullopt;
    }
    Bridge bridge{{}, {}, from};
    const Vector3d& start = from.position_mm();
    double length_mm = 0.0;
    for (double ahead = 0.0; ahead < contact_mm;) {
        ahead = std::min(ahead + step, contact_mm);
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
                       const Steering& steering, const TraceOptions& options) {
    return TautTracer(surface, steering, options).run(start, direction);
}

}  // namespace meshwind
