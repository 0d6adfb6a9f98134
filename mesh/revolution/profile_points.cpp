#include "mesh/revolution/profile_points.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/segment/spindle_axis.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d in_half_plane(const Vector3d& p) {
    return {p.head<2>().norm(), p.z()};
}

struct Edge {
    std::int32_t to;
    double way_mm;     // in the half plane
    double length_mm;  // in space
};

std::vector<std::vector<Edge>> edges_of(const Surface& surface) {
    std::vector<std::vector<Edge>> edges(surface.position_mm.size());
    const auto add = [&](std::int32_t from, std::int32_t to) {
        const Vector3d& a = surface.position_mm[at(from)];
        const Vector3d& b = surface.position_mm[at(to)];
        edges[at(from)].push_back(
            {to, (in_half_plane(b) - in_half_plane(a)).norm(), (b - a).norm()});
    };
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = surface.neighbour[f][e];
            if (g == kNoFace || static_cast<std::size_t>(g) > f) {
                add(surface.face[f][e], surface.face[f][(e + 1) % 3]);
                add(surface.face[f][(e + 1) % 3], surface.face[f][e]);
            }
        }
    }
    return edges;
}

// What the two ends may be, and where the way along the meridian starts.
struct EndPlace {
    MeridianEnd end;
    Vector2d at_mm = Vector2d::Zero();
    std::vector<std::int32_t> vertices;  // of the rim, or the one nearest to the pole
};

EndPlace rim_end(const Surface& surface, const Rim& rim) {
    EndPlace place{{MeridianEnd::Kind::Rim, rim.id}, Vector2d::Zero(), rim.vertices};
    for (const std::int32_t v : rim.vertices) {
        place.at_mm += in_half_plane(surface.position_mm[at(v)]);
    }
    place.at_mm /= static_cast<double>(rim.vertices.size());
    return place;
}

// Where the axis goes through the surface; hits within an edge of each other are one.
std::vector<EndPlace> pole_ends(const Surface& surface) {
    constexpr double kOnEdge = 1e-6;  // of the doubled area: the axis meets a vertex of many faces
    std::vector<EndPlace> poles;
    for (const auto& face : surface.face) {
        std::array<Vector3d, 3> p;
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = surface.position_mm[at(face[i])];
        }
        const auto cross = [](const Vector3d& a, const Vector3d& b) {
            return a.x() * b.y() - a.y() * b.x();
        };
        const double all = cross(p[0], p[1]) + cross(p[1], p[2]) + cross(p[2], p[0]);
        const double slack = -kOnEdge * std::abs(all);
        const double sign = all < 0.0 ? -1.0 : 1.0;
        if (all == 0.0 || sign * cross(p[0], p[1]) < slack || sign * cross(p[1], p[2]) < slack ||
            sign * cross(p[2], p[0]) < slack) {
            continue;
        }
        const double z = (cross(p[1], p[2]) * p[0].z() + cross(p[2], p[0]) * p[1].z() +
                          cross(p[0], p[1]) * p[2].z()) /
                         all;
        const auto nearest =
            *std::min_element(face.begin(), face.end(), [&](std::int32_t a, std::int32_t b) {
                return surface.position_mm[at(a)].head<2>().norm() <
                       surface.position_mm[at(b)].head<2>().norm();
            });
        const bool known = std::any_of(poles.begin(), poles.end(), [&](const EndPlace& pole) {
            return std::abs(pole.at_mm.y() - z) < surface.mean_edge_mm;
        });
        if (!known) {
            poles.push_back({{MeridianEnd::Kind::Pole, -1}, Vector2d(0.0, z), {nearest}});
        }
    }
    return poles;
}

// Whether open edges lie beside the rims: a hole in the wall.
bool has_hole(const Surface& surface) {
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (surface.neighbour[f][e] == kNoFace && surface.rim[f][e] < 0) {
                return true;
            }
        }
    }
    return false;
}

std::string rims_off_axis(std::span<const Rim> rims) {
    for (const Rim& rim : rims) {
        const std::string name = "rim " + std::to_string(rim.id);
        if (rim.axis.head<2>().norm() > kCoaxialSine) {
            return name + " is not square to the spindle: its axis leans by " +
                   fixed(deg_from_rad(std::asin(std::min(1.0, rim.axis.head<2>().norm()))), 1) +
                   " deg";
        }
        const double off = rim.centre_mm.head<2>().norm();
        if (off > kRevolutionShare * rim.radius_mm) {
            return name + " is not about the spindle: its centre lies " + fixed(off, 2) +
                   " mm off the axis";
        }
    }
    return {};
}

