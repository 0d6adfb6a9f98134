#include "mesh/shapes/remesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "mesh/even/flip_angles.h"
#include "mesh/repair/open_mesh_kernel.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Project = std::function<Vector3d(const Vector3d&)>;

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
    VertexAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

Vector3d eigen(const OpenMesh::Vec3d& v) {
    return {v[0], v[1], v[2]};
}

OpenMesh::Vec3d open(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

Mesh mesh_of(const TriangleSoup& soup) {
    Mesh mesh;
    std::vector<Mesh::VertexHandle> vertices;
    vertices.reserve(soup.points_mm.size());
    for (const Vector3d& point : soup.points_mm) {
        vertices.push_back(mesh.add_vertex(open(point)));
    }
    for (const auto& [a, b, c] : soup.faces) {
        mesh.add_face(vertices[static_cast<std::size_t>(a)], vertices[static_cast<std::size_t>(b)],
                      vertices[static_cast<std::size_t>(c)]);
    }
    return mesh;
}

TriangleSoup soup_of(const Mesh& mesh) {
    TriangleSoup soup;
    soup.points_mm.reserve(mesh.n_vertices());
    for (const auto vertex : mesh.vertices()) {
        soup.points_mm.push_back(eigen(mesh.point(vertex)));
    }
    soup.faces.reserve(mesh.n_faces());
    for (const auto face : mesh.faces()) {
        std::array<std::int32_t, 3> corners{};
        std::size_t i = 0;
        for (const auto vertex : face.vertices()) {
            corners[i++] = vertex.idx();
        }
        soup.faces.push_back(corners);
    }
    return soup;
}

Vector3d normal_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return (b - a).cross(c - a).normalized();
}

// Of the angles of a triangle, see flip_angles.h.
double worst_cosine(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return worst_cosine_of_sides((b - a).normalized(), (c - b).normalized(), (a - c).normalized());
}

// Triangles after an operation must not turn away from those before it by more than 60 degrees.
constexpr double kTurnCosine = 0.5;

void split_long(Mesh& mesh, const Project& project, double limit) {
    // Edges made by a split are at most as long again; one look per edge and sweep is enough.
    const std::size_t count = mesh.n_edges();
    for (std::size_t i = 0; i < count; ++i) {
        const Mesh::EdgeHandle edge(static_cast<int>(i));
        if (!mesh.is_boundary(edge) && mesh.calc_edge_length(edge) > limit) {
            mesh.split(edge, open(project(eigen(mesh.calc_edge_midpoint(edge)))));
        }
    }
}

// Whether the start of `half` may move to its end: no long edge, no folded triangle.
bool collapse_is_good(const Mesh& mesh, Mesh::HalfedgeHandle half, double limit) {
    const auto from = mesh.from_vertex_handle(half);
    const auto to = mesh.to_vertex_handle(half);
    const Vector3d target = eigen(mesh.point(to));
    for (const auto out : mesh.voh_range(from)) {
        if (out.to() != to && (eigen(mesh.point(out.to())) - target).norm() > limit) {
            return false;
        }
        const auto next = out.next().to();
        if (out.is_boundary() || out.to() == to || next == to) {
            continue;
        }
        const Vector3d b = eigen(mesh.point(out.to()));
        const Vector3d c = eigen(mesh.point(next));
        const Vector3d before = normal_of(eigen(mesh.point(from)), b, c);
        if (before.dot(normal_of(target, b, c)) < kTurnCosine) {
            return false;
        }
    }
    return true;
}

void collapse_short(Mesh& mesh, double lower, double upper) {
    bool any = false;
    for (const auto edge : mesh.edges()) {
        if (mesh.status(edge).deleted() || mesh.calc_edge_length(edge) >= lower) {
            continue;
        }
        for (const unsigned side : {0U, 1U}) {
            const auto half = mesh.halfedge_handle(edge, side);
            if (!mesh.is_boundary(mesh.from_vertex_handle(half)) && mesh.is_collapse_ok(half) &&
                collapse_is_good(mesh, half, upper)) {
                mesh.collapse(half);
                any = true;
                break;
            }
        }
    }
    if (any) {
        mesh.garbage_collection();
    }
}

