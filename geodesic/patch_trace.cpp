#include "geodesic/patch_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

class PatchWalker {
public:
    PatchWalker(const Surface& surface, const SurfacePoint& start, const Vector3d& direction,
                const Steering& steering, const TraceOptions& options)
        : surface_(surface),
          steering_(steering),
          options_(options),
          patch_(surface, start.face),
          face_(start.face),
          min_station_mm_(kMinStationShare * surface.mean_edge_mm),
          clearance_mm_(kVertexClearance * surface.mean_edge_mm),
          idle_mm_(kIdleShare * surface.mean_edge_mm) {
        const Vector2d uv(start.bary[1], start.bary[2]);
        begin(uv, patch_.at(uv), direction);
    }

    TraceResult run() {
        result_.path.reserve(256);
        record(motion_.kn_per_mm);
        int idle = 0;
        for (int steps = 0; steps < options_.max_faces; ++steps) {
            const double before_mm = length_mm_;
            if (!step()) {
                return std::move(result_);
            }
            idle = length_mm_ - before_mm < idle_mm_ ? idle + 1 : 0;
            if (idle == kIdleSteps) {
                fold();
                return std::move(result_);
            }
        }
        result_.stop = TraceStop::FaceLimit;
        return std::move(result_);
    }

private:
    struct Exit {
        double length_mm = kNever;
        std::size_t opposite = kNoEdge;  // bary index that becomes zero
    };

    [[nodiscard]] double slip_ratio(double kn) const {
        return kn > 0.0 ? steering_.slip_ratio : steering_.slip_ratio_concave;
    }

    [[nodiscard]] Motion motion_of(const PatchPlace& place, const Vector2d& rate) const {
        Motion m{place, place.normal(), place.along(rate), {}, 0.0};
        const Vector3d second = place.second(rate);
        m.kn_per_mm = -m.normal.dot(second) / m.tangent.squaredNorm();
        const double kg = slip_ratio(m.kn_per_mm) * m.kn_per_mm;
        m.acceleration = in_parameters(place, kg * m.normal.cross(m.tangent) - second);
        return m;
    }

    // Into the patch at `uv` along `direction`, which is projected.
    void begin(const Vector2d& uv, const PatchPlace& place, const Vector3d& direction) {
        state_.uv = uv;
        state_.rate = in_parameters(place, direction);
        state_.rate /= place.along(state_.rate).norm();
        motion_ = motion_of(place, state_.rate);
        // To a crease a patch is drawn over about its length, flat or not.
        const double turn_rad = patch_.is_exact() ? kMaxKnownTurn_rad : kMaxStepTurn_rad;
        max_step_mm_ = std::min({options_.max_step_mm, patch_.shortest_crease_mm(),
                                 turn_rad / std::max(patch_.curvature_per_mm(), 1e-12)});
    }

    // Where the parabola that the path starts with leaves the triangle.
    [[nodiscard]] Exit predict_exit() const {
        Exit exit;
        for (std::size_t i = 0; i < 3; ++i) {
            const double b = std::max(0.0, bary(state_.uv, i, 1.0));
            const double rate = bary(state_.rate, i, 0.0);
            const double half = 0.5 * bary(motion_.acceleration, i, 0.0);
            const double length = i == entry_ ? first_root(0.0, std::max(0.0, rate), half)
                                              : first_root(b, rate, half);
            if (length < exit.length_mm) {
                exit = {length, i};
            }
        }
        return exit;
    }

