#include "mesh/even/details.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/interrupt.h"
#include "mesh/edge_table.h"
#include "mesh/even/enclosed_places.h"
#include "mesh/even/fair.h"
#include "mesh/even/rolling_ball.h"
#include "mesh/even/ruled_shape.h"
#include "mesh/ray_query.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A detail takes less of the wall than this.
constexpr double kDetailShare = 0.05;

// More places out of reach than this are a rough wall, not lettering.
constexpr std::size_t kMostPlaces = 2000;

// Share of a detail's outline that lies in one region of the wall: lettering across a crease stays.
constexpr double kOneRegion = 0.8;

// A detail stands on the wall by flanks: this share of its area at least is turned by more than
// this from the wall that goes on under it. The two sides of a crotch are not.
constexpr double kFlankShare = 0.03;
constexpr double kFlankCosine = 0.5;  // 60 degrees

// The wall around a detail does not turn by more than this (70 degrees) within the ball's diameter.
constexpr double kAroundCosine = 0.34;

// So many rings of triangles around a detail tell which cylinder or cone it stands on.
constexpr int kRings = 3;

// The wall lies on that within this share of what counts as a detail; what does not is left out in
// so many fits at most.
constexpr double kGroundShare = 0.1;
constexpr int kMostFits = 6;

// Faces are added around vertices where an outline touches itself so many times at most.
constexpr int kMostMends = 4;

Vector3d normal_of(const TriangleSoup& soup, const std::array<std::int32_t, 3>& face) {
    const Vector3d& a = soup.points_mm[at(face[0])];
    return (soup.points_mm[at(face[1])] - a).cross(soup.points_mm[at(face[2])] - a).normalized();
}

Vector3d middle_of(const TriangleSoup& soup, const std::array<std::int32_t, 3>& face) {
    return (soup.points_mm[at(face[0])] + soup.points_mm[at(face[1])] +
            soup.points_mm[at(face[2])]) /
           3.0;
}

using Neighbours = std::vector<std::array<std::int32_t, 3>>;

// Edges of faces that stay, next to faces that go.
struct BorderEdge {
    std::int32_t face = 0;
    std::int32_t edge = 0;
};

std::vector<BorderEdge> border_of(const Neighbours& neighbours,
                                  const std::set<std::int32_t>& gone) {
    std::vector<BorderEdge> border;
    for (const std::int32_t f : gone) {
        for (const std::int32_t g : neighbours[at(f)]) {
            if (g >= 0 && gone.count(g) == 0) {
                border.push_back({g, shared_edge(neighbours[at(g)], f)});
            }
        }
    }
    return border;
}

