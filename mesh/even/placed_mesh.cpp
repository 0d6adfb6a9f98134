#include "mesh/even/placed_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Vertex = WorkMesh::Vertex;
using Edge = WorkMesh::Edge;
using Halfedge = WorkMesh::Halfedge;

// Lines while they are chained.
struct LineChains {
    const LabelledMesh& part;
    std::vector<std::int32_t> wall_face;  // per face of the part: of the frozen wall, or -1
    std::vector<char> used;               // per edge
    std::vector<CornerLine> lines = {};
    std::int32_t corners = 0;
};

// Per face of the part: its number in the frozen wall, or -1.
std::vector<std::int32_t> numbers_of_wall_faces(const WorkMesh& work) {
    std::vector<std::int32_t> numbers;
    std::int32_t count = 0;
    for (const auto face : work.mesh.faces()) {
        numbers.push_back(work.is_wall(face) ? count++ : -1);
    }
    return numbers;
}

Vertex other_end(const WorkMesh& work, Edge edge, Vertex v) {
    const Halfedge half = work.mesh.halfedge_handle(edge, 0);
    const Vertex from = work.mesh.from_vertex_handle(half);
    return from == v ? work.mesh.to_vertex_handle(half) : from;
}

// Whether a line goes straight on through the vertex, more or less.
bool is_corner(const WorkMesh& work, Vertex v) {
    int count = 0;
    double product = 0.0;
    Vector3d last = Vector3d::Zero();
    for (const Edge edge : work.mesh.ve_range(v)) {
        if (work.is_line(edge)) {
            const Vector3d way = (work.at(other_end(work, edge, v)) - work.at(v)).normalized();
            product = last.dot(way);
            last = way;
            ++count;
        }
    }
    return count != 2 || !(-product >= std::cos(kLineCornerRad));
}

// The edge as one of the frozen wall, run from `from`. \pre nothing is changed yet
WallLine::Step step_of(const WorkMesh& work, const LineChains& chains, Edge edge, Vertex from) {
    for (const unsigned side : {0U, 1U}) {
        const Halfedge half = work.mesh.halfedge_handle(edge, side);
        const auto face = work.mesh.face_handle(half);
        if (!work.is_wall(face)) {
            continue;
        }
        const auto& corners = chains.part.soup.faces[at(face.idx())];
        const auto start =
            std::find(corners.begin(), corners.end(), work.mesh.from_vertex_handle(half).idx());
        const auto e = static_cast<std::int32_t>(start - corners.begin());
        return {chains.wall_face[at(face.idx())], e, work.mesh.from_vertex_handle(half) != from,
                work.length(edge)};
    }
    return {};
}

// Numbered when first asked for.
std::int32_t corner_number(VertexPlace& place, LineChains& chains) {
    place.kind = VertexPlace::Kind::Fixed;
    if (place.corner < 0) {
        place.corner = chains.corners++;
    }
    return place.corner;
}

void add_line(PlacedMesh& placed, LineChains& chains, const std::vector<Vertex>& vertices,
              const std::vector<Edge>& edges) {
    const auto id = static_cast<std::int32_t>(chains.lines.size());
    std::vector<WallLine::Step> steps;
    double way = 0.0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        placed.work.label(edges[i]).line = id;
        steps.push_back(step_of(placed.work, chains, edges[i], vertices[i]));
        way += steps.back().length_mm;
        if (i + 1 < edges.size()) {
            placed.place(vertices[i + 1]).line = id;
            placed.place(vertices[i + 1]).way_mm = way;
        }
    }
    chains.lines.push_back({WallLine(std::move(steps)),
                            {corner_number(placed.place(vertices.front()), chains),
                             corner_number(placed.place(vertices.back()), chains)}});
}

