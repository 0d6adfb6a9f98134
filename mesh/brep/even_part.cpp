#include "mesh/brep/even_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "core/index.h"
#include "mesh/edge_table.h"
#include "mesh/even/even_mesh.h"
#include "mesh/even/slivers.h"
#include "mesh/even/wall_surface.h"
#include "mesh/even/work_mesh.h"
#include "mesh/smooth/freeze.h"
#include "mesh/smooth/patch.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A vertex is moved onto its face by less than this share of its shortest edge; what is farther off
// was led astray on its way, and stays.
constexpr double kMaxSnap = 0.2;

// The middle of an edge is off the middle of its chord by less than this share of the chord: on the
// way about half a cylinder. What is farther off is another place.
constexpr double kMaxLift = 0.5;

// Short edges of narrow triangles, and what vertices that are left out may be off the triangles
// that stay, by the part's size: of the first mesh, which has points where edges are bent.
constexpr double kShortEdge = 0.02;
constexpr double kLeftOut = 1e-5;

// Rounded lips and the like take few triangles: two along a quarter of a turn. What is wound of
// them is known exactly all the same.
constexpr double kMaxTurn_rad = 0.7;
constexpr double kGrading = 0.35;

// A part of more triangles than this, and than so many times those of its longest edge, has
// roundings far smaller than itself. Their edges are made longer by a factor, from a share of the
// least edge on, until it has no more.
constexpr double kMaxTriangles = 60000.0;
constexpr double kMaxRefined = 2.0;
constexpr double kLonger = 1.4;
constexpr double kShortest = 0.02;

LabelledMesh labelled(const TriangleSoup& soup, std::span<const std::int32_t> face) {
    LabelledMesh part{soup, {face.begin(), face.end()}, {}};
    const auto neighbours = face_neighbours(soup.faces);
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        auto& feature = part.feature.emplace_back();
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t next = neighbours[f][e];
            feature[e] = next != kNoFace && face[at(next)] != face[f] ? 1 : 0;
        }
    }
    return part;
}

// Halves edges until none is longer, the longest first. New vertices lie on the faces and their
// edges.
class Halving {
public:
    Halving(const LabelledMesh& part, const std::vector<char>& all, ExactFaces& exact,
            double longest_mm)
        : work_(part, all), exact_(exact), longest_mm_(longest_mm) {}

    [[nodiscard]] LabelledMesh run() {
        for (const Edge edge : work_.mesh.edges()) {
            add(edge);
        }
        while (!queue_.empty()) {
            const auto [length_mm, index] = queue_.top();
            queue_.pop();
            const Edge edge(index);
            if (work_.length(edge) != length_mm) {
                continue;  // halved before
            }
            const WorkMesh::Vertex middle = work_.split(edge, middle_of(edge));
            for (const Edge around : work_.mesh.ve_range(middle)) {
                add(around);
            }
        }
        return work_.part();
    }

private:
    using Edge = WorkMesh::Edge;
    using Entry = std::pair<double, int>;
    struct Later {
        bool operator()(const Entry& a, const Entry& b) const {
            return a.first != b.first ? a.first < b.first : a.second > b.second;
        }
    };

    void add(Edge edge) {
        if (work_.length(edge) > longest_mm_) {
            queue_.emplace(work_.length(edge), edge.idx());
        }
    }

    [[nodiscard]] std::int32_t label(Edge edge, unsigned side) const {
        const auto face = work_.mesh.face_handle(work_.mesh.halfedge_handle(edge, side));
        return face.is_valid() ? work_.label(face).region : -1;
    }

    [[nodiscard]] Vector3d middle_of(Edge edge) {
        const WorkMesh::Halfedge half = work_.mesh.halfedge_handle(edge, 0);
        const Vector3d chord = 0.5 * (work_.at(work_.mesh.from_vertex_handle(half)) +
                                      work_.at(work_.mesh.to_vertex_handle(half)));
        const auto [other, here] = std::minmax({label(edge, 0), label(edge, 1)});
        const auto found =
            here == other ? exact_.on_face(here, chord) : exact_.on_border(here, other, chord);
        return found && (*found - chord).norm() < kMaxLift * work_.length(edge) ? *found : chord;
    }

    WorkMesh work_;
    ExactFaces& exact_;
    double longest_mm_;
    std::priority_queue<Entry, std::vector<Entry>, Later> queue_;
};

// The start with the exact surface about its corners.
Surface exact_wall(const LabelledMesh& part, const std::vector<char>& all, ExactFaces& exact) {
    Surface wall = frozen_wall(part, all);
    std::vector<char> done(wall.normal.size(), 0);
    for (std::size_t f = 0; f < wall.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t corner = at(wall.corner[f][c]);
            if (std::exchange(done[corner], 1) != 0) {
                continue;
            }
            const std::size_t v = at(wall.face[f][c]);
            const Vector3d& p = wall.position_mm[v];
            // Without terms that would grow along an edge from end to end of the part.
            if (const auto jet = exact.jet(wall.region[f], p, 0.0)) {
                set_jet(wall, corner, *jet);
            }
        }
    }
    return wall;
}