// The two triangles on an edge: a and b its ends, c and d the corners left and right of a -> b.
struct Diamond {
    Mesh::VertexHandle a, b, c, d;
};

Diamond diamond_of(const Mesh& mesh, Mesh::EdgeHandle edge) {
    const auto half = mesh.halfedge_handle(edge, 0);
    const auto other = mesh.halfedge_handle(edge, 1);
    return {mesh.from_vertex_handle(half), mesh.to_vertex_handle(half),
            mesh.to_vertex_handle(mesh.next_halfedge_handle(half)),
            mesh.to_vertex_handle(mesh.next_halfedge_handle(other))};
}

// The corners of a diamond.
struct FlipView {
    Vector3d a, b, c, d;

    FlipView(const Mesh& mesh, const Diamond& diamond)
        : a(eigen(mesh.point(diamond.a))),
          b(eigen(mesh.point(diamond.b))),
          c(eigen(mesh.point(diamond.c))),
          d(eigen(mesh.point(diamond.d))) {}

    [[nodiscard]] bool folds() const {
        const Vector3d before = normal_of(a, b, c) + normal_of(b, a, d);
        return before.dot(normal_of(a, d, c)) < 2.0 * kTurnCosine ||
               before.dot(normal_of(d, b, c)) < 2.0 * kTurnCosine;
    }

    [[nodiscard]] FlipCosines worst() const { return flip_cosines(a, b, c, d); }
};

// How many edges meet at each vertex, and how many should.
class Valences {
public:
    explicit Valences(const Mesh& mesh) : gap_(mesh.n_vertices()) {
        for (const auto vertex : mesh.vertices()) {
            gap_[at(vertex)] =
                static_cast<int>(mesh.valence(vertex)) - (mesh.is_boundary(vertex) ? 4 : 6);
        }
    }

    [[nodiscard]] bool are_evened_by_flip(const Diamond& v) const {
        const int before = gap(v.a, 0) + gap(v.b, 0) + gap(v.c, 0) + gap(v.d, 0);
        const int after = gap(v.a, -1) + gap(v.b, -1) + gap(v.c, 1) + gap(v.d, 1);
        return after < before;
    }

    void note_flip(const Diamond& v) {
        --gap_[at(v.a)];
        --gap_[at(v.b)];
        ++gap_[at(v.c)];
        ++gap_[at(v.d)];
    }

private:
    static std::size_t at(Mesh::VertexHandle vertex) {
        return static_cast<std::size_t>(vertex.idx());
    }
    [[nodiscard]] int gap(Mesh::VertexHandle vertex, int change) const {
        return std::abs(gap_[at(vertex)] + change);
    }

    std::vector<int> gap_;
};

// Flips make no vertex one of the boundary, nor the contrary.
void flip_for_valence(Mesh& mesh) {
    Valences valences(mesh);
    for (const auto edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) {
            continue;
        }
        const Diamond diamond = diamond_of(mesh, edge);
        if (valences.are_evened_by_flip(diamond) && mesh.is_flip_ok(edge) &&
            !FlipView(mesh, diamond).folds()) {
            mesh.flip(edge);
            valences.note_flip(diamond);
        }
    }
}

void flip_for_angle(Mesh& mesh) {
    // Angles closer than this count as equal, so that symmetric diamonds do not flip for rounding.
    constexpr double kCosineGain = 1e-6;
    for (const auto edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) {
            continue;
        }
        const FlipView view(mesh, diamond_of(mesh, edge));
        const auto [before, after] = view.worst();
        if (after < before - kCosineGain && mesh.is_flip_ok(edge) && !view.folds()) {
            mesh.flip(edge);
        }
    }
}

bool move_folds(const Mesh& mesh, Mesh::VertexHandle vertex, const Vector3d& target) {
    for (const auto out : mesh.voh_range(vertex)) {
        const Vector3d b = eigen(mesh.point(out.to()));
        const Vector3d c = eigen(mesh.point(out.next().to()));
        const Vector3d before = normal_of(eigen(mesh.point(vertex)), b, c);
        if (!(before.dot(normal_of(target, b, c)) >= kTurnCosine)) {
            return true;
        }
    }
    return false;
}

