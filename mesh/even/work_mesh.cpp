#include "mesh/even/work_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A triangle whose area is below this share of its longest side squared tells no direction: what it
// seems to face is rounding.
constexpr double kTellsDirection = 1e-2;

Vector3d area_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return 0.5 * (b - a).cross(c - a);
}

bool tells_direction(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return area_of(a, b, c).norm() > kTellsDirection * longest;
}

// Whether a triangle stays within the angle of `cosine` of what it was, or of `around` where it
// told no direction.
bool keeps_way(const std::array<Vector3d, 3>& was, const std::array<Vector3d, 3>& is,
               const Vector3d& around, double cosine) {
    const Vector3d before =
        tells_direction(was[0], was[1], was[2]) ? area_of(was[0], was[1], was[2]) : around;
    const Vector3d after = area_of(is[0], is[1], is[2]);
    const double size = before.norm() * after.norm();
    return size > 0.0 && before.dot(after) >= cosine * size;
}

// The two triangles on an edge: a and b its ends, c and d the corners left and right of a -> b.
struct Diamond {
    WorkMesh::Vertex a, b, c, d;
};

Diamond diamond_of(const WorkMesh::Mesh& mesh, WorkMesh::Edge edge) {
    const auto half = mesh.halfedge_handle(edge, 0);
    const auto other = mesh.halfedge_handle(edge, 1);
    return {mesh.from_vertex_handle(half), mesh.to_vertex_handle(half),
            mesh.to_vertex_handle(mesh.next_halfedge_handle(half)),
            mesh.to_vertex_handle(mesh.next_halfedge_handle(other))};
}

// Sum of the area vectors of the triangles at a vertex.
Vector3d area_around(const WorkMesh& work, WorkMesh::Vertex v) {
    Vector3d sum = Vector3d::Zero();
    for (const auto out : work.mesh.voh_range(v)) {
        if (!work.mesh.is_boundary(out)) {
            sum +=
                area_of(work.at(v), work.at(work.mesh.to_vertex_handle(out)),
                        work.at(work.mesh.to_vertex_handle(work.mesh.next_halfedge_handle(out))));
        }
    }
    return sum;
}

}  // namespace

WorkMesh::WorkMesh(const LabelledMesh& part, const std::vector<char>& kept) {
    mesh.add_property(face_label_);
    mesh.add_property(edge_label_);
    mesh.reserve(part.soup.points_mm.size(), 2 * part.soup.faces.size(), part.soup.faces.size());
    for (const Vector3d& p : part.soup.points_mm) {
        mesh.add_vertex({p.x(), p.y(), p.z()});
    }
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        const auto& [a, b, c] = part.soup.faces[f];
        const Face face = mesh.add_face(Vertex(a), Vertex(b), Vertex(c));
        label(face) = {part.region[f], part.shape.empty() ? -1 : part.shape[f],
                       kept[static_cast<std::size_t>(part.region[f])] != 0};
    }
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const Halfedge half = mesh.find_halfedge(Vertex(part.soup.faces[f][e]),
                                                     Vertex(part.soup.faces[f][(e + 1) % 3]));
            const Edge edge = mesh.edge_handle(half);
            label(edge).crease |= part.feature[f][e] != 0;
        }
    }
    for (const Edge edge : mesh.edges()) {
        const bool one = is_wall(mesh.face_handle(mesh.halfedge_handle(edge, 0)));
        const bool other = is_wall(mesh.face_handle(mesh.halfedge_handle(edge, 1)));
        if (one != other || (one && label(edge).crease)) {
            label(edge).line = 0;
        }
    }
}

bool WorkMesh::touches_wall(Edge edge) const {
    return is_wall(mesh.face_handle(mesh.halfedge_handle(edge, 0))) ||
           is_wall(mesh.face_handle(mesh.halfedge_handle(edge, 1)));
}

int WorkMesh::lines_at(Vertex v) const {
    int count = 0;
    for (const Edge edge : mesh.ve_range(v)) {
        count += is_line(edge) ? 1 : 0;
    }
    return count;
}

std::int32_t WorkMesh::region_at(Vertex v) const {
    for (const Face face : mesh.vf_range(v)) {
        if (is_wall(face)) {
            return label(face).region;
        }
    }
    return -1;
}

