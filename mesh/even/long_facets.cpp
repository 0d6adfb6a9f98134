#include "mesh/even/long_facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/index.h"
#include "core/interrupt.h"
#include "mesh/even/ruled_shape.h"
#include "mesh/even/work_mesh.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Vertex = WorkMesh::Vertex;
using Edge = WorkMesh::Edge;
using Face = WorkMesh::Face;
using Halfedge = WorkMesh::Halfedge;

// A facet is long from so many times its height.
constexpr double kLong = 3.0;

// Facets hang together over the edges that are this share of their longest: along rulings.
constexpr double kAlong = 0.5;

// Fewer facets than this tell no shape.
constexpr std::size_t kFewFacets = 4;

// What vertices may be off their cylinder: by more than the facets themselves are off it, they do
// not lie on it; less than this share of its radius is rounding.
constexpr double kOfFacets = 1.1;
constexpr double kRounding = 1e-5;

// Wider facets than this share of the radius (34 degrees) are no round wall.
constexpr double kWidest = 0.6;

// Facets with a vertex that is off by more than this share of the worst are left out of a row, as
// long as so much of the row is left.
constexpr double kFarOff = 0.5;
constexpr double kMinShare = 0.7;

// The middle of an edge is nearer to its shape than this share of the edge, so that halves are
// shorter than the whole; beside the tip of a cone it may not be.
constexpr double kNearShare = 0.25;

// A crease is straight where its middle is off the shapes beside it by less than this share of it.
constexpr double kStraight = 1e-5;

// The longest edges lose at least a quarter of their length in every round: enough for facets of
// 10,000 edges.
constexpr int kMaxRounds = 40;

// Halves are no more than this, nor than so many for each of the part's triangles: a pipe 100 times
// as long as wide takes 150 for each. More come of facets with hardly an area.
constexpr double kMaxHalves = 300000.0;
constexpr double kMaxHalvesEach = 200.0;
constexpr double kFewHalves = 20000.0;

// Triangles turned afterwards stay within 20 degrees.
constexpr double kTurnCosine = 0.94;

struct Facet {
    RuledFacet seen;
    double longest_mm = 0.0;
    double height_mm = 0.0;  // over the longest edge
};

Facet facet_of(const WorkMesh& work, Face face) {
    std::array<Vector3d, 3> p;
    std::size_t i = 0;
    for (const Vertex v : work.mesh.fv_range(face)) {
        p[i++] = work.at(v);
    }
    const Vector3d area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]);
    Facet facet;
    facet.seen.area_mm2 = area.norm();
    facet.seen.normal = area.normalized();
    facet.seen.centre_mm = (p[0] + p[1] + p[2]) / 3.0;
    facet.longest_mm = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    facet.height_mm = 2.0 * facet.seen.area_mm2 / facet.longest_mm;
    return facet;
}

// A part's triangles, and the shapes that the faces' labels name.
struct ShapedMesh {
    WorkMesh work;
    std::vector<WallShape> shapes;
};

// Per face of the part; those that are no wall have none.
std::vector<Facet> facets_of(const WorkMesh& work) {
    std::vector<Facet> facets;
    for (const Face face : work.mesh.faces()) {
        facets.push_back(work.is_wall(face) ? facet_of(work, face) : Facet{});
    }
    return facets;
}

// The farthest that a vertex is off the shape of its face.
double residual_mm(const ShapedMesh& mesh) {
    double most = 0.0;
    for (const Face face : mesh.work.mesh.faces()) {
        if (mesh.work.label(face).shape >= 0) {
            const WallShape& shape = mesh.shapes[at(mesh.work.label(face).shape)];
            for (const Vertex v : mesh.work.mesh.fv_range(face)) {
                most = std::max(most, shape.distance_mm(mesh.work.at(v)));
            }
        }
    }
    return most;
}

bool is_long(const WorkMesh& work, const std::vector<Facet>& facets, double edge_mm, Face face) {
    const Facet& facet = facets[at(face.idx())];
    return work.is_wall(face) && work.label(face).shape < 0 && facet.seen.area_mm2 > 0.0 &&
           facet.longest_mm > edge_mm && facet.longest_mm > kLong * facet.height_mm;
}

// What a row's facets say together.
struct RowFit {
    std::optional<RuledShape> shape;
    double most_off_mm = 0.0;  // what vertices of the shape may be off it
};

