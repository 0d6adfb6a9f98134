#include "mesh/even/wall_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/interrupt.h"
#include "mesh/edge_table.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Faces = std::vector<std::int32_t>;

// What a vertex may be off its shape, as a share of the part's size: files in single precision are
// off by a tenth of it, text of six digits by half. On a narrow shape it is less, a share of its
// radius, or columns of a round lip would be cylinders; but never below rounding.
constexpr double kOff = 2e-5;
constexpr double kOffOfRadius = 2e-4;
constexpr double kRounding = 2e-6;

// A facet lower than this share of the part's size tells no normal: 20 times what its vertices may
// be off.
constexpr double kTellsNormalShare = 4e-4;

// Facets that tell a shape hang together over edges of this share of their longest: on long ones
// along the rulings.
constexpr double kAlong = 0.5;
constexpr std::size_t kGroup = 16;
constexpr std::size_t kMinGroup = 6;

// So few short facets turn too little to tell a shape; then so many are looked at, those first that
// turn least. They have vertices inside: one row of a curved surface has none, and lies on a cone.
constexpr std::size_t kWideGroup = 128;

// Facets of which so many lie on a shape that is none are not looked at again: from each of them
// the same would be found.
constexpr std::size_t kManyInVain = 256;

// A shape's own normals turn by less than this over a facet (46 degrees), and the facet's is among
// them within this (3 degrees).
constexpr double kMaxTurnRad = 0.8;
constexpr double kNormalRad = 0.05;

// Fewer facets than this lie in a plane by chance: a row of facets has two in each.
// A strip is one facet of a round wall in pieces; a disc has 0.08, a strip of 1 : 10 has 0.02 of
// its outline's square as area.
constexpr std::size_t kMinInPlane = 6;
constexpr double kCompact = 0.02;

// Planes below this share of the part's size squared have no long facets.
constexpr double kLargePlane = 0.05;

// What is rounder than this share of the part's size is an edge: even meshes come no nearer to it.
constexpr double kRoundest = 2e-3;

// A ball has vertices within, away from its outline. Flatter than this times the part's size it is
// no ball, nor a cylinder.
constexpr int kMinInside = 3;
constexpr double kFlattest = 10.0;

constexpr int kMaxGrowths = 4;

// A row of facets turns, across its rulings, into its neighbours by more than this (0.6 degrees),
// to one side along this share of its outline, and is shorter than so many times the longer of
// them: it is part of a surface that is curved along its rulings too. Edges within 45 degrees of
// the rulings do not tell.
constexpr double kAcross = 0.7;
constexpr double kTurnsRad = 0.01;
constexpr double kOneSide = 0.65;
constexpr double kShort = 1.5;

double angle_rad(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

double signed_angle_rad(const Vector3d& left, const Vector3d& right, const Vector3d& edge) {
    return (left.cross(right).dot(edge) < 0.0 ? -1.0 : 1.0) * angle_rad(left, right);
}

struct Facet {
    Vector3d normal = Vector3d::Zero();
    double area_mm2 = 0.0;
    double longest_mm = 0.0;
};

// A part and its facets as they are measured.
struct WallFacets {
    const LabelledMesh& part;
    const std::vector<char>& kept;  // per region: whether it is wall
    std::vector<std::array<std::int32_t, 3>> neighbours;
    double size_mm = 0.0;  // of the wall
    double off_mm = 0.0;   // what a vertex may be off its shape at most
    std::vector<Facet> facets = {};

    [[nodiscard]] const Vector3d& point(std::int32_t face, std::size_t c) const {
        return part.soup.points_mm[at(part.soup.faces[at(face)][c % 3])];
    }
    [[nodiscard]] double edge_mm(std::int32_t face, std::size_t e) const {
        return (point(face, e + 1) - point(face, e)).norm();
    }
    [[nodiscard]] bool is_wall(std::int32_t face) const {
        return kept[at(part.region[at(face)])] != 0;
    }
    // The wall's face beyond an edge that is no crease, or -1.
    [[nodiscard]] std::int32_t beyond(std::int32_t face, std::size_t e) const {
        const std::int32_t next = neighbours[at(face)][e];
        return next >= 0 && part.feature[at(face)][e] == 0 && is_wall(next) ? next : -1;
    }
};

// A set of faces that is emptied at once.
class FaceSet {
public:
    explicit FaceSet(std::size_t faces) : round_of_(faces, 0) {}

    void clear() { ++round_; }
    // Whether it was not in the set.
    bool insert(std::int32_t face) { return std::exchange(round_of_[at(face)], round_) != round_; }
    void assign(const Faces& faces) {
        clear();
        for (const std::int32_t f : faces) {
            round_of_[at(f)] = round_;
        }
    }
    [[nodiscard]] bool has(std::int32_t face) const { return round_of_[at(face)] == round_; }

private:
    std::vector<int> round_of_;  // per face: in which round it was put in last
    int round_ = 0;
};

// How far the search for shapes is.
struct ShapeSearch {
    std::vector<char> tried;  // per face: whether it need not be a seed
    FaceSet seen;
    WallShapes found;
};

Facet measured(const WallFacets& wall, std::int32_t f) {
    Facet facet;
    const Vector3d twice =
        (wall.point(f, 1) - wall.point(f, 0)).cross(wall.point(f, 2) - wall.point(f, 0));
    facet.area_mm2 = 0.5 * twice.norm();
    facet.normal = twice.normalized();
    facet.longest_mm = std::max({wall.edge_mm(f, 0), wall.edge_mm(f, 1), wall.edge_mm(f, 2)});
    return facet;
}

WallFacets facets_of(const LabelledMesh& part, const std::vector<char>& kept) {
    const double size = size_mm(part, kept);
    WallFacets wall{part, kept, face_neighbours(part.soup.faces), size, kOff * size};
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        wall.facets.push_back(measured(wall, static_cast<std::int32_t>(f)));
    }
    return wall;
}

