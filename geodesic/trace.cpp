#include "geodesic/trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "core/tolerances.h"
#include "geodesic/patch_trace.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Index = std::int32_t;

// A crossing this close to a vertex (share of the edge) is moved onto the edge, so that it is
// always clear which face comes next; the path moves by 1e-9 of an edge at most.
constexpr double kVertexClearance = 1e-9;

// Stations closer together than this share of the mean edge are not recorded twice.
constexpr double kMinStationShare = 1e-5;

// Sine of the angle at which a direction still counts as pointing into a face (no unit).
constexpr double kGrazingSine = 1e-12;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

// Turns below this are evaluated by a few terms of the series, exact to rounding: the terms left
// out are below 6e-18.
constexpr double kSmallTurn_rad = 0.05;

struct Turn {
    double cosine;
    double sine;
};

Turn turn_by(double rad) {
    if (std::abs(rad) > kSmallTurn_rad) {
        return {std::cos(rad), std::sin(rad)};
    }
    const double q = rad * rad;
    return {(1.0 - 0.5 * q) + q * q * ((1.0 / 24.0 - q * (1.0 / 720.0)) + q * q * (1.0 / 40320.0)),
            rad * ((1.0 - q * (1.0 / 6.0)) + q * q * (1.0 / 120.0 - q * (1.0 / 5040.0)))};
}

// `tangent`, a unit vector perpendicular to unit `from`, turned by the minimal rotation that takes
// `from` to unit `to`.
Vector3d carried(const Vector3d& tangent, const Vector3d& from, const Vector3d& to) {
    const double c = from.dot(to);
    if (c < -1.0 + 1e-9) {
        // A fold by half a turn has no minimal rotation; the path ends up bridging.
        return (tangent - to * to.dot(tangent)).normalized();
    }
    return tangent - (from + to) * (1.0 / (1.0 + c)) * tangent.dot(to);
}

struct FaceExit {
    double length_mm;
    std::size_t opposite;  // corner whose barycentric coordinate becomes zero
};

// A face that is walked over. Corners are counted from the edge by which it was entered: that edge
// runs from corner 0 to corner 1, and corner 2 lies ahead. In the first face they are the face's
// own.
struct WalkedFace {
    Index face = kNoFace;
    std::size_t first = 0;  // the surface's number of corner 0
    bool entered = false;   // false in the first face
    std::array<const WalkCorner*, 3> corner;
    Vector3d normal;                   // of the facet
    std::array<Vector3d, 3> gradient;  // of the barycentric coordinates, per mm

    // Corner and edge number `i` as the surface counts them.
    [[nodiscard]] std::size_t own(std::size_t i) const { return (first + i) % 3; }

    [[nodiscard]] const Vector3d& p(std::size_t i) const { return corner[i]->position_mm; }

    void enter(const Surface& surface, Index next, std::size_t first_corner) {
        face = next;
        first = first_corner;
        const WalkFace& here = surface.walk_face[at(face)];
        for (std::size_t i = 0; i < 3; ++i) {
            corner[i] = &surface.walk_corner[at(here.corner[own(i)])];
        }
        for (const std::size_t edge : {own(1), own(2)}) {
            // The corner ahead on the other side: fetching it takes as long as crossing this face.
            const Index across = std::max(here.across[edge], 0);
            const auto ahead = (at(across % 4) + 2) % 3;
            const WalkFace& beyond = surface.walk_face[at(across / 4)];
            __builtin_prefetch(&surface.walk_corner[at(beyond.corner[ahead])]);
        }
    }

    void measure() {
        const Vector3d cross = (p(1) - p(0)).cross(p(2) - p(0));
        const double inverse_area = 1.0 / cross.norm();
        normal = cross * inverse_area;
        gradient[0] = normal.cross(p(2) - p(1)) * inverse_area;
        gradient[1] = normal.cross(p(0) - p(2)) * inverse_area;
        gradient[2] = normal.cross(p(1) - p(0)) * inverse_area;
    }

    // Of the barycentric coordinates per mm along in-plane unit `d`.
    [[nodiscard]] Vector3d rates(const Vector3d& d) const {
        return {gradient[0].dot(d), gradient[1].dot(d), gradient[2].dot(d)};
    }

    // Back over the edge by which the face was entered.
    [[nodiscard]] bool points_back(const Vector3d& rate) const {
        return entered && rate[2] < kGrazingSine * gradient[2].norm();
    }

