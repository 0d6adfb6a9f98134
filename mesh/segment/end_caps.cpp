#include "mesh/segment/end_caps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/index.h"

namespace meshwind {
namespace {

// An end face: most of its area in one plane, by distance (of its size) and by normal (8 deg). The
// rest may be rounded or notched, but faces the same way on the whole; a dome does neither.
constexpr double kPlanarAreaShare = 0.5;
constexpr double kSameWayShare = 0.93;  // |mean normal|
constexpr double kPlaneShare = 2e-3;
constexpr double kPlaneCosine = 0.99;
constexpr double kConvexShare = 0.9;  // of an end cap's boundary length; notches are concave

// End caps against other plateaus such as the tops of letters, by radius relative to the largest
// end, which may be open.
constexpr double kCapRadiusShare = 0.25;

// Share of the part's area that an end's outline encloses at least: that of a pipe 5000 radii long.
// What is smaller is a sliver.
constexpr double kCapAreaShare = 1e-4;

// The end of an angular leg against pads on a wall, by area relative to the smallest end cap.
constexpr double kAngularShare = 0.5;

// A plateau without a hole encloses no more than its own area.
constexpr double kDisc = 1.01;

// Area of the faces in the plane through the region's median height along its mean normal.
double planar_area(const TriangleSoup& soup, const std::vector<Eigen::Vector3d>& normals,
                   const std::vector<double>& face_area, const RegionFacts& r) {
    const Eigen::Vector3d normal = r.area_normal.normalized();
    if (r.area_normal.norm() < 0.5 * r.area_mm2) {
        return 0.0;
    }
    std::vector<std::pair<double, std::int32_t>> heights;
    for (const std::int32_t f : r.faces) {
        const auto& [a, b, c] = soup.faces[at(f)];
        heights.emplace_back(
            normal.dot(soup.points_mm[at(a)] + soup.points_mm[at(b)] + soup.points_mm[at(c)]) / 3.0,
            f);
    }
    std::sort(heights.begin(), heights.end());
    double below = 0.0;
    double median = heights.back().first;
    for (const auto& [height, f] : heights) {
        below += face_area[at(f)];
        if (2.0 * below >= r.area_mm2) {
            median = height;
            break;
        }
    }
    const double tolerance = kPlaneShare * r.box.diagonal().norm();
    double planar = 0.0;
    for (const auto& [height, f] : heights) {
        const bool inside =
            std::abs(height - median) <= tolerance && normals[at(f)].dot(normal) >= kPlaneCosine;
        planar += inside ? face_area[at(f)] : 0.0;
    }
    return planar;
}

// Edges by the vertex they begin at.
struct Step {
    std::int32_t to = 0;
    std::int32_t beyond = 0;  // region across the edge, -1: none
};
using Steps = std::map<std::int32_t, Step>;

struct Loop {
    Eigen::Vector3d area_mm2 = Eigen::Vector3d::Zero();  // along the normal it turns left about
    std::vector<std::int32_t> beyond;
};

// Takes the loop of the first edge out. \pre there is one
Loop take_loop(const TriangleSoup& soup, Steps& steps) {
    Loop loop;
    const Eigen::Vector3d origin = soup.points_mm[at(steps.begin()->first)];
    for (auto step = steps.begin(); step != steps.end();) {
        const std::int32_t onward = step->second.to;
        loop.area_mm2 +=
            0.5 *
            (soup.points_mm[at(step->first)] - origin).cross(soup.points_mm[at(onward)] - origin);
        loop.beyond.push_back(step->second.beyond);
        steps.erase(step);
        step = steps.find(onward);
    }
    return loop;
}

// The largest area that an open border of the part encloses.
double largest_opening_mm2(const TriangleSoup& soup, const Segmentation& s) {
    Steps steps;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (s.neighbours[f][e] < 0) {
                steps.emplace(soup.faces[f][e], Step{soup.faces[f][(e + 1) % 3], -1});
            }
        }
    }
    double largest = 0.0;
    while (!steps.empty()) {
        largest = std::max(largest, take_loop(soup, steps).area_mm2.norm());
    }
    return largest;
}

bool is_plateau(const RegionFacts& r) {
    return !r.open && r.boundary_mm > 0.0 && r.convex_mm >= kConvexShare * r.boundary_mm &&
           r.area_normal.norm() >= kSameWayShare * r.area_mm2 &&
           r.planar_mm2 >= kPlanarAreaShare * r.area_mm2;
}

}  // namespace