// Facets around one, over their long edges: the nearest, or those that turn least.
// \param of_face shape per face, -1: none yet
Faces group_around(const WallFacets& wall, const std::vector<std::int32_t>& of_face,
                   std::int32_t seed, bool wide) {
    const std::size_t most = wide ? kWideGroup : kGroup;
    double seen = 0.0;
    Faces group;
    std::set<std::pair<double, std::int32_t>> next{{0.0, seed}};
    while (!next.empty() && group.size() < most) {
        const std::int32_t f = next.extract(next.begin()).value().second;
        if (std::find(group.begin(), group.end(), f) != group.end()) {
            continue;
        }
        group.push_back(f);
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = wall.beyond(f, e);
            const double length = wall.edge_mm(f, e);
            if (g >= 0 && of_face[at(g)] < 0 && length >= kAlong * wall.facets[at(f)].longest_mm &&
                length >= kAlong * wall.facets[at(g)].longest_mm) {
                seen += 1.0;
                next.emplace(
                    wide ? angle_rad(wall.facets[at(f)].normal, wall.facets[at(g)].normal) : seen,
                    g);
            }
        }
    }
    return group;
}

bool tells_normal(const WallFacets& wall, std::int32_t f) {
    const Facet& facet = wall.facets[at(f)];
    return 2.0 * facet.area_mm2 > kTellsNormalShare * wall.size_mm * facet.longest_mm;
}

double off_mm(const WallFacets& wall, const WallShape& shape) {
    const double radius =
        shape.kind == WallShape::Kind::Ball ? shape.radius_mm : shape.ruled.radius_mm;
    return shape.kind == WallShape::Kind::Plane
               ? wall.off_mm
               : std::clamp(kOffOfRadius * radius, kRounding * wall.size_mm, wall.off_mm);
}

bool lies_on(const WallFacets& wall, const WallShape& shape, std::int32_t f) {
    std::array<Vector3d, 3> normal;
    const double off = off_mm(wall, shape);
    for (std::size_t c = 0; c < 3; ++c) {
        if (!(shape.distance_mm(wall.point(f, c)) <= off)) {
            return false;
        }
        normal[c] = shape.normal_at(wall.point(f, c));
        if (normal[c].dot(normal[0]) < 0.0) {
            return false;
        }
    }
    const double turn = std::max({angle_rad(normal[0], normal[1]), angle_rad(normal[1], normal[2]),
                                  angle_rad(normal[2], normal[0])});
    if (turn > kMaxTurnRad) {
        return false;
    }
    const Vector3d& own = wall.facets[at(f)].normal;
    const double side = own.dot(normal[0]) < 0.0 ? -1.0 : 1.0;
    return !tells_normal(wall, f) ||
           std::all_of(normal.begin(), normal.end(), [&](const Vector3d& n) {
               return angle_rad(own, side * n) <= turn + kNormalRad;
           });
}

// All faces on the shape that hang together with the first of `seeds` that lies on it.
Faces grown(const WallFacets& wall, const WallShape& shape, const Faces& seeds,
            ShapeSearch& search) {
    Faces faces;
    search.seen.clear();
    const auto look = [&](std::int32_t f) {
        if (search.found.of_face[at(f)] < 0 && search.seen.insert(f) && lies_on(wall, shape, f)) {
            faces.push_back(f);
        }
    };
    for (std::size_t i = 0; i < seeds.size() && faces.empty(); ++i) {
        look(seeds[i]);
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = wall.beyond(faces[i], e);
            if (g >= 0) {
                look(g);
            }
        }
    }
    return faces;
}