// How the normals lie about the axis.
struct NormalFacts {
    double miss_mm = 0.0;         // rms distance from the axis
    double mean_radius_mm = 0.0;  // of the surface
};

NormalFacts normal_facts(const Surface& surface) {
    NormalFacts facts;
    double area = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        std::array<Vector3d, 3> p;
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = surface.position_mm[at(surface.face[f][i])];
        }
        const double third = (p[1] - p[0]).cross(p[2] - p[0]).norm() / 6.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector3d& n = surface.normal[at(surface.corner[f][i])];
            const double miss = p[i].x() * n.y() - p[i].y() * n.x();
            facts.miss_mm += third * miss * miss;
            facts.mean_radius_mm += third * p[i].head<2>().norm();
            area += third;
        }
    }
    facts.miss_mm = std::sqrt(facts.miss_mm / area);
    facts.mean_radius_mm /= area;
    return facts;
}

std::vector<double> arcs_from(const EndPlace& start, const std::vector<std::vector<Edge>>& edges,
                              const Surface& surface) {
    using Entry = std::pair<double, std::int32_t>;
    std::vector<double> arc(edges.size(), std::numeric_limits<double>::infinity());
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const std::int32_t v : start.vertices) {
        const Vector2d p = in_half_plane(surface.position_mm[at(v)]);
        arc[at(v)] = start.end.kind == MeridianEnd::Kind::Pole ? p.x() : 0.0;
        queue.emplace(arc[at(v)], v);
    }
    while (!queue.empty()) {
        const auto [reached, v] = queue.top();
        queue.pop();
        if (reached > arc[at(v)]) {
            continue;
        }
        for (const Edge& edge : edges[at(v)]) {
            if (reached + edge.way_mm < arc[at(edge.to)]) {
                arc[at(edge.to)] = reached + edge.way_mm;
                queue.emplace(arc[at(edge.to)], edge.to);
            }
        }
    }
    return arc;
}

// Sum over the surface of how far outside lies on the right of growing arc.
double outside_on_right(const Surface& surface, const std::vector<double>& arc) {
    double sum = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t from = surface.face[f][e];
            const std::int32_t to = surface.face[f][(e + 1) % 3];
            const Vector3d& p = surface.position_mm[at(from)];
            Vector2d way = in_half_plane(surface.position_mm[at(to)]) - in_half_plane(p);
            way *= arc[at(to)] < arc[at(from)] ? -1.0 : 1.0;
            const Vector3d& n = surface.normal[at(surface.corner[f][e])];
            const double radius = p.head<2>().norm();
            const double outward = radius > 0.0 ? p.head<2>().dot(n.head<2>()) / radius : 0.0;
            sum += outward * way.y() - n.z() * way.x();
        }
    }
    return sum;
}

struct FeatureEdge {
    double arc_mm;
    double turn_rad;
    std::array<std::int32_t, 2> vertex;
};

// Feature edges about the axis; the length of the others goes to `along_mm`.
std::vector<FeatureEdge> feature_edges_about(const Surface& surface, const std::vector<double>& arc,
                                             double& along_mm) {
    std::vector<FeatureEdge> about;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (surface.feature[f][e] == 0 ||
                surface.neighbour[f][e] < static_cast<std::int32_t>(f)) {
                continue;
            }
            const std::int32_t a = surface.face[f][e];
            const std::int32_t b = surface.face[f][(e + 1) % 3];
            const Vector3d& p = surface.position_mm[at(a)];
            const Vector3d& q = surface.position_mm[at(b)];
            const double way = (in_half_plane(q) - in_half_plane(p)).norm();
            if (way > 0.5 * (q - p).norm()) {
                along_mm += way;
                continue;
            }
            const double turn =
                std::atan2(p.x() * q.y() - p.y() * q.x(), p.head<2>().dot(q.head<2>()));
            about.push_back({0.5 * (arc[at(a)] + arc[at(b)]), std::abs(turn), {a, b}});
        }
    }
    std::sort(about.begin(), about.end(),
              [](const FeatureEdge& a, const FeatureEdge& b) { return a.arc_mm < b.arc_mm; });
    return about;
}