// The part while details are taken off: faces are struck out, and those of fills added.
class Work {
public:
    Work(const LabelledMesh& part, const std::vector<char>& kept, double ball_mm)
        : part_(part),
          kept_(kept),
          ball_mm_(ball_mm),
          neighbours_(face_neighbours(part.soup.faces)),
          struck_(part.soup.faces.size(), 0),
          around_(part.soup.points_mm.size()) {
        for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
            for (const std::int32_t v : part.soup.faces[f]) {
                around_[at(v)].push_back(static_cast<std::int32_t>(f));
            }
        }
    }

    [[nodiscard]] const Neighbours& neighbours() const { return neighbours_; }

    // Strikes the faces out and fills their place, where that is one hole in one region and the
    // faces stand off its fill as they may.
    void take_off(std::set<std::int32_t> gone, double least_mm, double height_mm,
                  Details& details) {
        const bool alone = std::all_of(gone.begin(), gone.end(), [&](std::int32_t f) {
            return struck_[at(f)] == 0 && !beside_struck(f);
        });
        std::optional<Hole> hole = alone ? hole_of(gone) : std::nullopt;
        if (!hole) {
            return;
        }
        const std::optional<Ground> ground = ground_of(*hole, gone, least_mm);
        if (ground && !ground->off.empty()) {
            std::set<std::int32_t> with_foot = gone;
            with_foot.insert(ground->off.begin(), ground->off.end());
            if (std::optional<Hole> wider = hole_of(with_foot)) {
                gone = std::move(with_foot);
                hole = std::move(wider);
            }
        }
        Fill fill = fill_of(hole->border, gone);
        if (ground) {
            settle_on(ground->shape, fill);
        }
        if (fill.faces.faces.empty()) {
            return;
        }
        const double off_mm =
            ground ? farthest_mm(ground->shape, gone) : farthest_mm(fill.faces, gone);
        if (off_mm < least_mm || off_mm > height_mm || !has_flanks(fill.faces, gone)) {
            return;
        }
        strike(gone, details);
        ++details.count;
        details.most_mm = std::max(details.most_mm, off_mm);
        add(fill, hole->region);
    }

    // Drops what was struck out, with its points.
    [[nodiscard]] LabelledMesh finish() const {
        LabelledMesh result;
        std::vector<std::int32_t> number(part_.soup.points_mm.size() + new_points_.size(), -1);
        const auto take = [&](std::array<std::int32_t, 3> face, std::int32_t region,
                              const std::array<std::uint8_t, 3>& feature) {
            for (std::int32_t& v : face) {
                std::int32_t& n = number[at(v)];
                if (n < 0) {
                    n = static_cast<std::int32_t>(result.soup.points_mm.size());
                    result.soup.points_mm.push_back(point(v));
                }
                v = n;
            }
            result.soup.faces.push_back(face);
            result.region.push_back(region);
            result.feature.push_back(feature);
        };
        for (std::size_t f = 0; f < struck_.size(); ++f) {
            if (struck_[f] == 0) {
                take(part_.soup.faces[f], part_.region[f], part_.feature[f]);
            }
        }
        const std::size_t given = result.soup.faces.size();
        for (std::size_t i = 0; i < new_faces_.size(); ++i) {
            take(new_faces_[i], new_region_[i], {0, 0, 0});
        }
        // A fill has a crease where it meets another region alone.
        const Neighbours neighbours = face_neighbours(result.soup.faces);
        for (std::size_t f = given; f < result.soup.faces.size(); ++f) {
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = neighbours[f][e];
                if (g >= 0) {
                    const auto crease =
                        static_cast<std::uint8_t>(result.region[at(g)] != result.region[f]);
                    const int back = shared_edge(neighbours[at(g)], static_cast<std::int32_t>(f));
                    result.feature[f][e] = crease;
                    result.feature[at(g)][at(back)] = crease;
                }
            }
        }
        return result;
    }

