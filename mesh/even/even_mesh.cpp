#include "mesh/even/even_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "core/index.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "mesh/even/placed_mesh.h"
#include "mesh/even/wall_surface.h"
#include "mesh/even/work_mesh.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Vertex = WorkMesh::Vertex;
using Edge = WorkMesh::Edge;
using Halfedge = WorkMesh::Halfedge;

// Edges are split above and collapsed below these shares of the wanted length: half of the longest
// that stays is no shorter than the shortest that stays.
constexpr double kLong = 4.0 / 3.0;
constexpr double kShort = 4.0 / 5.0;

// Triangles after a change do not turn away from those before it by more than 60 degrees.
constexpr double kTurnCosine = 0.5;

// Angles closer than this count as equal, so that symmetric pairs do not flip for rounding.
constexpr double kCosineGain = 1e-6;

// Area of an equilateral triangle in squares of its edge.
constexpr double kEquilateral = 0.433;

// More faces than so many times what is wanted: the sweeps do not settle.
constexpr double kMaxGrowth = 3.0;
constexpr double kMaxGrowthFaces = 1000.0;

constexpr std::size_t kProjectChunk = 256;

// Wanted edge length per vertex of the surface: by curvature, growing slowly from short to long.
std::vector<double> sizes_of(const Surface& surface, const EvenMeshOptions& options) {
    const std::vector<double> curvature = vertex_curvatures_per_mm(surface);
    std::vector<double> size(curvature.size());
    for (std::size_t v = 0; v < size.size(); ++v) {
        const double k = std::max(curvature[v], 1e-12);
        const double least =
            std::max(options.shortest_mm, std::min(options.least_mm, options.most_turn / k));
        size[v] = std::clamp(options.turn_rad / k, std::min(least, options.longest_mm),
                             options.longest_mm);
        if (!options.most_mm.empty()) {
            size[v] = std::min(size[v], options.most_mm[v]);
        }
    }
    using Entry = std::pair<double, std::int32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<std::vector<std::int32_t>> next(size.size());
    for (const auto& face : surface.face) {
        for (std::size_t e = 0; e < 3; ++e) {
            next[at(face[e])].push_back(face[(e + 1) % 3]);
            next[at(face[e])].push_back(face[(e + 2) % 3]);
        }
    }
    for (std::size_t v = 0; v < size.size(); ++v) {
        queue.emplace(size[v], static_cast<std::int32_t>(v));
    }
    while (!queue.empty()) {
        const auto [reached, v] = queue.top();
        queue.pop();
        if (reached > size[at(v)]) {
            continue;
        }
        for (const std::int32_t w : next[at(v)]) {
            const double way = (surface.position_mm[at(w)] - surface.position_mm[at(v)]).norm();
            const double allowed = reached + options.grading * way;
            if (allowed < size[at(w)]) {
                size[at(w)] = allowed;
                queue.emplace(allowed, w);
            }
        }
    }
    return size;
}

double triangles_of(const Surface& surface, const std::vector<double>& size_mm) {
    double count = 0.0;
    for (const auto& v : surface.face) {
        const double size = (size_mm[at(v[0])] + size_mm[at(v[1])] + size_mm[at(v[2])]) / 3.0;
        count += area_mm2(surface.position_mm, v) / (kEquilateral * size * size);
    }
    return count;
}

// The wall that vertices are put on, and the lengths wanted of edges there.
struct Target {
    const Surface& surface;
    const WallProjection& projection;    // on it
    const std::vector<double>& size_mm;  // per vertex of it
};

double size_at(const Target& target, const WallProjection::Foot& foot) {
    double size = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        size += foot.bary[static_cast<Eigen::Index>(c)] *
                target.size_mm[at(target.surface.face[at(foot.face)][c])];
    }
    return size;
}

void set_wanted_sizes(const Target& target, PlacedMesh& placed) {
    for (const Vertex v : placed.work.mesh.vertices()) {
        const std::int32_t region = placed.work.region_at(v);
        if (region >= 0) {
            placed.place(v).size_mm =
                size_at(target, target.projection.nearest(placed.work.at(v), region));
        }
    }
}

double wanted_mm(const PlacedMesh& placed, Edge edge) {
    const Halfedge half = placed.work.mesh.halfedge_handle(edge, 0);
    return 0.5 * (placed.place(placed.work.mesh.from_vertex_handle(half)).size_mm +
                  placed.place(placed.work.mesh.to_vertex_handle(half)).size_mm);
}

