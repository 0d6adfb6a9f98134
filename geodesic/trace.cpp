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

// Turns `vector` by the minimal rotation that takes unit `from` to unit `to`.
Vector3d rotate_minimally(const Vector3d& vector, const Vector3d& from, const Vector3d& to) {
    const double c = from.dot(to);
    if (c < -1.0 + 1e-9) {
        return vector;  // a fold by half a turn has no minimal rotation; the path ends up bridging
    }
    const Vector3d axis = from.cross(to);
    return c * vector + axis.cross(vector) + axis * (axis.dot(vector) / (1.0 + c));
}

class Walker {
public:
    Walker(const Surface& surface, const SurfacePoint& start, const Vector3d& direction,
           const Steering& steering, const TraceOptions& options)
        : surface_(surface), steering_(steering), options_(options) {
        face_ = start.face;
        bary_ = start.bary;
        position_ = position_mm(surface, start);
        normal_ = smooth_normal(surface, start);
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
        std::size_t opposite;  // bary index that becomes zero
    };

    // Curvature along `tangent`, interpolated from the corners by `bary_`.
    [[nodiscard]] double normal_curvature() const {
        const auto& corner = surface_.corner[at(face_)];
        double kn = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            if (bary_[static_cast<Index>(c)] != 0.0) {
                kn += bary_[static_cast<Index>(c)] *
                      tangent_.dot(surface_.shape_operator_per_mm[at(corner[c])] * tangent_);
            }
        }
        return kn;
    }

    [[nodiscard]] double geodesic_curvature(double kn) const {
        return kn * (kn > 0.0 ? steering_.slip_ratio : steering_.slip_ratio_concave);
    }

    [[nodiscard]] PathPoint station() {
        const double kn = normal_curvature();
        kg_per_mm_ = geodesic_curvature(kn);
        return {{face_, bary_}, position_, normal_, tangent_, length_mm_, kn, kg_per_mm_};
    }

    void record() {
        const PathPoint point = station();
        if (!result_.path.empty() && length_mm_ - result_.path.back().s_mm < min_station_mm_ &&
            result_.path.back().normal.dot(normal_) > 1.0 - kBaryEps) {
            return;
        }
        result_.path.push_back(point);
    }

    // Rates of the barycentric coordinates per mm along in-plane unit `d`.
    void prepare_face() {
        const auto& v = surface_.face[at(face_)];
        for (std::size_t i = 0; i < 3; ++i) {
            p_[i] = surface_.position_mm[at(v[i])];
        }
        const Vector3d cross = (p_[1] - p_[0]).cross(p_[2] - p_[0]);
        double_area_ = cross.norm();
        facet_normal_ = cross / double_area_;
    }

    [[nodiscard]] Vector3d rates(const Vector3d& d) const {
        const Vector3d side = facet_normal_.cross(d) / double_area_;
        return {-side.dot(p_[2] - p_[1]), -side.dot(p_[0] - p_[2]), -side.dot(p_[1] - p_[0])};
    }

    [[nodiscard]] Exit find_exit(const Vector3d& rate) const {
        Exit exit{std::numeric_limits<double>::infinity(), 0};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto k = static_cast<Index>(i);
            if (rate[k] < 0.0 && i != entry_) {
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
        return entry_ < 3 &&
               rate[static_cast<Index>(entry_)] * double_area_ < kGrazingSine * edge_length(entry_);
    }

    [[nodiscard]] double edge_length(std::size_t opposite) const {
        return (p_[(opposite + 2) % 3] - p_[(opposite + 1) % 3]).norm();
    }

    bool step() {
        prepare_face();
        Vector3d d = rotate_minimally(tangent_, normal_, facet_normal_);
        d = (d - facet_normal_ * facet_normal_.dot(d)).normalized();
        Vector3d rate = rates(d);
        if (points_back(rate)) {
            return slide_along_entry(d);
        }
        Exit exit = find_exit(rate);
        if (kg_per_mm_ != 0.0 && std::isfinite(exit.length_mm)) {
            // The chord of a steered path is turned by half of what the tangent turns over it.
            const double half_turn = 0.5 * kg_per_mm_ * exit.length_mm;
            const Vector3d turned =
                std::cos(half_turn) * d + std::sin(half_turn) * facet_normal_.cross(d);
            const Vector3d turned_rate = rates(turned);
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
        Vector3d bary = bary_ + exit.length_mm * rate;
        bary[static_cast<Index>(exit.opposite)] = 0.0;
        return cross(bary, exit.opposite, exit.length_mm);
    }

    // Follows the entry edge to its end ahead and leaves the face through the edge that starts
    // there.
    bool slide_along_entry(const Vector3d& d) {
        const std::size_t from = (entry_ + 1) % 3;
        const std::size_t to = (entry_ + 2) % 3;
        const bool forward = d.dot(p_[to] - p_[from]) >= 0.0;
        const std::size_t vertex = forward ? to : from;
        Vector3d bary = Vector3d::Zero();
        bary[static_cast<Index>(vertex)] = 1.0;
        const double length = (p_[vertex] - position_).norm();
        if (length >= options_.max_length_mm - length_mm_) {
            const double left = options_.max_length_mm - length_mm_;
            return end_at(bary_ + (bary - bary_) * (left / length), left);
        }
        // The exit edge joins `vertex` and the corner opposite the entry edge.
        return cross(bary, forward ? from : to, length);
    }

    void move_to(const Vector3d& bary, double length) {
        bary_ = bary.cwiseMax(0.0);
        bary_ /= bary_.sum();
        position_ = bary_[0] * p_[0] + bary_[1] * p_[1] + bary_[2] * p_[2];
        length_mm_ += length;
        const Vector3d normal = smooth_normal(surface_, {face_, bary_});
        carry_to(normal, kg_per_mm_ * length);
        if (steering_.slip_ratio != 0.0 || steering_.slip_ratio_concave != 0.0) {
            // The mean of the curvatures at both ends: second order.
            const double change = geodesic_curvature(normal_curvature()) - kg_per_mm_;
            carry_to(normal, 0.5 * change * length);
        }
    }

    void carry_to(const Vector3d& normal, double turn_rad) {
        Vector3d t = tangent_;
        if (turn_rad != 0.0) {
            t = std::cos(turn_rad) * t + std::sin(turn_rad) * normal_.cross(t);
        }
        t = rotate_minimally(t, normal_, normal);
        normal_ = normal;
        tangent_ = (t - normal * normal.dot(t)).normalized();
    }

    // The last station is where it was asked for, to the bit and however near the one before.
    bool end_at(const Vector3d& bary, double left) {
        move_to(bary, left);
        length_mm_ = options_.max_length_mm;
        result_.stop = TraceStop::Length;
        result_.path.push_back(station());
        return false;
    }

    // Moves to `bary` on the edge opposite `opposite` and into the next face.
    bool cross(Vector3d bary, std::size_t opposite, double length) {
        const std::size_t from = (opposite + 1) % 3;
        const std::size_t to = (opposite + 2) % 3;
        const double share =
            std::clamp(bary[static_cast<Index>(to)], kVertexClearance, 1.0 - kVertexClearance);
        bary[static_cast<Index>(opposite)] = 0.0;
        bary[static_cast<Index>(from)] = 1.0 - share;
        bary[static_cast<Index>(to)] = share;
        move_to(bary, length);
        record();
        const std::size_t edge = from;
        const Index next = surface_.neighbour[at(face_)][edge];
        if (next == kNoFace) {
            result_.stop = TraceStop::Rim;
            result_.rim = surface_.rim[at(face_)][edge];
            return false;
        }
        enter(next, surface_.face[at(face_)][to], share, surface_.feature[at(face_)][edge] != 0);
        return true;
    }

    void enter(Index next, Index first_vertex, double share, bool feature) {
        const auto& v = surface_.face[at(next)];
        std::size_t first = 0;  // where the shared edge starts in the next face
        while (first < 2 && v[first] != first_vertex) {
            ++first;
        }
        face_ = next;
        entry_ = (first + 2) % 3;
        bary_.setZero();
        bary_[static_cast<Index>(first)] = share;
        bary_[static_cast<Index>((first + 1) % 3)] = 1.0 - share;
        if (feature) {
            carry_to(smooth_normal(surface_, {face_, bary_}), 0.0);
            record();
        }
    }

    const Surface& surface_;
    const Steering& steering_;
    const TraceOptions& options_;
    TraceResult result_;
    Index face_ = kNoFace;
    std::size_t entry_ = 3;  // bary index that is zero on the edge by which the face was entered
    Vector3d bary_;
    Vector3d position_;
    Vector3d normal_;
    Vector3d tangent_;
    double length_mm_ = 0.0;
    double kg_per_mm_ = 0.0;
    double min_station_mm_ = 0.0;
    std::array<Vector3d, 3> p_;
    Vector3d facet_normal_;
    double double_area_ = 0.0;
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

Vector3d smooth_normal(const Surface& surface, const SurfacePoint& point) {
    const auto& corner = surface.corner[at(point.face)];
    return (point.bary[0] * surface.normal[at(corner[0])] +
            point.bary[1] * surface.normal[at(corner[1])] +
            point.bary[2] * surface.normal[at(corner[2])])
        .normalized();
}

SurfacePath reversed(const SurfacePath& path) {
    SurfacePath back(path.rbegin(), path.rend());
    const double length = path.empty() ? 0.0 : path.back().s_mm;
    for (PathPoint& point : back) {
        point.tangent = -point.tangent;
        point.kg_per_mm = -point.kg_per_mm;
        point.s_mm = length - point.s_mm;
    }
    return back;
}

}  // namespace meshwind