bool is_round(const WallFacets& wall, const WallShape& shape) {
    const double radius =
        shape.kind == WallShape::Kind::Ball ? shape.radius_mm : shape.ruled.radius_mm;
    return shape.kind == WallShape::Kind::Plane ||
           (radius > kRoundest * wall.size_mm && radius < kFlattest * wall.size_mm);
}

std::optional<WallShape> fit(const WallFacets& wall, WallShape::Kind kind, const Faces& faces) {
    std::vector<std::int32_t> vertices;
    std::vector<RuledFacet> facets;
    Vector3d normal = Vector3d::Zero();
    for (const std::int32_t f : faces) {
        const auto& v = wall.part.soup.faces[at(f)];
        vertices.insert(vertices.end(), v.begin(), v.end());
        const Facet& facet = wall.facets[at(f)];
        facets.push_back({(wall.point(f, 0) + wall.point(f, 1) + wall.point(f, 2)) / 3.0,
                          facet.normal, facet.area_mm2});
        normal += facet.area_mm2 * facet.normal;
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vector3d> points;
    points.reserve(vertices.size());
    for (const std::int32_t v : vertices) {
        points.push_back(wall.part.soup.points_mm[at(v)]);
    }
    std::optional<WallShape> shape;
    if (kind == WallShape::Kind::Plane) {
        shape =
            WallShape{.kind = kind, .centre_mm = mean_mm(points), .normal = normal.normalized()};
    } else if (kind == WallShape::Kind::Ball) {
        if (const auto ball = fit_ball(points)) {
            shape =
                WallShape{.kind = kind, .centre_mm = ball->centre_mm, .radius_mm = ball->radius_mm};
        }
    } else if (const auto ruled = fit_ruled_shape(points, facets)) {
        shape = WallShape{.kind = kind, .ruled = *ruled};
    }
    if (!shape || !is_round(wall, *shape)) {
        return std::nullopt;
    }
    const bool on = std::all_of(points.begin(), points.end(), [&](const Vector3d& p) {
        return shape->distance_mm(p) <= off_mm(wall, *shape);
    });
    return on ? shape : std::nullopt;
}

// Vertices all of whose faces are among these.
int vertices_inside(const WallFacets& wall, const Faces& faces, FaceSet& seen) {
    seen.assign(faces);
    Faces all;
    Faces border;
    for (const std::int32_t f : faces) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = wall.neighbours[at(f)][e];
            const auto& v = wall.part.soup.faces[at(f)];
            all.push_back(v[e]);
            if (g < 0 || !seen.has(g)) {
                border.push_back(v[e]);
                border.push_back(v[(e + 1) % 3]);
            }
        }
    }
    for (Faces* list : {&all, &border}) {
        std::sort(list->begin(), list->end());
        list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    return static_cast<int>(all.size()) - static_cast<int>(border.size());
}

// Whether the faces are as wide as long, more or less, and not small.
bool is_compact(const WallFacets& wall, const Faces& faces, FaceSet& seen) {
    seen.assign(faces);
    double area = 0.0;
    double outline = 0.0;
    for (const std::int32_t f : faces) {
        area += wall.facets[at(f)].area_mm2;
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = wall.neighbours[at(f)][e];
            outline += g >= 0 && seen.has(g) ? 0.0 : wall.edge_mm(f, e);
        }
    }
    return area > kCompact * outline * outline && area > kLargePlane * wall.size_mm * wall.size_mm;
}

// Whether an edge runs across the rulings.
bool is_across(const WallFacets& wall, const RuledShape& shape, std::int32_t f, std::size_t e) {
    const Vector3d way = wall.point(f, e + 1) - wall.point(f, e);
    const Vector3d middle = 0.5 * (wall.point(f, e + 1) + wall.point(f, e));
    return std::abs(way.dot(shape.ruling_at(middle))) < kAcross * way.norm();
}

// A row between two others of its kind, to both of which it turns to the same side.
bool is_of_a_curve(const WallFacets& wall, const RuledShape& shape, const Faces& faces,
                   FaceSet& seen) {
    seen.assign(faces);
    double area = 0.0;
    double whole = 0.0;
    std::array<double, 2> side{};
    double longest = 0.0;
    for (const std::int32_t f : faces) {
        area += wall.facets[at(f)].area_mm2;
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = wall.neighbours[at(f)][e];
            if ((g >= 0 && seen.has(g)) || !is_across(wall, shape, f, e)) {
                continue;
            }
            const double length = wall.edge_mm(f, e);
            whole += length;
            const std::int32_t next = wall.beyond(f, e);
            if (next < 0) {
                continue;
            }
            const double turn =
                signed_angle_rad(wall.facets[at(f)].normal, wall.facets[at(next)].normal,
                                 wall.point(f, e + 1) - wall.point(f, e));
            if (std::abs(turn) > kTurnsRad) {
                side[turn > 0.0 ? 0 : 1] += length;
                longest = std::max(longest, 2.0 * wall.facets[at(next)].area_mm2 / length);
            }
        }
    }
    const double own = whole > 0.0 ? 2.0 * area / whole : 0.0;
    return std::max(side[0], side[1]) > kOneSide * whole && own < kShort * longest;
}

