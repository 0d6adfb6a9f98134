#include "geodesic/patch_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "mesh/smooth/patch.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Index = std::int32_t;

// A crossing this close to a vertex (share of the edge) is moved onto the edge, so that it is
// always clear which face comes next; the path moves by 1e-9 of an edge at most.
constexpr double kVertexClearance = 1e-9;

// Stations closer together than this share of the mean edge are not recorded twice.
constexpr double kMinStationShare = 1e-5;

// Most that the normal may turn in one step: a step of the third-order scheme then errs by 1e-6 of
// its length, and long facets get stations that show their curvature.
constexpr double kMaxStepTurn_rad = 0.2;

// The same where the surface is known, as on CAD faces, and the steps err most: 3e-5 mm per metre
// on a torus, with 0.05 four times that.
constexpr double kMaxKnownTurn_rad = 0.03;

// Barycentric coordinate below which a step has left the triangle, and tries to end on the edge.
constexpr double kOutside = 1e-10;
constexpr int kMaxLandings = 16;

// Share of a step by which its end is moved onto an edge without taking it again.
constexpr double kLandingShare = 0.02;

// So many steps in a row of less than this share of the mean edge: around a vertex there may be
// dozens; hundreds mean a patch folded over itself.
constexpr int kIdleSteps = 500;
constexpr double kIdleShare = 1e-7;

// One minus the cosine below which two normals at one place are the same.
constexpr double kSameNormal = 1e-9;

constexpr std::size_t kNoEdge = 3;
constexpr double kNever = std::numeric_limits<double>::infinity();

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

// A place in the parameters of a patch and its rates per mm.
struct State {
    Vector2d uv;
    Vector2d rate;
    Vector2d acceleration = Vector2d::Zero();  // per mm^2
};

// Barycentric coordinate i, or its rate where `constant` is 0.
double bary(const Vector2d& uv, std::size_t i, double constant) {
    return i == 0 ? constant - uv.x() - uv.y() : uv[static_cast<Index>(i) - 1];
}

// The path's equation at a state.
struct Motion {
    PatchPlace place;
    Vector3d normal;
    Vector3d tangent;
    Vector2d acceleration;  // of u and v
    double kn_per_mm;
};

// Solves along_u a + along_v b = tangential part of `vector`.
Vector2d in_parameters(const PatchPlace& place, const Vector3d& vector) {
    const double uu = place.along_u.squaredNorm();
    const double uv = place.along_u.dot(place.along_v);
    const double vv = place.along_v.squaredNorm();
    const double u = place.along_u.dot(vector);
    const double v = place.along_v.dot(vector);
    return Vector2d(vv * u - uv * v, uu * v - uv * u) / (uu * vv - uv * uv);
}

// First x at which b + rate x + half x^2 falls to zero, in the forms that do not cancel; infinite
// where it never does. b >= 0
double first_root(double b, double rate, double half) {
    const double square = rate * rate - 4.0 * half * b;
    if (square >= 0.0) {
        const double root = std::sqrt(square);
        if (rate < 0.0) {
            return 2.0 * b / (root - rate);
        }
        if (rate > 0.0 && half < 0.0) {
            return (root + rate) / (-2.0 * half);
        }
    }
    return kNever;
}

double slip_ratio_of(const Steering& steering, double kn) {
    return kn > 0.0 ? steering.slip_ratio : steering.slip_ratio_concave;
}

Motion motion_of(const PatchPlace& place, const Vector2d& rate, const Steering& steering) {
    Motion m{place, place.normal(), place.along(rate), {}, 0.0};
    const Vector3d second = place.second(rate);
    m.kn_per_mm = -m.normal.dot(second) / m.tangent.squaredNorm();
    const double kg = slip_ratio_of(steering, m.kn_per_mm) * m.kn_per_mm;
    m.acceleration = in_parameters(place, kg * m.normal.cross(m.tangent) - second);
    return m;
}

// Where the path is on a patch.
struct Standing {
    State state;
    Motion motion;
    std::size_t entry = kNoEdge;  // bary index that is zero on the edge by which it was entered
};

struct Exit {
    double length_mm = kNever;
    std::size_t opposite = kNoEdge;  // bary index that becomes zero
};

