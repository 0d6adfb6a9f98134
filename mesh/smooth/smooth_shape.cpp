#include "mesh/smooth/smooth_shape.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "core/index.h"
#include "mesh/smooth/patch.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

}  // namespace

SmoothShape::SmoothShape(const Surface& surface)
    : surface_(surface), rim_tangent_(surface.position_mm.size(), Vector3d::Zero()) {
    std::vector<Vector3d> into(rim_tangent_.size(), Vector3d::Zero());
    std::vector<Vector3d> out_of(rim_tangent_.size(), Vector3d::Zero());
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (surface.neighbour[f][e] == kNoFace) {
                const std::int32_t from = surface.face[f][e];
                const std::int32_t to = surface.face[f][(e + 1) % 3];
                out_of[at(from)] = into[at(to)] =
                    surface.position_mm[at(to)] - surface.position_mm[at(from)];
            }
        }
    }
    for (std::size_t v = 0; v < rim_tangent_.size(); ++v) {
        const double before = into[v].norm();
        const double after = out_of[v].norm();
        if (before > 0.0 && after > 0.0 &&
            into[v].dot(out_of[v]) > std::cos(kLineCornerRad) * before * after) {
            // Of the circle through the three vertices.
            rim_tangent_[v] = (after * after * into[v] + before * before * out_of[v]).normalized();
        }
    }
}

// The arc from one vertex of the rim to the next at a share of its way: a cubic whose middle is
// exact on circles.
Vector3d SmoothShape::rim_arc(std::int32_t from, std::int32_t to, double share) const {
    const Vector3d& a = surface_.position_mm[at(from)];
    const Vector3d& b = surface_.position_mm[at(to)];
    const Vector3d chord = b - a;
    const auto rate = [&](std::int32_t vertex) -> Vector3d {
        const Vector3d& tangent = rim_tangent_[at(vertex)];
        const double length = chord.norm();
        const double cosine = tangent.dot(chord) / length;
        return cosine > 0.0 ? Vector3d(2.0 * length / (1.0 + cosine) * tangent) : chord;
    };
    const double s = share;
    const double r = 1.0 - s;
    return r * a + s * b + s * r * (r * (rate(from) - chord) - s * (rate(to) - chord));
}

Vector3d SmoothShape::point_at(std::int32_t face, const Vector2d& uv) const {
    const Patch patch(surface_, face);
    Vector3d place = patch.at(uv).position_mm;
    const std::array<double, 3> bary = {1.0 - uv.x() - uv.y(), uv.x(), uv.y()};
    for (std::size_t e = 0; e < 3; ++e) {
        const std::size_t to = (e + 1) % 3;
        const double sum = bary[e] + bary[to];
        if (surface_.neighbour[at(face)][e] != kNoFace || !(sum > 0.0)) {
            continue;
        }
        const double share = bary[to] / sum;
        const Vector2d on_edge = (1.0 - share) * corner_uv(e) + share * corner_uv(to);
        const auto& vertex = surface_.face[at(face)];
        place +=
            sum * sum * (rim_arc(vertex[e], vertex[to], share) - patch.at(on_edge).position_mm);
    }
    return place;
}

}  // namespace meshwind
