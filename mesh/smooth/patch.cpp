#include "mesh/smooth/patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/index.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Sine of the angle between the fitted normals of both sides (10 deg) below which an edge is no
// crease of the smooth surface but a fold of too coarse facets, or the end of a crease that runs
// out: the normals' errors would turn the tangent.
constexpr double kMinCreaseSine = 0.17;

// Sine of the angle between the normals of both sides (0.06 deg) below which they are the same: the
// faces of a CAD part meet as nearly where they are meant to be tangent.
constexpr double kSmoothSine = 1e-3;

// And share of its chord by which the middles of an edge, as both sides have it, may be apart.
constexpr double kSmoothGap = 1e-4;

// Cosine of the largest angle between a patch and its facet (60 deg).
constexpr double kMinFacing = 0.5;

// Sine of a corner between two creases (3 deg) below which it is taken as closed.
constexpr double kMinEarSine = 0.05;

// Rates of the barycentric coordinates by u and v.
constexpr std::array<double, 3> kBaryByU = {-1.0, 1.0, 0.0};
constexpr std::array<double, 3> kBaryByV = {-1.0, 0.0, 1.0};

// Lift of the facet's point along the frame's third axis, with its derivatives along two directions
// of the frame.
struct Lift {
    double value, by_a, by_b, by_aa, by_ab, by_bb;
};

Lift lift_at(const HeightJet& jet, const Vector3d& at, const Vector3d& a, const Vector3d& b) {
    const JetHeight h = height_at(jet, at.x(), at.y());
    const double xa = h.by_xx * a.x() + h.by_xy * a.y();
    const double ya = h.by_xy * a.x() + h.by_yy * a.y();
    const double xb = h.by_xx * b.x() + h.by_xy * b.y();
    const double yb = h.by_xy * b.x() + h.by_yy * b.y();
    return {h.value - at.z(),
            h.by_x * a.x() + h.by_y * a.y() - a.z(),
            h.by_x * b.x() + h.by_y * b.y() - b.z(),
            xa * a.x() + ya * a.y(),
            xb * a.x() + yb * a.y(),
            xb * b.x() + yb * b.y()};
}

// A corner of a feature edge seen from both sides.
struct Side {
    Vector3d normal, normal_across;
    std::int32_t face_across;
    std::size_t corner_across;
};

Side side_of(const Surface& surface, std::int32_t face, std::size_t edge, std::size_t corner) {
    const std::int32_t other = surface.neighbour[at(face)][edge];
    const auto& there = surface.face[at(other)];
    const std::int32_t vertex = surface.face[at(face)][corner];
    const auto across =
        static_cast<std::size_t>(std::find(there.begin(), there.end(), vertex) - there.begin());
    return {surface.normal[at(surface.corner[at(face)][corner])],
            surface.normal[at(surface.corner[at(other)][across])], other, across};
}

bool is_crease(const Surface& surface, std::int32_t face, std::size_t edge) {
    return surface.feature[at(face)][edge] != 0 && surface.neighbour[at(face)][edge] != kNoFace;
}

// What the jets of an edge's two corners lift the middle of its chord by.
Vector3d middle_lift(const Surface& surface, const std::array<std::int32_t, 2>& corner,
                     const Vector3d& chord) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
        const HeightJet& jet = surface.jet[at(corner[i])];
        const Vector3d half = (i == 0 ? 0.5 : -0.5) * (jet.frame.transpose() * chord);
        sum += (height_at(jet, half.x(), half.y()).value - half.z()) * jet.frame.col(2);
    }
    return 0.5 * sum;
}