// Where the parabola that the path starts with leaves the triangle.
Exit predict_exit(const Standing& here) {
    Exit exit;
    for (std::size_t i = 0; i < 3; ++i) {
        const double b = std::max(0.0, bary(here.state.uv, i, 1.0));
        const double rate = bary(here.state.rate, i, 0.0);
        const double half = 0.5 * bary(here.motion.acceleration, i, 0.0);
        const double length = i == here.entry ? first_root(0.0, std::max(0.0, rate), half)
                                              : first_root(b, rate, half);
        if (length < exit.length_mm) {
            exit = {length, i};
        }
    }
    return exit;
}

// The state after `h` by Nystrom's fourth-order step; two of its stages share a place.
State advanced(const Patch& patch, const Standing& here, const Steering& steering, double h) {
    const Vector2d& x = here.state.uv;
    const Vector2d& v = here.state.rate;
    const Vector2d& a1 = here.motion.acceleration;
    const PatchPlace middle = patch.at(x + 0.5 * h * v + 0.125 * h * h * a1);
    const Vector2d a2 = motion_of(middle, v + 0.5 * h * a1, steering).acceleration;
    const Vector2d a3 = motion_of(middle, v + 0.5 * h * a2, steering).acceleration;
    const PatchPlace end = patch.at(x + h * v + 0.5 * h * h * a3);
    const Vector2d a4 = motion_of(end, v + h * a3, steering).acceleration;
    return {x + h * v + h * h / 6.0 * (a1 + a2 + a3), v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4),
            a4};
}

// Length to the edge opposite corner i, < 0 where it lies behind; infinite where the path does
// not go there.
double time_to(const State& state, std::size_t i) {
    const double rate = bary(state.rate, i, 0.0);
    return rate < 0.0 ? bary(state.uv, i, 1.0) / -rate : kNever;
}

// Moves the end of a step onto the edge by which the path leaves: of the edges already behind
// it the first, else the predicted one, else none. False where that is too far for this step:
// then `exit` says how long another should be.
bool land(State& state, Exit& exit, double clearance_mm) {
    for (int i = 0; i < kMaxLandings; ++i) {
        double time = exit.opposite == kNoEdge ? kNever : time_to(state, exit.opposite);
        bool returning = false;  // out of the triangle and on its way back in
        for (std::size_t k = 0; k < 3; ++k) {
            if (bary(state.uv, k, 1.0) < -kOutside) {
                const double back = time_to(state, k);
                returning = returning || back == kNever;
                if (back < time) {
                    time = back;
                    exit.opposite = k;
                }
            }
        }
        if (exit.length_mm > clearance_mm && (returning || time < -exit.length_mm)) {
            exit = {0.5 * exit.length_mm, kNoEdge};
            return false;
        }
        if (time == kNever) {
            exit.opposite = kNoEdge;
            return true;
        }
        exit.length_mm = std::max(0.0, exit.length_mm + time);
        if (std::abs(time) > kLandingShare * exit.length_mm + clearance_mm) {
            return false;
        }
        // By the parabola: over so short a way its error is far below the step's.
        state.uv += time * state.rate + 0.5 * time * time * state.acceleration;
        state.rate += time * state.acceleration;
        if (std::abs(time) <= clearance_mm) {
            return true;
        }
    }
    return true;
}

// A step and where it ends.
struct Leap {
    State end;
    Exit exit;
};

struct StepLimits {
    double left_mm;  // of the path
    double longest_mm;
    double clearance_mm;
};

// To the edge by which the path leaves, or within the patch where that is far.
Leap leap_from(const Patch& patch, const Standing& here, const Steering& steering,
               const StepLimits& limits) {
    Exit exit = predict_exit(here);
    if (exit.length_mm > std::min(limits.left_mm, limits.longest_mm)) {
        const double length = std::min(limits.left_mm, exit.length_mm);
        exit = {length / std::max(1.0, std::ceil(length / limits.longest_mm)), kNoEdge};
    }
    State next = advanced(patch, here, steering, exit.length_mm);
    for (int i = 0; i < kMaxLandings && !land(next, exit, limits.clearance_mm); ++i) {
        next = advanced(patch, here, steering, exit.length_mm);
    }
    return {next, exit};
}

// To a crease a patch is drawn over about its length, flat or not.
double longest_step_mm(const Patch& patch, const TraceOptions& options) {
    const double turn_rad = patch.is_exact() ? kMaxKnownTurn_rad : kMaxStepTurn_rad;
    return std::min({options.max_step_mm, patch.shortest_crease_mm(),
                     turn_rad / std::max(patch.curvature_per_mm(), 1e-12)});
}

