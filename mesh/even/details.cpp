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

#include <Eigen/Core>

#include "core/index.h"
#include "core/interrupt.h"
#include "mesh/edge_table.h"
#include "mesh/even/enclosed_places.h"
#include "mesh/even/fair.h"
#include "mesh/even/hole.h"
#include "mesh/even/rolling_ball.h"
#include "mesh/even/ruled_shape.h"
#include "mesh/ray_query.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A detail takes less of the wall than this.
constexpr double kDetailShare = 0.05;

// More places out of reach than this are a rough wall, not lettering.
constexpr std::size_t kMaxPlaces = 2000;

// A detail stands on the wall by flanks: this share of its area at least is turned by more than
// this from the wall that goes on under it. The two sides of a crotch are not.
constexpr double kFlankShare = 0.03;
constexpr double kFlankCosine = 0.5;  // 60 degrees

// So many rings of triangles around a detail tell which cylinder or cone it stands on.
constexpr int kRings = 3;

// The wall lies on that within this share of what counts as a detail; what does not is left out in
// so many fits at most.
constexpr double kGroundShare = 0.1;
constexpr int kMaxFits = 6;

// What is taken off, in mm (without_details).
struct DetailSizes {
    double ball_mm = 0.0;
    double least_mm = 0.0;
    double height_mm = 0.0;
};

// What comes in the place of faces that go.
struct Fill {
    TriangleSoup faces;                // of the fill alone
    std::vector<std::int32_t> number;  // of its points in the part; -1: new
};

// The cylinder or cone around a hole.
struct Ground {
    RuledShape shape;
    std::set<std::int32_t> off;  // faces around the hole that do not lie on it
};

// A detail, and how the wall goes on over its place.
struct Detail {
    std::set<std::int32_t> faces;
    Fill fill;
    std::int32_t region = 0;  // around it
    double off_mm = 0.0;      // the farthest that it stands off the fill
};

// Faces of all fills.
struct NewFaces {
    std::vector<Vector3d> points_mm;  // numbered on from those of the part
    std::vector<std::array<std::int32_t, 3>> faces;
    std::vector<std::int32_t> region;  // per face
};

// Whether no face is struck out or next to one that is.
bool stand_alone(const StruckPart& part, const std::set<std::int32_t>& faces) {
    const auto struck = [&](std::int32_t f) { return part.struck[at(f)] != 0; };
    return std::all_of(faces.begin(), faces.end(), [&](std::int32_t f) {
        const auto& next = part.neighbours[at(f)];
        return !struck(f) && std::none_of(next.begin(), next.end(),
                                          [&](std::int32_t g) { return g >= 0 && struck(g); });
    });
}

// By the faces around the hole, which tell its tangents.
Fill fill_of(const StruckPart& part, const std::vector<BorderEdge>& border,
             const std::set<std::int32_t>& gone) {
    std::set<std::int32_t> ring;
    for (const BorderEdge& e : border) {
        for (const std::int32_t f : part.around[e.from]) {
            if (gone.count(f) == 0 && part.struck[at(f)] == 0) {
                ring.insert(f);
            }
        }
    }
    Fill fill;
    TriangleSoup soup;
    std::map<std::int32_t, std::int32_t> local;
    for (const std::int32_t f : ring) {
        std::array<std::int32_t, 3> face = part.soup.faces[at(f)];
        for (std::int32_t& v : face) {
            const auto [found, fresh] =
                local.emplace(v, static_cast<std::int32_t>(fill.number.size()));
            if (fresh) {
                fill.number.push_back(v);
                soup.points_mm.push_back(part.soup.points_mm[at(v)]);
            }
            v = found->second;
        }
        soup.faces.push_back(face);
    }
    const std::size_t given = soup.faces.size();
    const auto place_of = [&](std::size_t v) { return local.at(static_cast<std::int32_t>(v)); };
    if (!fill_hole(soup, place_of(border[0].from), place_of(border[0].to))) {
        return {};
    }
    fill.faces.faces.assign(soup.faces.begin() + static_cast<std::ptrdiff_t>(given),
                            soup.faces.end());
    fill.number.resize(soup.points_mm.size(), -1);
    fill.faces.points_mm = std::move(soup.points_mm);
    return fill;
}

