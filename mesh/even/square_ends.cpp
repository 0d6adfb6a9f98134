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
constexpr double kMostDepth = 0.25;
constexpr double kLeastDepth = 2e-3;

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

// A leg with its axis away from the part, and where it is cut along that.
struct Cut {
    RuledShape leg;
    double tolerance_mm = 0.0;  // of its vertices
    double height_mm = 0.0;     // over the leg's origin
    double depth_mm = 0.0;
    std::vector<std::int32_t> loop;  // vertices of the rim
};

class EndFinder {
public:
    EndFinder(const LabelledView& part, const std::vector<char>& kept)
        : part_(part),
          kept_(kept),
          ends_(ends_of(part, kept)),
          faces_at_(part.soup.points_mm.size()) {
        for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
            if (is_wall(static_cast<std::int32_t>(f))) {
                for (const std::int32_t v : part.soup.faces[f]) {
                    faces_at_[at(v)].push_back(static_cast<std::int32_t>(f));
                }
            }
        }
    }

    [[nodiscard]] std::vector<Cut> cuts(const std::optional<double>& depth_mm) const {
        std::vector<Cut> result;
        for (const Rim& rim : ends_.rims) {
            std::optional<Cut> cut = leg_at(rim);
            if (cut && (depth_mm ? cut_by(*cut, *depth_mm) : cut_where_it_ends(rim, *cut))) {
                result.push_back(std::move(*cut));
            }
        }
        return result;
    }