// The tangent on the other side of an edge: turned about the edge's tangent, and steered for
// the turn of the normal there, unless that would turn it back.
Vector3d unfolded(const PathPoint& leaving, const Vector3d& edge, const Vector3d& normal,
                  const Steering& steering, bool feature) {
    const double across = leaving.tangent.dot(leaving.normal.cross(edge));
    const Vector3d straight = leaving.tangent.dot(edge) * edge + across * normal.cross(edge);
    if (feature) {
        return straight;
    }
    const double turn = slip_ratio_of(steering, leaving.kn_per_mm) * 0.5 *
                        (normal - leaving.normal).dot(leaving.tangent + straight);
    const Vector3d steered = straight + turn * normal.cross(straight);
    return steered.dot(normal.cross(edge)) * across > 0.0 ? steered : straight;
}

Vector2d corner_uv(std::size_t i) {
    return {i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
}

void set_curvature(PathPoint& point, const Steering& steering, double kn) {
    point.kn_per_mm = kn;
    point.kg_per_mm = slip_ratio_of(steering, kn) * kn;
}

PathPoint station_of(Index face, const Standing& here, const Steering& steering, double s_mm) {
    const Vector2d& uv = here.state.uv;
    const Motion& motion = here.motion;
    PathPoint point;
    const Vector3d shares = Vector3d(1.0 - uv.sum(), uv.x(), uv.y()).cwiseMax(0.0);
    point.at = {face, shares / shares.sum()};
    point.position_mm = motion.place.position_mm;
    point.normal = motion.normal;
    point.tangent =
        (motion.tangent - motion.normal * motion.normal.dot(motion.tangent)).normalized();
    point.s_mm = s_mm;
    set_curvature(point, steering, motion.kn_per_mm);
    return point;
}

// On an edge that is no feature: curved as the patches of both sides are on average.
PathPoint between_patches(PathPoint leaving, const Steering& steering, double entering_kn) {
    set_curvature(leaving, steering, 0.5 * (leaving.kn_per_mm + entering_kn));
    return leaving;
}

// Unless it is the station before once more.
void add(const PathPoint& point, double min_station_mm, SurfacePath& path) {
    if (path.empty() || point.s_mm - path.back().s_mm >= min_station_mm ||
        path.back().normal.dot(point.normal) <= 1.0 - kSameNormal) {
        path.push_back(point);
    }
}

// The corner of a face at a vertex.
std::size_t corner_at(const Surface& surface, Index face, Index vertex) {
    const auto& vertices = surface.face[at(face)];
    return static_cast<std::size_t>(std::find(vertices.begin(), vertices.end(), vertex) -
                                    vertices.begin());
}

// A path that is walked over the patches, one after the other.
class PatchWalker {
public:
    PatchWalker(const Surface& surface, const SurfacePoint& start, const Vector3d& direction,
                const Steering& steering, const TraceOptions& options)
        : surface_(surface),
          steering_(steering),
          options_(options),
          patch_(surface, start.face),
          face_(start.face) {
        const Vector2d uv(start.bary[1], start.bary[2]);
        begin(uv, patch_.at(uv), direction);
    }

    TraceResult run() {
        result_.path.reserve(256);
        record(station());
        int idle = 0;
        for (int steps = 0; steps < options_.max_faces; ++steps) {
            const double before_mm = length_mm_;
            if (!step()) {
                return std::move(result_);
            }
            idle = length_mm_ - before_mm < idle_mm_ ? idle + 1 : 0;
            if (idle == kIdleSteps) {
                end(TraceStop::Folded);
                return std::move(result_);
            }
        }
        result_.stop = TraceStop::FaceLimit;
        return std::move(result_);
    }

private:
    // Into the patch at `uv` along `direction`, which is projected.
    void begin(const Vector2d& uv, const PatchPlace& place, const Vector3d& direction) {
        here_.state.uv = uv;
        here_.state.rate = in_parameters(place, direction);
        here_.state.rate /= place.along(here_.state.rate).norm();
        here_.motion = motion_of(place, here_.state.rate, steering_);
        max_step_mm_ = longest_step_mm(patch_, options_);
    }

    bool step() {
        const double left = options_.max_length_mm - length_mm_;
        auto [next, exit] =
            leap_from(patch_, here_, steering_, {left, max_step_mm_, clearance_mm_});
        if (exit.opposite != kNoEdge && exit.length_mm < left) {
            return cross(next, exit.opposite, exit.length_mm);
        }
        if (exit.opposite != kNoEdge) {  // the edge lies just beyond the end
            exit.length_mm = left;
            next = advanced(patch_, here_, steering_, left);
        }
        if (!move_within(next, exit.length_mm)) {
            return end(TraceStop::Folded);
        }
        if (exit.length_mm < left) {
            record(station());
            return true;
        }
        length_mm_ = options_.max_length_mm;
        result_.path.push_back(station());
        return end(TraceStop::Length);
    }

    // False where there is no surface.
    bool move_within(const State& next, double length) {
        here_.state = next;
        here_.state.uv = here_.state.uv.cwiseMax(0.0);
        here_.state.uv /= std::max(1.0, here_.state.uv.sum());
        length_mm_ += length;
        here_.entry = kNoEdge;
        here_.motion = motion_of(patch_.at(here_.state.uv), here_.state.rate, steering_);
        return patch_.holds(here_.motion.normal);
    }

    bool end(TraceStop stop) {
        result_.stop = stop;
        return false;
    }

    // Over the edge opposite `opposite` into the next face.
    bool cross(const State& at_edge, std::size_t opposite, double length) {
        const std::size_t from = (opposite + 1) % 3;
        const std::size_t to = (opposite + 2) % 3;
        const double share =
            std::clamp(bary(at_edge.uv, to, 1.0), kVertexClearance, 1.0 - kVertexClearance);
        if (!move_within(
                {corner_uv(from) + share * (corner_uv(to) - corner_uv(from)), at_edge.rate},
                length)) {
            return end(TraceStop::Folded);
        }
        const PathPoint leaving = station();
        if (surface_.neighbour[at(face_)][from] == kNoFace) {
            record(leaving);
            result_.rim = surface_.rim[at(face_)][from];
            return end(TraceStop::Rim);
        }
        const bool feature = surface_.feature[at(face_)][from] != 0;
        enter(leaving, from, share, feature);
        if (!patch_.holds(here_.motion.normal)) {
            record(leaving);
            return end(TraceStop::Folded);
        }
        if (feature) {
            record(leaving);
            record(station());
        } else {
            record(between_patches(leaving, steering_, here_.motion.kn_per_mm));
        }
        return true;
    }

    // The next face, `share` of the way along the edge that begins at corner `from` of this one.
    void enter(const PathPoint& leaving, std::size_t from, double share, bool feature) {
        const std::size_t to = (from + 1) % 3;
        const Vector3d edge =
            here_.motion.place.along(corner_uv(to) - corner_uv(from)).normalized();
        const Index next = surface_.neighbour[at(face_)][from];
        const std::size_t first = corner_at(surface_, next, surface_.face[at(face_)][to]);
        const std::size_t second = (first + 1) % 3;
        face_ = next;
        here_.entry = (first + 2) % 3;
        patch_ = Patch(surface_, next);
        const Vector2d uv = corner_uv(second) + share * (corner_uv(first) - corner_uv(second));
        const PatchPlace place = patch_.at(uv);
        begin(uv, place, unfolded(leaving, edge, place.normal(), steering_, feature));
    }

    [[nodiscard]] PathPoint station() const {
        return station_of(face_, here_, steering_, length_mm_);
    }

    void record(const PathPoint& point) { add(point, min_station_mm_, result_.path); }

    const Surface& surface_;
    const Steering& steering_;
    const TraceOptions& options_;
    const double min_station_mm_ = kMinStationShare * surface_.mean_edge_mm;
    const double clearance_mm_ = kVertexClearance * surface_.mean_edge_mm;
    const double idle_mm_ = kIdleShare * surface_.mean_edge_mm;
    TraceResult result_;
    Patch patch_;
    Index face_;
    Standing here_;
    double max_step_mm_ = 0.0;
    double length_mm_ = 0.0;
};

}  // namespace

TraceResult trace_on_patches(const Surface& surface, const SurfacePoint& start,
                             const Vector3d& direction, const Steering& steering,
                             const TraceOptions& options) {
    return PatchWalker(surface, start, direction, steering, options).run();
}

}  // namespace meshwind
