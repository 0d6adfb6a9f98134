#include "mesh/even/wall_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <Eigen/Cholesky>
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
constexpr std::size_t kLeastGroup = 6;

// So few short facets turn too little to tell a shape; then so many are looked at, those first that
// turn least. They have vertices inside: one row of a curved surface has none, and lies on a cone.
constexpr std::size_t kWideGroup = 128;

// Facets of which so many lie on a shape that is none are not looked at again: from each of them
// the same would be found.
constexpr std::size_t kManyInVain = 256;

// A shape's own normals turn by less than this over a facet (46 degrees), and the facet's is among
// them within this (3 degrees).
constexpr double kMostTurnRad = 0.8;
constexpr double kNormalRad = 0.05;

// Fewer facets than this lie in a plane by chance: a row of facets has two in each.
// A strip is one facet of a round wall in pieces; a disc has 0.08, a strip of 1 : 10 has 0.02 of
// its outline's square as area.
constexpr std::size_t kLeastInPlane = 6;
constexpr double kCompact = 0.02;

// Planes below this share of the part's size squared have no long facets.
constexpr double kLargePlane = 0.05;

// What is rounder than this share of the part's size is an edge: even meshes come no nearer to it.
constexpr double kRoundest = 2e-3;

// A ball has vertices within, away from its outline. Flatter than this times the part's size it is
// no ball, nor a cylinder.
constexpr int kLeastInside = 3;
constexpr double kFlattest = 10.0;

constexpr int kMostGrowths = 4;

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

WallShape plane_through(std::span<const Vector3d> points, const Vector3d& normal) {
    WallShape shape;
    shape.kind = WallShape::Kind::Plane;
    shape.normal = normal;
    for (const Vector3d& p : points) {
        shape.centre_mm += p / static_cast<double>(points.size());
    }
    return shape;
}

// Least squares of |p - c|^2 = r^2.
std::optional<WallShape> fit_ball(std::span<const Vector3d> points) {
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : points) {
        mean += p / static_cast<double>(points.size());
    }
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Vector3d& p : points) {
        const Vector3d d = p - mean;
        const Eigen::Vector4d row(2.0 * d.x(), 2.0 * d.y(), 2.0 * d.z(), 1.0);
        sum += row * row.transpose();
        right += d.squaredNorm() * row;
    }
    const Eigen::Vector4d x = sum.ldlt().solve(right);
    const double squared = x[3] + x.head<3>().squaredNorm();
    if (!x.allFinite() || !(squared > 0.0)) {
        return std::nullopt;
    }
    WallShape shape;
    shape.kind = WallShape::Kind::Ball;
    shape.centre_mm = mean + x.head<3>();
    shape.radius_mm = std::sqrt(squared);
    return shape;
}

class ShapeFinder {
public:
    ShapeFinder(const LabelledMesh& part, const std::vector<char>& kept)
        : part_(part),
          kept_(kept),
          neighbours_(face_neighbours(part.soup.faces)),
          size_mm_(size_mm(part, kept)),
          off_mm_(kOff * size_mm_),
          mark_(part.soup.faces.size(), 0),
          tried_(part.soup.faces.size(), 0) {
        found_.of_face.assign(part.soup.faces.size(), -1);
        for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
            measure(static_cast<std::int32_t>(f));
        }
    }

    WallShapes run() {
        Faces order;
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            if (is_wall(static_cast<std::int32_t>(f)) && facets_[f].area_mm2 > 0.0) {
                order.push_back(static_cast<std::int32_t>(f));
            }
        }
        std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
            const double one = facets_[at(a)].area_mm2;
            const double other = facets_[at(b)].area_mm2;
            return one != other ? one > other : a < b;
        });
        // A round wall has planes of its own where a row is cut up: they come last.
        for (const bool flat : {false, true}) {
            std::fill(tried_.begin(), tried_.end(), char{0});
            for (const std::int32_t seed : order) {
                if (found_.of_face[at(seed)] < 0 && tried_[at(seed)] == 0) {
                    check_interrupt();
                    try_seed(seed, flat);
                }
            }
        }
        return std::move(found_);
    }