// The wall's faces in the hole's region, up to kRings across vertices from it.
std::set<std::int32_t> faces_around(const StruckPart& part, const Hole& hole,
                                    const std::set<std::int32_t>& gone) {
    std::set<std::int32_t> faces;
    std::set<std::int32_t> rim;
    for (const BorderEdge& e : hole.border) {
        rim.insert(static_cast<std::int32_t>(e.from));
    }
    for (int ring = 0; ring < kRings; ++ring) {
        std::set<std::int32_t> next;
        for (const std::int32_t v : rim) {
            for (const std::int32_t f : part.around[at(v)]) {
                if (part.region[at(f)] == hole.region && gone.count(f) == 0 &&
                    part.struck[at(f)] == 0 && faces.insert(f).second) {
                    const auto& face = part.soup.faces[at(f)];
                    next.insert(face.begin(), face.end());
                }
            }
        }
        rim = std::move(next);
    }
    return faces;
}

// The cylinder or cone through faces; `off` are left out.
std::optional<RuledShape> shape_of(const StruckPart& part, const std::set<std::int32_t>& faces,
                                   const std::set<std::int32_t>& off) {
    const TriangleSoup& soup = part.soup;
    std::set<std::int32_t> vertices;
    std::vector<RuledFacet> facets;
    for (const std::int32_t f : faces) {
        if (off.count(f) == 0) {
            const auto& face = soup.faces[at(f)];
            vertices.insert(face.begin(), face.end());
            facets.push_back({middle_mm(soup.points_mm, face), face_normal(soup, face),
                              area_mm2(soup.points_mm, face)});
        }
    }
    std::vector<Vector3d> points;
    points.reserve(vertices.size());
    for (const std::int32_t v : vertices) {
        points.push_back(soup.points_mm[at(v)]);
    }
    return fit_ruled_shape(points, facets);
}

