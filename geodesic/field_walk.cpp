#include "geodesic/field_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/index.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A crossing this close to a vertex (share of the edge) is moved onto the edge, so that it is
// always clear which face comes next.
constexpr double kVertexClearance = 1e-9;

// Barycentric coordinate below which a step has left the triangle, and within which one ends on the
// edge.
constexpr double kOutside = 1e-10;
constexpr int kMaxLandings = 30;

// The walk has arrived this close to where `beyond` is zero: rounding of positions of some metres.
constexpr double kArrival_mm = 1e-9;
constexpr int kMaxApproaches = 3;

// Curvature within which the wall counts as flat: noise of the fits on cylinders and cones.
constexpr double kFlat_per_mm = 1e-6;

// On flat wall the walk goes on where `beyond` is lower by this share of `per_curvature`: an eye
// that far under the plane is no rounding of its position.
constexpr double kFlatUnder_rad = 1e-5;

// move_under() is there when a step of Newton's method is no longer, and gives up after so many.
constexpr double kNear_mm = 1e-4;
constexpr int kMaxNearing = 60;

// A walk with so many steps shorter than this share of the mean edge gets nowhere: a patch folded
// over itself, or faces around a vertex that all lead to it.
constexpr int kIdleSteps = 500;
constexpr double kIdleShare = 1e-6;

constexpr std::size_t kNoEdge = 3;
constexpr double kNever = std::numeric_limits<double>::infinity();

// Barycentric coordinate i, or its rate where `constant` is 0.
double bary(const Vector2d& uv, std::size_t i, double constant) {
    return i == 0 ? constant - uv.x() - uv.y() : uv[static_cast<Eigen::Index>(i) - 1];
}

Vector2d corner_uv(std::size_t i) {
    return {i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
}

// Rates of u and v along the tangential part of a vector, one mm per unit.
Vector2d unit_rate(const PatchPlace& place, const Vector3d& vector) {
    const double uu = place.along_u.squaredNorm();
    const double uv = place.along_u.dot(place.along_v);
    const double vv = place.along_v.squaredNorm();
    const double u = place.along_u.dot(vector);
    const double v = place.along_v.dot(vector);
    const Vector2d rate(vv * u - uv * v, uu * v - uv * u);
    const double speed = place.along(rate).norm();
    return speed > 0.0 ? Vector2d(rate / speed) : Vector2d::Zero();
}

double curvature(const PatchPlace& place, const Vector3d& normal, const Vector2d& rate) {
    return -normal.dot(place.second(rate));
}

}  // namespace

struct FieldWalker::Heading {
    Aim aim;
    Vector2d rate;
    double kn_per_mm;
};

FieldWalker::FieldWalker(const Surface& surface, const SurfacePoint& start)
    : surface_(&surface), patch_(surface, start.face), face_(start.face), entry_(kNoEdge) {
    settle({start.bary[1], start.bary[2]});
}

void FieldWalker::move_to(const SurfacePoint& place) {
    face_ = place.face;
    patch_ = Patch(*surface_, face_);
    entry_ = kNoEdge;
    settle({place.bary[1], place.bary[2]});
}

void FieldWalker::settle(const Vector2d& uv) {
    uv_ = uv;
    place_ = patch_.at(uv);
    normal_ = place_.normal();
}

// On the edge just crossed, and back over it.
bool FieldWalker::goes_back(const Vector2d& uv, const Vector2d& rate) const {
    return entry_ != kNoEdge && bary(rate, entry_, 0.0) <= 0.0 && bary(uv, entry_, 1.0) <= kOutside;
}

Vector2d FieldWalker::entry_edge() const {
    return corner_uv((entry_ + 2) % 3) - corner_uv((entry_ + 1) % 3);
}

// Along the tangential part of a direction; on the edge just crossed never back over it.
Vector2d FieldWalker::rate_at(const Vector2d& uv, const PatchPlace& place,
                              const Vector3d& direction) const {
    const Vector2d rate = unit_rate(place, direction);
    if (!goes_back(uv, rate)) {
        return rate;
    }
    const Vector3d edge = place.along(entry_edge());
    return unit_rate(place, edge.dot(direction) * edge);
}

Vector2d FieldWalker::field_rate(const Vector2d& uv, const AimField& field) const {
    const PatchPlace place = patch_.at(uv);
    return rate_at(uv, place, field(place.position_mm, place.normal()).direction);
}

FieldWalker::Heading FieldWalker::heading(const AimField& field) const {
    Heading heading{field(place_.position_mm, normal_), {}, 0.0};
    heading.rate = rate_at(uv_, place_, heading.aim.direction);
    heading.kn_per_mm = curvature(place_, normal_, heading.rate);
    return heading;
}

