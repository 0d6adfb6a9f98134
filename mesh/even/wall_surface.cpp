#include "mesh/even/wall_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/index.h"
#include "mesh/edge_table.h"
#include "mesh/smooth/freeze.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A patch lifts a point of a facet by less than this share of the facet's height over its longest
// edge, or it has gone astray on a poor fit.
constexpr double kMaxLift = 0.3;

double largest_curvature(const Eigen::Matrix3d& shape_operator_per_mm) {
    const double mean = 0.5 * shape_operator_per_mm.trace();
    return std::abs(mean) +
           std::sqrt(std::max(0.0, 0.5 * shape_operator_per_mm.squaredNorm() - mean * mean));
}

double height_mm(const Surface& surface, std::int32_t face) {
    const auto& v = surface.face[at(face)];
    double longest = 0.0;
    for (std::size_t e = 0; e < 3; ++e) {
        longest = std::max(
            longest,
            (surface.position_mm[at(v[(e + 1) % 3])] - surface.position_mm[at(v[e])]).norm());
    }
    return longest > 0.0 ? 2.0 * area_mm2(surface.position_mm, v) / longest : 0.0;
}

}  // namespace

Surface frozen_wall(const LabelledMesh& part, const std::vector<char>& kept) {
    const auto neighbours = face_neighbours(part.soup.faces);
    const LabelledMesh wall = wall_of({part.soup, part.region, part.feature, neighbours}, kept);
    const std::vector<std::array<std::int32_t, 3>> no_rims(wall.soup.faces.size(), {-1, -1, -1});
    return freeze_surface(wall.soup,
                          {.feature = wall.feature, .region = wall.region, .rim = no_rims});
}

std::vector<double> vertex_curvatures_per_mm(const Surface& surface) {
    std::vector<double> own(surface.position_mm.size(), 0.0);
    std::vector<std::vector<std::int32_t>> next(own.size());
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t v = at(surface.face[f][c]);
            own[v] = std::max(
                own[v], largest_curvature(surface.shape_operator_per_mm[at(surface.corner[f][c])]));
            next[v].push_back(surface.face[f][(c + 1) % 3]);
        }
    }
    std::vector<double> median(own.size());
    std::vector<double> around;
    for (std::size_t v = 0; v < own.size(); ++v) {
        around.assign(1, own[v]);
        for (const std::int32_t w : next[v]) {
            around.push_back(own[at(w)]);
        }
        const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
        std::nth_element(around.begin(), middle, around.end());
        median[v] = *middle;
    }
    return median;
}

WallProjection::WallProjection(const Surface& surface) : surface_(surface), shape_(surface) {
    std::map<std::int32_t, TriangleSoup> soups;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        TriangleSoup& soup = soups[surface.region[f]];
        std::array<std::int32_t, 3> face{};
        for (std::size_t c = 0; c < 3; ++c) {
            face[c] = static_cast<std::int32_t>(soup.points_mm.size());
            soup.points_mm.push_back(surface.position_mm[at(surface.face[f][c])]);
        }
        soup.faces.push_back(face);
        part_[surface.region[f]].face.push_back(static_cast<std::int32_t>(f));
    }
    for (const auto& [region, soup] : soups) {
        part_[region].query = std::make_unique<RayQuery>(std::span(&soup, 1));
    }
    reach_mm_ = diagonal_mm(surface.position_mm);
}

WallProjection::Foot WallProjection::nearest(const Vector3d& point, std::int32_t region) const {
    const Part& part = part_.at(region);
    const ClosestPoint closest = part.query->closest(point, reach_mm_);
    Foot foot;
    foot.face = part.face[at(std::max(closest.face, 0))];
    foot.bary = closest.bary;
    foot.position_mm = closest.position_mm;
    const Vector3d lifted = shape_.point_at(foot.face, Vector2d(foot.bary[1], foot.bary[2]));
    if ((lifted - foot.position_mm).norm() <= kMaxLift * height_mm(surface_, foot.face)) {
        foot.position_mm = lifted;
    }
    return foot;
}

WallLine::WallLine(std::vector<Step> steps) : steps_(std::move(steps)), begin_mm_{0.0} {
    for (const Step& step : steps_) {
        begin_mm_.push_back(begin_mm_.back() + step.length_mm);
    }
}

Vector3d WallLine::at(const SmoothShape& shape, double way_mm) const {
    const auto after = std::upper_bound(begin_mm_.begin() + 1, begin_mm_.end() - 1, way_mm);
    const auto i = static_cast<std::size_t>(after - begin_mm_.begin()) - 1;
    const Step& step = steps_[i];
    double share = step.length_mm > 0.0 ? (way_mm - begin_mm_[i]) / step.length_mm : 0.0;
    share = std::clamp(share, 0.0, 1.0);
    share = step.backward ? 1.0 - share : share;
    const auto e = static_cast<std::size_t>(step.edge);
    return shape.point_at(step.face, (1.0 - share) * SmoothShape::corner_uv(e) +
                                         share * SmoothShape::corner_uv((e + 1) % 3));
}

}  // namespace meshwind