WorkMesh::Vertex WorkMesh::split(Edge edge, const Eigen::Vector3d& p) {
    const Halfedge half = mesh.halfedge_handle(edge, 0);
    const Vertex a = mesh.from_vertex_handle(half);
    const Vertex b = mesh.to_vertex_handle(half);
    const EdgeLabel on_edge = label(edge);
    struct Side {
        Vertex apex;
        FaceLabel label;
    };
    std::array<Side, 2> sides;
    for (unsigned i = 0; i < 2; ++i) {
        const Halfedge h = mesh.halfedge_handle(edge, i);
        if (!mesh.is_boundary(h)) {
            sides[i] = {mesh.to_vertex_handle(mesh.next_halfedge_handle(h)),
                        label(mesh.face_handle(h))};
        }
    }
    const Vertex middle = mesh.add_vertex({p.x(), p.y(), p.z()});
    mesh.split(edge, middle);
    for (const Edge around : mesh.ve_range(middle)) {
        label(around) = {};
    }
    label(mesh.edge_handle(mesh.find_halfedge(middle, a))) = on_edge;
    label(mesh.edge_handle(mesh.find_halfedge(middle, b))) = on_edge;
    for (const Face face : mesh.vf_range(middle)) {
        const bool first = std::any_of(mesh.cfv_begin(face), mesh.cfv_end(face), [&](Vertex v) {
            return sides[0].apex.is_valid() && v == sides[0].apex;
        });
        label(face) = first ? sides[0].label : sides[1].label;
    }
    return middle;
}

bool WorkMesh::may_collapse(Halfedge half, double cosine, double longest_mm) {
    const Vertex from = mesh.from_vertex_handle(half);
    const Vertex to = mesh.to_vertex_handle(half);
    const Edge edge = mesh.edge_handle(half);
    const int lines = lines_at(from);
    if (lines != 0 && !(lines == 2 && is_line(edge))) {
        return false;
    }
    if (!mesh.is_collapse_ok(half)) {
        return false;
    }
    const Vector3d target = at(to);
    const Vector3d around = area_around(*this, from);
    for (const Halfedge out : mesh.voh_range(from)) {
        const Vertex first = mesh.to_vertex_handle(out);
        if (first != to && (at(first) - target).norm() > longest_mm) {
            return false;
        }
        if (mesh.is_boundary(out)) {
            continue;
        }
        if (lines == 0 && !is_wall(mesh.face_handle(out))) {
            return false;
        }
        const Halfedge across = mesh.next_halfedge_handle(out);
        const Vertex second = mesh.to_vertex_handle(across);
        if (first == to || second == to) {
            // This triangle goes, and its two other edges become one: not two lines.
            const Edge left = mesh.edge_handle(first == to ? across : out);
            const Edge right =
                mesh.edge_handle(first == to ? mesh.next_halfedge_handle(across) : across);
            if (is_line(left) && is_line(right)) {
                return false;
            }
            continue;
        }
        if (!keeps_way({at(from), at(first), at(second)}, {target, at(first), at(second)}, around,
                       cosine)) {
            return false;
        }
    }
    return true;
}

double WorkMesh::collapse_leaves_mm(Halfedge half) const {
    const Vertex from = mesh.from_vertex_handle(half);
    const Vertex to = mesh.to_vertex_handle(half);
    double most = 0.0;
    for (const Halfedge out : mesh.voh_range(from)) {
        if (mesh.is_boundary(out)) {
            continue;
        }
        const Vertex first = mesh.to_vertex_handle(out);
        const Vertex second = mesh.to_vertex_handle(mesh.next_halfedge_handle(out));
        if (first != to && second != to && tells_direction(at(to), at(first), at(second))) {
            const Vector3d normal = area_of(at(to), at(first), at(second)).normalized();
            most = std::max(most, std::abs(normal.dot(at(from) - at(to))));
        }
    }
    return most;
}