// The place after `h` mm.
Vector2d FieldWalker::stepped(const Heading& from, double h, const AimField& field) const {
    const Vector2d& k1 = from.rate;
    const Vector2d k2 = field_rate(uv_ + 0.5 * h * k1, field);
    const Vector2d k3 = field_rate(uv_ + 0.5 * h * k2, field);
    const Vector2d k4 = field_rate(uv_ + h * k3, field);
    return uv_ + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
}

// Steps by `h` mm or to the edge before that; returns the bary index that is zero there, or
// kNoEdge.
std::size_t FieldWalker::step(const Heading& from, double& h, const AimField& field) {
    std::size_t edge = kNoEdge;
    for (std::size_t k = 0; k < 3; ++k) {
        const double rate = bary(from.rate, k, 0.0);
        const double to_edge = rate < 0.0 ? std::max(0.0, bary(uv_, k, 1.0)) / -rate : kNever;
        if (to_edge < h) {
            h = to_edge;
            edge = k;
        }
    }
    Vector2d end = stepped(from, h, field);
    for (int i = 0; i < kMaxLandings; ++i) {
        double lowest = edge == kNoEdge ? -kOutside : bary(end, edge, 1.0);
        for (std::size_t k = 0; k < 3; ++k) {
            if (bary(end, k, 1.0) < std::min(lowest, -kOutside) && k != entry_) {
                lowest = bary(end, k, 1.0);
                edge = k;
            }
        }
        if (edge == kNoEdge || std::abs(lowest) <= kOutside) {
            break;
        }
        if (lowest > 0.0) {  // short of the edge that was aimed at: the next step gets there
            edge = kNoEdge;
            break;
        }
        // Back to the edge, by the secant of its coordinate.
        const double start = std::max(0.0, bary(uv_, edge, 1.0));
        h *= start / (start - lowest);
        end = stepped(from, h, field);
    }
    settle(end.cwiseMax(0.0) / std::max(1.0, end.cwiseMax(0.0).sum()));
    return edge;
}

FieldWalk FieldWalker::walk(const AimField& field, double longest_mm, double longest_step_mm,
                            const Visit& visit) {
    FieldWalk walk;
    entry_ = kNoEdge;  // another field may lead back over the edge that the last walk ended on
    Heading here = heading(field);
    int idle = 0;
    while (idle < kIdleSteps) {
        const double rise = here.aim.per_length + here.aim.per_curvature * here.kn_per_mm;
        if (here.aim.beyond >= 0.0) {
            walk.stop = FieldStop::Arrived;
            return walk;
        }
        const double flat_rise = kFlat_per_mm * here.aim.per_curvature;
        const bool rises = rise > flat_rise;
        if (!rises &&
            !(rise >= -flat_rise && here.aim.beyond < -kFlatUnder_rad * here.aim.per_curvature)) {
            walk.stop = FieldStop::Stalled;
            return walk;
        }
        double h = rises ? -here.aim.beyond / rise : longest_step_mm;
        if (h < kArrival_mm) {
            walk.stop = FieldStop::Arrived;
            return walk;
        }
        if (walk.length_mm >= longest_mm) {
            walk.stop = FieldStop::Length;
            return walk;
        }
        h = std::min({h, longest_step_mm, longest_mm - walk.length_mm});
        const Vector2d from = uv_;
        const PatchPlace from_place = place_;
        const Vector3d from_normal = normal_;
        std::size_t edge = step(here, h, field);
        Heading next = heading(field);
        for (int i = 0; i < kMaxApproaches && next.aim.beyond > kArrival_mm * rise; ++i) {
            // Beyond the end: back to where the line between both puts it.
            h *= -here.aim.beyond / (next.aim.beyond - here.aim.beyond);
            uv_ = from;
            place_ = from_place;
            normal_ = from_normal;
            edge = step(here, h, field);
            next = heading(field);
        }
        walk.length_mm += h;
        idle += h > kIdleShare * surface_->mean_edge_mm ? 0 : 1;
        if (edge == kNoEdge) {
            if (entry_ != kNoEdge && bary(uv_, entry_, 1.0) > kOutside) {
                entry_ = kNoEdge;
            }
            here = next;
            continue;
        }
        if (!cross(next, edge, visit, walk)) {
            return walk;
        }
        here = heading(field);
    }
    walk.stop = FieldStop::Folded;
    return walk;
}