// The shortest edges that the part can afford, 0 where it can afford any.
double affordable_edge_mm(const Surface& wall, EvenMeshOptions options) {
    options.shortest_mm = options.longest_mm;
    const double most = std::max(kMaxTriangles, kMaxRefined * wanted_triangles(wall, options));
    options.shortest_mm = 0.0;
    while (wanted_triangles(wall, options) > most) {
        options.shortest_mm = std::max(kLonger * options.shortest_mm, kShortest * options.least_mm);
    }
    return options.shortest_mm;
}

// What meets at a vertex.
struct Meeting {
    std::set<std::int32_t> faces;
    bool open = false;  // on an edge with one triangle
    double shortest_mm = std::numeric_limits<double>::infinity();
    double longest_mm = 0.0;
};

std::vector<Meeting> meetings(const LabelledMesh& part) {
    std::vector<Meeting> at_vertex(part.soup.points_mm.size());
    const auto neighbours = face_neighbours(part.soup.faces);
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t a = part.soup.faces[f][e];
            const std::int32_t b = part.soup.faces[f][(e + 1) % 3];
            const double length = (part.soup.points_mm[at(a)] - part.soup.points_mm[at(b)]).norm();
            for (const std::int32_t v : {a, b}) {
                Meeting& meeting = at_vertex[at(v)];
                meeting.faces.insert(part.region[f]);
                meeting.open = meeting.open || neighbours[f][e] == kNoFace;
                meeting.shortest_mm = std::min(meeting.shortest_mm, length);
                meeting.longest_mm = std::max(meeting.longest_mm, length);
            }
        }
    }
    return at_vertex;
}

void snap(LabelledMesh& part, const std::vector<Meeting>& at_vertex, ExactFaces& exact) {
    for (std::size_t v = 0; v < at_vertex.size(); ++v) {
        const Meeting& meeting = at_vertex[v];
        Vector3d& p = part.soup.points_mm[v];
        std::optional<Vector3d> target;
        if (meeting.faces.size() == 1) {
            const std::int32_t face = *meeting.faces.begin();
            target = meeting.open ? exact.on_border(face, -1, p) : exact.on_face(face, p);
        } else if (meeting.faces.size() == 2 && !meeting.open) {
            target = exact.on_border(*meeting.faces.begin(), *meeting.faces.rbegin(), p);
        }
        if (target && (*target - p).norm() <= kMaxSnap * meeting.shortest_mm) {
            p = *target;
        }
    }
}

void add_jets(const std::vector<Meeting>& at_vertex, ExactFaces& exact, CadMesh& mesh) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> known;  // of vertex and face
    for (std::size_t f = 0; f < mesh.soup.faces.size(); ++f) {
        auto& jets = mesh.jet.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int32_t v = mesh.soup.faces[f][c];
            const auto [found, is_new] = known.try_emplace({v, mesh.face[f]}, -1);
            if (is_new) {
                const Vector3d& p = mesh.soup.points_mm[at(v)];
                if (const auto jet = exact.jet(mesh.face[f], p, at_vertex[at(v)].longest_mm)) {
                    found->second = static_cast<std::int32_t>(mesh.jets.size());
                    mesh.jets.push_back(*jet);
                }
            }
            jets[c] = found->second;
        }
    }
}

}  // namespace

CadMesh even_part(const TriangleSoup& start, std::span<const std::int32_t> face, ExactFaces& exact,
                  double edge_mm) {
    LabelledMesh part = labelled(start, face);
    const std::int32_t faces = 1 + *std::max_element(face.begin(), face.end());
    const std::vector<char> all(at(faces), 1);
    const double size = size_mm(part, all);
    EvenMeshOptions options = even_options(size);
    options.most_turn = kMaxTurn_rad;
    options.grading = kGrading;
    if (edge_mm > 0.0) {
        options.longest_mm = edge_mm;
        options.least_mm = std::min(options.least_mm, edge_mm);
    }
    part = without_slivers(part, all, kShortEdge * size, kLeftOut * size);
    part = Halving(part, all, exact, options.longest_mm).run();
    part = without_slivers(part, all, kShortEdge * size, kLeftOut * size);
    Surface wall = exact_wall(part, all, exact);
    options.shortest_mm = affordable_edge_mm(wall, options);
    part = even_mesh(part, all, std::move(wall), options);
    snap(part, meetings(part), exact);
    CadMesh mesh;
    mesh.soup = std::move(part.soup);
    mesh.face = std::move(part.region);
    add_jets(meetings({mesh.soup, mesh.face, {}}), exact, mesh);
    return mesh;
}

}  // namespace meshwind