void split(const Target& target, PlacedMesh& placed, Edge edge) {
    const Halfedge half = placed.work.mesh.halfedge_handle(edge, 0);
    const Vector3d chord = 0.5 * (placed.work.at(placed.work.mesh.from_vertex_handle(half)) +
                                  placed.work.at(placed.work.mesh.to_vertex_handle(half)));
    VertexPlace middle;
    Vector3d position = chord;
    const std::int32_t line = placed.work.label(edge).line;
    if (line != kNoLine) {
        const auto [from, to] = placed.ways_of(edge);
        middle.kind = VertexPlace::Kind::OnLine;
        middle.line = line;
        middle.way_mm = 0.5 * (from + to);
        position = placed.curve(line).at(target.projection.shape(), middle.way_mm);
        middle.size_mm = wanted_mm(placed, edge);
    } else {
        const auto face = placed.work.mesh.face_handle(half);
        const WallProjection::Foot foot =
            target.projection.nearest(chord, placed.work.label(face).region);
        middle.kind = VertexPlace::Kind::Inside;
        position = foot.position_mm;
        middle.size_mm = size_at(target, foot);
    }
    const Vertex v = placed.work.split(edge, position);
    placed.place(v) = middle;
}

void split_long(const Target& target, PlacedMesh& placed) {
    // Edges made by a split are at most as long again; one look per edge and sweep is enough.
    const std::size_t count = placed.work.mesh.n_edges();
    for (std::size_t i = 0; i < count; ++i) {
        const Edge edge(static_cast<int>(i));
        if (placed.work.touches_wall(edge) &&
            placed.work.length(edge) > kLong * wanted_mm(placed, edge)) {
            split(target, placed, edge);
        }
    }
}

void collapse_short(PlacedMesh& placed) {
    bool any = false;
    for (const Edge edge : placed.work.mesh.edges()) {
        if (placed.work.mesh.status(edge).deleted() || !placed.work.touches_wall(edge)) {
            continue;
        }
        const double wanted = wanted_mm(placed, edge);
        if (placed.work.length(edge) >= kShort * wanted) {
            continue;
        }
        for (const unsigned side : {0U, 1U}) {
            const Halfedge half = placed.work.mesh.halfedge_handle(edge, side);
            const VertexPlace::Kind kind =
                placed.place(placed.work.mesh.from_vertex_handle(half)).kind;
            if (kind != VertexPlace::Kind::Fixed &&
                placed.work.may_collapse(half, kTurnCosine, kLong * wanted)) {
                placed.work.collapse(half);
                any = true;
                break;
            }
        }
    }
    if (any) {
        placed.work.mesh.garbage_collection();
    }
}

// Flips make no vertex one of a line, nor the contrary.
void flip_for_valence(WorkMesh& work) {
    std::vector<int> gap(work.mesh.n_vertices());
    for (const Vertex v : work.mesh.vertices()) {
        gap[at(v.idx())] =
            static_cast<int>(work.mesh.valence(v)) - (work.mesh.is_boundary(v) ? 4 : 6);
    }
    const auto off = [&](Vertex v, int change) { return std::abs(gap[at(v.idx())] + change); };
    for (const Edge edge : work.mesh.edges()) {
        if (work.is_line(edge) || work.mesh.is_boundary(edge)) {
            continue;
        }
        const Halfedge half = work.mesh.halfedge_handle(edge, 0);
        const Vertex a = work.mesh.from_vertex_handle(half);
        const Vertex b = work.mesh.to_vertex_handle(half);
        const Vertex c = work.mesh.to_vertex_handle(work.mesh.next_halfedge_handle(half));
        const Vertex d = work.mesh.to_vertex_handle(
            work.mesh.next_halfedge_handle(work.mesh.opposite_halfedge_handle(half)));
        if (off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1) <
                off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0) &&
            work.may_flip(edge, kTurnCosine)) {
            work.mesh.flip(edge);
            --gap[at(a.idx())];
            --gap[at(b.idx())];
            ++gap[at(c.idx())];
            ++gap[at(d.idx())];
        }
    }
}

