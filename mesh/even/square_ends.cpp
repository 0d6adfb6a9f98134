#include "mesh/even/square_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>

#include "core/angle_gap.h"
#include "core/index.h"
#include "mesh/even/ruled_shape.h"
#include "mesh/even/work_mesh.h"
#include "mesh/segment/rims.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// The leg is looked for within so many radii of the rim, where a socket may end soon, among facets
// that lean to its axis by less than these sines: the nearest and steepest first.
constexpr std::array kLegReaches = {0.5, 1.5};
constexpr std::array kLegLeans = {0.03, 0.1, 0.3};

// Vertices of the leg lie on it within this share of its radius: at most, and at least.
constexpr double kOnLeg = 5e-3;
constexpr double kRounding = 1e-4;

// Facets farther off the leg than so many times their median are left out of its fit; where the
// wall leaves the leg, its vertices are farther off than so many times the fit's residual.
constexpr double kFarOff = 3.0;
constexpr double kLeaves = 5.0;

// An end loses this share of its radius at most, and a rim with less beyond its circle is one.
constexpr double kMaxDepth = 0.25;
constexpr double kMinDepth = 2e-3;

// Facets seen from the leg's axis leave no wider gap than this between them.
constexpr double kWidestGap_rad = 2.1;

// A vertex this near to the plane of the cut, as a share of the radius, lies in it.
constexpr double kInPlane = 1e-4;

// The wall's faces and the rims they end at, by the numbers of the part.
struct Ends {
    std::vector<std::array<std::int32_t, 3>> rim_of_edge;  // per face of the part, -1 elsewhere
    std::vector<Rim> rims;
};

Ends ends_of(const LabelledView& part, const std::vector<char>& kept) {
    Rims found = find_rims(wall_of(part, kept).soup);
    Ends ends;
    ends.rim_of_edge.assign(part.soup.faces.size(), {-1, -1, -1});
    std::size_t next = 0;  // the wall has its faces in the part's order
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (kept[at(part.region[f])] != 0) {
            ends.rim_of_edge[f] = found.of_edge[next++];
        }
    }
    ends.rims = std::move(found.rims);
    return ends;
}

// The wall of a part, and where it ends.
struct WallFaces {
    const LabelledView& part;
    Ends ends;
    std::vector<std::vector<std::int32_t>> faces_at;  // of the wall, per vertex

    [[nodiscard]] const Vector3d& point(std::int32_t v) const { return part.soup.points_mm[at(v)]; }
};

WallFaces wall_faces(const LabelledView& part, const std::vector<char>& kept) {
    WallFaces wall{part, ends_of(part, kept), {}};
    wall.faces_at.resize(part.soup.points_mm.size());
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (kept[at(part.region[f])] != 0) {
            for (const std::int32_t v : part.soup.faces[f]) {
                wall.faces_at[at(v)].push_back(static_cast<std::int32_t>(f));
            }
        }
    }
    return wall;
}

// What the wall has behind a rim.
struct Leg {
    RuledShape shape;                // its axis away from the part
    double tolerance_mm = 0.0;       // of its vertices
    std::vector<std::int32_t> loop;  // vertices of the rim
};

// Where a leg is cut along its axis.
struct Cut {
    Leg leg;
    double height_mm = 0.0;  // over the leg's origin
    double depth_mm = 0.0;
};

std::vector<std::int32_t> loop_of(const WallFaces& wall, const Rim& rim) {
    std::vector<std::int32_t> loop;
    for (std::size_t f = 0; f < wall.ends.rim_of_edge.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (wall.ends.rim_of_edge[f][e] == rim.id) {
                loop.push_back(wall.part.soup.faces[f][e]);
                loop.push_back(wall.part.soup.faces[f][(e + 1) % 3]);
            }
        }
    }
    std::sort(loop.begin(), loop.end());
    loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
    return loop;
}