void WorkMesh::collapse(Halfedge half) {
    const Vertex from = mesh.from_vertex_handle(half);
    const Vertex to = mesh.to_vertex_handle(half);
    // The edges from the removed vertex and from the one that stays to a common neighbour become
    // one edge: a line, where one of them was.
    struct Joined {
        Vertex apex;
        EdgeLabel label;
    };
    std::array<Joined, 2> joined;
    for (std::size_t i = 0; i < 2; ++i) {
        const Halfedge h = i == 0 ? half : mesh.opposite_halfedge_handle(half);
        if (mesh.is_boundary(h)) {
            continue;
        }
        const Vertex apex = mesh.to_vertex_handle(mesh.next_halfedge_handle(h));
        const EdgeLabel one = label(mesh.edge_handle(mesh.find_halfedge(apex, from)));
        const EdgeLabel other = label(mesh.edge_handle(mesh.find_halfedge(apex, to)));
        joined[i] = {apex, one.line != kNoLine || one.crease ? one : other};
    }
    mesh.collapse(half);
    for (const Joined& j : joined) {
        if (j.apex.is_valid()) {
            const Halfedge h = mesh.find_halfedge(j.apex, to);
            if (h.is_valid()) {
                label(mesh.edge_handle(h)) = j.label;
            }
        }
    }
}

bool WorkMesh::may_flip(Edge edge, double cosine) const {
    if (mesh.is_boundary(edge) || is_line(edge) || label(edge).crease) {
        return false;
    }
    const FaceLabel& one = label(mesh.face_handle(mesh.halfedge_handle(edge, 0)));
    const FaceLabel& other = label(mesh.face_handle(mesh.halfedge_handle(edge, 1)));
    if (!one.wall || !other.wall || one.region != other.region ||
        (one.shape != other.shape && one.shape >= 0 && other.shape >= 0) ||
        !mesh.is_flip_ok(edge)) {
        return false;
    }
    const Diamond v = diamond_of(mesh, edge);
    const Vector3d before = area_of(at(v.a), at(v.b), at(v.c)) + area_of(at(v.b), at(v.a), at(v.d));
    const Vector3d left = area_of(at(v.a), at(v.d), at(v.c));
    const Vector3d right = area_of(at(v.d), at(v.b), at(v.c));
    const double size = before.norm();
    return left.norm() > 0.0 && right.norm() > 0.0 &&
           before.dot(left) >= cosine * size * left.norm() &&
           before.dot(right) >= cosine * size * right.norm();
}

void WorkMesh::flip(Edge edge) {
    FaceLabel& one = label(mesh.face_handle(mesh.halfedge_handle(edge, 0)));
    FaceLabel& other = label(mesh.face_handle(mesh.halfedge_handle(edge, 1)));
    if (one.shape != other.shape) {
        one.shape = other.shape = -1;
    }
    mesh.flip(edge);
}

FlipCosines WorkMesh::angles(Edge edge) const {
    const Diamond v = diamond_of(mesh, edge);
    return flip_cosines(at(v.a), at(v.b), at(v.c), at(v.d));
}

bool WorkMesh::may_move(Vertex v, const Vector3d& target, double cosine) const {
    if (!target.allFinite()) {
        return false;
    }
    const Vector3d around = area_around(*this, v);
    for (const Halfedge out : mesh.voh_range(v)) {
        if (mesh.is_boundary(out)) {
            continue;
        }
        const Vector3d b = at(mesh.to_vertex_handle(out));
        const Vector3d c = at(mesh.to_vertex_handle(mesh.next_halfedge_handle(out)));
        if (!keeps_way({at(v), b, c}, {target, b, c}, around, cosine)) {
            return false;
        }
    }
    return true;
}

LabelledMesh WorkMesh::part() {
    mesh.garbage_collection();
    LabelledMesh result;
    for (const Vertex v : mesh.vertices()) {
        result.soup.points_mm.push_back(at(v));
    }
    for (const Face face : mesh.faces()) {
        std::array<std::int32_t, 3> corners{};
        std::array<std::uint8_t, 3> feature{};
        std::size_t i = 0;
        for (const Halfedge half : mesh.fh_range(face)) {
            corners[i] = mesh.from_vertex_handle(half).idx();
            feature[i] = label(mesh.edge_handle(half)).crease ? 1 : 0;
            ++i;
        }
        result.soup.faces.push_back(corners);
        result.feature.push_back(feature);
        result.region.push_back(label(face).region);
        result.shape.push_back(label(face).shape);
    }
    return result;
}

}  // namespace meshwind