private:
    [[nodiscard]] const Vector3d& point_of(std::int32_t v) const {
        return part_.soup.points_mm[at(v)];
    }
    [[nodiscard]] bool is_wall(std::int32_t f) const { return kept_[at(part_.region[at(f)])] != 0; }

    [[nodiscard]] std::vector<std::int32_t> loop_of(const Rim& rim) const {
        std::vector<std::int32_t> loop;
        for (std::size_t f = 0; f < ends_.rim_of_edge.size(); ++f) {
            for (std::size_t e = 0; e < 3; ++e) {
                if (ends_.rim_of_edge[f][e] == rim.id) {
                    loop.push_back(part_.soup.faces[f][e]);
                    loop.push_back(part_.soup.faces[f][(e + 1) % 3]);
                }
            }
        }
        std::sort(loop.begin(), loop.end());
        loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
        return loop;
    }

    [[nodiscard]] RuledFacet facet_of(std::int32_t f) const {
        const auto& [a, b, c] = part_.soup.faces[at(f)];
        const Vector3d area = 0.5 * (point_of(b) - point_of(a)).cross(point_of(c) - point_of(a));
        const double size = area.norm();
        return {(point_of(a) + point_of(b) + point_of(c)) / 3.0,
                size > 0.0 ? Vector3d(area / size) : Vector3d::Zero(), size};
    }

    // Faces that hang together with the rim and have a vertex near it.
    [[nodiscard]] std::vector<std::int32_t> faces_near(const Rim& rim,
                                                       const std::vector<std::int32_t>& loop,
                                                       double reach) const {
        const auto near = [&](std::int32_t v) {
            const Vector3d arm = point_of(v) - rim.centre_mm;
            return rim.axis.dot(arm) > -reach * rim.radius_mm &&
                   arm.norm() < (1.5 + reach) * rim.radius_mm;
        };
        std::vector<char> reached(faces_at_.size(), 0);
        std::vector<std::int32_t> stack = loop;
        std::vector<std::int32_t> faces;
        for (const std::int32_t v : loop) {
            reached[at(v)] = 1;
        }
        while (!stack.empty()) {
            const std::int32_t v = stack.back();
            stack.pop_back();
            for (const std::int32_t f : faces_at_[at(v)]) {
                faces.push_back(f);
                for (const std::int32_t w : part_.soup.faces[at(f)]) {
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

    [[nodiscard]] std::optional<Cut> leg_at(const Rim& rim) const {
        const std::vector<std::int32_t> loop = loop_of(rim);
        for (const double reach : kLegReaches) {
            const std::vector<std::int32_t> near = faces_near(rim, loop, reach);
            for (const double lean : kLegLeans) {
                std::optional<RuledShape> leg = fit_leg(steep(near, rim, lean));
                if (leg) {
                    if (leg->axis.dot(rim.axis) < 0.0) {
                        leg->axis = -leg->axis;
                        leg->growth = -leg->growth;
                    }
                    Cut cut;
                    cut.leg = *leg;
                    cut.loop = loop;
                    cut.tolerance_mm =
                        std::max(kLeaves * leg->residual_mm, kRounding * leg->radius_mm);
                    return cut;
                }
            }
        }
        return std::nullopt;
    }

    // Facets that look away from the rim's axis and lean little to it.
    [[nodiscard]] std::vector<std::int32_t> steep(const std::vector<std::int32_t>& faces,
                                                  const Rim& rim, double lean) const {
        std::vector<std::int32_t> found;
        for (const std::int32_t f : faces) {
            const RuledFacet facet = facet_of(f);
            const Vector3d arm = facet.centre_mm - rim.centre_mm;
            const Vector3d outward = arm - rim.axis.dot(arm) * rim.axis;
            if (std::abs(facet.normal.dot(rim.axis)) < lean && facet.normal.dot(outward) > 0.0) {
                found.push_back(f);
            }
        }
        return found;
    }

    // What lies around its axis on one cylinder or cone. Facets with vertices off the others' are
    // left out.
    [[nodiscard]] std::optional<RuledShape> fit_leg(std::vector<std::int32_t> faces) const {
        constexpr int kRounds = 6;
        constexpr std::size_t kFew = 8;
        for (int round = 0; round < kRounds; ++round) {
            std::vector<std::int32_t> vertices;
            std::vector<RuledFacet> facets;
            for (const std::int32_t f : faces) {
                facets.push_back(facet_of(f));
                const auto& corners = part_.soup.faces[at(f)];
                vertices.insert(vertices.end(), corners.begin(), corners.end());
            }
            std::sort(vertices.begin(), vertices.end());
            vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
            std::vector<Vector3d> points;
            points.reserve(vertices.size());
            for (const std::int32_t v : vertices) {
                points.push_back(point_of(v));
            }
            const std::optional<RuledShape> shape =
                points.size() < kFew ? std::nullopt : fit_ruled_shape(points, facets);
            if (!shape) {
                return std::nullopt;
            }
            const double median = median_off_mm(*shape, faces);
            const double limit = std::max(
                {kFarOff * median, kRounding * shape->radius_mm, 0.1 * shape->residual_mm});
            if (shape->residual_mm <= limit || round + 1 == kRounds) {
                const bool is_leg = shape->residual_mm <= kOnLeg * shape->radius_mm &&
                                    gap_about_rad(*shape, facets) < kWidestGap_rad;
                return is_leg ? shape : std::nullopt;
            }
            const auto is_off = [&](std::int32_t f) {
                const auto& c = part_.soup.faces[at(f)];
                return std::any_of(c.begin(), c.end(), [&](std::int32_t v) {
                    return shape->distance_mm(point_of(v)) > limit;
                });
            };
            faces.erase(std::remove_if(faces.begin(), faces.end(), is_off), faces.end());
        }
        return std::nullopt;
    }

    // By area, so that the many vertices of a letter do not outvote the wall around it.
    [[nodiscard]] double median_off_mm(const RuledShape& shape,
                                       const std::vector<std::int32_t>& faces) const {
        std::vector<std::pair<double, double>> off;  // and area
        double all = 0.0;
        for (const std::int32_t f : faces) {
            double farthest = 0.0;
            for (const std::int32_t v : part_.soup.faces[at(f)]) {
                farthest = std::max(farthest, shape.distance_mm(point_of(v)));
            }
            off.emplace_back(farthest, facet_of(f).area_mm2);
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

    [[nodiscard]] static double gap_about_rad(const RuledShape& leg,
                                              const std::vector<RuledFacet>& facets) {
        const Vector3d u = leg.axis.unitOrthogonal();
        const Vector3d v = leg.axis.cross(u);
        std::vector<double> angles;
        angles.reserve(facets.size());
        for (const RuledFacet& facet : facets) {
            angles.push_back(std::atan2(v.dot(facet.normal), u.dot(facet.normal)));
        }
        return widest_gap_rad(std::move(angles));
    }

    [[nodiscard]] static double height_mm(const RuledShape& leg, const Vector3d& p) {
        return leg.axis.dot(p - leg.origin_mm);
    }

    [[nodiscard]] double farthest_mm(const Cut& cut) const {
        double farthest = -1e300;
        for (const std::int32_t v : cut.loop) {
            farthest = std::max(farthest, height_mm(cut.leg, point_of(v)));
        }
        return farthest;
    }

    [[nodiscard]] bool cut_by(Cut& cut, double depth_mm) const {
        cut.depth_mm = depth_mm;
        cut.height_mm = farthest_mm(cut) - depth_mm;
        return depth_mm > 0.0;
    }

    // How far inside the leg's surface.
    [[nodiscard]] double inside_mm(const Cut& cut, std::int32_t v) const {
        const RuledShape& leg = cut.leg;
        const Vector3d arm = point_of(v) - leg.origin_mm;
        const double z = leg.axis.dot(arm);
        return leg.radius_mm + leg.growth * z - (arm - z * leg.axis).norm();
    }

    [[nodiscard]] bool cut_where_it_ends(const Rim& rim, Cut& cut) const {
        const double radius = cut.leg.radius_mm;
        double farthest = farthest_mm(cut);
        double nearest = farthest;
        std::vector<char> reached(faces_at_.size(), 0);
        std::vector<std::int32_t> stack;
        for (const std::int32_t v : cut.loop) {
            nearest = std::min(nearest, height_mm(cut.leg, point_of(v)));
            reached[at(v)] = 1;
            if (inside_mm(cut, v) > cut.tolerance_mm) {
                stack.push_back(v);
            }
        }
        if (stack.empty() && rim.circularity_mm <= kLeastDepth * radius) {
            return false;
        }
        // From the rim along what lies inside the leg, to the first vertices that lie on it, but
        // for so much.
        double off_mm = cut.leg.residual_mm;
        while (!stack.empty() && farthest - nearest <= kMostDepth * radius) {
            const std::int32_t v = stack.back();
            stack.pop_back();
            for (const std::int32_t f : faces_at_[at(v)]) {
                for (const std::int32_t w : part_.soup.faces[at(f)]) {
                    if (reached[at(w)] != 0) {
                        continue;
                    }
                    reached[at(w)] = 1;
                    const double height = height_mm(cut.leg, point_of(w));
                    nearest = std::min(nearest, height);
                    farthest = std::max(farthest, height);
                    const double inside = inside_mm(cut, w);
                    if (inside > cut.tolerance_mm) {
                        stack.push_back(w);
                    } else {
                        off_mm = std::max(off_mm, inside + cut.leg.residual_mm);
                    }
                }
            }
        }
        // A round lip goes on that far beyond its last vertex, and there its normals still lean.
        nearest -= std::sqrt(2.0 * off_mm * (farthest - nearest));
        cut.depth_mm = farthest - nearest;
        cut.height_mm = nearest;
        return cut.depth_mm > kLeastDepth * radius && cut.depth_mm <= kMostDepth * radius;
    }

    const LabelledView& part_;
    const std::vector<char>& kept_;
    Ends ends_;
    std::vector<std::vector<std::int32_t>> faces_at_;  // of the wall, per vertex
};

// Splits the wall's edges at the plane and gives what lies beyond it the region `end`.
void cut_off(WorkMesh& work, const Cut& cut, std::int32_t end) {
    const double tolerance = kInPlane * cut.leg.radius_mm;
    const auto height = [&](WorkMesh::Vertex v) {
        return cut.leg.axis.dot(work.at(v) - cut.leg.origin_mm) - cut.height_mm;
    };
    // Faces that reach beyond the plane and hang together with the rim.
    const auto beyond = [&] {
        std::vector<char> seen(work.mesh.n_faces(), 0);
        std::vector<WorkMesh::Face> faces;
        std::vector<WorkMesh::Vertex> stack;
        std::vector<char> reached(work.mesh.n_vertices(), 0);
        for (const std::int32_t v : cut.loop) {
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
    };
    std::vector<WorkMesh::Edge> edges;
    for (const WorkMesh::Face face : beyond()) {
        for (const auto half : work.mesh.fh_range(face)) {
            edges.push_back(work.mesh.edge_handle(half));
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const WorkMesh::Edge edge : edges) {
        const auto half = work.mesh.halfedge_handle(edge, 0);
        const WorkMesh::Vertex a = work.mesh.from_vertex_handle(half);
        const WorkMesh::Vertex b = work.mesh.to_vertex_handle(half);
        const double ha = height(a);
        const double hb = height(b);
        if (std::min(ha, hb) >= -tolerance || std::max(ha, hb) <= tolerance) {
            continue;
        }
        const Vector3d chord = work.at(a) + ha / (ha - hb) * (work.at(b) - work.at(a));
        // Chords of a round wall are inside it.
        const Vector3d on_leg = cut.leg.nearest(chord);
        const bool near = (on_leg - chord).norm() <= 2.0 * kOnLeg * cut.leg.radius_mm;
        Vector3d point = near ? on_leg : chord;
        point -= (cut.leg.axis.dot(point - cut.leg.origin_mm) - cut.height_mm) * cut.leg.axis;
        work.split(edge, point);
    }
    for (const WorkMesh::Face face : beyond()) {
        work.label(face).region = end;
        work.label(face).wall = false;
    }
}

}  // namespace

std::optional<SquareEnds> square_ends(const LabelledView& part, const std::vector<char>& kept,
                                      const std::optional<double>& depth_mm) {
    const std::vector<Cut> cuts = EndFinder(part, kept).cuts(depth_mm);
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
        const Vector3d centre = cut.leg.origin_mm + cut.height_mm * cut.leg.axis;
        result.cuts.push_back({centre, cut.depth_mm});
    }
    result.part = work.part();
    return result;
}

}  // namespace meshwind