private:
    struct Fill {
        TriangleSoup faces;                // of the fill alone
        std::vector<std::int32_t> number;  // of its points in the part; -1: new
    };

    // What faces that go leave open.
    struct Hole {
        std::vector<BorderEdge> border;  // one loop
        std::int32_t region = 0;         // around it
    };

    // The cylinder or cone around a hole.
    struct Ground {
        RuledShape shape;
        std::set<std::int32_t> off;  // faces around the hole that do not lie on it
    };

    [[nodiscard]] const Vector3d& point(std::int32_t v) const {
        const std::size_t given = part_.soup.points_mm.size();
        return at(v) < given ? part_.soup.points_mm[at(v)] : new_points_[at(v) - given];
    }

    [[nodiscard]] bool beside_struck(std::int32_t f) const {
        const auto& next = neighbours_[at(f)];
        return std::any_of(next.begin(), next.end(),
                           [&](std::int32_t g) { return g >= 0 && struck_[at(g)] != 0; });
    }

    [[nodiscard]] std::size_t edge_from(const BorderEdge& e) const {
        return at(part_.soup.faces[at(e.face)][at(e.edge)]);
    }
    [[nodiscard]] std::size_t edge_to(const BorderEdge& e) const {
        return at(part_.soup.faces[at(e.face)][at((e.edge + 1) % 3)]);
    }

    // Adds the faces around vertices that the outline passes twice. False where that goes on, or
    // the outline comes to what is no wall or struck out.
    [[nodiscard]] bool make_simple(std::set<std::int32_t>& gone) const {
        for (int round = 0; round <= kMostMends; ++round) {
            std::map<std::size_t, int> passes;
            const std::vector<BorderEdge> border = border_of(neighbours_, gone);
            for (const BorderEdge& e : border) {
                if (kept_[at(part_.region[at(e.face)])] == 0 || struck_[at(e.face)] != 0) {
                    return false;
                }
                ++passes[edge_from(e)];
            }
            bool simple = true;
            for (const auto& [v, times] : passes) {
                if (times > 1) {
                    simple = false;
                    for (const std::int32_t f : around_[v]) {
                        if (kept_[at(part_.region[at(f)])] == 0 || struck_[at(f)] != 0) {
                            return false;
                        }
                        gone.insert(f);
                    }
                }
            }
            if (simple) {
                return !border.empty();
            }
        }
        return false;
    }

    // The region that most of the outline lies in; none where no region has nearly all of it.
    [[nodiscard]] std::optional<std::int32_t> region_around(
        const std::vector<BorderEdge>& border) const {
        std::map<std::int32_t, double> length_mm;
        double whole = 0.0;
        for (const BorderEdge& e : border) {
            const double mm =
                (part_.soup.points_mm[edge_to(e)] - part_.soup.points_mm[edge_from(e)]).norm();
            length_mm[part_.region[at(e.face)]] += mm;
            whole += mm;
        }
        for (const auto& [region, mm] : length_mm) {
            if (mm >= kOneRegion * whole) {
                return region;
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] bool is_one_loop(const std::vector<BorderEdge>& border) const {
        std::map<std::size_t, std::size_t> next;
        for (const BorderEdge& e : border) {
            next[edge_from(e)] = edge_to(e);
        }
        std::size_t steps = 1;
        const std::size_t first = next.begin()->first;
        for (std::size_t v = next.begin()->second; v != first; ++steps) {
            const auto onward = next.find(v);
            if (onward == next.end() || steps > next.size()) {
                return false;
            }
            v = onward->second;
        }
        return steps == next.size();
    }

    // By the faces around the hole, which tell its tangents.
    [[nodiscard]] Fill fill_of(const std::vector<BorderEdge>& border,
                               const std::set<std::int32_t>& gone) const {
        std::set<std::int32_t> ring;
        for (const BorderEdge& e : border) {
            for (const std::int32_t f : around_[edge_from(e)]) {
                if (gone.count(f) == 0 && struck_[at(f)] == 0) {
                    ring.insert(f);
                }
            }
        }
        Fill fill;
        TriangleSoup soup;
        std::map<std::int32_t, std::int32_t> local;
        for (const std::int32_t f : ring) {
            std::array<std::int32_t, 3> face = part_.soup.faces[at(f)];
            for (std::int32_t& v : face) {
                const auto [found, fresh] =
                    local.emplace(v, static_cast<std::int32_t>(fill.number.size()));
                if (fresh) {
                    fill.number.push_back(v);
                    soup.points_mm.push_back(part_.soup.points_mm[at(v)]);
                }
                v = found->second;
            }
            soup.faces.push_back(face);
        }
        const std::size_t given = soup.faces.size();
        const auto place_of = [&](std::size_t v) { return local.at(static_cast<std::int32_t>(v)); };
        if (!fill_hole(soup, place_of(edge_from(border[0])), place_of(edge_to(border[0])))) {
            return {};
        }
        fill.faces.faces.assign(soup.faces.begin() + static_cast<std::ptrdiff_t>(given),
                                soup.faces.end());
        fill.number.resize(soup.points_mm.size(), -1);
        fill.faces.points_mm = std::move(soup.points_mm);
        return fill;
    }

    // None where the faces leave more than one hole, or one whose wall around is not one. Faces are
    // added where the hole's outline touches itself.
    [[nodiscard]] std::optional<Hole> hole_of(std::set<std::int32_t>& gone) const {
        if (!make_simple(gone)) {
            return std::nullopt;
        }
        Hole hole{.border = border_of(neighbours_, gone)};
        const std::optional<std::int32_t> region = region_around(hole.border);
        if (!region || !is_one_loop(hole.border) || turns(hole.border, 2.0 * ball_mm_)) {
            return std::nullopt;
        }
        hole.region = *region;
        return hole;
    }

    // What goes on from facets has their unevenness; most lettering stands on a cylinder or cone.
    // None where the wall around the hole is neither within `least_mm`, but for the foot of what
    // stands on it.
    [[nodiscard]] std::optional<Ground> ground_of(const Hole& hole,
                                                  const std::set<std::int32_t>& gone,
                                                  double least_mm) const {
        const std::set<std::int32_t> around = faces_around(hole, gone);
        std::set<std::int32_t> off;
        for (int fit = 0; fit < kMostFits; ++fit) {
            std::set<std::int32_t> vertices;
            std::vector<RuledFacet> facets;
            for (const std::int32_t f : around) {
                if (off.count(f) == 0) {
                    const auto& face = part_.soup.faces[at(f)];
                    vertices.insert(face.begin(), face.end());
                    facets.push_back({middle_of(part_.soup, face), normal_of(part_.soup, face),
                                      area_mm2(part_.soup.points_mm, face)});
                }
            }
            std::vector<Vector3d> points;
            points.reserve(vertices.size());
            for (const std::int32_t v : vertices) {
                points.push_back(part_.soup.points_mm[at(v)]);
            }
            const std::optional<RuledShape> shape = fit_ruled_shape(points, facets);
            if (!shape) {
                return std::nullopt;
            }
            if (shape->residual_mm <= kGroundShare * least_mm) {
                return Ground{*shape, std::move(off)};
            }
            for (const std::int32_t f : around) {
                for (const std::int32_t v : part_.soup.faces[at(f)]) {
                    if (shape->distance_mm(part_.soup.points_mm[at(v)]) >
                        0.5 * shape->residual_mm) {
                        off.insert(f);
                    }
                }
            }
            if (2 * off.size() > around.size()) {
                return std::nullopt;
            }
        }
        return std::nullopt;
    }

    static void settle_on(const RuledShape& shape, Fill& fill) {
        for (std::size_t v = 0; v < fill.number.size(); ++v) {
            if (fill.number[v] < 0) {
                fill.faces.points_mm[v] = shape.nearest(fill.faces.points_mm[v]);
            }
        }
    }

    // The wall's faces in the hole's region, up to kRings across vertices from it.
    [[nodiscard]] std::set<std::int32_t> faces_around(const Hole& hole,
                                                      const std::set<std::int32_t>& gone) const {
        std::set<std::int32_t> faces;
        std::set<std::int32_t> rim;
        for (const BorderEdge& e : hole.border) {
            rim.insert(static_cast<std::int32_t>(edge_from(e)));
        }
        for (int ring = 0; ring < kRings; ++ring) {
            std::set<std::int32_t> next;
            for (const std::int32_t v : rim) {
                for (const std::int32_t f : around_[at(v)]) {
                    if (part_.region[at(f)] == hole.region && gone.count(f) == 0 &&
                        struck_[at(f)] == 0 && faces.insert(f).second) {
                        const auto& face = part_.soup.faces[at(f)];
                        next.insert(face.begin(), face.end());
                    }
                }
            }
            rim = std::move(next);
        }
        return faces;
    }

    // Of a point of the faces that go from what comes in their place.
    [[nodiscard]] double farthest_mm(const RuledShape& ground,
                                     const std::set<std::int32_t>& gone) const {
        double most = 0.0;
        for (const std::int32_t f : gone) {
            for (const std::int32_t v : part_.soup.faces[at(f)]) {
                most = std::max(most, ground.distance_mm(part_.soup.points_mm[at(v)]));
            }
        }
        return most;
    }
    [[nodiscard]] double farthest_mm(const TriangleSoup& fill,
                                     const std::set<std::int32_t>& gone) const {
        const RayQuery query{std::span(&fill, 1)};
        const double reach = diagonal_mm(part_.soup);
        double most = 0.0;
        for (const std::int32_t f : gone) {
            for (const std::int32_t v : part_.soup.faces[at(f)]) {
                const Vector3d& p = part_.soup.points_mm[at(v)];
                most = std::max(most, query.closest(p, reach).distance_mm);
            }
        }
        return most;
    }

    [[nodiscard]] bool has_flanks(const TriangleSoup& fill,
                                  const std::set<std::int32_t>& gone) const {
        const RayQuery query{std::span(&fill, 1)};
        const double reach = diagonal_mm(part_.soup);
        double flanks = 0.0;
        double all = 0.0;
        for (const std::int32_t f : gone) {
            const auto& face = part_.soup.faces[at(f)];
            const ClosestPoint under = query.closest(middle_of(part_.soup, face), reach);
            const double area = area_mm2(part_.soup.points_mm, face);
            all += area;
            if (normal_of(part_.soup, face).dot(normal_of(fill, fill.faces[at(under.face)])) <
                kFlankCosine) {
                flanks += area;
            }
        }
        return flanks >= kFlankShare * all;
    }

    // Whether faces along the border that are so near to each other face different ways.
    [[nodiscard]] bool turns(const std::vector<BorderEdge>& border, double near_mm) const {
        for (std::size_t i = 0; i < border.size(); ++i) {
            const Vector3d& p = part_.soup.points_mm[edge_from(border[i])];
            const Vector3d normal = normal_of(part_.soup, part_.soup.faces[at(border[i].face)]);
            for (std::size_t j = 0; j < i; ++j) {
                const bool near =
                    (part_.soup.points_mm[edge_from(border[j])] - p).norm() <= near_mm;
                if (near &&
                    normal.dot(normal_of(part_.soup, part_.soup.faces[at(border[j].face)])) <
                        kAroundCosine) {
                    return true;
                }
            }
        }
        return false;
    }

    void strike(const std::set<std::int32_t>& gone, Details& details) {
        for (const std::int32_t f : gone) {
            struck_[at(f)] = 1;
            std::array<std::int32_t, 3> face = part_.soup.faces[at(f)];
            details.area_mm2 += area_mm2(part_.soup.points_mm, face);
            for (std::int32_t& v : face) {
                details.removed.points_mm.push_back(part_.soup.points_mm[at(v)]);
                v = static_cast<std::int32_t>(details.removed.points_mm.size()) - 1;
            }
            details.removed.faces.push_back(face);
        }
    }

    void add(const Fill& fill, std::int32_t region) {
        const auto given = static_cast<std::int32_t>(part_.soup.points_mm.size());
        std::vector<std::int32_t> number = fill.number;
        for (std::size_t v = 0; v < number.size(); ++v) {
            if (number[v] < 0) {
                number[v] = given + static_cast<std::int32_t>(new_points_.size());
                new_points_.push_back(fill.faces.points_mm[v]);
            }
        }
        for (std::array<std::int32_t, 3> face : fill.faces.faces) {
            for (std::int32_t& v : face) {
                v = number[at(v)];
            }
            new_faces_.push_back(face);
            new_region_.push_back(region);
        }
    }

    const LabelledMesh& part_;
    const std::vector<char>& kept_;
    double ball_mm_;
    Neighbours neighbours_;
    std::vector<char> struck_;                       // per given face
    std::vector<std::vector<std::int32_t>> around_;  // per given point: its faces
    std::vector<Vector3d> new_points_;
    std::vector<std::array<std::int32_t, 3>> new_faces_;
    std::vector<std::int32_t> new_region_;
};

}  // namespace

Details without_details(const LabelledMesh& part, const std::vector<char>& kept, double ball_mm,
                        double least_mm, double height_mm) {
    Details details;
    Work work(part, kept, ball_mm);
    std::vector<std::int32_t> face;  // of the part, per face of the wall
    for (std::size_t f = 0; f < part.region.size(); ++f) {
        if (kept[at(part.region[f])] != 0) {
            face.push_back(static_cast<std::int32_t>(f));
        }
    }
    const TriangleSoup wall =
        wall_of({part.soup, part.region, part.feature, work.neighbours()}, kept).soup;
    for (const WallSide side : {WallSide::Inside, WallSide::Outside}) {
        check_interrupt();
        const auto places =
            enclosed_places(wall, out_of_reach(wall, ball_mm, side), kDetailShare, kMostPlaces);
        for (const std::vector<std::int32_t>& place : places) {
            check_interrupt();
            std::set<std::int32_t> gone;
            for (const std::int32_t f : place) {
                gone.insert(face[at(f)]);
            }
            work.take_off(std::move(gone), least_mm, height_mm, details);
        }
    }
    details.part = details.count > 0 ? work.finish() : part;
    return details;
}

}  // namespace meshwind
