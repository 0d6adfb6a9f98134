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
constexpr double kMostGrowth = 3.0;
constexpr double kMostGrowthFaces = 1000.0;

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

class EvenMesher {
public:
    EvenMesher(const LabelledMesh& part, const std::vector<char>& kept, Surface&& wall,
               const EvenMeshOptions& options)
        : options_(options),
          work_(part, kept),
          surface_(std::move(wall)),
          wall_(surface_),
          size_of_surface_(sizes_of(surface_, options)) {
        work_.mesh.add_property(place_);
        number_wall_faces();
        chain_lines(part);
        for (const Vertex v : work_.mesh.vertices()) {
            const std::int32_t region = work_.region_at(v);
            if (region >= 0) {
                place(v).size_mm = size_at(wall_.nearest(work_.at(v), region));
            }
        }
    }

    LabelledMesh run() {
        const double wanted =
            static_cast<double>(work_.mesh.n_faces()) + triangles_of(surface_, size_of_surface_);
        const double most = kMostGrowth * wanted + kMostGrowthFaces;
        for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
            check_interrupt();
            if (static_cast<double>(work_.mesh.n_faces()) > most) {
                break;  // patches that stand for no surface: what comes of it shows that
            }
            split_long();
            collapse_short();
            flip_for_valence();
            smooth();
        }
        for (int sweep = 0; sweep < options_.polish; ++sweep) {
            check_interrupt();
            flip_for_angle();
            smooth();
        }
        flip_for_angle();
        return work_.part();
    }