    // Of a path from `bary`, which changes by `rate` per mm.
    [[nodiscard]] FaceExit find_exit(const Vector3d& bary, const Vector3d& rate) const {
        FaceExit exit{std::numeric_limits<double>::infinity(), 0};
        if (entered) {
            const std::size_t i = rate[0] * bary[1] < rate[1] * bary[0] ? 0 : 1;
            const auto k = static_cast<Index>(i);
            return rate[k] < 0.0 ? FaceExit{bary[k] / -rate[k], i} : exit;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const auto k = static_cast<Index>(i);
            if (rate[k] < 0.0) {
                const double length = std::max(0.0, bary[k]) / -rate[k];
                if (length < exit.length_mm) {
                    exit = {length, i};
                }
            }
        }
        return exit;
    }
};

double geodesic_curvature(double kn, const Steering& steering) {
    return kn * (kn > 0.0 ? steering.slip_ratio : steering.slip_ratio_concave);
}

// Where the path is in a face.
struct WalkPlace {
    Vector3d bary;
    Vector6d shape_operator_per_mm;
    Vector3d position_mm;
    Vector3d normal;  // the smooth one
    Vector3d tangent;
    double length_mm = 0.0;
    double kg_per_mm = 0.0;

    // The smooth normal and the shape operator where `bary` says.
    void interpolate(const WalkedFace& face) {
        const auto& [a, b, c] = face.corner;
        normal = (bary[0] * a->normal + bary[1] * b->normal + bary[2] * c->normal).normalized();
        shape_operator_per_mm = bary[0] * a->shape_operator_per_mm +
                                bary[1] * b->shape_operator_per_mm +
                                bary[2] * c->shape_operator_per_mm;
    }

    [[nodiscard]] double normal_curvature() const {
        const auto& t = tangent;
        Vector6d square;
        square << t.x() * t.x(), t.y() * t.y(), t.z() * t.z(), 2.0 * t.x() * t.y(),
            2.0 * t.x() * t.z(), 2.0 * t.y() * t.z();
        return shape_operator_per_mm.dot(square);
    }

    // Its kg is the path's from here on.
    [[nodiscard]] PathPoint station(const WalkedFace& face, const Steering& steering) {
        const double kn = normal_curvature();
        kg_per_mm = geodesic_curvature(kn, steering);
        SurfacePoint here{face.face, {}};
        for (std::size_t i = 0; i < 3; ++i) {
            here.bary[static_cast<Index>(face.own(i))] = bary[static_cast<Index>(i)];
        }
        return {here, position_mm, normal, tangent, length_mm, kn, kg_per_mm};
    }

    void turn_left(double rad) {
        const Turn turn = turn_by(rad);
        tangent = turn.cosine * tangent + turn.sine * normal.cross(tangent);
    }

    // Into the tangent plane where `bary` says.
    void carry(const WalkedFace& face) {
        const Vector3d from = normal;
        interpolate(face);
        // One step of Newton's method for the length 1 that rounding has changed.
        tangent *= 1.5 - 0.5 * tangent.squaredNorm();
        tangent = carried(tangent, from, normal);
    }

    // To where `bary` says.
    void move(const WalkedFace& face, const Steering& steering, double way_mm) {
        position_mm = bary[0] * face.p(0) + bary[1] * face.p(1) + bary[2] * face.p(2);
        length_mm += way_mm;
        if (kg_per_mm != 0.0) {
            turn_left(kg_per_mm * way_mm);
        }
        carry(face);
        if (steering.slip_ratio != 0.0 || steering.slip_ratio_concave != 0.0) {
            // The mean of the curvatures at both ends: second order.
            const double change = geodesic_curvature(normal_curvature(), steering) - kg_per_mm;
            turn_left(0.5 * change * way_mm);
        }
    }
};

// A path that is walked from face to face.
class Walker {
public:
    Walker(const Surface& surface, const SurfacePoint& start, const Vector3d& direction,
           const Steering& steering, const TraceOptions& options)
        : surface_(surface), steering_(steering), options_(options) {
        face_.enter(surface, start.face, 0);
        here_.bary = start.bary;
        here_.position_mm = position_mm(surface, start);
        here_.interpolate(face_);
        here_.tangent = (direction - here_.normal * here_.normal.dot(direction)).normalized();
        min_station_mm_ = kMinStationShare * surface.mean_edge_mm;
    }

    TraceResult run() {
        result_.path.reserve(256);
        record();
        for (int crossed = 0; crossed < options_.max_faces; ++crossed) {
            if (!step()) {
                return std::move(result_);
            }
        }
        result_.stop = TraceStop::FaceLimit;
        return std::move(result_);
    }

private:
    void record() {
        const PathPoint point = here_.station(face_, steering_);
        if (!result_.path.empty() && here_.length_mm - result_.path.back().s_mm < min_station_mm_ &&
            result_.path.back().normal.dot(here_.normal) > 1.0 - kBaryEps) {
            return;
        }
        result_.path.push_back(point);
    }