// Onto the face over the edge opposite `opposite`: Arrived, or why not.
FieldStop FieldWalker::enter(std::size_t opposite) {
    const std::size_t from = (opposite + 1) % 3;
    const std::size_t to = (opposite + 2) % 3;
    const std::int32_t next = surface_->neighbour[at(face_)][from];
    if (next == kNoFace) {
        return FieldStop::Rim;
    }
    const double share = std::clamp(bary(uv_, to, 1.0), kVertexClearance, 1.0 - kVertexClearance);
    const auto& vertices = surface_->face[at(next)];
    const auto first = static_cast<std::size_t>(
        std::find(vertices.begin(), vertices.end(), surface_->face[at(face_)][to]) -
        vertices.begin());
    const std::size_t second = (first + 1) % 3;
    face_ = next;
    patch_ = Patch(*surface_, next);
    entry_ = (first + 2) % 3;
    settle(corner_uv(second) + share * (corner_uv(first) - corner_uv(second)));
    return patch_.holds(normal_) ? FieldStop::Arrived : FieldStop::Folded;
}

// Over the edge opposite `opposite`; false where the walk ends there.
bool FieldWalker::cross(const Heading& heading, std::size_t opposite, const Visit& visit,
                        FieldWalk& walk) {
    const std::size_t edge = (opposite + 1) % 3;
    const bool feature = surface_->feature[at(face_)][edge] != 0;
    PathPoint leaving = station(heading.aim.direction);
    leaving.s_mm = walk.length_mm;
    walk.stop = enter(opposite);
    if (walk.stop != FieldStop::Arrived) {
        walk.rim = walk.stop == FieldStop::Rim ? surface_->rim[at(face_)][edge] : -1;
        return false;
    }
    if (visit) {
        PathPoint entering = station(heading.aim.direction);
        entering.s_mm = walk.length_mm;
        if (!feature) {
            leaving.kn_per_mm = 0.5 * (leaving.kn_per_mm + entering.kn_per_mm);
        }
        visit(leaving);
        if (feature) {
            visit(entering);
        }
    }
    return true;
}

// Step in u and v to the place nearest to a point, by the second order of the distance.
Vector2d FieldWalker::towards(const Vector3d& point_mm) const {
    const Vector3d rest = point_mm - place_.position_mm;
    const Vector2d slope(place_.along_u.dot(rest), place_.along_v.dot(rest));
    Eigen::Matrix2d metric;
    metric << place_.along_u.squaredNorm(), place_.along_u.dot(place_.along_v),
        place_.along_u.dot(place_.along_v), place_.along_v.squaredNorm();
    Eigen::Matrix2d bent;
    bent << place_.second_uu.dot(rest), place_.second_uv.dot(rest), place_.second_uv.dot(rest),
        place_.second_vv.dot(rest);
    const Eigen::Matrix2d whole = metric - bent;
    // Further off than the surface's centre of curvature the nearest place is no longer below.
    const bool sound = whole(0, 0) > 0.0 && whole.determinant() > 0.0;
    const Vector2d step = (sound ? whole : metric).inverse() * slope;
    if (!goes_back(uv_, step)) {
        return step;
    }
    const Vector3d edge = place_.along(entry_edge());
    return edge.dot(rest) / edge.squaredNorm() * entry_edge();
}

bool FieldWalker::move_under(const Vector3d& point_mm) {
    entry_ = kNoEdge;  // where it came from says nothing of where this point is
    for (int i = 0; i < kMaxNearing; ++i) {
        const Vector2d step = towards(point_mm);
        double share = 1.0;
        std::size_t edge = kNoEdge;
        for (std::size_t k = 0; k < 3; ++k) {
            const double room = std::max(0.0, bary(uv_, k, 1.0));
            if (bary(step, k, 0.0) < 0.0 && room < -share * bary(step, k, 0.0)) {
                share = -room / bary(step, k, 0.0);
                edge = k;
            }
        }
        const double way_mm = place_.along(step).norm();
        const Vector2d end = (uv_ + share * step).cwiseMax(0.0);
        settle(end / std::max(1.0, end.sum()));
        if (edge != kNoEdge) {
            if (enter(edge) != FieldStop::Arrived) {
                return false;
            }
        } else if (way_mm < kNear_mm) {
            return true;
        } else if (entry_ != kNoEdge && bary(uv_, entry_, 1.0) > kOutside) {
            entry_ = kNoEdge;
        }
    }
    return false;
}

PathPoint FieldWalker::station(const Vector3d& direction) const {
    PathPoint point;
    const Vector2d rate = unit_rate(place_, direction);
    const Vector3d shares = Vector3d(1.0 - uv_.sum(), uv_.x(), uv_.y()).cwiseMax(0.0);
    point.at = {face_, shares / shares.sum()};
    point.position_mm = place_.position_mm;
    point.normal = normal_;
    point.tangent = place_.along(rate);
    point.kn_per_mm = curvature(place_, normal_, rate);
    return point;
}

}  // namespace meshwind