    // The state after `h` by Nystrom's fourth-order step; two of its stages share a place.
    [[nodiscard]] State advanced(double h) const {
        const Vector2d& x = state_.uv;
        const Vector2d& v = state_.rate;
        const Vector2d& a1 = motion_.acceleration;
        const PatchPlace middle = patch_.at(x + 0.5 * h * v + 0.125 * h * h * a1);
        const Vector2d a2 = motion_of(middle, v + 0.5 * h * a1).acceleration;
        const Vector2d a3 = motion_of(middle, v + 0.5 * h * a2).acceleration;
        const PatchPlace end = patch_.at(x + h * v + 0.5 * h * h * a3);
        const Vector2d a4 = motion_of(end, v + h * a3).acceleration;
        return {x + h * v + h * h / 6.0 * (a1 + a2 + a3), v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4),
                a4};
    }

    // One step: to the edge by which the path leaves, or within the patch where that is far.
    bool step() {
        const double left = options_.max_length_mm - length_mm_;
        Exit exit = predict_exit();
        if (exit.length_mm > std::min(left, max_step_mm_)) {
            const double length = std::min(left, exit.length_mm);
            exit = {length / std::max(1.0, std::ceil(length / max_step_mm_)), kNoEdge};
        }
        State next = advanced(exit.length_mm);
        for (int i = 0; i < kMaxLandings && !land(next, exit); ++i) {
            next = advanced(exit.length_mm);
        }
        if (exit.opposite != kNoEdge && exit.length_mm < left) {
            return cross(next, exit.opposite, exit.length_mm);
        }
        if (exit.opposite != kNoEdge) {  // the edge lies just beyond the end
            exit.length_mm = left;
            next = advanced(left);
        }
        if (!move_within(next, exit.length_mm)) {
            return fold();
        }
        if (exit.length_mm < left) {
            record(motion_.kn_per_mm);
            return true;
        }
        length_mm_ = options_.max_length_mm;
        result_.stop = TraceStop::Length;
        result_.path.push_back(station(motion_.kn_per_mm));
        return false;
    }

    // Moves the end of a step onto the edge by which the path leaves: of the edges already behind
    // it the first, else the predicted one, else none. False where that is too far for this step:
    // then `exit` says how long another should be.
    bool land(State& state, Exit& exit) const {
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
            if (exit.length_mm > clearance_mm_ && (returning || time < -exit.length_mm)) {
                exit = {0.5 * exit.length_mm, kNoEdge};
                return false;
            }
            if (time == kNever) {
                exit.opposite = kNoEdge;
                return true;
            }
            exit.length_mm = std::max(0.0, exit.length_mm + time);
            if (std::abs(time) > kLandingShare * exit.length_mm + clearance_mm_) {
                return false;
            }
            // By the parabola: over so short a way its error is far below the step's.
            state.uv += time * state.rate + 0.5 * time * time * state.acceleration;
            state.rate += time * state.acceleration;
            if (std::abs(time) <= clearance_mm_) {
                return true;
            }
        }
        return true;
    }

    // Length to the edge opposite corner i, < 0 where it lies behind; infinite where the path does
    // not go there.
    [[nodiscard]] static double time_to(const State& state, std::size_t i) {
        const double rate = bary(state.rate, i, 0.0);
        return rate < 0.0 ? bary(state.uv, i, 1.0) / -rate : kNever;
    }

    // False where there is no surface.
    bool move_within(const State& next, double length) {
        state_ = next;
        state_.uv = state_.uv.cwiseMax(0.0);
        state_.uv /= std::max(1.0, state_.uv.sum());
        length_mm_ += length;
        entry_ = kNoEdge;
        motion_ = motion_of(patch_.at(state_.uv), state_.rate);
        return patch_.holds(motion_.normal);
    }

    bool fold() {
        result_.stop = TraceStop::Folded;
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
            return fold();
        }
        const Index next = surface_.neighbour[at(face_)][from];
        if (next == kNoFace) {
            record(motion_.kn_per_mm);
            result_.stop = TraceStop::Rim;
            result_.rim = surface_.rim[at(face_)][from];
            return false;
        }
        const PathPoint leaving = station(motion_.kn_per_mm);
        const bool feature = surface_.feature[at(face_)][from] != 0;
        const Vector3d edge = motion_.place.along(corner_uv(to) - corner_uv(from)).normalized();
        const Index first_vertex = surface_.face[at(face_)][to];
        const auto& vertices = surface_.face[at(next)];
        const auto first = static_cast<std::size_t>(
            std::find(vertices.begin(), vertices.end(), first_vertex) - vertices.begin());
        const std::size_t second = (first + 1) % 3;
        face_ = next;
        entry_ = (first + 2) % 3;
        patch_ = Patch(surface_, next);
        const Vector2d uv = corner_uv(second) + share * (corner_uv(first) - corner_uv(second));
        const PatchPlace place = patch_.at(uv);
        begin(uv, place, unfolded(leaving, edge, place.normal(), feature));
        if (!patch_.holds(motion_.normal)) {
            add(leaving);
            return fold();
        }
        if (feature) {
            add(leaving);
            record(motion_.kn_per_mm);
        } else {
            PathPoint mean = leaving;
            set_curvature(mean, 0.5 * (leaving.kn_per_mm + motion_.kn_per_mm));
            add(mean);
        }
        return true;
    }

    // The tangent on the other side of an edge: turned about the edge's tangent, and steered for
    // the turn of the normal there, unless that would turn it back.
    [[nodiscard]] Vector3d unfolded(const PathPoint& leaving, const Vector3d& edge,
                                    const Vector3d& normal, bool feature) const {
        const double across = leaving.tangent.dot(leaving.normal.cross(edge));
        const Vector3d straight = leaving.tangent.dot(edge) * edge + across * normal.cross(edge);
        if (feature) {
            return straight;
        }
        const double turn = slip_ratio(leaving.kn_per_mm) * 0.5 *
                            (normal - leaving.normal).dot(leaving.tangent + straight);
        const Vector3d steered = straight + turn * normal.cross(straight);
        return steered.dot(normal.cross(edge)) * across > 0.0 ? steered : straight;
    }

    [[nodiscard]] static Vector2d corner_uv(std::size_t i) {
        return {i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
    }

    void set_curvature(PathPoint& point, double kn) const {
        point.kn_per_mm = kn;
        point.kg_per_mm = slip_ratio(kn) * kn;
    }

    [[nodiscard]] PathPoint station(double kn) const {
        PathPoint point;
        const Vector3d shares =
            Vector3d(1.0 - state_.uv.sum(), state_.uv.x(), state_.uv.y()).cwiseMax(0.0);
        point.at = {face_, shares / shares.sum()};
        point.position_mm = motion_.place.position_mm;
        point.normal = motion_.normal;
        point.tangent =
            (motion_.tangent - motion_.normal * motion_.normal.dot(motion_.tangent)).normalized();
        point.s_mm = length_mm_;
        set_curvature(point, kn);
        return point;
    }

    void record(double kn) { add(station(kn)); }

    // Unless it is the station before once more.
    void add(const PathPoint& point) {
        if (result_.path.empty() || point.s_mm - result_.path.back().s_mm >= min_station_mm_ ||
            result_.path.back().normal.dot(point.normal) <= 1.0 - kSameNormal) {
            result_.path.push_back(point);
        }
    }

    const Surface& surface_;
    const Steering& steering_;
    const TraceOptions& options_;
    Patch patch_;
    Index face_;
    double min_station_mm_;
    double clearance_mm_;
    double idle_mm_;
    TraceResult result_;
    std::size_t entry_ =
        kNoEdge;  // bary index that is zero on the edge by which the face was entered
    State state_;
    Motion motion_;
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
