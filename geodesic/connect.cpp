#include "geodesic/connect.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "geodesic/jacobi_field.h"
#include "geodesic/shortest_path.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// The target's nearest place is looked for within this share of the expected arc length around it,
// and at least some edges: on a tube the next turn of a path is farther away than that for up to
// four turns.
constexpr double kWindowShare = 0.25;
constexpr double kWindowEdges = 5.0;

// An end that is right over or under the target is at it when no higher than this many edges:
// facets and patches are within a small share of an edge of each other.
constexpr double kHeightEdges = 0.5;

// No step of the start angle is longer, rad: beyond, the Jacobi field says little.
constexpr double kMaxStep_rad = 0.5;

// Below this share of the path's length per radian neighbouring paths count as meeting: on a
// sphere within 1.8 degrees of the opposite point.
constexpr double kConjugateShare = 0.01;

// Where no step leads nearer, paths of this slip turn back before the target, at a fold where j is
// 0 but for the scatter of facets and fitted curvature: 2.2 % was measured on spheres with h = R
// / 5.
constexpr double kFoldShare = 0.05;

// A geodesic that is so much longer than the way over the facets is another one than the shortest;
// the facets' own error is h^2 / (24 R^2), below 1 % for triangles that a cubic can be fitted to.
constexpr double kDetourShare = 0.02;

// A chord shorter than this share of the whole way, or of an edge, has no direction worth taking.
constexpr double kChordShare = 1e-6;

// The arc length at which a path is abreast of the target settles in two or three traces.
constexpr int kMaxCuts = 6;

// Share of the tolerance to which the place abreast of the target is found.
constexpr double kCutShare = 0.1;

// A shot that leaves more than this share of the miss is not followed by another Newton step.
constexpr double kGoodStep = 0.5;

// Where so small a share of Newton's step does not help, none does.
constexpr double kMinDamping = 1e-6;

// Going to the target by stages: the least stage as a share of the way, the tolerance as a share
// of an edge and the iterations for a stage that is worth following.
constexpr double kMinStage = 1.0 / 64.0;
constexpr double kStageTolerance = 1e-3;
constexpr int kStageIterations = 20;

// Where the tracer sees a surface point, which with curved patches is not on the facet.
struct Place {
    Vector3d position_mm;
    Vector3d normal;  // zero: not known
};

// A trace's first station lies where the tracer sees its start.
Place place_of(const Surface& surface, const SurfacePoint& point, TraceOptions options) {
    options.max_length_mm = kChordShare * surface.mean_edge_mm;
    const Vector3d direction = smooth_normal(surface, point).unitOrthogonal();
    const PathPoint at = trace(surface, point, direction, {}, options).path.front();
    return {at.position_mm, at.normal};
}

// A traced path that ends abreast of the target, or as near to that as it gets.
struct Shot {
    double angle_rad = 0.0;
    SurfacePath path;
    TraceStop stop = TraceStop::Length;
    std::int32_t rim = -1;
    double across_mm = 0.0;
    double along_mm = 0.0;
    bool on_sheet = false;  // the end is on the target's side of a thin wall
    double jacobi_mm = 0.0;
    int conjugate_points = 0;

    [[nodiscard]] double length_mm() const { return path.back().s_mm; }
    [[nodiscard]] double miss_mm() const { return std::hypot(across_mm, along_mm); }
};