// Whether both sides know the same normals and the same curve along an edge, from exact faces: a
// border over which the surface is smooth. Bent to a curve of its own, a patch would only become
// uneven. One-sided fits are not as good: their patches have to be joined.
bool is_smooth(const Surface& surface, std::int32_t face, std::size_t edge) {
    const std::size_t to = (edge + 1) % 3;
    const Side from_side = side_of(surface, face, edge, edge);
    const Side to_side = side_of(surface, face, edge, to);
    const auto differ = [](const Side& side) {
        return side.normal.cross(side.normal_across).norm() > kSmoothSine;
    };
    if (differ(from_side) || differ(to_side)) {
        return false;
    }
    const auto& vertex = surface.face[at(face)];
    const auto& here = surface.corner[at(face)];
    const auto& there = surface.corner[at(from_side.face_across)];
    for (const std::int32_t corner :
         {here[edge], here[to], there[from_side.corner_across], there[to_side.corner_across]}) {
        if (surface.exact[at(corner)] == 0) {
            return false;
        }
    }
    const Vector3d chord =
        surface.position_mm[at(vertex[to])] - surface.position_mm[at(vertex[edge])];
    const Vector3d gap =
        middle_lift(surface, {here[edge], here[to]}, chord) -
        middle_lift(surface, {there[from_side.corner_across], there[to_side.corner_across]}, chord);
    return gap.norm() < kSmoothGap * chord.norm();
}

// Whether two creases run on into each other at a face's corner, as where a cap's triangle has two
// edges on its rim: both along their tangent, they would close the corner.
bool is_ear(const Surface& surface, std::int32_t face, std::size_t corner) {
    const std::size_t before = (corner + 2) % 3;
    if (!is_crease(surface, face, corner) || !is_crease(surface, face, before)) {
        return false;
    }
    const auto& vertex = surface.face[at(face)];
    const auto tangent = [&](std::size_t edge) {
        const Side side = side_of(surface, face, edge, corner);
        const Vector3d chord =
            surface.position_mm[at(vertex[(edge + 1) % 3])] - surface.position_mm[at(vertex[edge])];
        const Vector3d along = side.normal.cross(side.normal_across).normalized();
        return along.dot(chord) < 0.0 ? Vector3d(-along) : along;
    };
    const Vector3d& normal = surface.normal[at(surface.corner[at(face)][corner])];
    return tangent(before).cross(tangent(corner)).dot(normal) < kMinEarSine;
}

}  // namespace

Patch::Patch(const Surface& surface, std::int32_t face) {
    for (std::size_t i = 0; i < 3; ++i) {
        position_mm_[i] = surface.position_mm[meshwind::at(surface.face[meshwind::at(face)][i])];
    }
    const Vector3d along_u = position_mm_[1] - position_mm_[0];
    const Vector3d along_v = position_mm_[2] - position_mm_[0];
    for (std::size_t i = 0; i < 3; ++i) {
        Corner& corner = corner_[i];
        const std::size_t known = meshwind::at(surface.corner[meshwind::at(face)][i]);
        corner.jet = &surface.jet[known];
        exact_ = exact_ && surface.exact[known] != 0;
        const auto to_frame = corner.jet->frame.transpose();
        corner.along_u = to_frame * along_u;
        corner.along_v = to_frame * along_v;
        corner.origin_mm = i == 0   ? Vector3d(Vector3d::Zero())
                           : i == 1 ? Vector3d(-corner.along_u)
                                    : Vector3d(-corner.along_v);
    }
    for (std::size_t e = 0; e < 3; ++e) {
        if (is_crease(surface, face, e) && !is_smooth(surface, face, e)) {
            add_crease(surface, face, e);
        }
    }
    if (creases_ == 0 && !surface.cylinder_of.empty()) {
        const std::int32_t known = surface.cylinder_of[meshwind::at(face)];
        cylinder_ = known < 0 ? nullptr : &surface.cylinder[meshwind::at(known)];
    }
}