void smooth(Mesh& mesh, const Project& project) {
    for (const auto vertex : mesh.vertices()) {
        if (mesh.is_boundary(vertex)) {
            continue;
        }
        Vector3d sum = Vector3d::Zero();
        int count = 0;
        for (const auto near : mesh.vv_range(vertex)) {
            sum += eigen(mesh.point(near));
            ++count;
        }
        const Vector3d target = project(sum / static_cast<double>(count));
        if (!move_folds(mesh, vertex, target)) {
            mesh.set_point(vertex, open(target));
        }
    }
}

// Even numbers in [0, 1), the same on every machine.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}
    double roll() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

private:
    std::mt19937_64 engine_;
};

struct Limits {
    double cosine;   // of the smallest angle
    double edge_mm;  // longest edge
};

// Whether a vertex at `target` would fold a triangle or break the limits.
bool move_spoils(const Mesh& mesh, Mesh::VertexHandle vertex, const Vector3d& target,
                 const Limits& limits) {
    if (move_folds(mesh, vertex, target)) {
        return true;
    }
    for (const auto out : mesh.voh_range(vertex)) {
        const Vector3d near = eigen(mesh.point(out.to()));
        if ((near - target).norm() > limits.edge_mm ||
            worst_cosine(target, near, eigen(mesh.point(out.next().to()))) > limits.cosine) {
            return true;
        }
    }
    return false;
}

bool flip_spoils(const Mesh& mesh, Mesh::EdgeHandle edge, const Limits& limits) {
    const Diamond diamond = diamond_of(mesh, edge);
    const FlipView view(mesh, diamond);
    const double length = (mesh.point(diamond.c) - mesh.point(diamond.d)).norm();
    return view.folds() || view.worst().after > limits.cosine || length > limits.edge_mm;
}

Vector3d random_in_ball(Dice& dice) {
    for (;;) {
        const double x = 2.0 * dice.roll() - 1.0;
        const double y = 2.0 * dice.roll() - 1.0;
        const double z = 2.0 * dice.roll() - 1.0;
        if (x * x + y * y + z * z <= 1.0) {
            return {x, y, z};
        }
    }
}

}  // namespace

TriangleSoup remesh_onto(const TriangleSoup& soup, const Project& project,
                         const RemeshOptions& options) {
    const double lower = 0.8 * options.edge_mm;
    const double upper = options.edge_mm * 4.0 / 3.0;
    Mesh mesh = mesh_of(soup);
    for (int sweep = 0; sweep < options.sweeps; ++sweep) {
        split_long(mesh, project, upper);
        collapse_short(mesh, lower, upper);
        flip_for_valence(mesh);
        smooth(mesh, project);
    }
    for (int sweep = 0; sweep < options.polish; ++sweep) {
        flip_for_angle(mesh);
        smooth(mesh, project);
    }
    flip_for_angle(mesh);
    return soup_of(mesh);
}

TriangleSoup roughen_onto(const TriangleSoup& soup, const Project& project,
                          const std::vector<std::uint8_t>& fixed, const RoughenOptions& options) {
    Mesh mesh = mesh_of(soup);
    Dice dice(options.seed);
    const Limits limits{std::cos(options.min_angle_rad), options.max_edge * options.edge_mm};
    const auto stays = [&](Mesh::VertexHandle vertex) {
        return !fixed.empty() && fixed[static_cast<std::size_t>(vertex.idx())] != 0;
    };
    for (const auto vertex : mesh.vertices()) {
        const Vector3d shift = options.jitter * options.edge_mm * random_in_ball(dice);
        if (!mesh.is_boundary(vertex) && !stays(vertex)) {
            const Vector3d target = project(eigen(mesh.point(vertex)) + shift);
            if (!move_spoils(mesh, vertex, target, limits)) {
                mesh.set_point(vertex, open(target));
            }
        }
    }
    for (const auto edge : mesh.edges()) {
        const bool wanted = dice.roll() < 0.5;
        const bool crease = stays(edge.v0()) && stays(edge.v1());
        if (wanted && !crease && !mesh.is_boundary(edge) && mesh.is_flip_ok(edge) &&
            !flip_spoils(mesh, edge, limits)) {
            mesh.flip(edge);
        }
    }
    return soup_of(mesh);
}

}  // namespace meshwind