// Arc length within [low, high] at which the chords of `path` come nearest to the target, among
// those on the target's side of a thin wall.
double nearest_s_mm(const SurfacePath& path, const Place& target, double low_mm, double high_mm) {
    double least = std::numeric_limits<double>::infinity();
    double nearest = std::min(high_mm, path.back().s_mm);
    for (std::size_t i = 1; i < path.size(); ++i) {
        const PathPoint& a = path[i - 1];
        const PathPoint& b = path[i];
        if (b.s_mm < low_mm || a.s_mm > high_mm || !(b.s_mm > a.s_mm) ||
            b.normal.dot(target.normal) < 0.0) {
            continue;
        }
        const Vector3d chord = b.position_mm - a.position_mm;
        const double share = std::clamp(
            (target.position_mm - a.position_mm).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
        const double distance = (a.position_mm + share * chord - target.position_mm).squaredNorm();
        if (distance < least) {
            least = distance;
            nearest = a.s_mm + share * (b.s_mm - a.s_mm);
        }
    }
    return nearest;
}

// Two start angles that pass the target on different sides.
struct Bracket {
    std::optional<double> left;   // of a path with the target to its left
    std::optional<double> right;  // of a path with the target to its right

    [[nodiscard]] bool closed() const { return left && right; }
    [[nodiscard]] double middle() const { return 0.5 * (*left + *right); }
    [[nodiscard]] double width() const { return std::abs(*left - *right); }
    [[nodiscard]] bool holds(double angle_rad) const {
        return (angle_rad - *left) * (angle_rad - *right) < 0.0;
    }
    // An angle outside a closed bracket says nothing new.
    void take(const Shot& shot) {
        if (!closed() || holds(shot.angle_rad)) {
            (shot.across_mm > 0.0 ? left : right) = shot.angle_rad;
        }
    }
};

// What is shot at what, and how.
struct ConnectTask {
    const Surface& surface;
    const SurfacePoint& from;
    Place start;  // of `from`
    Place target;
    Vector3d ahead;  // tangent there from which start angles count
    double slip_ratio;
    const ConnectOptions& options;
};

TraceResult trace_to(const ConnectTask& task, double angle_rad, double length_mm) {
    TraceOptions options = task.options.trace;
    options.max_length_mm = std::min(length_mm, options.max_length_mm);
    const Vector3d direction = std::cos(angle_rad) * task.ahead +
                               std::sin(angle_rad) * task.start.normal.cross(task.ahead);
    return trace(task.surface, task.from, direction, {task.slip_ratio, task.slip_ratio}, options);
}

// The target seen from the end of a path, in the tangent plane there.
void measure_miss(const ConnectTask& task, Shot& shot) {
    const PathPoint& end = shot.path.back();
    const Vector3d miss = task.target.position_mm - end.position_mm;
    shot.along_mm = miss.dot(end.tangent);
    shot.across_mm = miss.dot(end.normal.cross(end.tangent));
    shot.on_sheet = end.normal.dot(task.target.normal) >= 0.0 &&
                    std::abs(miss.dot(end.normal)) < kHeightEdges * task.surface.mean_edge_mm;
}

void follow_neighbours(const ConnectTask& task, Shot& shot) {
    const std::vector<double> field = jacobi_field_mm(task.surface, shot.path, task.slip_ratio);
    shot.jacobi_mm = field.back();
    for (std::size_t i = 2; i < field.size(); ++i) {
        shot.conjugate_points += (field[i] > 0.0) != (field[i - 1] > 0.0) ? 1 : 0;
    }
}

Shot shoot(const ConnectTask& task, double angle_rad, double expected_mm) {
    const double tolerance_mm = task.options.tolerance_mm;
    const double window =
        std::max(kWindowShare * expected_mm, kWindowEdges * task.surface.mean_edge_mm);
    TraceResult traced = trace_to(task, angle_rad, expected_mm + window);
    const double reach = traced.path.back().s_mm;
    Shot shot;
    shot.angle_rad = angle_rad;
    shot.stop = traced.stop;
    shot.rim = traced.rim;
    double s =
        std::max(nearest_s_mm(traced.path, task.target, expected_mm - window, reach), tolerance_mm);
    shot.path = std::move(traced.path);
    measure_miss(task, shot);
    for (int cut = 0; cut < kMaxCuts && s < reach; ++cut) {
        shot.path = trace_to(task, angle_rad, s).path;
        measure_miss(task, shot);
        if (std::abs(shot.along_mm) <= kCutShare * tolerance_mm) {
            break;
        }
        s = std::clamp(s + shot.along_mm, tolerance_mm, reach);
    }
    follow_neighbours(task, shot);
    return shot;
}

bool hits(const Shot& shot, double tolerance_mm) {
    return shot.on_sheet && shot.miss_mm() <= tolerance_mm;
}

// What ended a path before it was abreast of the target, if anything did.
std::optional<ConnectStop> cut_off(const Shot& shot, const ConnectOptions& options) {
    if (shot.along_mm <= options.tolerance_mm) {
        return std::nullopt;
    }
    if (shot.stop == TraceStop::Rim) {
        return ConnectStop::Rim;
    }
    if (shot.stop == TraceStop::FaceLimit || shot.length_mm() >= options.trace.max_length_mm) {
        return ConnectStop::TraceLimit;
    }
    return std::nullopt;
}

bool is_conjugate(const Shot& shot, ConnectStop end) {
    const double share = end == ConnectStop::Stalled ? kFoldShare : kConjugateShare;
    return std::abs(shot.jacobi_mm) <= share * shot.length_mm();
}

// How the next step is taken.
struct Stepping {
    double damping = 1.0;  // of Newton's step
    bool bisect = false;   // the last step gained little
};

// Newton's step from the best shot, shortened while shots get worse; the middle of the bracket
// where that leads out of it or did not help.
double next_angle(const Shot& best, const Bracket& bracket, const Stepping& stepping) {
    const double slope = std::copysign(
        std::max(std::abs(best.jacobi_mm), kConjugateShare * best.length_mm()), best.jacobi_mm);
    const double step = std::clamp(best.across_mm / slope, -kMaxStep_rad, kMaxStep_rad);
    const double angle = best.angle_rad + stepping.damping * step;
    if (bracket.closed() && (stepping.bisect || !bracket.holds(angle))) {
        return bracket.middle();
    }
    return angle;
}

// Nothing is left between both sides that could come nearer than the tolerance.
bool is_shut(const Bracket& bracket, const Shot& best, double tolerance_mm) {
    const double reach = std::max(std::abs(best.jacobi_mm), kConjugateShare * best.length_mm());
    return bracket.closed() && bracket.width() * reach <= kCutShare * tolerance_mm;
}

ConnectResult concluded(Shot best, ConnectStop end, int iterations, const ConnectOptions& options) {
    ConnectResult result;
    result.iterations = iterations;
    if (const std::optional<ConnectStop> cut = cut_off(best, options)) {
        end = *cut;
        result.rim = best.rim;
    } else if (is_conjugate(best, end)) {
        end = ConnectStop::Conjugate;
    }
    result.stop = end;
    result.length_mm = best.length_mm();
    result.miss_mm = best.miss_mm();
    result.across_mm = best.across_mm;
    result.along_mm = best.along_mm;
    result.jacobi_mm = best.jacobi_mm;
    result.conjugate_points = best.conjugate_points;
    result.path = std::move(best.path);
    return result;
}

// From a first shot to the nearest that can be had.
ConnectResult shoot_nearer(const ConnectTask& task, Shot best) {
    const double tolerance_mm = task.options.tolerance_mm;
    Bracket bracket;
    bracket.take(best);
    Stepping stepping;
    ConnectStop end = ConnectStop::Stalled;
    int iterations = 1;
    for (; iterations < task.options.max_iterations; ++iterations) {
        if (hits(best, tolerance_mm)) {
            end = ConnectStop::Reached;
            break;
        }
        if (is_shut(bracket, best, tolerance_mm)) {
            end = ConnectStop::Gap;
            break;
        }
        if (std::abs(best.across_mm) <= tolerance_mm && cut_off(best, task.options)) {
            break;
        }
        Shot shot = shoot(task, next_angle(best, bracket, stepping), best.length_mm());
        bracket.take(shot);
        const double share = shot.miss_mm() / best.miss_mm();
        stepping.bisect = share >= kGoodStep;
        stepping.damping =
            share < 1.0 ? std::min(1.0, 2.0 * stepping.damping) : 0.5 * stepping.damping;
        if (share < 1.0) {
            best = std::move(shot);
        } else if (stepping.damping < kMinDamping) {
            break;
        }
    }
    return concluded(std::move(best), end, iterations, task.options);
}

// From `from` to where the tracer sees the target.
ConnectResult connect_to(const Surface& surface, const SurfacePoint& from, const Place& target,
                         const ConnectGuess& guess, double slip_ratio,
                         const ConnectOptions& options) {
    const Place start = place_of(surface, from, options.trace);
    if ((start.position_mm - target.position_mm).norm() <= options.tolerance_mm &&
        start.normal.dot(target.normal) > 0.0) {
        ConnectResult result;
        result.stop = ConnectStop::SamePoint;
        return result;
    }
    const Vector3d& n = start.normal;
    const Vector3d ahead = (guess.direction - n * n.dot(guess.direction)).normalized();
    const ConnectTask task{surface, from, start, target, ahead, slip_ratio, options};
    return shoot_nearer(task, shoot(task, 0.0, guess.length_mm));
}

// Along the first chord that is long enough to have a direction.
ConnectGuess guess_of(const PolyhedralPath& way) {
    const Vector3d& start = way.points_mm.front();
    Vector3d chord = way.points_mm.back() - start;
    for (const Vector3d& point : way.points_mm) {
        if ((point - start).norm() > kChordShare * way.length_mm) {
            chord = point - start;
            break;
        }
    }
    return {chord, way.length_mm};
}

// The point that parts a way at a share of its length.
Place waypoint(const PolyhedralPath& way, double share) {
    double left = share * way.length_mm;
    for (std::size_t i = 1; i < way.points_mm.size(); ++i) {
        const Vector3d chord = way.points_mm[i] - way.points_mm[i - 1];
        const double length = chord.norm();
        if (left < length) {
            return {way.points_mm[i - 1] + left / length * chord, Vector3d::Zero()};
        }
        left -= length;
    }
    return {way.points_mm.back(), Vector3d::Zero()};
}

// To points ever farther along the way, from the first angle that was found for the point before.
// The first stage is the whole way; one that fails is halved.
ConnectResult by_stages(const Surface& surface, const SurfacePoint& from, const Place& target,
                        const PolyhedralPath& way, double slip_ratio,
                        const ConnectOptions& options) {
    ConnectOptions coarse = options;
    coarse.tolerance_mm = std::max(options.tolerance_mm, kStageTolerance * surface.mean_edge_mm);
    coarse.max_iterations = std::min(options.max_iterations, kStageIterations);
    ConnectGuess guess = guess_of(way);
    ConnectResult best;
    int iterations = 0;
    double done = 0.0;       // share of the way to which a path was found
    double length_mm = 0.0;  // of that path
    for (double stage = 1.0; stage >= kMinStage;) {
        const double next = std::min(1.0, done + stage);
        const bool whole = next == 1.0;
        guess.length_mm = length_mm + (next - done) * way.length_mm;
        ConnectResult result = connect_to(surface, from, whole ? target : waypoint(way, next),
                                          guess, slip_ratio, whole ? options : coarse);
        iterations += result.iterations;
        if (!whole && result.stop == ConnectStop::Reached) {
            done = next;
            length_mm = result.length_mm;
            guess.direction = result.path.front().tangent;
            continue;
        }
        stage *= 0.5;
        if (whole && (best.path.empty() || result.miss_mm < best.miss_mm)) {
            best = std::move(result);
        }
        if (whole && best.miss_mm <= coarse.tolerance_mm) {
            break;
        }
    }
    best.iterations = iterations;
    return best;
}

}  // namespace