// From a corner to the next one. Where that is the same one, the vertex in the middle becomes a
// corner as well.
void chain_from(PlacedMesh& placed, LineChains& chains, Vertex start, Edge first) {
    std::vector<Vertex> vertices{start};
    std::vector<Edge> edges;
    for (Edge edge = first; edge.is_valid();) {
        chains.used[at(edge.idx())] = 1;
        edges.push_back(edge);
        vertices.push_back(other_end(placed.work, edge, vertices.back()));
        edge = Edge();
        if (placed.place(vertices.back()).kind == VertexPlace::Kind::OnLine) {
            for (const Edge around : placed.work.mesh.ve_range(vertices.back())) {
                if (placed.work.is_line(around) && chains.used[at(around.idx())] == 0) {
                    edge = around;
                }
            }
        }
    }
    const std::size_t middle = edges.size() / 2;
    if (vertices.front() == vertices.back() && middle > 0) {
        add_line(placed, chains,
                 {vertices.begin(), vertices.begin() + static_cast<long>(middle) + 1},
                 {edges.begin(), edges.begin() + static_cast<long>(middle)});
        add_line(placed, chains, {vertices.begin() + static_cast<long>(middle), vertices.end()},
                 {edges.begin() + static_cast<long>(middle), edges.end()});
    } else {
        add_line(placed, chains, vertices, edges);
    }
}

// A vertex of no line is inside, one that a line goes on through is on it, others are fixed.
void place_vertices(PlacedMesh& placed) {
    for (const Vertex v : placed.work.mesh.vertices()) {
        const int count = placed.work.lines_at(v);
        if (placed.work.region_at(v) < 0) {
            placed.place(v).kind = VertexPlace::Kind::Fixed;
        } else if (count == 0) {
            placed.place(v).kind = VertexPlace::Kind::Inside;
        } else {
            placed.place(v).kind =
                is_corner(placed.work, v) ? VertexPlace::Kind::Fixed : VertexPlace::Kind::OnLine;
        }
    }
}

// Chains the lines of a part whose vertices have their kinds; closed lines get corners.
std::vector<CornerLine> chained_lines(const LabelledMesh& part, PlacedMesh& placed) {
    LineChains chains{part, numbers_of_wall_faces(placed.work),
                      std::vector<char>(placed.work.mesh.n_edges(), 0)};
    for (const Vertex v : placed.work.mesh.vertices()) {
        if (placed.place(v).kind == VertexPlace::Kind::Fixed) {
            for (const Edge first : placed.work.mesh.ve_range(v)) {
                if (placed.work.is_line(first) && chains.used[at(first.idx())] == 0) {
                    chain_from(placed, chains, v, first);
                }
            }
        }
    }
    for (const Edge edge : placed.work.mesh.edges()) {  // what is left closes without a corner
        if (placed.work.is_line(edge) && chains.used[at(edge.idx())] == 0) {
            const Vertex start =
                placed.work.mesh.from_vertex_handle(placed.work.mesh.halfedge_handle(edge, 0));
            placed.place(start).kind = VertexPlace::Kind::Fixed;
            chain_from(placed, chains, start, edge);
        }
    }
    return std::move(chains.lines);
}

}  // namespace

PlacedMesh::PlacedMesh(const LabelledMesh& part, const std::vector<char>& kept) : work(part, kept) {
    work.mesh.add_property(place_);
    place_vertices(*this);
    lines_ = chained_lines(part, *this);
}

const WallLine& PlacedMesh::curve(std::int32_t line) const {
    return lines_[at(line)].curve;
}

std::array<double, 2> PlacedMesh::ways_of(Edge edge) const {
    const Halfedge half = work.mesh.halfedge_handle(edge, 0);
    const VertexPlace& a = place(work.mesh.from_vertex_handle(half));
    const VertexPlace& b = place(work.mesh.to_vertex_handle(half));
    const CornerLine& on = lines_[at(work.label(edge).line)];
    const auto way = [&](const VertexPlace& p) {
        if (p.kind == VertexPlace::Kind::OnLine) {
            return p.way_mm;
        }
        return p.corner == on.corner[0] ? 0.0 : on.curve.length_mm();
    };
    return {way(a), way(b)};
}

}  // namespace meshwind
