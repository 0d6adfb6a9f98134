#include "geodesic/lifted_wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "mesh/smooth/patch.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Places of a patch at which its height over the facet is measured: the middles of the edges and of
// the triangle. Between them it may be somewhat more.
const std::array<Eigen::Vector2d, 4> kMeasured{
    {{0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}, {1.0 / 3.0, 1.0 / 3.0}}};
constexpr double kBetween = 1.5;

// Rays are in single precision, which is good to 1e-7 of the size of the scene.
constexpr double kSingle = 1e-6;

// Where an edge is so sharp that its facets are lifted by less of the way of its vertices, no ray
// tells anything.
constexpr double kMinShare = 0.2;

// The facets are over the wall by what they are lifted, and by what patches are under them.
constexpr double kOver = 2.0;

constexpr std::size_t kChunk = 1024;

struct Facet {
    Vector3d normal;
    double off_mm = 0.0;  // of the patch over it; infinite where that is none
};

Facet facet_of(const Surface& surface, std::size_t face) {
    const auto& v = surface.face[face];
    const Vector3d& a = surface.position_mm[at(v[0])];
    const Vector3d along_u = surface.position_mm[at(v[1])] - a;
    const Vector3d along_v = surface.position_mm[at(v[2])] - a;
    const Patch patch(surface, static_cast<std::int32_t>(face));
    Facet facet{along_u.cross(along_v).normalized()};
    for (const Eigen::Vector2d& uv : kMeasured) {
        const Vector3d flat = a + uv.x() * along_u + uv.y() * along_v;
        const double off = (patch.at(uv).position_mm - flat).norm();
        facet.off_mm = std::isfinite(off) ? std::max(facet.off_mm, off)
                                          : std::numeric_limits<double>::infinity();
    }
    return facet;
}

struct Lifted {
    std::vector<Vector3d> position_mm;  // per vertex
    double highest_mm = 0.0;
};

// Every vertex goes out so far that each facet about it is lifted by as much as its patch is off.
Lifted lift(const Surface& surface) {
    const double least_mm = kSingle * diagonal_mm(surface.position_mm);
    std::vector<Facet> facets(surface.face.size());
    parallel_for(facets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            facets[f] = facet_of(surface, f);
        }
    });
    std::vector<Vector3d> normal(surface.position_mm.size(), Vector3d::Zero());
    std::vector<double> needed_mm(surface.position_mm.size(), least_mm);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const double off_mm = least_mm + kBetween * facets[f].off_mm;
        for (const std::int32_t vertex : surface.face[f]) {
            normal[at(vertex)] += facets[f].normal;
            needed_mm[at(vertex)] = std::max(needed_mm[at(vertex)], off_mm);
        }
    }
    std::vector<double> share(normal.size(), 1.0);  // of a vertex's way that the facets are lifted
    for (Vector3d& n : normal) {
        n.normalize();
    }
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (const std::int32_t vertex : surface.face[f]) {
            share[at(vertex)] =
                std::min(share[at(vertex)], normal[at(vertex)].dot(facets[f].normal));
        }
    }
    Lifted lifted;
    for (std::size_t i = 0; i < normal.size(); ++i) {
        const double way_mm = needed_mm[i] / std::max(share[i], kMinShare);
        lifted.position_mm.push_back(surface.position_mm[i] + way_mm * normal[i]);
        lifted.highest_mm =
            std::max(lifted.highest_mm,
                     share[i] < kMinShare ? std::numeric_limits<double>::infinity() : way_mm);
    }
    return lifted;
}

}  // namespace

LiftedWall::LiftedWall(const Surface& surface) {
    const Lifted lifted = lift(surface);
    height_mm_ = kOver * lifted.highest_mm;
    if (std::isfinite(height_mm_)) {
        const std::array<TriangleSoup, 1> soup{{{lifted.position_mm, surface.face}}};
        facets_.emplace(soup);
    }
}

bool LiftedWall::is_free(const Vector3d& from, const Vector3d& to) const {
    return facets_ && facets_->closest(from, height_mm_).part < 0 && !facets_->occluded(from, to);
}

}  // namespace meshwind