// What goes on from facets has their unevenness; most lettering stands on a cylinder or cone.
// None where the wall around the hole is neither within `least_mm`, but for the foot of what
// stands on it.
std::optional<Ground> ground_of(const StruckPart& part, const Hole& hole,
                                const std::set<std::int32_t>& gone, double least_mm) {
    const std::set<std::int32_t> around = faces_around(part, hole, gone);
    std::set<std::int32_t> off;
    for (int fit = 0; fit < kMaxFits; ++fit) {
        const std::optional<RuledShape> shape = shape_of(part, around, off);
        if (!shape) {
            return std::nullopt;
        }
        if (shape->residual_mm <= kGroundShare * least_mm) {
            return Ground{*shape, std::move(off)};
        }
        for (const std::int32_t f : around) {
            for (const std::int32_t v : part.soup.faces[at(f)]) {
                if (shape->distance_mm(part.soup.points_mm[at(v)]) > 0.5 * shape->residual_mm) {
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

void settle_on(const RuledShape& shape, Fill& fill) {
    for (std::size_t v = 0; v < fill.number.size(); ++v) {
        if (fill.number[v] < 0) {
            fill.faces.points_mm[v] = shape.nearest(fill.faces.points_mm[v]);
        }
    }
}

// Of a point of the faces that go from what comes in their place.
double farthest_mm(const StruckPart& part, const RuledShape& ground,
                   const std::set<std::int32_t>& gone) {
    double most = 0.0;
    for (const std::int32_t f : gone) {
        for (const std::int32_t v : part.soup.faces[at(f)]) {
            most = std::max(most, ground.distance_mm(part.soup.points_mm[at(v)]));
        }
    }
    return most;
}

double farthest_mm(const StruckPart& part, const TriangleSoup& fill,
                   const std::set<std::int32_t>& gone) {
    const RayQuery query{std::span(&fill, 1)};
    const double reach = diagonal_mm(part.soup);
    double most = 0.0;
    for (const std::int32_t f : gone) {
        for (const std::int32_t v : part.soup.faces[at(f)]) {
            const Vector3d& p = part.soup.points_mm[at(v)];
            most = std::max(most, query.closest(p, reach).distance_mm);
        }
    }
    return most;
}

bool has_flanks(const StruckPart& part, const TriangleSoup& fill,
                const std::set<std::int32_t>& gone) {
    const RayQuery query{std::span(&fill, 1)};
    const double reach = diagonal_mm(part.soup);
    double flanks = 0.0;
    double all = 0.0;
    for (const std::int32_t f : gone) {
        const auto& face = part.soup.faces[at(f)];
        const ClosestPoint under = query.closest(middle_mm(part.soup.points_mm, face), reach);
        const double area = area_mm2(part.soup.points_mm, face);
        all += area;
        if (face_normal(part.soup, face).dot(face_normal(fill, fill.faces[at(under.face)])) <
            kFlankCosine) {
            flanks += area;
        }
    }
    return flanks >= kFlankShare * all;
}

// None where the place of the faces is no hole in one region, or they do not stand off its fill as
// details do.
std::optional<Detail> detail_of(const StruckPart& part, std::set<std::int32_t> gone,
                                const DetailSizes& sizes) {
    const double near_mm = 2.0 * sizes.ball_mm;
    std::optional<Hole> hole =
        stand_alone(part, gone) ? hole_of(part, gone, near_mm) : std::nullopt;
    if (!hole) {
        return std::nullopt;
    }
    const std::optional<Ground> ground = ground_of(part, *hole, gone, sizes.least_mm);
    if (ground && !ground->off.empty()) {
        std::set<std::int32_t> with_foot = gone;
        with_foot.insert(ground->off.begin(), ground->off.end());
        if (std::optional<Hole> wider = hole_of(part, with_foot, near_mm)) {
            gone = std::move(with_foot);
            hole = std::move(wider);
        }
    }
    Fill fill = fill_of(part, hole->border, gone);
    if (ground) {
        settle_on(ground->shape, fill);
    }
    if (fill.faces.faces.empty()) {
        return std::nullopt;
    }
    const double off_mm =
        ground ? farthest_mm(part, ground->shape, gone) : farthest_mm(part, fill.faces, gone);
    if (off_mm < sizes.least_mm || off_mm > sizes.height_mm ||
        !has_flanks(part, fill.faces, gone)) {
        return std::nullopt;
    }
    return Detail{std::move(gone), std::move(fill), hole->region, off_mm};
}

// Notes a detail as taken off, and strikes its faces out.
void take_off(const Detail& detail, StruckPart& part, Details& details) {
    for (const std::int32_t f : detail.faces) {
        part.struck[at(f)] = 1;
        std::array<std::int32_t, 3> face = part.soup.faces[at(f)];
        details.area_mm2 += area_mm2(part.soup.points_mm, face);
        for (std::int32_t& v : face) {
            details.removed.points_mm.push_back(part.soup.points_mm[at(v)]);
            v = static_cast<std::int32_t>(details.removed.points_mm.size()) - 1;
        }
        details.removed.faces.push_back(face);
    }
    ++details.count;
    details.most_mm = std::max(details.most_mm, detail.off_mm);
}

// \param given number of the part's points
void add_fill(const Detail& detail, std::size_t given, NewFaces& added) {
    const Fill& fill = detail.fill;
    std::vector<std::int32_t> number = fill.number;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < 0) {
            number[v] = static_cast<std::int32_t>(given + added.points_mm.size());
            added.points_mm.push_back(fill.faces.points_mm[v]);
        }
    }
    for (std::array<std::int32_t, 3> face : fill.faces.faces) {
        for (std::int32_t& v : face) {
            v = number[at(v)];
        }
        added.faces.push_back(face);
        added.region.push_back(detail.region);
    }
}

// A fill has a crease where it meets another region alone. \param first face of the fills
void crease_between_regions(LabelledMesh& part, std::size_t first) {
    const auto neighbours = face_neighbours(part.soup.faces);
    for (std::size_t f = first; f < part.soup.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = neighbours[f][e];
            if (g >= 0) {
                const auto crease = static_cast<std::uint8_t>(part.region[at(g)] != part.region[f]);
                const int back = shared_edge(neighbours[at(g)], static_cast<std::int32_t>(f));
                part.feature[f][e] = crease;
                part.feature[at(g)][at(back)] = crease;
            }
        }
    }
}

// Drops what was struck out, with its points.
LabelledMesh filled(const LabelledMesh& part, const std::vector<char>& struck,
                    const NewFaces& added) {
    LabelledMesh result;
    const std::size_t given = part.soup.points_mm.size();
    std::vector<std::int32_t> number(given + added.points_mm.size(), -1);
    const auto take = [&](std::array<std::int32_t, 3> face, std::int32_t region,
                          const std::array<std::uint8_t, 3>& feature) {
        for (std::int32_t& v : face) {
            std::int32_t& n = number[at(v)];
            if (n < 0) {
                n = static_cast<std::int32_t>(result.soup.points_mm.size());
                result.soup.points_mm.push_back(at(v) < given ? part.soup.points_mm[at(v)]
                                                              : added.points_mm[at(v) - given]);
            }
            v = n;
        }
        result.soup.faces.push_back(face);
        result.region.push_back(region);
        result.feature.push_back(feature);
    };
    for (std::size_t f = 0; f < struck.size(); ++f) {
        if (struck[f] == 0) {
            take(part.soup.faces[f], part.region[f], part.feature[f]);
        }
    }
    const std::size_t first = result.soup.faces.size();
    for (std::size_t i = 0; i < added.faces.size(); ++i) {
        take(added.faces[i], added.region[i], {0, 0, 0});
    }
    crease_between_regions(result, first);
    return result;
}

// Numbers in the part of the faces of its wall.
std::vector<std::int32_t> faces_of_wall(const LabelledMesh& part, const std::vector<char>& kept) {
    std::vector<std::int32_t> faces;
    for (std::size_t f = 0; f < part.region.size(); ++f) {
        if (kept[at(part.region[f])] != 0) {
            faces.push_back(static_cast<std::int32_t>(f));
        }
    }
    return faces;
}

}  // namespace

Details without_details(const LabelledMesh& part, const std::vector<char>& kept, double ball_mm,
                        double least_mm, double height_mm) {
    Details details;
    const DetailSizes sizes{ball_mm, least_mm, height_mm};
    StruckPart struck = unstruck(part, kept);
    NewFaces added;
    const std::vector<std::int32_t> face = faces_of_wall(part, kept);
    const TriangleSoup wall =
        wall_of({part.soup, part.region, part.feature, struck.neighbours}, kept).soup;
    for (const WallSide side : {WallSide::Inside, WallSide::Outside}) {
        check_interrupt();
        const auto places =
            enclosed_places(wall, out_of_reach(wall, ball_mm, side), kDetailShare, kMaxPlaces);
        for (const std::vector<std::int32_t>& place : places) {
            check_interrupt();
            std::set<std::int32_t> gone;
            for (const std::int32_t f : place) {
                gone.insert(face[at(f)]);
            }
            if (const auto detail = detail_of(struck, std::move(gone), sizes)) {
                take_off(*detail, struck, details);
                add_fill(*detail, part.soup.points_mm.size(), added);
            }
        }
    }
    details.part = details.count > 0 ? filled(part, struck.struck, added) : part;
    return details;
}

}  // namespace meshwind