RowFit fit_row(const WorkMesh& work, const std::vector<Facet>& facets,
               const std::vector<Face>& row) {
    std::vector<RuledFacet> seen;
    std::vector<std::int32_t> vertices;
    double widest = 0.0;
    for (const Face face : row) {
        seen.push_back(facets[at(face.idx())].seen);
        widest = std::max(widest, facets[at(face.idx())].height_mm);
        for (const Vertex v : work.mesh.fv_range(face)) {
            vertices.push_back(v.idx());
        }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vector3d> points;
    points.reserve(vertices.size());
    for (const std::int32_t v : vertices) {
        points.push_back(work.at(Vertex(v)));
    }
    RowFit fit{fit_ruled_shape(points, seen), 0.0};
    if (fit.shape && widest <= kWidest * fit.shape->radius_mm) {
        const double sagitta = widest * widest / (8.0 * fit.shape->radius_mm);
        fit.most_off_mm = std::max(kOfFacets * sagitta, kRounding * fit.shape->radius_mm);
    } else {
        fit.shape.reset();
    }
    return fit;
}

// The shape of a row becomes its facets'. Facets that belong to something else are left out, a few
// at a time. \return what the row's vertices are off it, 0: it has none
double add_shape(std::vector<Face> row, const std::vector<Facet>& facets, ShapedMesh& mesh) {
    WorkMesh& work = mesh.work;
    const std::size_t whole = row.size();
    while (row.size() >= kFewFacets &&
           static_cast<double>(row.size()) >= kMinShare * static_cast<double>(whole)) {
        const RowFit fit = fit_row(work, facets, row);
        if (!fit.shape) {
            return 0.0;
        }
        if (fit.shape->residual_mm <= fit.most_off_mm) {
            for (const Face face : row) {
                work.label(face).shape = static_cast<std::int32_t>(mesh.shapes.size());
            }
            WallShape shape;
            shape.kind = WallShape::Kind::Ruled;
            shape.ruled = *fit.shape;
            mesh.shapes.push_back(shape);
            return fit.shape->residual_mm;
        }
        const double limit = std::max(fit.most_off_mm, kFarOff * fit.shape->residual_mm);
        row.erase(std::remove_if(row.begin(), row.end(),
                                 [&](Face face) {
                                     return std::any_of(
                                         work.mesh.cfv_begin(face), work.mesh.cfv_end(face),
                                         [&](Vertex v) {
                                             return fit.shape->distance_mm(work.at(v)) > limit;
                                         });
                                 }),
                  row.end());
    }
    return 0.0;
}

// Long facets beside each other along their long edges, from one on.
std::vector<Face> row_from(const WorkMesh& work, const std::vector<Facet>& facets, double edge_mm,
                           Face seed, std::vector<char>& used) {
    std::vector<Face> row{seed};
    used[at(seed.idx())] = 1;
    for (std::size_t i = 0; i < row.size(); ++i) {
        for (const Halfedge half : work.mesh.fh_range(row[i])) {
            const Edge edge = work.mesh.edge_handle(half);
            const Face other = work.mesh.face_handle(work.mesh.opposite_halfedge_handle(half));
            if (work.is_line(edge) || !other.is_valid() || used[at(other.idx())] != 0 ||
                !is_long(work, facets, edge_mm, other) ||
                work.length(edge) < kAlong * facets[at(row[i].idx())].longest_mm ||
                work.length(edge) < kAlong * facets[at(other.idx())].longest_mm) {
                continue;
            }
            used[at(other.idx())] = 1;
            row.push_back(other);
        }
    }
    return row;
}

// Gives each row of long facets its shape. \return the farthest that a vertex is off one
double add_shapes(const std::vector<Facet>& facets, double edge_mm, ShapedMesh& mesh) {
    double most = 0.0;
    std::vector<char> used(facets.size(), 0);
    for (const Face seed : mesh.work.mesh.faces()) {
        if (used[at(seed.idx())] == 0 && is_long(mesh.work, facets, edge_mm, seed)) {
            const std::vector<Face> row = row_from(mesh.work, facets, edge_mm, seed, used);
            most = std::max(most, add_shape(row, facets, mesh));
        }
    }
    return most;
}

// Not of a ball: its facets are as long as high.
std::int32_t shape_of(const ShapedMesh& mesh, Edge edge) {
    for (const unsigned side : {0U, 1U}) {
        const Face face = mesh.work.mesh.face_handle(mesh.work.mesh.halfedge_handle(edge, side));
        if (mesh.work.is_wall(face) && mesh.work.label(face).shape >= 0 &&
            mesh.shapes[at(mesh.work.label(face).shape)].kind != WallShape::Kind::Ball) {
            return mesh.work.label(face).shape;
        }
    }
    return -1;
}

// How many pieces the long edges come to, about.
double halves(const ShapedMesh& mesh, double edge_mm) {
    double count = 0.0;
    for (const Edge edge : mesh.work.mesh.edges()) {
        if (!mesh.work.is_line(edge) && shape_of(mesh, edge) >= 0) {
            count += mesh.work.length(edge) / edge_mm;
        }
    }
    return count;
}

Vector3d middle_of(const ShapedMesh& mesh, Edge edge) {
    const Halfedge half = mesh.work.mesh.halfedge_handle(edge, 0);
    return 0.5 * (mesh.work.at(mesh.work.mesh.from_vertex_handle(half)) +
                  mesh.work.at(mesh.work.mesh.to_vertex_handle(half)));
}

// Straight creases are halved too: a facet beside one has no other long edge.
bool may_halve(const ShapedMesh& mesh, Edge edge) {
    if (shape_of(mesh, edge) < 0) {
        return false;
    }
    if (!mesh.work.is_line(edge)) {
        return true;
    }
    const Vector3d middle = middle_of(mesh, edge);
    for (const unsigned side : {0U, 1U}) {
        const Face face = mesh.work.mesh.face_handle(mesh.work.mesh.halfedge_handle(edge, side));
        if (!mesh.work.is_wall(face) || mesh.work.label(face).shape < 0 ||
            mesh.shapes[at(mesh.work.label(face).shape)].distance_mm(middle) >
                kStraight * mesh.work.length(edge)) {
            return false;
        }
    }
    return true;
}

// The longest edges first, each once. \return how many
int halve_once(ShapedMesh& mesh, double edge_mm) {
    struct Entry {
        double length;
        std::int32_t edge;
    };
    std::vector<Entry> entries;
    for (const Edge edge : mesh.work.mesh.edges()) {
        const double length = mesh.work.length(edge);
        if (length > edge_mm && may_halve(mesh, edge)) {
            entries.push_back({length, edge.idx()});
        }
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.length != b.length ? a.length > b.length : a.edge < b.edge;
    });
    // Those much shorter than the longest wait for the next round.
    constexpr double kThisRound = 0.7;
    int halved = 0;
    for (const Entry& entry : entries) {
        if (entry.length < kThisRound * entries.front().length) {
            break;
        }
        const Edge edge(entry.edge);
        const Vector3d chord = middle_of(mesh, edge);
        const Vector3d foot = mesh.shapes[at(shape_of(mesh, edge))].nearest(chord);
        const bool near =
            !mesh.work.is_line(edge) && (foot - chord).norm() <= kNearShare * entry.length;
        mesh.work.split(edge, near ? foot : chord);
        ++halved;
    }
    return halved;
}

