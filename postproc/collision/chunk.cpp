#include "postproc/collision/chunk.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/small_linear.h"
#include "core/units.h"

namespace meshwind {

using Eigen::Vector3d;

namespace {

// Fewest and most faces of a capsule's mesh around its axis: a quarter turn must stay a few faces,
// and a drum of a metre within 0.1 mm takes 300.
constexpr int kFewestSides = 12;
constexpr int kMaxSides = 720;
// Squared lengths below this share of the larger one belong to points, not to segments.
constexpr double kPoint = 1e-24;

const Vector3d& corner_of(const Chunk& chunk, int i) {
    return chunk.corner[static_cast<std::size_t>(i)];
}

// True when the segment passes through the triangle.
bool crosses(const Vector3d& from, const Vector3d& to, const std::array<Vector3d, 3>& t) {
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double a = normal.dot(from - t[0]);
    const double b = normal.dot(to - t[0]);
    if (a * b > 0.0 || a == b) {
        return false;
    }
    const Vector3d hit = from + a / (a - b) * (to - from);
    for (std::size_t i = 0; i < 3; ++i) {
        if (normal.dot((t[(i + 1) % 3] - t[i]).cross(hit - t[i])) < 0.0) {
            return false;
        }
    }
    return true;
}

double side_distance(const Chunk& a, const Chunk& b) {
    double least = std::numeric_limits<double>::infinity();
    const int a_sides = a.corners == 2 ? 1 : 3;
    const int b_sides = b.corners == 2 ? 1 : 3;
    for (int i = 0; i < a_sides; ++i) {
        for (int j = 0; j < b_sides; ++j) {
            least = std::min(
                least, segment_distance_mm(corner_of(a, i), corner_of(a, (i + 1) % a.corners),
                                           corner_of(b, j), corner_of(b, (j + 1) % b.corners)));
        }
    }
    return least;
}

// Corners of `a` over the face of `b`, and its sides through it.
double face_distance(const Chunk& a, const Chunk& b) {
    double least = std::numeric_limits<double>::infinity();
    if (b.corners != 3) {
        return least;
    }
    const int sides = a.corners == 2 ? 1 : 3;
    for (int i = 0; i < sides; ++i) {
        if (crosses(corner_of(a, i), corner_of(a, (i + 1) % a.corners), b.corner)) {
            return 0.0;
        }
    }
    for (int i = 0; i < a.corners; ++i) {
        least = std::min(least, triangle_distance_mm(corner_of(a, i), b.corner));
    }
    return least;
}

}  // namespace

Vector3d Chunk::centre() const {
    return corners == 2 ? Vector3d(0.5 * (corner[0] + corner[1]))
                        : Vector3d((corner[0] + corner[1] + corner[2]) / 3.0);
}

double Chunk::reach_mm() const {
    const Vector3d c = centre();
    double reach = 0.0;
    for (int i = 0; i < corners; ++i) {
        reach = std::max(reach, (corner[static_cast<std::size_t>(i)] - c).norm());
    }
    return reach;
}

std::array<Chunk, 2> Chunk::halves() const {
    std::size_t from = 0;
    double longest = -1.0;
    for (std::size_t i = 0; i < (corners == 2 ? 1U : 3U); ++i) {
        const double length = (corner[(i + 1) % 3] - corner[i]).norm();
        if (length > longest) {
            longest = length;
            from = i;
        }
    }
    const std::size_t to = (from + 1) % 3;
    const Vector3d middle = 0.5 * (corner[from] + corner[to]);
    std::array<Chunk, 2> both{*this, *this};
    both[0].corner[to] = middle;
    both[1].corner[from] = middle;
    return both;
}

Chunk Chunk::moved(const Eigen::Isometry3d& motion) const {
    Chunk result = *this;
    for (Vector3d& point : result.corner) {
        point = motion * point;
    }
    return result;
}

Chunk chunk_of(const Capsule& capsule) {
    return {{capsule.from_mm, capsule.to_mm, capsule.to_mm}, 2, capsule.radius_mm};
}

std::vector<Chunk> chunks_of(const TriangleSoup& triangles) {
    std::vector<Chunk> chunks;
    for (const auto& f : triangles.faces) {
        const auto at = [&](std::size_t i) {
            return triangles.points_mm[static_cast<std::size_t>(f[i])];
        };
        chunks.push_back({{at(0), at(1), at(2)}, 3, 0.0});
    }
    return chunks;
}

double segment_distance_mm(const Vector3d& a0, const Vector3d& a1, const Vector3d& b0,
                           const Vector3d& b1) {
    const Vector3d u = a1 - a0;
    const Vector3d v = b1 - b0;
    const Vector3d w = a0 - b0;
    const double uu = u.squaredNorm();
    const double vv = v.squaredNorm();
    const double tiny = kPoint * std::max({uu, vv, w.squaredNorm()});
    const auto on_b = [&](double s) {
        return vv > tiny ? std::clamp((w + s * u).dot(v) / vv, 0.0, 1.0) : 0.0;
    };
    const auto on_a = [&](double t) {
        return uu > tiny ? std::clamp((t * v - w).dot(u) / uu, 0.0, 1.0) : 0.0;
    };
    // Nearest points of the lines, each brought back to its segment; parallel ones from the ends.
    const double uv = u.dot(v);
    const double determinant = u.cross(v).squaredNorm();
    double s = 0.0;
    if (determinant > tiny * std::max(uu, vv)) {
        s = std::clamp((uv * w.dot(v) - vv * w.dot(u)) / determinant, 0.0, 1.0);
    }
    double least = std::numeric_limits<double>::infinity();
    for (const double start : {s, 0.0, 1.0}) {
        const double t = on_b(start);
        const double back = on_a(t);
        least = std::min(least, (w + back * u - on_b(back) * v).norm());
    }
    return least;
}

double triangle_distance_mm(const Vector3d& point, const std::array<Vector3d, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    const Vector3d normal = (b - a).cross(c - a);
    bool over = normal.squaredNorm() > 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3d& from = triangle[i];
        const Vector3d& to = triangle[(i + 1) % 3];
        over = over && normal.dot((to - from).cross(point - from)) >= 0.0;
        least = std::min(least, segment_distance_mm(point, point, from, to));
    }
    return over ? std::abs(normal.dot(point - a)) / normal.norm() : least;
}