// \param faces that it takes
bool is_certain(const WallFacets& wall, const WallShape& shape, const Faces& faces, FaceSet& seen) {
    if (shape.kind == WallShape::Kind::Plane) {
        return faces.size() >= kMinInPlane && is_compact(wall, faces, seen);
    }
    if (shape.kind == WallShape::Kind::Ball) {
        return faces.size() >= kGroup && vertices_inside(wall, faces, seen) >= kMinInside;
    }
    return faces.size() >= kMinGroup && !is_of_a_curve(wall, shape.ruled, faces, seen);
}

// A shape, and the faces that it takes.
struct GrownShape {
    std::optional<WallShape> shape;
    Faces faces;
};

// Fits a shape to a group, then to all faces on it that hang together with the group, in turn.
GrownShape grown_shape(const WallFacets& wall, WallShape::Kind kind, const Faces& group,
                       ShapeSearch& search) {
    GrownShape result{fit(wall, kind, group), {}};
    for (int i = 0; result.shape && i < kMaxGrowths; ++i) {
        Faces more = grown(wall, *result.shape, group, search);
        if (more.size() <= result.faces.size()) {
            break;
        }
        result.faces = std::move(more);
        const std::optional<WallShape> better = fit(wall, kind, result.faces);
        if (!better) {
            break;
        }
        result.shape = better;
    }
    return result;
}

// Whether the group tells a shape, which is then among those found.
bool take(const WallFacets& wall, WallShape::Kind kind, const Faces& group, bool wide,
          ShapeSearch& search) {
    const auto [shape, faces] = grown_shape(wall, kind, group, search);
    if (!shape || !is_certain(wall, *shape, faces, search.seen) ||
        (wide && vertices_inside(wall, faces, search.seen) < kMinInside)) {
        if (faces.size() >= kManyInVain) {
            for (const std::int32_t f : faces) {
                search.tried[at(f)] = 1;
            }
        }
        return false;
    }
    for (const std::int32_t f : faces) {
        search.found.of_face[at(f)] = static_cast<std::int32_t>(search.found.shapes.size());
    }
    search.found.shapes.push_back(*shape);
    return true;
}

void try_curved(const WallFacets& wall, std::int32_t seed, ShapeSearch& search) {
    for (const bool wide : {false, true}) {
        const Faces group = group_around(wall, search.found.of_face, seed, wide);
        if (group.size() >= (wide ? kGroup : kMinGroup) &&
            (take(wall, WallShape::Kind::Ruled, group, wide, search) ||
             take(wall, WallShape::Kind::Ball, group, wide, search))) {
            return;
        }
        for (const std::int32_t f : group) {
            search.tried[at(f)] = 1;
        }
    }
}

// The wall's faces, the largest first.
Faces by_area(const WallFacets& wall) {
    Faces order;
    for (std::size_t f = 0; f < wall.facets.size(); ++f) {
        if (wall.is_wall(static_cast<std::int32_t>(f)) && wall.facets[f].area_mm2 > 0.0) {
            order.push_back(static_cast<std::int32_t>(f));
        }
    }
    std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        const double one = wall.facets[at(a)].area_mm2;
        const double other = wall.facets[at(b)].area_mm2;
        return one != other ? one > other : a < b;
    });
    return order;
}

}  // namespace

WallShapes find_wall_shapes(const LabelledMesh& part, const std::vector<char>& kept) {
    const WallFacets wall = facets_of(part, kept);
    const Faces order = by_area(wall);
    const std::size_t count = part.soup.faces.size();
    ShapeSearch search{std::vector<char>(count, 0), FaceSet(count), {}};
    search.found.of_face.assign(count, -1);
    // A round wall has planes of its own where a row is cut up: they come last.
    for (const bool flat : {false, true}) {
        std::fill(search.tried.begin(), search.tried.end(), char{0});
        for (const std::int32_t seed : order) {
            if (search.found.of_face[at(seed)] < 0 && search.tried[at(seed)] == 0) {
                check_interrupt();
                if (flat) {
                    take(wall, WallShape::Kind::Plane, {seed}, false, search);
                } else {
                    try_curved(wall, seed, search);
                }
            }
        }
    }
    return std::move(search.found);
}

}  // namespace meshwind