std::vector<RegionFacts> region_facts(const TriangleSoup& soup, const Segmentation& s,
                                      const std::vector<Eigen::Vector3d>& normals,
                                      const std::vector<double>& face_area) {
    const std::int32_t count = *std::max_element(s.region.begin(), s.region.end()) + 1;
    std::vector<RegionFacts> facts(at(count));
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        RegionFacts& r = facts[at(s.region[f])];
        r.faces.push_back(static_cast<std::int32_t>(f));
        r.area_mm2 += face_area[f];
        r.area_normal += face_area[f] * normals[f];
        for (std::size_t e = 0; e < 3; ++e) {
            const Eigen::Vector3d& from = soup.points_mm[at(soup.faces[f][e])];
            const Eigen::Vector3d along = soup.points_mm[at(soup.faces[f][(e + 1) % 3])] - from;
            const std::int32_t g = s.neighbours[f][e];
            r.box.extend(from);
            if (g < 0) {
                r.open = true;
            } else if (s.region[at(g)] != s.region[f]) {
                r.boundary_mm += along.norm();
                r.convex_mm +=
                    normals[f].cross(normals[at(g)]).dot(along) > 0.0 ? along.norm() : 0.0;
                r.beside.push_back(s.region[at(g)]);
            }
        }
    }
    for (std::size_t id = 0; id < facts.size(); ++id) {
        RegionFacts& r = facts[id];
        std::sort(r.beside.begin(), r.beside.end());
        r.beside.erase(std::unique(r.beside.begin(), r.beside.end()), r.beside.end());
        r.planar_mm2 = planar_area(soup, normals, face_area, r);
    }
    return facts;
}

void trace_outline(const TriangleSoup& soup, const Segmentation& s, std::int32_t id,
                   RegionFacts& facts) {
    Steps steps;
    for (const std::int32_t f : facts.faces) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = s.neighbours[at(f)][e];
            if (g >= 0 && s.region[at(g)] != id) {
                steps.emplace(soup.faces[at(f)][e],
                              Step{soup.faces[at(f)][(e + 1) % 3], s.region[at(g)]});
            }
        }
    }
    const Eigen::Vector3d normal = facts.area_normal.normalized();
    while (!steps.empty()) {
        const Loop loop = take_loop(soup, steps);
        const double enclosed = normal.dot(loop.area_mm2);
        auto& side = enclosed > 0.0 ? facts.beyond_outline : facts.in_holes;
        side.insert(side.end(), loop.beyond.begin(), loop.beyond.end());
        facts.outline_mm2 = std::max(facts.outline_mm2, enclosed);
    }
}

void mark_end_caps(const TriangleSoup& soup, const std::vector<std::int32_t>& flat_end,
                   Segmentation& s, std::vector<RegionFacts>& facts) {
    const auto is_flat_end = [&](const RegionFacts& r) {
        return flat_end[at(r.faces.front())] >= 0;
    };
    std::vector<char> plateau(facts.size(), 0);
    double least = 0.0;
    double largest = largest_opening_mm2(soup, s);
    for (const RegionFacts& r : facts) {
        least += kCapAreaShare * r.area_mm2;
    }
    for (std::size_t id = 0; id < facts.size(); ++id) {
        if (is_plateau(facts[id]) || is_flat_end(facts[id])) {
            plateau[id] = 1;
            trace_outline(soup, s, static_cast<std::int32_t>(id), facts[id]);
        }
    }
    std::vector<char> cap(facts.size(), 0);
    for (std::size_t id = 0; id < facts.size(); ++id) {
        const bool disc = facts[id].outline_mm2 < kDisc * facts[id].area_mm2;
        const bool flat_of_box =
            disc &&
            std::any_of(facts[id].beside.begin(), facts[id].beside.end(), [&](std::int32_t other) {
                return plateau[at(other)] != 0 &&
                       facts[at(other)].area_mm2 > 0.1 * facts[id].area_mm2;
            });
        cap[id] = static_cast<char>(plateau[id] != 0 && (!flat_of_box || is_flat_end(facts[id])));
        largest = std::max(largest, cap[id] != 0 ? facts[id].outline_mm2 : 0.0);
    }
    least = std::max(least, kCapRadiusShare * kCapRadiusShare * largest);
    for (std::size_t id = 0; id < facts.size(); ++id) {
        if (cap[id] != 0 && facts[id].outline_mm2 >= least) {
            s.regions[id].kind = RegionKind::EndCap;
        }
    }
}

std::vector<std::int32_t> angular_ends(const TriangleSoup& soup, const Segmentation& s,
                                       std::vector<RegionFacts> facts) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Region& region : s.regions) {
        if (region.kind == RegionKind::EndCap) {
            smallest = std::min(smallest, facts[at(region.id)].outline_mm2);
        }
    }
    std::vector<std::int32_t> ends;
    for (const Region& region : s.regions) {
        RegionFacts& r = facts[at(region.id)];
        if (!region.kept || !(r.area_mm2 >= kAngularShare * smallest) || !is_plateau(r) ||
            !std::all_of(r.beside.begin(), r.beside.end(),
                         [&](std::int32_t other) { return is_plateau(facts[at(other)]); })) {
            continue;
        }
        trace_outline(soup, s, region.id, r);
        if (r.outline_mm2 < kDisc * r.area_mm2) {
            ends.push_back(region.id);
        }
    }
    return ends;
}

}  // namespace meshwind