private:
    struct Facet {
        Vector3d normal = Vector3d::Zero();
        double area_mm2 = 0.0;
        double longest_mm = 0.0;
    };

    [[nodiscard]] const Vector3d& point(std::int32_t face, std::size_t c) const {
        return part_.soup.points_mm[at(part_.soup.faces[at(face)][c % 3])];
    }
    [[nodiscard]] double edge_mm(std::int32_t face, std::size_t e) const {
        return (point(face, e + 1) - point(face, e)).norm();
    }
    [[nodiscard]] bool is_wall(std::int32_t face) const {
        return kept_[at(part_.region[at(face)])] != 0;
    }
    // The wall's face beyond an edge that is no crease, or -1.
    [[nodiscard]] std::int32_t beyond(std::int32_t face, std::size_t e) const {
        const std::int32_t next = neighbours_[at(face)][e];
        return next >= 0 && part_.feature[at(face)][e] == 0 && is_wall(next) ? next : -1;
    }

    void measure(std::int32_t f) {
        Facet facet;
        const Vector3d twice = (point(f, 1) - point(f, 0)).cross(point(f, 2) - point(f, 0));
        facet.area_mm2 = 0.5 * twice.norm();
        facet.normal = twice.normalized();
        facet.longest_mm = std::max({edge_mm(f, 0), edge_mm(f, 1), edge_mm(f, 2)});
        facets_.push_back(facet);
    }

    [[nodiscard]] bool tells_normal(std::int32_t f) const {
        const Facet& facet = facets_[at(f)];
        return 2.0 * facet.area_mm2 > kTellsNormalShare * size_mm_ * facet.longest_mm;
    }

    [[nodiscard]] double off_mm(const WallShape& shape) const {
        const double radius =
            shape.kind == WallShape::Kind::Ball ? shape.radius_mm : shape.ruled.radius_mm;
        return shape.kind == WallShape::Kind::Plane
                   ? off_mm_
                   : std::clamp(kOffOfRadius * radius, kRounding * size_mm_, off_mm_);
    }

    [[nodiscard]] bool lies_on(const WallShape& shape, std::int32_t f) const {
        std::array<Vector3d, 3> normal;
        const double off = off_mm(shape);
        for (std::size_t c = 0; c < 3; ++c) {
            if (!(shape.distance_mm(point(f, c)) <= off)) {
                return false;
            }
            normal[c] = shape.normal_at(point(f, c));
            if (normal[c].dot(normal[0]) < 0.0) {
                return false;
            }
        }
        const double turn =
            std::max({angle_rad(normal[0], normal[1]), angle_rad(normal[1], normal[2]),
                      angle_rad(normal[2], normal[0])});
        if (turn > kMostTurnRad) {
            return false;
        }
        const Vector3d& own = facets_[at(f)].normal;
        const double side = own.dot(normal[0]) < 0.0 ? -1.0 : 1.0;
        return !tells_normal(f) ||
               std::all_of(normal.begin(), normal.end(), [&](const Vector3d& n) {
                   return angle_rad(own, side * n) <= turn + kNormalRad;
               });
    }

    // Facets around one, over their long edges: the nearest, or those that turn least.
    [[nodiscard]] Faces group_around(std::int32_t seed, bool wide) const {
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
                const std::int32_t g = beyond(f, e);
                const double length = edge_mm(f, e);
                if (g >= 0 && found_.of_face[at(g)] < 0 &&
                    length >= kAlong * facets_[at(f)].longest_mm &&
                    length >= kAlong * facets_[at(g)].longest_mm) {
                    seen += 1.0;
                    next.emplace(
                        wide ? angle_rad(facets_[at(f)].normal, facets_[at(g)].normal) : seen, g);
                }
            }
        }
        return group;
    }

    // All faces on the shape that hang together with the first of `seeds` that lies on it.
    [[nodiscard]] Faces grown(const WallShape& shape, const Faces& seeds) {
        Faces faces;
        ++round_;
        const auto look = [&](std::int32_t f) {
            if (found_.of_face[at(f)] < 0 && mark_[at(f)] != round_) {
                mark_[at(f)] = round_;
                if (lies_on(shape, f)) {
                    faces.push_back(f);
                }
            }
        };
        for (std::size_t i = 0; i < seeds.size() && faces.empty(); ++i) {
            look(seeds[i]);
        }
        for (std::size_t i = 0; i < faces.size(); ++i) {
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = beyond(faces[i], e);
                if (g >= 0) {
                    look(g);
                }
            }
        }
        return faces;
    }

    [[nodiscard]] std::optional<WallShape> fit(WallShape::Kind kind, const Faces& faces) const {
        std::vector<std::int32_t> vertices;
        std::vector<RuledFacet> facets;
        Vector3d normal = Vector3d::Zero();
        for (const std::int32_t f : faces) {
            const auto& v = part_.soup.faces[at(f)];
            vertices.insert(vertices.end(), v.begin(), v.end());
            const Facet& facet = facets_[at(f)];
            facets.push_back(
                {(point(f, 0) + point(f, 1) + point(f, 2)) / 3.0, facet.normal, facet.area_mm2});
            normal += facet.area_mm2 * facet.normal;
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        std::vector<Vector3d> points;
        points.reserve(vertices.size());
        for (const std::int32_t v : vertices) {
            points.push_back(part_.soup.points_mm[at(v)]);
        }
        std::optional<WallShape> shape;
        if (kind == WallShape::Kind::Plane) {
            shape = plane_through(points, normal.normalized());
        } else if (kind == WallShape::Kind::Ball) {
            shape = fit_ball(points);
        } else if (const auto ruled = fit_ruled_shape(points, facets)) {
            shape.emplace();
            shape->kind = WallShape::Kind::Ruled;
            shape->ruled = *ruled;
        }
        if (!shape || !is_round(*shape)) {
            return std::nullopt;
        }
        const bool on = std::all_of(points.begin(), points.end(), [&](const Vector3d& p) {
            return shape->distance_mm(p) <= off_mm(*shape);
        });
        return on ? shape : std::nullopt;
    }

    [[nodiscard]] bool is_round(const WallShape& shape) const {
        const double radius =
            shape.kind == WallShape::Kind::Ball ? shape.radius_mm : shape.ruled.radius_mm;
        return shape.kind == WallShape::Kind::Plane ||
               (radius > kRoundest * size_mm_ && radius < kFlattest * size_mm_);
    }

    void try_seed(std::int32_t seed, bool flat) {
        if (flat) {
            take(WallShape::Kind::Plane, {seed}, false);
            return;
        }
        for (const bool wide : {false, true}) {
            const Faces group = group_around(seed, wide);
            if (group.size() >= (wide ? kGroup : kLeastGroup) &&
                (take(WallShape::Kind::Ruled, group, wide) ||
                 take(WallShape::Kind::Ball, group, wide))) {
                return;
            }
            for (const std::int32_t f : group) {
                tried_[at(f)] = 1;
            }
        }
    }

    bool take(WallShape::Kind kind, const Faces& group, bool wide) {
        std::optional<WallShape> shape = fit(kind, group);
        Faces faces;
        for (int i = 0; shape && i < kMostGrowths; ++i) {
            Faces more = grown(*shape, group);
            if (more.size() <= faces.size()) {
                break;
            }
            faces = std::move(more);
            const std::optional<WallShape> better = fit(kind, faces);
            if (!better) {
                break;
            }
            shape = better;
        }
        if (!shape || !is_certain(*shape, faces) ||
            (wide && vertices_inside(faces) < kLeastInside)) {
            if (faces.size() >= kManyInVain) {
                for (const std::int32_t f : faces) {
                    tried_[at(f)] = 1;
                }
            }
            return false;
        }
        for (const std::int32_t f : faces) {
            found_.of_face[at(f)] = static_cast<std::int32_t>(found_.shapes.size());
        }
        found_.shapes.push_back(*shape);
        return true;
    }

    [[nodiscard]] bool is_certain(const WallShape& shape, const Faces& faces) {
        if (shape.kind == WallShape::Kind::Plane) {
            return faces.size() >= kLeastInPlane && is_compact(faces);
        }
        if (shape.kind == WallShape::Kind::Ball) {
            return faces.size() >= kGroup && vertices_inside(faces) >= kLeastInside;
        }
        return faces.size() >= kLeastGroup && !is_of_a_curve(shape.ruled, faces);
    }

    void mark(const Faces& faces) {
        ++round_;
        for (const std::int32_t f : faces) {
            mark_[at(f)] = round_;
        }
    }

    // Vertices all of whose faces are among these.
    [[nodiscard]] int vertices_inside(const Faces& faces) {
        mark(faces);
        Faces all;
        Faces border;
        for (const std::int32_t f : faces) {
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = neighbours_[at(f)][e];
                const auto& v = part_.soup.faces[at(f)];
                all.push_back(v[e]);
                if (g < 0 || mark_[at(g)] != round_) {
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
    [[nodiscard]] bool is_compact(const Faces& faces) {
        mark(faces);
        double area = 0.0;
        double outline = 0.0;
        for (const std::int32_t f : faces) {
            area += facets_[at(f)].area_mm2;
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = neighbours_[at(f)][e];
                outline += g >= 0 && mark_[at(g)] == round_ ? 0.0 : edge_mm(f, e);
            }
        }
        return area > kCompact * outline * outline && area > kLargePlane * size_mm_ * size_mm_;
    }

    // Whether an edge runs across the rulings.
    [[nodiscard]] bool is_across(const RuledShape& shape, std::int32_t f, std::size_t e) const {
        const Vector3d way = point(f, e + 1) - point(f, e);
        const Vector3d d = 0.5 * (point(f, e + 1) + point(f, e)) - shape.origin_mm;
        const Vector3d out = (d - d.dot(shape.axis) * shape.axis).normalized();
        const Vector3d ruling = (shape.axis + shape.growth * out).normalized();
        return std::abs(way.dot(ruling)) < kAcross * way.norm();
    }

    // A row between two others of its kind, to both of which it turns to the same side.
    [[nodiscard]] bool is_of_a_curve(const RuledShape& shape, const Faces& faces) {
        mark(faces);
        double area = 0.0;
        double whole = 0.0;
        std::array<double, 2> side{};
        double longest = 0.0;
        for (const std::int32_t f : faces) {
            area += facets_[at(f)].area_mm2;
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = neighbours_[at(f)][e];
                if ((g >= 0 && mark_[at(g)] == round_) || !is_across(shape, f, e)) {
                    continue;
                }
                const double length = edge_mm(f, e);
                whole += length;
                const std::int32_t next = beyond(f, e);
                if (next < 0) {
                    continue;
                }
                const double turn = signed_angle_rad(
                    facets_[at(f)].normal, facets_[at(next)].normal, point(f, e + 1) - point(f, e));
                if (std::abs(turn) > kTurnsRad) {
                    side[turn > 0.0 ? 0 : 1] += length;
                    longest = std::max(longest, 2.0 * facets_[at(next)].area_mm2 / length);
                }
            }
        }
        const double own = whole > 0.0 ? 2.0 * area / whole : 0.0;
        return std::max(side[0], side[1]) > kOneSide * whole && own < kShort * longest;
    }

    const LabelledMesh& part_;
    const std::vector<char>& kept_;
    std::vector<std::array<std::int32_t, 3>> neighbours_;
    double size_mm_;
    double off_mm_;
    std::vector<Facet> facets_;
    std::vector<int> mark_;  // per face: in which round it was looked at
    std::vector<char> tried_;
    int round_ = 0;
    WallShapes found_;
};

}  // namespace

Vector3d WallShape::nearest(const Vector3d& p) const {
    if (kind == Kind::Ruled) {
        return ruled.nearest(p);
    }
    if (kind == Kind::Ball) {
        return centre_mm + radius_mm * (p - centre_mm).normalized();
    }
    return p - normal.dot(p - centre_mm) * normal;
}

double WallShape::distance_mm(const Vector3d& p) const {
    if (kind == Kind::Ruled) {
        return ruled.distance_mm(p);
    }
    if (kind == Kind::Ball) {
        return std::abs((p - centre_mm).norm() - radius_mm);
    }
    return std::abs(normal.dot(p - centre_mm));
}

Vector3d WallShape::normal_at(const Vector3d& p) const {
    if (kind == Kind::Ruled) {
        const Vector3d d = p - ruled.origin_mm;
        const Vector3d out = (d - d.dot(ruled.axis) * ruled.axis).normalized();
        return (out - ruled.growth * ruled.axis).normalized();
    }
    return kind == Kind::Ball ? (p - centre_mm).normalized() : normal;
}

WallShapes find_wall_shapes(const LabelledMesh& part, const std::vector<char>& kept) {
    return ShapeFinder(part, kept).run();
}

}  // namespace meshwind
