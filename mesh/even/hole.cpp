#include "mesh/even/hole.h"

#include <map>

#include <Eigen/Geometry>

#include "core/index.h"
#include "mesh/edge_table.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Share of a detail's outline that lies in one region of the wall: lettering across a crease stays.
constexpr double kOneRegion = 0.8;

// The wall around a detail does not turn by more than this (70 degrees) within the ball's diameter.
constexpr double kAroundCosine = 0.34;

// Faces are added around vertices where an outline touches itself so many times at most.
constexpr int kMaxMends = 4;

std::vector<BorderEdge> border_of(const StruckPart& part, const std::set<std::int32_t>& gone) {
    std::vector<BorderEdge> border;
    for (const std::int32_t f : gone) {
        for (const std::int32_t g : part.neighbours[at(f)]) {
            if (g >= 0 && gone.count(g) == 0) {
                const int edge = shared_edge(part.neighbours[at(g)], f);
                const std::array<std::int32_t, 3>& face = part.soup.faces[at(g)];
                border.push_back({g, at(face[at(edge)]), at(face[at((edge + 1) % 3)])});
            }
        }
    }
    return border;
}

bool is_standing_wall(const StruckPart& part, std::int32_t face) {
    return part.kept[at(part.region[at(face)])] != 0 && part.struck[at(face)] == 0;
}

// Adds the faces around vertices that the outline passes twice. False where that goes on, or
// the outline comes to what is no wall or struck out.
bool make_simple(const StruckPart& part, std::set<std::int32_t>& gone) {
    for (int round = 0; round <= kMaxMends; ++round) {
        std::map<std::size_t, int> passes;
        const std::vector<BorderEdge> border = border_of(part, gone);
        for (const BorderEdge& e : border) {
            if (!is_standing_wall(part, e.face)) {
                return false;
            }
            ++passes[e.from];
        }
        bool simple = true;
        for (const auto& [v, times] : passes) {
            if (times > 1) {
                simple = false;
                for (const std::int32_t f : part.around[v]) {
                    if (!is_standing_wall(part, f)) {
                        return false;
                    }
                    gone.insert(f);
                }
            }
        }
        if (simple) {
            return !border.empty();
        }
    }
    return false;
}

// The region that most of the outline lies in; none where no region has nearly all of it.
std::optional<std::int32_t> region_around(const StruckPart& part,
                                          const std::vector<BorderEdge>& border) {
    std::map<std::int32_t, double> length_mm;
    double whole = 0.0;
    for (const BorderEdge& e : border) {
        const double mm = (part.soup.points_mm[e.to] - part.soup.points_mm[e.from]).norm();
        length_mm[part.region[at(e.face)]] += mm;
        whole += mm;
    }
    for (const auto& [region, mm] : length_mm) {
        if (mm >= kOneRegion * whole) {
            return region;
        }
    }
    return std::nullopt;
}

bool is_one_loop(const std::vector<BorderEdge>& border) {
    std::map<std::size_t, std::size_t> next;
    for (const BorderEdge& e : border) {
        next[e.from] = e.to;
    }
    std::size_t steps = 1;
    const std::size_t first = next.begin()->first;
    for (std::size_t v = next.begin()->second; v != first; ++steps) {
        const auto onward = next.find(v);
        if (onward == next.end() || steps > next.size()) {
            return false;
        }
        v = onward->second;
    }
    return steps == next.size();
}

// Whether faces along the border that are so near to each other face different ways.
bool turns(const StruckPart& part, const std::vector<BorderEdge>& border, double near_mm) {
    for (std::size_t i = 0; i < border.size(); ++i) {
        const Vector3d& p = part.soup.points_mm[border[i].from];
        const Vector3d normal = face_normal(part.soup, part.soup.faces[at(border[i].face)]);
        for (std::size_t j = 0; j < i; ++j) {
            const bool near = (part.soup.points_mm[border[j].from] - p).norm() <= near_mm;
            if (near && normal.dot(face_normal(part.soup, part.soup.faces[at(border[j].face)])) <
                            kAroundCosine) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace

StruckPart unstruck(const LabelledMesh& part, const std::vector<char>& kept) {
    StruckPart result{part.soup,
                      part.region,
                      kept,
                      face_neighbours(part.soup.faces),
                      std::vector<std::vector<std::int32_t>>(part.soup.points_mm.size()),
                      std::vector<char>(part.soup.faces.size(), 0)};
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        for (const std::int32_t v : part.soup.faces[f]) {
            result.around[at(v)].push_back(static_cast<std::int32_t>(f));
        }
    }
    return result;
}

Vector3d face_normal(const TriangleSoup& soup, const std::array<std::int32_t, 3>& face) {
    const Vector3d& a = soup.points_mm[at(face[0])];
    return (soup.points_mm[at(face[1])] - a).cross(soup.points_mm[at(face[2])] - a).normalized();
}

std::optional<Hole> hole_of(const StruckPart& part, std::set<std::int32_t>& gone, double near_mm) {
    if (!make_simple(part, gone)) {
        return std::nullopt;
    }
    Hole hole;
    hole.border = border_of(part, gone);
    const std::optional<std::int32_t> region = region_around(part, hole.border);
    if (!region || !is_one_loop(hole.border) || turns(part, hole.border, near_mm)) {
        return std::nullopt;
    }
    hole.region = *region;
    return hole;
}

}  // namespace meshwind