void flip_for_angle(WorkMesh& work) {
    for (const Edge edge : work.mesh.edges()) {
        if (work.is_line(edge) || work.mesh.is_boundary(edge)) {
            continue;
        }
        const auto [before, after] = work.angles(edge);
        if (after < before - kCosineGain && work.may_flip(edge, kTurnCosine)) {
            work.mesh.flip(edge);
        }
    }
}

void slide(const Target& target, PlacedMesh& placed, Vertex v) {
    double sum = 0.0;
    int count = 0;
    for (const Edge edge : placed.work.mesh.ve_range(v)) {
        if (placed.work.is_line(edge)) {
            const auto ways = placed.ways_of(edge);
            const bool first =
                placed.work.mesh.from_vertex_handle(placed.work.mesh.halfedge_handle(edge, 0)) == v;
            sum += first ? ways[1] : ways[0];
            ++count;
        }
    }
    if (count != 2) {
        return;
    }
    const double way = 0.5 * sum;
    const Vector3d position = placed.curve(placed.place(v).line).at(target.projection.shape(), way);
    if (placed.work.may_move(v, position, kTurnCosine)) {
        placed.work.move(v, position);
        placed.place(v).way_mm = way;
    }
}

// Vertices go to the middle of those next to them, along the surface or the line.
void smooth(const Target& target, PlacedMesh& placed) {
    std::vector<Vertex> inside;
    for (const Vertex v : placed.work.mesh.vertices()) {
        if (placed.place(v).kind == VertexPlace::Kind::Inside) {
            inside.push_back(v);
        } else if (placed.place(v).kind == VertexPlace::Kind::OnLine) {
            slide(target, placed, v);
        }
    }
    std::vector<WallProjection::Foot> feet(inside.size());
    parallel_for(inside.size(), kProjectChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Vector3d sum = Vector3d::Zero();
            double weight = 0.0;
            for (const Vertex near : placed.work.mesh.vv_range(inside[i])) {
                sum += placed.work.at(near);
                weight += 1.0;
            }
            feet[i] = target.projection.nearest(sum / weight, placed.work.region_at(inside[i]));
        }
    });
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (placed.work.may_move(inside[i], feet[i].position_mm, kTurnCosine)) {
            placed.work.move(inside[i], feet[i].position_mm);
            placed.place(inside[i]).size_mm = size_at(target, feet[i]);
        }
    }
}

// \param most faces; with more the sweeps do not settle
void sweep_even(const Target& target, const EvenMeshOptions& options, double most,
                PlacedMesh& placed) {
    for (int sweep = 0; sweep < options.sweeps; ++sweep) {
        check_interrupt();
        if (static_cast<double>(placed.work.mesh.n_faces()) > most) {
            break;  // patches that stand for no surface: what comes of it shows that
        }
        split_long(target, placed);
        collapse_short(placed);
        flip_for_valence(placed.work);
        smooth(target, placed);
    }
}

// Flips towards larger angles and smooths.
void polish(const Target& target, const EvenMeshOptions& options, PlacedMesh& placed) {
    for (int sweep = 0; sweep < options.polish; ++sweep) {
        check_interrupt();
        flip_for_angle(placed.work);
        smooth(target, placed);
    }
    flip_for_angle(placed.work);
}

}  // namespace

EvenMeshOptions even_options(double size_mm) {
    constexpr double kLongestEdge = 0.15;
    constexpr double kMinEdge = 0.02;
    EvenMeshOptions options;
    options.least_mm = kMinEdge * size_mm;
    options.longest_mm = kLongestEdge * size_mm;
    return options;
}

double wanted_triangles(const Surface& wall, const EvenMeshOptions& options) {
    return triangles_of(wall, sizes_of(wall, options));
}

LabelledMesh even_mesh(const LabelledMesh& part, const std::vector<char>& kept, Surface wall,
                       const EvenMeshOptions& options) {
    PlacedMesh placed(part, kept);
    const Surface surface = std::move(wall);
    const WallProjection projection(surface);
    const std::vector<double> size_mm = sizes_of(surface, options);
    const Target target{surface, projection, size_mm};
    set_wanted_sizes(target, placed);
    const double wanted =
        static_cast<double>(placed.work.mesh.n_faces()) + triangles_of(surface, size_mm);
    sweep_even(target, options, kMaxGrowth * wanted + kMaxGrowthFaces, placed);
    polish(target, options, placed);
    return placed.work.part();
}

}  // namespace meshwind