private:
    // Where a vertex may go.
    struct Place {
        enum class Kind { Inside, OnLine, Fixed };
        Kind kind = Kind::Fixed;
        std::int32_t line = kNoLine;
        std::int32_t corner = -1;  // number of a fixed place at the end of a line
        double way_mm = 0.0;       // along the line
        double size_mm = 0.0;      // wanted length of the edges here
    };
    struct Line {
        WallLine curve;
        std::array<std::int32_t, 2> corner;  // at its ends, different ones
    };

    Place& place(Vertex v) { return work_.mesh.property(place_, v); }
    [[nodiscard]] const Place& place(Vertex v) const { return work_.mesh.property(place_, v); }

    [[nodiscard]] double size_at(const WallProjection::Foot& foot) const {
        double size = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            size += foot.bary[static_cast<Eigen::Index>(c)] *
                    size_of_surface_[at(surface_.face[at(foot.face)][c])];
        }
        return size;
    }

    [[nodiscard]] double wanted_mm(Edge edge) const {
        const Halfedge half = work_.mesh.halfedge_handle(edge, 0);
        return 0.5 * (place(work_.mesh.from_vertex_handle(half)).size_mm +
                      place(work_.mesh.to_vertex_handle(half)).size_mm);
    }

    void number_wall_faces() {
        std::int32_t count = 0;
        for (const auto face : work_.mesh.faces()) {
            wall_face_.push_back(work_.is_wall(face) ? count++ : -1);
        }
    }

    // The edge as one of the frozen wall, run from `from`. \pre nothing is changed yet
    [[nodiscard]] WallLine::Step step_of(const LabelledMesh& part, Edge edge, Vertex from) const {
        for (const unsigned side : {0U, 1U}) {
            const Halfedge half = work_.mesh.halfedge_handle(edge, side);
            const auto face = work_.mesh.face_handle(half);
            if (!work_.is_wall(face)) {
                continue;
            }
            const auto& corners = part.soup.faces[at(face.idx())];
            const auto start = std::find(corners.begin(), corners.end(),
                                         work_.mesh.from_vertex_handle(half).idx());
            const auto e = static_cast<std::int32_t>(start - corners.begin());
            return {wall_face_[at(face.idx())], e, work_.mesh.from_vertex_handle(half) != from,
                    work_.length(edge)};
        }
        return {};
    }

    [[nodiscard]] Vertex other_end(Edge edge, Vertex v) const {
        const Halfedge half = work_.mesh.halfedge_handle(edge, 0);
        const Vertex from = work_.mesh.from_vertex_handle(half);
        return from == v ? work_.mesh.to_vertex_handle(half) : from;
    }

    // Whether a line goes straight on through the vertex, more or less.
    [[nodiscard]] bool is_corner(Vertex v) const {
        int count = 0;
        double product = 0.0;
        Vector3d last = Vector3d::Zero();
        for (const Edge edge : work_.mesh.ve_range(v)) {
            if (work_.is_line(edge)) {
                const Vector3d way = (work_.at(other_end(edge, v)) - work_.at(v)).normalized();
                product = last.dot(way);
                last = way;
                ++count;
            }
        }
        return count != 2 || !(-product >= std::cos(kLineCornerRad));
    }

    void chain_lines(const LabelledMesh& part) {
        for (const Vertex v : work_.mesh.vertices()) {
            const int count = work_.lines_at(v);
            if (work_.region_at(v) < 0) {
                place(v).kind = Place::Kind::Fixed;
            } else if (count == 0) {
                place(v).kind = Place::Kind::Inside;
            } else {
                place(v).kind = is_corner(v) ? Place::Kind::Fixed : Place::Kind::OnLine;
            }
        }
        std::vector<char> used(work_.mesh.n_edges(), 0);
        for (const Vertex v : work_.mesh.vertices()) {
            if (place(v).kind == Place::Kind::Fixed) {
                for (const Edge first : work_.mesh.ve_range(v)) {
                    if (work_.is_line(first) && used[at(first.idx())] == 0) {
                        chain_from(part, v, first, used);
                    }
                }
            }
        }
        for (const Edge edge : work_.mesh.edges()) {  // what is left closes without a corner
            if (work_.is_line(edge) && used[at(edge.idx())] == 0) {
                const Vertex start =
                    work_.mesh.from_vertex_handle(work_.mesh.halfedge_handle(edge, 0));
                place(start).kind = Place::Kind::Fixed;
                chain_from(part, start, edge, used);
            }
        }
    }

    std::int32_t corner_number(Vertex v) {
        Place& p = place(v);
        p.kind = Place::Kind::Fixed;
        if (p.corner < 0) {
            p.corner = corners_++;
        }
        return p.corner;
    }

    // From a corner to the next one. Where that is the same one, the vertex in the middle becomes a
    // corner as well.
    void chain_from(const LabelledMesh& part, Vertex start, Edge first, std::vector<char>& used) {
        std::vector<Vertex> vertices{start};
        std::vector<Edge> edges;
        for (Edge edge = first; edge.is_valid();) {
            used[at(edge.idx())] = 1;
            edges.push_back(edge);
            vertices.push_back(other_end(edge, vertices.back()));
            edge = Edge();
            if (place(vertices.back()).kind == Place::Kind::OnLine) {
                for (const Edge around : work_.mesh.ve_range(vertices.back())) {
                    if (work_.is_line(around) && used[at(around.idx())] == 0) {
                        edge = around;
                    }
                }
            }
        }
        const std::size_t middle = edges.size() / 2;
        if (vertices.front() == vertices.back() && middle > 0) {
            add_line(part, {vertices.begin(), vertices.begin() + static_cast<long>(middle) + 1},
                     {edges.begin(), edges.begin() + static_cast<long>(middle)});
            add_line(part, {vertices.begin() + static_cast<long>(middle), vertices.end()},
                     {edges.begin() + static_cast<long>(middle), edges.end()});
        } else {
            add_line(part, vertices, edges);
        }
    }

    void add_line(const LabelledMesh& part, const std::vector<Vertex>& vertices,
                  const std::vector<Edge>& edges) {
        const auto id = static_cast<std::int32_t>(lines_.size());
        std::vector<WallLine::Step> steps;
        double way = 0.0;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            work_.label(edges[i]).line = id;
            steps.push_back(step_of(part, edges[i], vertices[i]));
            way += steps.back().length_mm;
            if (i + 1 < edges.size()) {
                place(vertices[i + 1]).line = id;
                place(vertices[i + 1]).way_mm = way;
            }
        }
        lines_.push_back({WallLine(std::move(steps)),
                          {corner_number(vertices.front()), corner_number(vertices.back())}});
    }

    // Ways of both ends of an edge along its line.
    [[nodiscard]] std::array<double, 2> ways_of(Edge edge) const {
        const Halfedge half = work_.mesh.halfedge_handle(edge, 0);
        const Place& a = place(work_.mesh.from_vertex_handle(half));
        const Place& b = place(work_.mesh.to_vertex_handle(half));
        const Line& on = lines_[at(work_.label(edge).line)];
        const auto way = [&](const Place& p) {
            if (p.kind == Place::Kind::OnLine) {
                return p.way_mm;
            }
            return p.corner == on.corner[0] ? 0.0 : on.curve.length_mm();
        };
        return {way(a), way(b)};
    }

    void split_long() {
        // Edges made by a split are at most as long again; one look per edge and sweep is enough.
        const std::size_t count = work_.mesh.n_edges();
        for (std::size_t i = 0; i < count; ++i) {
            const Edge edge(static_cast<int>(i));
            if (work_.touches_wall(edge) && work_.length(edge) > kLong * wanted_mm(edge)) {
                split(edge);
            }
        }
    }

    void split(Edge edge) {
        const Halfedge half = work_.mesh.halfedge_handle(edge, 0);
        const Vector3d chord = 0.5 * (work_.at(work_.mesh.from_vertex_handle(half)) +
                                      work_.at(work_.mesh.to_vertex_handle(half)));
        Place middle;
        Vector3d position = chord;
        const std::int32_t line = work_.label(edge).line;
        if (line != kNoLine) {
            const auto [from, to] = ways_of(edge);
            middle.kind = Place::Kind::OnLine;
            middle.line = line;
            middle.way_mm = 0.5 * (from + to);
            position = lines_[at(line)].curve.at(wall_.shape(), middle.way_mm);
            middle.size_mm = wanted_mm(edge);
        } else {
            const auto face = work_.mesh.face_handle(half);
            const WallProjection::Foot foot = wall_.nearest(chord, work_.label(face).region);
            middle.kind = Place::Kind::Inside;
            position = foot.position_mm;
            middle.size_mm = size_at(foot);
        }
        const Vertex v = work_.split(edge, position);
        place(v) = middle;
    }

    void collapse_short() {
        bool any = false;
        for (const Edge edge : work_.mesh.edges()) {
            if (work_.mesh.status(edge).deleted() || !work_.touches_wall(edge)) {
                continue;
            }
            const double wanted = wanted_mm(edge);
            if (work_.length(edge) >= kShort * wanted) {
                continue;
            }
            for (const unsigned side : {0U, 1U}) {
                const Halfedge half = work_.mesh.halfedge_handle(edge, side);
                const Place::Kind kind = place(work_.mesh.from_vertex_handle(half)).kind;
                if (kind != Place::Kind::Fixed &&
                    work_.may_collapse(half, kTurnCosine, kLong * wanted)) {
                    work_.collapse(half);
                    any = true;
                    break;
                }
            }
        }
        if (any) {
            work_.mesh.garbage_collection();
        }
    }

    // Flips make no vertex one of a line, nor the contrary.
    void flip_for_valence() {
        std::vector<int> gap(work_.mesh.n_vertices());
        for (const Vertex v : work_.mesh.vertices()) {
            gap[at(v.idx())] =
                static_cast<int>(work_.mesh.valence(v)) - (work_.mesh.is_boundary(v) ? 4 : 6);
        }
        const auto off = [&](Vertex v, int change) { return std::abs(gap[at(v.idx())] + change); };
        for (const Edge edge : work_.mesh.edges()) {
            if (work_.is_line(edge) || work_.mesh.is_boundary(edge)) {
                continue;
            }
            const Halfedge half = work_.mesh.halfedge_handle(edge, 0);
            const Vertex a = work_.mesh.from_vertex_handle(half);
            const Vertex b = work_.mesh.to_vertex_handle(half);
            const Vertex c = work_.mesh.to_vertex_handle(work_.mesh.next_halfedge_handle(half));
            const Vertex d = work_.mesh.to_vertex_handle(
                work_.mesh.next_halfedge_handle(work_.mesh.opposite_halfedge_handle(half)));
            if (off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1) <
                    off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0) &&
                work_.may_flip(edge, kTurnCosine)) {
                work_.mesh.flip(edge);
                --gap[at(a.idx())];
                --gap[at(b.idx())];
                ++gap[at(c.idx())];
                ++gap[at(d.idx())];
            }
        }
    }

    void flip_for_angle() {
        for (const Edge edge : work_.mesh.edges()) {
            if (work_.is_line(edge) || work_.mesh.is_boundary(edge)) {
                continue;
            }
            const auto [before, after] = work_.angles(edge);
            if (after < before - kCosineGain && work_.may_flip(edge, kTurnCosine)) {
                work_.mesh.flip(edge);
            }
        }
    }

    // Vertices go to the middle of those next to them, along the surface or the line.
    void smooth() {
        std::vector<Vertex> inside;
        for (const Vertex v : work_.mesh.vertices()) {
            if (place(v).kind == Place::Kind::Inside) {
                inside.push_back(v);
            } else if (place(v).kind == Place::Kind::OnLine) {
                slide(v);
            }
        }
        std::vector<WallProjection::Foot> feet(inside.size());
        parallel_for(inside.size(), kProjectChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                Vector3d sum = Vector3d::Zero();
                double weight = 0.0;
                for (const Vertex near : work_.mesh.vv_range(inside[i])) {
                    sum += work_.at(near);
                    weight += 1.0;
                }
                feet[i] = wall_.nearest(sum / weight, work_.region_at(inside[i]));
            }
        });
        for (std::size_t i = 0; i < inside.size(); ++i) {
            if (work_.may_move(inside[i], feet[i].position_mm, kTurnCosine)) {
                work_.move(inside[i], feet[i].position_mm);
                place(inside[i]).size_mm = size_at(feet[i]);
            }
        }
    }

    void slide(Vertex v) {
        double sum = 0.0;
        int count = 0;
        for (const Edge edge : work_.mesh.ve_range(v)) {
            if (work_.is_line(edge)) {
                const auto ways = ways_of(edge);
                const bool first =
                    work_.mesh.from_vertex_handle(work_.mesh.halfedge_handle(edge, 0)) == v;
                sum += first ? ways[1] : ways[0];
                ++count;
            }
        }
        if (count != 2) {
            return;
        }
        const double way = 0.5 * sum;
        const Vector3d target = lines_[at(place(v).line)].curve.at(wall_.shape(), way);
        if (work_.may_move(v, target, kTurnCosine)) {
            work_.move(v, target);
            place(v).way_mm = way;
        }
    }

    EvenMeshOptions options_;
    WorkMesh work_;
    Surface surface_;
    WallProjection wall_;
    std::vector<double> size_of_surface_;  // per vertex of the surface
    std::vector<std::int32_t> wall_face_;  // per face of the part: of the surface, or -1
    std::vector<Line> lines_;
    std::int32_t corners_ = 0;
    OpenMesh::VPropHandleT<Place> place_;
};

}  // namespace

EvenMeshOptions even_options(double size_mm) {
    constexpr double kLongestEdge = 0.15;
    constexpr double kLeastEdge = 0.02;
    EvenMeshOptions options;
    options.least_mm = kLeastEdge * size_mm;
    options.longest_mm = kLongestEdge * size_mm;
    return options;
}

double wanted_triangles(const Surface& wall, const EvenMeshOptions& options) {
    return triangles_of(wall, sizes_of(wall, options));
}

LabelledMesh even_mesh(const LabelledMesh& part, const std::vector<char>& kept, Surface wall,
                       const EvenMeshOptions& options) {
    return EvenMesher(part, kept, std::move(wall), options).run();
}

}  // namespace meshwind