    // In-plane direction; turned back inside where the smooth tangent would leave through the entry
    // edge.
    bool step() {
        face_.measure();
        const Vector3d d = carried(here_.tangent, here_.normal, face_.normal);
        Vector3d rate = face_.rates(d);
        if (face_.points_back(rate)) {
            return slide_along_entry(d);
        }
        FaceExit exit = face_.find_exit(here_.bary, rate);
        if (here_.kg_per_mm != 0.0 && std::isfinite(exit.length_mm)) {
            // The chord of a steered path is turned by half of what the tangent turns over it.
            const Turn turn = turn_by(0.5 * here_.kg_per_mm * exit.length_mm);
            const Vector3d turned_rate =
                turn.cosine * rate + turn.sine * face_.rates(face_.normal.cross(d));
            const FaceExit turned_exit = face_.find_exit(here_.bary, turned_rate);
            if (!face_.points_back(turned_rate) && std::isfinite(turned_exit.length_mm)) {
                rate = turned_rate;
                exit = turned_exit;
            }
        }
        if (!std::isfinite(exit.length_mm)) {
            return slide_along_entry(d);
        }
        return advance(rate, exit);
    }

    bool advance(const Vector3d& rate, const FaceExit& exit) {
        const double left = options_.max_length_mm - here_.length_mm;
        if (exit.length_mm >= left) {
            return end_at(here_.bary + left * rate, left);
        }
        const auto to = static_cast<Index>((exit.opposite + 2) % 3);
        return cross(exit.opposite, here_.bary[to] + exit.length_mm * rate[to], exit.length_mm);
    }

    // Follows the entry edge to its end ahead and leaves the face through the edge that starts
    // there.
    bool slide_along_entry(const Vector3d& d) {
        const bool forward = d.dot(face_.p(1) - face_.p(0)) >= 0.0;
        const std::size_t vertex = forward ? 1 : 0;
        const double length = (face_.p(vertex) - here_.position_mm).norm();
        const double left = options_.max_length_mm - here_.length_mm;
        if (length >= left) {
            const Vector3d end = forward ? Vector3d::UnitY() : Vector3d::UnitX();
            return end_at(here_.bary + (end - here_.bary) * (left / length), left);
        }
        // The exit edge joins `vertex` and the corner ahead.
        return forward ? cross(0, 0.0, length) : cross(1, 1.0, length);
    }

    // The last station is where it was asked for, to the bit and however near the one before.
    bool end_at(const Vector3d& bary, double left) {
        here_.bary = bary.cwiseMax(0.0);
        here_.bary /= here_.bary.sum();
        here_.move(face_, steering_, left);
        here_.length_mm = options_.max_length_mm;
        result_.stop = TraceStop::Length;
        result_.path.push_back(here_.station(face_, steering_));
        return false;
    }

    // Moves onto the edge opposite a corner, `share` of the way from its start to its end, and
    // into the next face.
    bool cross(std::size_t opposite, double share, double length) {
        const std::size_t from = (opposite + 1) % 3;
        const std::size_t to = (opposite + 2) % 3;
        share = std::clamp(share, kVertexClearance, 1.0 - kVertexClearance);
        here_.bary[static_cast<Index>(opposite)] = 0.0;
        here_.bary[static_cast<Index>(from)] = 1.0 - share;
        here_.bary[static_cast<Index>(to)] = share;
        here_.move(face_, steering_, length);
        record();
        const std::size_t edge = face_.own(from);
        const WalkFace& left = surface_.walk_face[at(face_.face)];
        const Index across = left.across[edge];
        if (across < 0) {
            result_.stop = TraceStop::Rim;
            result_.rim = surface_.rim[at(face_.face)][edge];
            return false;
        }
        face_.enter(surface_, across / 4, at(across % 4));
        here_.bary = {share, 1.0 - share, 0.0};
        face_.entered = true;
        if (left.feature[edge] != 0) {
            here_.carry(face_);
            record();
        }
        return true;
    }

    const Surface& surface_;
    const Steering& steering_;
    const TraceOptions& options_;
    TraceResult result_;
    double min_station_mm_ = 0.0;
    WalkedFace face_;
    WalkPlace here_;
};

}  // namespace

const char* name_of(TraceStop stop) {
    switch (stop) {
        case TraceStop::Length:
            return "length";
        case TraceStop::Rim:
            return "rim";
        case TraceStop::FaceLimit:
            return "face-limit";
        case TraceStop::Folded:
            return "folded";
    }
    return "";
}

TraceResult trace(const Surface& surface, const SurfacePoint& start, const Vector3d& direction,
                  const Steering& steering, const TraceOptions& options) {
    if (options.method == TraceMethod::Patches) {
        return trace_on_patches(surface, start, direction, steering, options);
    }
    return Walker(surface, start, direction, steering, options).run();
}

}  // namespace meshwind
