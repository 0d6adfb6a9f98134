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

// Where a path leaves the wall is found to so many halvings of the way between two stations.
constexpr int kHalvings = 14;

// Stations before the first lifted one at which leaving is tried: the string over a path knows
// where only to a station.
constexpr std::size_t kStationsBefore = 2;

// Bridges along one path; more means a wall of spikes.
constexpr int kMaxBridges = 200;

// Leads along under the straight fibre through `target`.
AimField shadow(const Vector3d& target, const Vector3d& along, double step) {
    return [&target, &along, step](const Vector3d& x, const Vector3d&) {
        const Vector3d rest = target - x;
        const double left = along.dot(rest);
        return Aim{rest + (step - left) * along, -left, 1.0, 0.0};
    };
}

class Follower {
public:
    Follower(const FieldWalker& from, const Vector3d& along, double step_mm)
        : from_mm_(from.position_mm()), along_(along), step_mm_(step_mm), scout_(from) {}

    // Over the wall to below the fibre at `ahead_mm`; false where there is no wall.
    bool go(double ahead_mm, const FieldWalker::Visit& visit = {}) {
        const Vector3d target = from_mm_ + ahead_mm * along_;
        const FieldWalk walk =
            scout_.walk(shadow(target, along_, step_mm_), 2.0 * step_mm_, step_mm_, visit);
        length_mm_ += walk.length_mm;
        over_mm_ = scout_.normal().dot(scout_.position_mm() - target);
        return walk.stop == FieldStop::Arrived;
    }

    [[nodiscard]] const FieldWalker& scout() const { return scout_; }
    [[nodiscard]] double length_mm() const { return length_mm_; }
    // Height of the wall over the fibre.
    [[nodiscard]] double over_mm() const { return over_mm_; }

private:
    Vector3d from_mm_;
    Vector3d along_;
    double step_mm_;
    FieldWalker scout_;
    double length_mm_ = 0.0;
    double over_mm_ = 0.0;
};

// How far ahead the wall stands highest; 0 where it stays below.
double contact_ahead(const FieldWalker& from, const Vector3d& along, double reach_mm,
                     double step_mm) {
    Follower follower(from, along, step_mm);
    double highest = kTouch_rad;
    double contact_mm = 0.0;
    for (double ahead = step_mm; ahead < reach_mm && follower.go(ahead); ahead += step_mm) {
        const double slope = follower.over_mm() / ahead;
        if (slope >= highest - kTouch_rad && slope > kTouch_rad) {
            highest = std::max(highest, slope);
            contact_mm = ahead;
        }
    }
    return contact_mm;
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
                            kBridgeReach_mm);
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

std::optional<Bridge> bridge_ahead(const Surface& surface, const FieldWalker& from,
                                   const Vector3d& along, double reach_mm) {
    const double step = kStepEdges * surface.mean_edge_mm;
    const double contact_mm = contact_ahead(from, along, reach_mm, step);
    if (contact_mm == 0.0) {
        return std::nullopt;
    }
    Follower follower(from, along, step);
    SurfacePath under;
    for (double ahead = 0.0; ahead < contact_mm;) {
        ahead = std::min(ahead + step, contact_mm);
        const double before = follower.length_mm();
        follower.go(ahead, [&](const PathPoint& station) {
            under.push_back(station);
            under.back().s_mm += before;
        });
        under.push_back(follower.scout().station(along));
        under.back().s_mm = follower.length_mm();
    }
    const Vector3d& start = from.position_mm();
    const Vector3d chord = under.back().position_mm - start;
    std::vector<double> gap_mm;
    for (const PathPoint& station : under) {
        const Vector3d rise = station.position_mm - start;
        gap_mm.push_back(station.normal.dot(rise.dot(chord) / chord.squaredNorm() * chord - rise));
    }
    return Bridge{std::move(under), std::move(gap_mm), follower.scout()};
}

TraceResult trace_taut(const Surface& surface, const SurfacePoint& start, const Vector3d& direction,
                       const Steering& steering, const TraceOptions& options) {
    return TautTracer(surface, steering, options).run(start, direction);
}

}  // namespace meshwind
