// What laying looks up of the wall.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/index.h"
#include "core/text/text_number.h"
#include "mesh/nearest.h"
#include "postproc/verify/laydown.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Curvature of the wall (radius 10 m) below which it counts as hollow; along 40 mm such a hollow is
// 0.02 mm deep.
constexpr double kHollow_per_mm = 1e-4;

// Shallower creases count as flat, as those of rims do (hollow_rim.h).
constexpr double kMinValley_rad = 1e-3;

// Whether the wall bends up at an edge: seen across it, the normal beyond leans back.
bool is_valley(const Surface& surface, std::size_t face, std::size_t edge) {
    const std::int32_t other = surface.neighbour[face][edge];
    if (other == kNoFace) {
        return false;
    }
    const std::int32_t start = surface.face[face][edge];
    const Vector3d along = surface.position_mm[at(surface.face[face][(edge + 1) % 3])] -
                           surface.position_mm[at(start)];
    const auto& there = surface.face[at(other)];
    const auto corner =
        static_cast<std::size_t>(std::find(there.begin(), there.end(), start) - there.begin());
    const Vector3d& here = surface.normal[at(surface.corner[face][edge])];
    const Vector3d& beyond = surface.normal[at(surface.corner[at(other)][corner])];
    return beyond.dot(along.cross(here).normalized()) < -kMinValley_rad;
}

// Per face: whether a hollow of the wall, along any direction, is within reach.
std::vector<char> hollow_faces(const Surface& surface, double reach_mm) {
    std::vector<Vector3d> hollow;
    const auto centre = [&](const std::array<std::int32_t, 3>& v) {
        return Vector3d((surface.position_mm[at(v[0])] + surface.position_mm[at(v[1])] +
                         surface.position_mm[at(v[2])]) /
                        3.0);
    };
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        bool found = false;
        for (std::size_t i = 0; i < 3 && !found; ++i) {
            const Eigen::Matrix3d& s = surface.shape_operator_per_mm[at(surface.corner[f][i])];
            // Of the two principal curvatures the smaller: mean and Gaussian curvature give it.
            const double mean = 0.5 * s.trace();
            const double square = 0.5 * (s * s).trace();
            const double least = mean - std::sqrt(std::max(0.0, square - mean * mean));
            const bool valley = surface.feature[f][i] != 0 && is_valley(surface, f, i);
            found = least < -kHollow_per_mm || valley;
        }
        if (found) {
            hollow.push_back(centre(surface.face[f]));
        }
    }
    std::vector<char> near(surface.face.size(), 0);
    if (hollow.empty()) {
        return near;
    }
    const NearestPoints points(hollow);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const Vector3d c = centre(surface.face[f]);
        const auto nearest = at(points.nearest(c));
        near[f] = (hollow[nearest] - c).norm() < reach_mm ? 1 : 0;
    }
    return near;
}

RayQuery facets_of(const Surface& surface) {
    const std::array<TriangleSoup, 1> soup{{{surface.position_mm, surface.face}}};
    return RayQuery(soup);
}

}  // namespace

LaydownSurface::LaydownSurface(Surface surface, double bridge_reach_mm, std::vector<Pin> pins)
    : surface_(std::move(surface)),
      bridge_reach_mm_(bridge_reach_mm),
      pins_(std::move(pins)),
      hollow_(hollow_faces(surface_, bridge_reach_mm)),
      facets_(facets_of(surface_)) {
    if (std::find(hollow_.begin(), hollow_.end(), 1) != hollow_.end()) {
        lifted_.emplace(surface_);
    }
}

SurfacePoint LaydownSurface::nearest(const Vector3d& place) const {
    const double reach = std::max(1.0, 2.0 * surface_.mean_edge_mm);
    const ClosestPoint closest = facets_.closest(place, reach);
    if (closest.part < 0) {
        throw InputError("verify.tie_on", "",
                         "the tie-on point (" + fixed(place.x(), 3) + ", " + fixed(place.y(), 3) +
                             ", " + fixed(place.z(), 3) + ") is more than " + fixed(reach, 1) +
                             " mm off the mandrel; is it the mandrel of this program?");
    }
    return {closest.face, closest.bary};
}

}  // namespace meshwind