const char* name_of(ConnectStop stop) {
    switch (stop) {
        case ConnectStop::Reached:
            return "reached";
        case ConnectStop::SamePoint:
            return "same-point";
        case ConnectStop::Detour:
            return "detour";
        case ConnectStop::Conjugate:
            return "conjugate";
        case ConnectStop::Gap:
            return "gap";
        case ConnectStop::Rim:
            return "rim";
        case ConnectStop::TraceLimit:
            return "trace-limit";
        case ConnectStop::Stalled:
            return "stalled";
        case ConnectStop::Unreachable:
            return "unreachable";
    }
    return "";
}

ConnectResult connect(const Surface& surface, const SurfacePoint& from, const SurfacePoint& to,
                      const ConnectGuess& guess, double slip_ratio, const ConnectOptions& options) {
    const Place target = place_of(surface, to, options.trace);
    return connect_to(surface, from, target, guess, slip_ratio, options);
}

ConnectResult connect(const Surface& surface, const SurfacePoint& from, const SurfacePoint& to,
                      const PolyhedralPath& way, double slip_ratio, const ConnectOptions& options) {
    ConnectResult result =
        by_stages(surface, from, place_of(surface, to, options.trace), way, slip_ratio, options);
    result.polyhedral_mm = way.length_mm;
    if (result.stop == ConnectStop::Reached && slip_ratio == 0.0 &&
        result.length_mm > (1.0 + kDetourShare) * way.length_mm) {
        result.stop = ConnectStop::Detour;
    }
    return result;
}

ConnectResult connect(const Surface& surface, const SurfacePoint& from, const SurfacePoint& to,
                      double slip_ratio, const ConnectOptions& options) {
    const std::optional<PolyhedralPath> way = ShortestPaths(surface, from).to(to);
    return way ? connect(surface, from, to, *way, slip_ratio, options) : ConnectResult{};
}

}  // namespace meshwind
