#include "mesh/mandrel/swept_part.h"

#include <algorithm>
#include <map>
#include <span>

#include <Eigen/Geometry>

#include "mesh/revolution/swept_wall.h"

namespace meshwind {
namespace {

// The region of most of the wall in each stretch between creases.
std::vector<std::int32_t> regions_along(const LabelledMesh& wall, const Meridian& meridian,
                                        const Eigen::Isometry3d& mandrel_from_part) {
    const std::span creases = meridian.creases_mm();
    std::vector<std::map<std::int32_t, double>> area_mm2_of(creases.size() + 1);
    for (std::size_t f = 0; f < wall.soup.faces.size(); ++f) {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const std::int32_t v : wall.soup.faces[f]) {
            middle += wall.soup.points_mm[static_cast<std::size_t>(v)] / 3.0;
        }
        middle = mandrel_from_part * middle;
        const double arc = meridian.foot(middle.head<2>().norm(), middle.z()).arc_mm;
        const auto stretch =
            std::upper_bound(creases.begin(), creases.end(), arc) - creases.begin();
        area_mm2_of[static_cast<std::size_t>(stretch)][wall.region[f]] +=
            area_mm2(wall.soup.points_mm, wall.soup.faces[f]);
    }
    std::vector<std::int32_t> regions;
    std::int32_t largest = wall.region.front();
    for (const auto& areas : area_mm2_of) {
        double most = 0.0;
        for (const auto& [region, area] : areas) {
            if (area > most) {
                most = area;
                largest = region;
            }
        }
        regions.push_back(largest);  // of a stretch without a facet, that of the one before
    }
    return regions;
}

}  // namespace

std::optional<LabelledMesh> swept_part(const LabelledView& part, const std::vector<char>& kept,
                                       const Meridian& meridian,
                                       const Eigen::Isometry3d& mandrel_from_part) {
    std::vector<char> others(kept.size());
    std::transform(kept.begin(), kept.end(), others.begin(),
                   [](char keep) { return static_cast<char>(keep == 0); });
    const LabelledMesh wall = wall_of(part, kept);
    const LabelledMesh rings = swept_wall(meridian, size_mm(wall, kept));
    if (rings.soup.faces.empty()) {
        return std::nullopt;
    }
    const std::vector<std::int32_t> regions = regions_along(wall, meridian, mandrel_from_part);
    LabelledMesh made = wall_of(part, others);
    const auto first = static_cast<std::int32_t>(made.soup.points_mm.size());
    const Eigen::Isometry3d back = mandrel_from_part.inverse();
    for (const Eigen::Vector3d& p : rings.soup.points_mm) {
        made.soup.points_mm.push_back(back * p);
    }
    for (std::size_t f = 0; f < rings.soup.faces.size(); ++f) {
        const auto& [a, b, c] = rings.soup.faces[f];
        made.soup.faces.push_back({first + a, first + b, first + c});
        made.region.push_back(regions[static_cast<std::size_t>(rings.region[f])]);
        made.feature.push_back(rings.feature[f]);
    }
    return made;
}

}  // namespace meshwind
