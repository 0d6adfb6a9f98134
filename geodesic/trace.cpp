#include "geodesic/trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// In a face, corners are counted from the edge by which it was entered: that edge runs from corner
// 0 to corner 1, and corner 2 lies ahead. In the first face they are the face's own.
class Walker {
public:
    Walker(const Surface& surface, const SurfacePoint& start, const Vector3d& direction,
           const Steering& steering, const TraceOptions& options)
        : surface_(surface), steering_(steering), options_(options) {
        enter(start.face, 0);
        bary_ = start.bary;
        position_ = position_mm(surface, start);
        interpolate();
        tangent_ = (direction - normal_ * normal_.dot(direction)).normalized();
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
    struct Exit {
        double length_mm;
        std::size_t opposite;  // corner whose barycentric coordinate becomes zero
    };

    // Corner and edge number `i` as the surface counts them.
    [[nodiscard]] std::size_t own(std::size_t i) const { return (first_ + i) % 3; }

    void enter(Index face, std::size_t first) {
        face_ = face;
        first_ = first;
        const WalkFace& here = surface_.walk_face[at(face)];
        for (std::size_t i = 0; i < 3; ++i) {
            corner_[i] = &surface_.walk_corner[at(here.corner[own(i)])];
        }
        for (const std::size_t edge : {own(1), own(2)}) {
            // The corner ahead on the other side: fetching it takes as long as crossing this face.
            const Index across = std::max(here.across[edge], 0);
            const auto ahead = (at(across % 4) + 2) % 3;
            const WalkFace& next = surface_.walk_face[at(across / 4)];
            __builtin_prefetch(&surface_.walk_corner[at(next.corner[ahead])]);
        }
    }

    [[nodiscard]] const Vector3d& p(std::size_t i) const { return corner_[i]->position_mm; }

    // The smooth normal and the shape operator where `bary_` says.
    void interpolate() {
        const auto& [a, b, c] = corner_;
        normal_ = (bary_[0] * a->normal + bary_[1] * b->normal + bary_[2] * c->normal).normalized();
        shape_operator_per_mm_ = bary_[0] * a->shape_operator_per_mm +
                                 bary_[1] * b->shape_operator_per_mm +
                                 bary_[2] * c->shape_operator_per_mm;
    }

    [[nodiscard]] double normal_curvature() const {
        const auto& t = tangent_;
        Vector6d square;
        square << t.x() * t.x(), t.y() * t.y(), t.z() * t.z(), 2.0 * t.x() * t.y(),
            2.0 * t.x() * t.z(), 2.0 * t.y() * t.z();
        return shape_operator_per_mm_.dot(square);
    }

    [[nodiscard]] double geodesic_curvature(double kn) const {
        return kn * (kn > 0.0 ? steering_.slip_ratio : steering_.slip_ratio_concave);
    }

    [[nodiscard]] PathPoint station() {
        const double kn = normal_curvature();
        kg_per_mm_ = geodesic_curvature(kn);
        SurfacePoint here{face_, {}};
        for (std::size_t i = 0; i < 3; ++i) {
            here.bary[static_cast<Index>(own(i))] = bary_[static_cast<Index>(i)];
        }
        return {here, position_, normal_, tangent_, length_mm_, kn, kg_per_mm_};
    }

    void record() {
        const PathPoint point = station();
        if (!result_.path.empty() && length_mm_ - result_.path.back().s_mm < min_station_mm_ &&
            result_.path.back().normal.dot(normal_) > 1.0 - kBaryEps) {
            return;
        }
        result_.path.push_back(point);
    }

    void measure_face() {
        const Vector3d cross = (p(1) - p(0)).cross(p(2) - p(0));
        const double inverse_area = 1.0 / cross.norm();
        facet_normal_ = cross * inverse_area;
        gradient_[0] = facet_normal_.cross(p(2) - p(1)) * inverse_area;
        gradient_[1] = facet_normal_.cross(p(0) - p(2)) * inverse_area;
        gradient_[2] = facet_normal_.cross(p(1) - p(0)) * inverse_area;
    }

    // Of the barycentric coordinates per mm along in-plane unit `d`.
    [[nodiscard]] Vector3d rates(const Vector3d& d) const {
        return {gradient_[0].dot(d), gradient_[1].dot(d), gradient_[2].dot(d)};
    }

    [[nodiscard]] Exit find_exit(const Vector3d& rate) const {
        Exit exit{std::numeric_limits<double>::infinity(), 0};
        if (entered_) {
            const std::size_t i = rate[0] * bary_[1] < rate[1] * bary_[0] ? 0 : 1;
            const auto k = static_cast<Index>(i);
            return rate[k] < 0.0 ? Exit{bary_[k] / -rate[k], i} : exit;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const auto k = static_cast<Index>(i);
            if (rate[k] < 0.0) {
                const double length = std::max(0.0, bary_[k]) / -rate[k];
                if (length < exit.length_mm) {
                    exit = {length, i};
                }
            }
        }
        return exit;
    }

    // In-plane direction; turned back inside where the smooth tangent would leave through the entry
    // edge.
    [[nodiscard]] bool points_back(const Vector3d& rate) const {
        return entered_ && rate[2] < kGrazingSine * gradient_[2].norm();
    }

    bool step() {
        measure_face();
        const Vector3d d = carried(tangent_, normal_, facet_normal_);
        Vector3d rate = rates(d);
        if (points_back(rate)) {
            return slide_along_entry(d);
        }
        Exit exit = find_exit(rate);
        if (kg_per_mm_ != 0.0 && std::isfinite(exit.length_mm)) {
            // The chord of a steered path is turned by half of what the tangent turns over it.
            const Turn turn = turn_by(0.5 * kg_per_mm_ * exit.length_mm);
            const Vector3d turned_rate =
                turn.cosine * rate + turn.sine * rates(facet_normal_.cross(d));
            const Exit turned_exit = find_exit(turned_rate);
            if (!points_back(turned_rate) && std::isfinite(turned_exit.length_mm)) {
                rate = turned_rate;
                exit = turned_exit;
            }
        }
        if (!std::isfinite(exit.length_mm)) {
            return slide_along_entry(d);
        }
        return advance(rate, exit);
    }

    bool advance(const Vector3d& rate, const Exit& exit) {
        const double left = options_.max_length_mm - length_mm_;
        if (exit.length_mm >= left) {
            return end_at(bary_ + left * rate, left);
        }
        const auto to = static_cast<Index>((exit.opposite + 2) % 3);
        return cross(exit.opposite, bary_[to] + exit.length_mm * rate[to], exit.length_mm);
    }

    // Follows the entry edge to its end ahead and leaves the face through the edge that starts
    // there.
    bool slide_along_entry(const Vector3d& d) {
        const bool forward = d.dot(p(1) - p(0)) >= 0.0;
        const std::size_t vertex = forward ? 1 : 0;
        const double length = (p(vertex) - position_).norm();
        const double left = options_.max_length_mm - length_mm_;
        if (length >= left) {
            const Vector3d end = forward ? Vector3d::UnitY() : Vector3d::UnitX();
            return end_at(bary_ + (end - bary_) * (left / length), left);
        }
        // The exit edge joins `vertex` and the corner ahead.
        return forward ? cross(0, 0.0, length) : cross(1, 1.0, length);
    }

    // To where `bary_` says.
    void move(double length) {
        position_ = bary_[0] * p(0) + bary_[1] * p(1) + bary_[2] * p(2);
        length_mm_ += length;
        if (kg_per_mm_ != 0.0) {
            turn_left(kg_per_mm_ * length);
        }
        carry();
        if (steering_.slip_ratio != 0.0 || steering_.slip_ratio_concave != 0.0) {
            // The mean of the curvatures at both ends: second order.
            const double change = geodesic_curvature(normal_curvature()) - kg_per_mm_;
            turn_left(0.5 * change * length);
        }
    }

    void turn_left(double rad) {
        const Turn turn = turn_by(rad);
        tangent_ = turn.cosine * tangent_ + turn.sine * normal_.cross(tangent_);
    }

    // Into the tangent plane where `bary_` says.
    void carry() {
        const Vector3d from = normal_;
        interpolate();
        // One step of Newton's method for the length 1 that rounding has changed.
        tangent_ *= 1.5 - 0.5 * tangent_.squaredNorm();
        tangent_ = carried(tangent_, from, normal_);
    }

    // The last station is where it was asked for, to the bit and however near the one before.
    bool end_at(const Vector3d& bary, double left) {
        bary_ = bary.cwiseMax(0.0);
        bary_ /= bary_.sum();
        move(left);
        length_mm_ = options_.max_length_mm;
        result_.stop = TraceStop::Length;
        result_.path.push_back(station());
        return false;
    }

    // Moves onto the edge opposite a corner, `share` of the way from its start to its end, and
    // into the next face.
    bool cross(std::size_t opposite, double share, double length) {
        const std::size_t from = (opposite + 1) % 3;
        const std::size_t to = (opposite + 2) % 3;
        share = std::clamp(share, kVertexClearance, 1.0 - kVertexClearance);
        bary_[static_cast<Index>(opposite)] = 0.0;
        bary_[static_cast<Index>(from)] = 1.0 - share;
        bary_[static_cast<Index>(to)] = share;
        move(length);
        record();
        const std::size_t edge = own(from);
        const WalkFace& left = surface_.walk_face[at(face_)];
        const Index across = left.across[edge];
        if (across < 0) {
            result_.stop = TraceStop::Rim;
            result_.rim = surface_.rim[at(face_)][edge];
            return false;
        }
        enter(across / 4, at(across % 4));
        bary_ = {share, 1.0 - share, 0.0};
        entered_ = true;
        if (left.feature[edge] != 0) {
            carry();
            record();
        }
        return true;
    }

    const Surface& surface_;
    const Steering& steering_;
    const TraceOptions& options_;
    TraceResult result_;
    double min_station_mm_ = 0.0;

    Index face_ = kNoFace;
    std::size_t first_ = 0;  // the surface's number of corner 0
    bool entered_ = false;   // false in the first face
    std::array<const WalkCorner*, 3> corner_;
    Vector3d facet_normal_;
    std::array<Vector3d, 3> gradient_;  // of the barycentric coordinates, per mm

    Vector3d bary_;
    Vector6d shape_operator_per_mm_;
    Vector3d position_;
    Vector3d normal_;
    Vector3d tangent_;
    double length_mm_ = 0.0;
    double kg_per_mm_ = 0.0;
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