// In rounds, until no edge is too long. \return how many
int halve_long(ShapedMesh& mesh, double edge_mm) {
    int count = 0;
    for (int round = 0; round < kMaxRounds; ++round) {
        const int halved = halve_once(mesh, edge_mm);
        if (halved == 0) {
            break;
        }
        count += halved;
        check_interrupt();
    }
    return count;
}

void flip(ShapedMesh& mesh) {
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round) {
        for (const Edge edge : mesh.work.mesh.edges()) {
            if (mesh.work.mesh.is_boundary(edge) || mesh.work.is_line(edge) ||
                shape_of(mesh, edge) < 0) {
                continue;
            }
            const auto [before, after] = mesh.work.angles(edge);
            if (after < before && mesh.work.may_flip(edge, kTurnCosine)) {
                mesh.work.flip(edge);
            }
        }
    }
}

}  // namespace

LongFacets halve_long_facets(const LabelledMesh& part, const std::vector<char>& kept,
                             double edge_mm, const std::vector<WallShape>& exact) {
    ShapedMesh mesh{WorkMesh(part, kept), exact};
    LongFacets found;
    const std::vector<Facet> facets = facets_of(mesh.work);
    found.residual_mm = residual_mm(mesh);
    found.residual_mm = std::max(found.residual_mm, add_shapes(facets, edge_mm, mesh));
    const double most =
        std::clamp(kMaxHalvesEach * static_cast<double>(facets.size()), kFewHalves, kMaxHalves);
    if (halves(mesh, edge_mm) <= most) {
        found.halved = halve_long(mesh, edge_mm);
    }
    if (found.halved > 0) {
        flip(mesh);
    }
    found.part = mesh.work.part();
    for (std::int32_t& shape : found.part.shape) {
        shape = shape < static_cast<std::int32_t>(exact.size()) ? shape : -1;
    }
    found.shapes = static_cast<int>(mesh.shapes.size());
    return found;
}

}  // namespace meshwind