// X = C + t W + R n of the facet's point P, with t = (P - C) . W and n the unit vector from the
// axis to P.
PatchPlace Patch::on_cylinder(const Vector2d& uv) const {
    const Vector3d& axis = cylinder_->direction;
    const double radius = cylinder_->radius_mm;
    const auto off_axis = [&](const Vector3d& v) { return Vector3d(v - v.dot(axis) * axis); };
    const Vector3d by_u = position_mm_[1] - position_mm_[0];
    const Vector3d by_v = position_mm_[2] - position_mm_[0];
    const Vector3d off = position_mm_[0] + uv.x() * by_u + uv.y() * by_v - cylinder_->point_mm;
    const Vector3d arm = off_axis(off);
    const double reach = arm.norm();
    const Vector3d n = arm / reach;
    const Vector3d a = off_axis(by_u);
    const Vector3d b = off_axis(by_v);
    const Vector3d n_u = (a - n.dot(a) * n) / reach;
    const Vector3d n_v = (b - n.dot(b) * n) / reach;
    const auto second = [&](const Vector3d& p, const Vector3d& n_p, const Vector3d& q,
                            const Vector3d& n_q) {
        return Vector3d(-radius / reach * (n.dot(p) * n_q + n_q.dot(p) * n + n.dot(q) * n_p));
    };
    return {cylinder_->point_mm + off.dot(axis) * axis + radius * n,
            by_u.dot(axis) * axis + radius * n_u,
            by_v.dot(axis) * axis + radius * n_v,
            second(a, n_u, a, n_u),
            second(a, n_u, b, n_v),
            second(b, n_v, b, n_v)};
}

PatchPlace Patch::at(const Vector2d& uv) const {
    if (cylinder_ != nullptr) {
        return on_cylinder(uv);
    }
    const double u = uv.x();
    const double v = uv.y();
    const std::array<double, 3> bary = {1.0 - u - v, u, v};
    PatchPlace place;
    place.along_u = position_mm_[1] - position_mm_[0];
    place.along_v = position_mm_[2] - position_mm_[0];
    place.position_mm = position_mm_[0] + u * place.along_u + v * place.along_v;
    place.second_uu.setZero();
    place.second_uv.setZero();
    place.second_vv.setZero();
    for (std::size_t i = 0; i < 3; ++i) {
        const Corner& corner = corner_[i];
        const Vector3d here = corner.origin_mm + u * corner.along_u + v * corner.along_v;
        const Lift lift = lift_at(*corner.jet, here, corner.along_u, corner.along_v);
        const Vector3d up = corner.jet->frame.col(2);
        const double by_u = kBaryByU[i];
        const double by_v = kBaryByV[i];
        place.position_mm += bary[i] * lift.value * up;
        place.along_u += (by_u * lift.value + bary[i] * lift.by_a) * up;
        place.along_v += (by_v * lift.value + bary[i] * lift.by_b) * up;
        place.second_uu += (2.0 * by_u * lift.by_a + bary[i] * lift.by_aa) * up;
        place.second_uv += (by_u * lift.by_b + by_v * lift.by_a + bary[i] * lift.by_ab) * up;
        place.second_vv += (2.0 * by_v * lift.by_b + bary[i] * lift.by_bb) * up;
    }
    for (std::size_t i = 0; i < creases_; ++i) {
        bend_to_crease(crease_[i], uv, place);
    }
    return place;
}

bool Patch::holds(const Vector3d& normal) const {
    const Vector3d facet =
        (position_mm_[1] - position_mm_[0]).cross(position_mm_[2] - position_mm_[0]);
    return normal.dot(facet) > kMinFacing * facet.norm();
}

double Patch::curvature_per_mm() const {
    double largest = 0.0;
    for (const Corner& corner : corner_) {
        const auto& c = corner.jet->coefficient;
        largest =
            std::max(largest, std::sqrt(4.0 * c[2] * c[2] + 2.0 * c[3] * c[3] + 4.0 * c[4] * c[4]));
    }
    return largest;
}

double Patch::shortest_crease_mm() const {
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < creases_; ++i) {
        shortest = std::min(shortest,
                            (position_mm_[crease_[i].to] - position_mm_[crease_[i].from]).norm());
    }
    return shortest;
}