std::vector<ProfileCrease> creases_of(const Surface& surface, const std::vector<double>& arc,
                                      const std::vector<FeatureEdge>& edges) {
    constexpr double kApart = 0.25;      // of an edge: farther along the meridian is another circle
    constexpr double kMaxOfTurn = 0.75;  // of a circle that there must be: the rest was too flat
    std::vector<ProfileCrease> creases;
    for (std::size_t first = 0; first < edges.size();) {
        std::size_t last = first;
        double turn = 0.0;
        ProfileCrease crease{Vector2d::Zero(), edges[first].arc_mm, edges[first].arc_mm};
        for (; last < edges.size() &&
               edges[last].arc_mm - edges[first].arc_mm <= kApart * surface.mean_edge_mm;
             ++last) {
            turn += edges[last].turn_rad;
            for (const std::int32_t v : edges[last].vertex) {
                crease.at_mm += in_half_plane(surface.position_mm[at(v)]);
                crease.low_mm = std::min(crease.low_mm, arc[at(v)]);
                crease.high_mm = std::max(crease.high_mm, arc[at(v)]);
            }
        }
        if (turn > kMaxOfTurn * 2.0 * kPi) {
            crease.at_mm /= 2.0 * static_cast<double>(last - first);
            creases.push_back(crease);
        }
        first = last;
    }
    return creases;
}

double second_shortest(const std::vector<Edge>& edges) {
    double shortest = std::numeric_limits<double>::infinity();
    double second = shortest;
    for (const Edge& edge : edges) {
        if (edge.length_mm < shortest) {
            second = shortest;
            shortest = edge.length_mm;
        } else {
            second = std::min(second, edge.length_mm);
        }
    }
    return second;
}

std::string refuse_ends(const Surface& surface, std::span<const Rim> rims, std::size_t poles) {
    if (rims.size() > 2) {
        return "it has " + std::to_string(rims.size()) +
               " rims, a body of revolution has two at most";
    }
    if (has_hole(surface)) {
        return "its wall has a hole";
    }
    if (std::string off = rims_off_axis(rims); !off.empty()) {
        return off;
    }
    if (rims.size() + poles != 2) {
        return "it has " + std::to_string(rims.size()) +
               " rims and the spindle goes through its wall " + std::to_string(poles) +
               " times: that does not make two ends";
    }
    return {};
}

std::string refuse_normals(const Surface& surface) {
    const NormalFacts facts = normal_facts(surface);
    if (facts.miss_mm > kRevolutionShare * facts.mean_radius_mm) {
        return "its normals pass the spindle at " + fixed(facts.miss_mm, 2) + " mm (rms), " +
               fixed(100.0 * facts.miss_mm / facts.mean_radius_mm, 1) + " % of the mean radius";
    }
    return {};
}

}  // namespace

ProfilePoints profile_points(const Surface& surface, std::span<const Rim> rims) {
    ProfilePoints result;
    std::vector<EndPlace> ends = pole_ends(surface);
    result.why_not = refuse_ends(surface, rims, ends.size());
    if (!result.why_not.empty()) {
        return result;
    }
    for (const Rim& rim : rims) {
        ends.push_back(rim_end(surface, rim));
    }
    std::sort(ends.begin(), ends.end(),
              [](const EndPlace& a, const EndPlace& b) { return a.at_mm.y() < b.at_mm.y(); });
    const auto edges = edges_of(surface);
    std::vector<double> arc = arcs_from(ends[0], edges, surface);
    if (outside_on_right(surface, arc) < 0.0) {
        std::swap(ends[0], ends[1]);
        arc = arcs_from(ends[0], edges, surface);
    }
    if (*std::max_element(arc.begin(), arc.end()) == std::numeric_limits<double>::infinity()) {
        result.why_not = "it consists of several pieces";
        return result;
    }
    double along = 0.0;
    result.creases = creases_of(surface, arc, feature_edges_about(surface, arc, along));
    constexpr double kAlongShare = 0.25;  // of the meridian: stray edges of slivers are shorter
    const double length = *std::max_element(arc.begin(), arc.end());
    if (along > kAlongShare * length) {
        result.why_not = "it has creases along the spindle, " + fixed(along, 1) + " mm together";
        return result;
    }
    result.why_not = refuse_normals(surface);
    if (!result.why_not.empty()) {
        return result;
    }
    for (std::size_t v = 0; v < arc.size(); ++v) {
        result.points.push_back(
            {in_half_plane(surface.position_mm[v]), arc[v], second_shortest(edges[v])});
    }
    std::sort(result.points.begin(), result.points.end(),
              [](const ProfilePoint& a, const ProfilePoint& b) { return a.arc_mm < b.arc_mm; });
    for (std::size_t i = 0; i < 2; ++i) {
        result.end[i] = ends[i].end;
        result.end_mm[i] = ends[i].at_mm;
    }
    return result;
}

}  // namespace meshwind