// Faces that hang together with the rim and have a vertex near it.
std::vector<std::int32_t> faces_near(const WallFaces& wall, const Rim& rim,
                                     const std::vector<std::int32_t>& loop, double reach) {
    const auto near = [&](std::int32_t v) {
        const Vector3d arm = wall.point(v) - rim.centre_mm;
        return rim.axis.dot(arm) > -reach * rim.radius_mm &&
               arm.norm() < (1.5 + reach) * rim.radius_mm;
    };
    std::vector<char> reached(wall.faces_at.size(), 0);
    std::vector<std::int32_t> stack = loop;
    std::vector<std::int32_t> faces;
    for (const std::int32_t v : loop) {
        reached[at(v)] = 1;
    }
    while (!stack.empty()) {
        const std::int32_t v = stack.back();
        stack.pop_back();
        for (const std::int32_t f : wall.faces_at[at(v)]) {
            faces.push_back(f);
            for (const std::int32_t w : wall.part.soup.faces[at(f)]) {
                if (reached[at(w)] == 0 && near(w)) {
                    reached[at(w)] = 1;
                    stack.push_back(w);
                }
            }
        }
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

RuledFacet facet_of(const WallFaces& wall, std::int32_t f) {
    const auto& [a, b, c] = wall.part.soup.faces[at(f)];
    const Vector3d area =
        0.5 * (wall.point(b) - wall.point(a)).cross(wall.point(c) - wall.point(a));
    const double size = area.norm();
    return {(wall.point(a) + wall.point(b) + wall.point(c)) / 3.0,
            size > 0.0 ? Vector3d(area / size) : Vector3d::Zero(), size};
}

// Facets that look away from the rim's axis and lean little to it.
std::vector<std::int32_t> steep(const WallFaces& wall, const std::vector<std::int32_t>& faces,
                                const Rim& rim, double lean) {
    std::vector<std::int32_t> found;
    for (const std::int32_t f : faces) {
        const RuledFacet facet = facet_of(wall, f);
        const Vector3d arm = facet.centre_mm - rim.centre_mm;
        const Vector3d outward = arm - rim.axis.dot(arm) * rim.axis;
        if (std::abs(facet.normal.dot(rim.axis)) < lean && facet.normal.dot(outward) > 0.0) {
            found.push_back(f);
        }
    }
    return found;
}

// By area, so that the many vertices of a letter do not outvote the wall around it.
double median_off_mm(const WallFaces& wall, const RuledShape& shape,
                     const std::vector<std::int32_t>& faces) {
    std::vector<std::pair<double, double>> off;  // and area
    double all = 0.0;
    for (const std::int32_t f : faces) {
        double farthest = 0.0;
        for (const std::int32_t v : wall.part.soup.faces[at(f)]) {
            farthest = std::max(farthest, shape.distance_mm(wall.point(v)));
        }
        off.emplace_back(farthest, facet_of(wall, f).area_mm2);
        all += off.back().second;
    }
    std::sort(off.begin(), off.end());
    double below = 0.0;
    for (const auto& [distance, area] : off) {
        below += area;
        if (2.0 * below >= all) {
            return distance;
        }
    }
    return 0.0;
}

double gap_about_rad(const RuledShape& leg, const std::vector<RuledFacet>& facets) {
    const Vector3d u = leg.axis.unitOrthogonal();
    const Vector3d v = leg.axis.cross(u);
    std::vector<double> angles;
    angles.reserve(facets.size());
    for (const RuledFacet& facet : facets) {
        angles.push_back(std::atan2(v.dot(facet.normal), u.dot(facet.normal)));
    }
    return widest_gap_rad(std::move(angles));
}

// What lies around its axis on one cylinder or cone. Facets with vertices off the others' are
// left out.
std::optional<RuledShape> fit_leg(const WallFaces& wall, std::vector<std::int32_t> faces) {
    constexpr int kRounds = 6;
    constexpr std::size_t kFew = 8;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<std::int32_t> vertices;
        std::vector<RuledFacet> facets;
        for (const std::int32_t f : faces) {
            facets.push_back(facet_of(wall, f));
            const auto& corners = wall.part.soup.faces[at(f)];
            vertices.insert(vertices.end(), corners.begin(), corners.end());
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        std::vector<Vector3d> points;
        points.reserve(vertices.size());
        for (const std::int32_t v : vertices) {
            points.push_back(wall.point(v));
        }
        const std::optional<RuledShape> shape =
            points.size() < kFew ? std::nullopt : fit_ruled_shape(points, facets);
        if (!shape) {
            return std::nullopt;
        }
        const double median = median_off_mm(wall, *shape, faces);
        const double limit =
            std::max({kFarOff * median, kRounding * shape->radius_mm, 0.1 * shape->residual_mm});
        if (shape->residual_mm <= limit || round + 1 == kRounds) {
            const bool is_leg = shape->residual_mm <= kOnLeg * shape->radius_mm &&
                                gap_about_rad(*shape, facets) < kWidestGap_rad;
            return is_leg ? shape : std::nullopt;
        }
        const auto is_off = [&](std::int32_t f) {
            const auto& c = wall.part.soup.faces[at(f)];
            return std::any_of(c.begin(), c.end(), [&](std::int32_t v) {
                return shape->distance_mm(wall.point(v)) > limit;
            });
        };
        faces.erase(std::remove_if(faces.begin(), faces.end(), is_off), faces.end());
    }
    return std::nullopt;
}

std::optional<Leg> leg_at(const WallFaces& wall, const Rim& rim) {
    const std::vector<std::int32_t> loop = loop_of(wall, rim);
    for (const double reach : kLegReaches) {
        const std::vector<std::int32_t> near = faces_near(wall, rim, loop, reach);
        for (const double lean : kLegLeans) {
            std::optional<RuledShape> shape = fit_leg(wall, steep(wall, near, rim, lean));
            if (shape) {
                if (shape->axis.dot(rim.axis) < 0.0) {
                    shape->axis = -shape->axis;
                    shape->growth = -shape->growth;
                }
                return Leg{*shape,
                           std::max(kLeaves * shape->residual_mm, kRounding * shape->radius_mm),
                           loop};
            }
        }
    }
    return std::nullopt;
}

double height_mm(const RuledShape& leg, const Vector3d& p) {
    return leg.axis.dot(p - leg.origin_mm);
}

// Height of the vertex of the rim farthest along the leg's axis.
double farthest_mm(const WallFaces& wall, const Leg& leg) {
    double farthest = -1e300;
    for (const std::int32_t v : leg.loop) {
        farthest = std::max(farthest, height_mm(leg.shape, wall.point(v)));
    }
    return farthest;
}

// How far inside the leg's surface.
double inside_mm(const RuledShape& leg, const Vector3d& p) {
    const Vector3d arm = p - leg.origin_mm;
    const double z = leg.axis.dot(arm);
    return leg.radius_mm + leg.growth * z - (arm - z * leg.axis).norm();
}

// Where a leg begins whose wall goes inside it before its rim, or whose rim is uneven; none where
// it does neither, or where the cut would take too little or too much.
std::optional<Cut> cut_where_it_ends(const WallFaces& wall, const Rim& rim, Leg leg) {
    const double radius = leg.shape.radius_mm;
    double farthest = farthest_mm(wall, leg);
    double nearest = farthest;
    std::vector<char> reached(wall.faces_at.size(), 0);
    std::vector<std::int32_t> stack;
    for (const std::int32_t v : leg.loop) {
        nearest = std::min(nearest, height_mm(leg.shape, wall.point(v)));
        reached[at(v)] = 1;
        if (inside_mm(leg.shape, wall.point(v)) > leg.tolerance_mm) {
            stack.push_back(v);
        }
    }
    if (stack.empty() && rim.circularity_mm <= kMinDepth * radius) {
        return std::nullopt;
    }
    // From the rim along what lies inside the leg, to the first vertices that lie on it, but
    // for so much.
    double off_mm = leg.shape.residual_mm;
    while (!stack.empty() && farthest - nearest <= kMaxDepth * radius) {
        const std::int32_t v = stack.back();
        stack.pop_back();
        for (const std::int32_t f : wall.faces_at[at(v)]) {
            for (const std::int32_t w : wall.part.soup.faces[at(f)]) {
                if (reached[at(w)] != 0) {
                    continue;
                }
                reached[at(w)] = 1;
                const double height = height_mm(leg.shape, wall.point(w));
                nearest = std::min(nearest, height);
                farthest = std::max(farthest, height);
                const double inside = inside_mm(leg.shape, wall.point(w));
                if (inside > leg.tolerance_mm) {
                    stack.push_back(w);
                } else {
                    off_mm = std::max(off_mm, inside + leg.shape.residual_mm);
                }
            }
        }
    }
    // A round lip goes on that far beyond its last vertex, and there its normals still lean.
    nearest -= std::sqrt(2.0 * off_mm * (farthest - nearest));
    const double depth = farthest - nearest;
    if (!(depth > kMinDepth * radius && depth <= kMaxDepth * radius)) {
        return std::nullopt;
    }
    return Cut{std::move(leg), nearest, depth};
}

// None where nothing is to be cut.
std::optional<Cut> cut_by(const WallFaces& wall, Leg leg, double depth_mm) {
    if (!(depth_mm > 0.0)) {
        return std::nullopt;
    }
    const double height = farthest_mm(wall, leg) - depth_mm;
    return Cut{std::move(leg), height, depth_mm};
}

// \param depth_mm of all cuts; none: each leg is cut where it ends
std::vector<Cut> cuts_of(const WallFaces& wall, const std::optional<double>& depth_mm) {
    std::vector<Cut> result;
    for (const Rim& rim : wall.ends.rims) {
        std::optional<Leg> leg = leg_at(wall, rim);
        if (!leg) {
            continue;
        }
        std::optional<Cut> cut = depth_mm ? cut_by(wall, std::move(*leg), *depth_mm)
                                          : cut_where_it_ends(wall, rim, std::move(*leg));
        if (cut) {
            result.push_back(std::move(*cut));
        }
    }
    return result;
}

// Height over the plane of the cut.
double over_mm(const Cut& cut, const Vector3d& p) {
    return cut.leg.shape.axis.dot(p - cut.leg.shape.origin_mm) - cut.height_mm;
}

// A vertex this near to the plane of the cut lies in it.
double plane_tolerance_mm(const Cut& cut) {
    return kInPlane * cut.leg.shape.radius_mm;
}

// Faces that reach beyond the plane and hang together with the rim.
std::vector<WorkMesh::Face> faces_beyond(const WorkMesh& work, const Cut& cut) {
    const double tolerance = plane_tolerance_mm(cut);
    const auto height = [&](WorkMesh::Vertex v) { return over_mm(cut, work.at(v)); };
    std::vector<char> seen(work.mesh.n_faces(), 0);
    std::vector<WorkMesh::Face> faces;
    std::vector<WorkMesh::Vertex> stack;
    std::vector<char> reached(work.mesh.n_vertices(), 0);
    for (const std::int32_t v : cut.leg.loop) {
        stack.push_back(WorkMesh::Vertex(v));
        reached[at(v)] = 1;
    }
    while (!stack.empty()) {
        const WorkMesh::Vertex v = stack.back();
        stack.pop_back();
        for (const WorkMesh::Face face : work.mesh.vf_range(v)) {
            if (!work.is_wall(face) || seen[at(face.idx())] != 0) {
                continue;
            }
            seen[at(face.idx())] = 1;
            double highest = -1e300;
            for (const WorkMesh::Vertex w : work.mesh.fv_range(face)) {
                highest = std::max(highest, height(w));
            }
            if (highest <= tolerance) {
                continue;
            }
            faces.push_back(face);
            for (const WorkMesh::Vertex w : work.mesh.fv_range(face)) {
                if (reached[at(w.idx())] == 0 && height(w) > tolerance) {
                    reached[at(w.idx())] = 1;
                    stack.push_back(w);
                }
            }
        }
    }
    return faces;
}

// Each once, by number.
std::vector<WorkMesh::Edge> edges_of(const WorkMesh& work,
                                     const std::vector<WorkMesh::Face>& faces) {
    std::vector<WorkMesh::Edge> edges;
    for (const WorkMesh::Face face : faces) {
        for (const auto half : work.mesh.fh_range(face)) {
            edges.push_back(work.mesh.edge_handle(half));
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

// Where the chord between heights `ha` and `hb` crosses the plane, on the leg where it is near.
Vector3d crossing_mm(const Cut& cut, const Vector3d& a, double ha, const Vector3d& b, double hb) {
    const RuledShape& leg = cut.leg.shape;
    const Vector3d chord = a + ha / (ha - hb) * (b - a);
    // Chords of a round wall are inside it.
    const Vector3d on_leg = leg.nearest(chord);
    const bool near = (on_leg - chord).norm() <= 2.0 * kOnLeg * leg.radius_mm;
    Vector3d point = near ? on_leg : chord;
    point -= (leg.axis.dot(point - leg.origin_mm) - cut.height_mm) * leg.axis;
    return point;
}

// Splits the wall's edges at the plane and gives what lies beyond it the region `end`.
void cut_off(WorkMesh& work, const Cut& cut, std::int32_t end) {
    const double tolerance = plane_tolerance_mm(cut);
    for (const WorkMesh::Edge edge : edges_of(work, faces_beyond(work, cut))) {
        const auto half = work.mesh.halfedge_handle(edge, 0);
        const Vector3d a = work.at(work.mesh.from_vertex_handle(half));
        const Vector3d b = work.at(work.mesh.to_vertex_handle(half));
        const double ha = over_mm(cut, a);
        const double hb = over_mm(cut, b);
        if (std::min(ha, hb) >= -tolerance || std::max(ha, hb) <= tolerance) {
            continue;
        }
        work.split(edge, crossing_mm(cut, a, ha, b, hb));
    }
    for (const WorkMesh::Face face : faces_beyond(work, cut)) {
        work.label(face).region = end;
        work.label(face).wall = false;
    }
}

}  // namespace

std::optional<SquareEnds> square_ends(const LabelledView& part, const std::vector<char>& kept,
                                      const std::optional<double>& depth_mm) {
    const std::vector<Cut> cuts = cuts_of(wall_faces(part, kept), depth_mm);
    if (cuts.empty()) {
        return std::nullopt;
    }
    SquareEnds result{{}, kept, {}};
    WorkMesh work({part.soup,
                   {part.region.begin(), part.region.end()},
                   {part.feature.begin(), part.feature.end()}},
                  kept);
    for (const Cut& cut : cuts) {
        cut_off(work, cut, static_cast<std::int32_t>(result.kept.size()));
        result.kept.push_back(0);
        const Vector3d centre = cut.leg.shape.origin_mm + cut.height_mm * cut.leg.shape.axis;
        result.cuts.push_back({centre, cut.depth_mm});
    }
    result.part = work.part();
    return result;
}

}  // namespace meshwind