void Patch::add_crease(const Surface& surface, std::int32_t face, std::size_t edge) {
    const std::size_t from = edge;
    const std::size_t to = (edge + 1) % 3;
    const Vector3d chord = position_mm_[to] - position_mm_[from];
    const auto tangent_at = [&](std::size_t corner) {
        const Side here = side_of(surface, face, edge, corner);
        Vector3d tangent = here.normal.cross(here.normal_across);
        if (tangent.norm() < kMinCreaseSine || is_ear(surface, face, corner) ||
            is_ear(surface, here.face_across, here.corner_across)) {
            const Vector3d normal = (here.normal + here.normal_across).normalized();
            tangent = chord - normal * normal.dot(chord);
            if (tangent.norm() < kMinCreaseSine * chord.norm()) {
                tangent = chord;
            }
        }
        // As long as makes the cubic a circle's to sixth order.
        const double cosine = tangent.dot(chord) / (tangent.norm() * chord.norm());
        tangent *= 2.0 / (1.0 + std::abs(cosine)) * chord.norm() / tangent.norm();
        return cosine < 0.0 ? Vector3d(-tangent) : tangent;
    };
    crease_[creases_++] = {from, to, tangent_at(from), tangent_at(to)};
}

// A vector along the edge with its derivatives by the share of the edge.
struct Patch::EdgeCurve {
    Vector3d value, first, second;
};

// From the averaged lift to the crease's cubic; zero at both ends.
Patch::EdgeCurve Patch::gap_at(const Crease& crease, double share) const {
    const double s = share;
    const double r = 1.0 - s;
    const Vector3d chord = position_mm_[crease.to] - position_mm_[crease.from];
    const Vector3d a = crease.tangent_from - chord;
    const Vector3d b = chord - crease.tangent_to;
    // The cubic less its chord.
    EdgeCurve gap{s * r * (r * a + s * b), (r * r - 2.0 * s * r) * a + (2.0 * s * r - s * s) * b,
                  (6.0 * s - 4.0) * a + (2.0 - 6.0 * s) * b};
    for (const bool end : {false, true}) {
        const std::size_t i = end ? crease.to : crease.from;
        const Vector3d along = corner_[i].jet->frame.transpose() * chord;
        const Lift lift = lift_at(*corner_[i].jet, (end ? -r : s) * along, along, along);
        const double weight = end ? s : r;
        const double weight_rate = end ? 1.0 : -1.0;
        const auto up = corner_[i].jet->frame.col(2);
        gap.value -= weight * lift.value * up;
        gap.first -= (weight_rate * lift.value + weight * lift.by_a) * up;
        gap.second -= (2.0 * weight_rate * lift.by_a + weight * lift.by_aa) * up;
    }
    return gap;
}

// Adds (b_from + b_to)^2 gap(b_to / (b_from + b_to)): all of it on the crease, nothing on the other
// two edges.
void Patch::bend_to_crease(const Crease& crease, const Vector2d& uv, PatchPlace& place) const {
    const std::array<double, 3> bary = {1.0 - uv.x() - uv.y(), uv.x(), uv.y()};
    const double sum = bary[crease.from] + bary[crease.to];
    if (!(sum > 0.0)) {
        return;
    }
    const EdgeCurve gap = gap_at(crease, bary[crease.to] / sum);
    // Rates of the sum, and of the share times the sum.
    const double sum_u = kBaryByU[crease.from] + kBaryByU[crease.to];
    const double sum_v = kBaryByV[crease.from] + kBaryByV[crease.to];
    const double share_u = kBaryByU[crease.to] - bary[crease.to] / sum * sum_u;
    const double share_v = kBaryByV[crease.to] - bary[crease.to] / sum * sum_v;
    place.position_mm += sum * sum * gap.value;
    place.along_u += sum * (2.0 * sum_u * gap.value + share_u * gap.first);
    place.along_v += sum * (2.0 * sum_v * gap.value + share_v * gap.first);
    const auto second = [&](double sum_a, double share_a, double sum_b, double share_b) {
        return Vector3d(2.0 * sum_a * sum_b * gap.value +
                        (sum_a * share_b + sum_b * share_a) * gap.first +
                        share_a * share_b * gap.second);
    };
    place.second_uu += second(sum_u, share_u, sum_u, share_u);
    place.second_uv += second(sum_u, share_u, sum_v, share_v);
    place.second_vv += second(sum_v, share_v, sum_v, share_v);
}

PatchPlace on_patch(const Surface& surface, std::int32_t face, const Vector3d& bary) {
    return Patch(surface, face).at({bary[1], bary[2]});
}

}  // namespace meshwind