double chunk_distance_mm(const Chunk& a, const Chunk& b) {
    const double distance =
        std::min({side_distance(a, b), face_distance(a, b), face_distance(b, a)});
    return distance - a.radius_mm - b.radius_mm;
}

TriangleSoup capsule_mesh(const Capsule& capsule, double outside_mm) {
    // Corners lie on a wider capsule, on a grid of the angle `step` both ways. Half a face's
    // diagonal is at most sqrt(2) sin(step / 2) of its radius, so faces sink to sqrt(cos step).
    const double wider = 1.0 + outside_mm / capsule.radius_mm;
    const double widest = std::acos(1.0 / (wider * wider));
    const int wanted = static_cast<int>(std::ceil(2.0 * kPi / widest));
    const int quarter = (std::clamp(wanted, kFewestSides, kMaxSides) + 3) / 4;
    const int sides = 4 * quarter;
    const double step = 2.0 * kPi / sides;
    const double radius = capsule.radius_mm / std::sqrt(std::cos(step));

    const Vector3d along = capsule.to_mm - capsule.from_mm;
    const Vector3d z = along.norm() > 0.0 ? Vector3d(along.normalized()) : Vector3d::UnitZ();
    const Eigen::Quaterniond turn = shortest_turn(Vector3d::UnitZ(), z);
    TriangleSoup soup;
    // Rings from the pole behind `from` to the pole beyond `to`; both have the equator's ring.
    const int rings = 2 * quarter;
    for (int r = 0; r <= rings + 1; ++r) {
        const bool first = r <= quarter;
        const double latitude = step * (first ? r - quarter : r - quarter - 1);
        const Vector3d& centre = first ? capsule.from_mm : capsule.to_mm;
        for (int k = 0; k < sides; ++k) {
            const Vector3d out(std::cos(latitude) * std::cos(step * k),
                               std::cos(latitude) * std::sin(step * k), std::sin(latitude));
            soup.points_mm.push_back(centre + radius * (turn * out));
        }
    }
    for (int r = 0; r <= rings; ++r) {
        if (r == quarter && along.norm() == 0.0) {
            continue;  // a ball has no side
        }
        for (int k = 0; k < sides; ++k) {
            const std::int32_t a = r * sides + k;
            const std::int32_t b = r * sides + (k + 1) % sides;
            if (r > 0) {
                soup.faces.push_back({a, b, b + sides});
            }
            if (r < rings) {
                soup.faces.push_back({a, b + sides, a + sides});
            }
        }
    }
    return soup;
}

}  // namespace meshwind
