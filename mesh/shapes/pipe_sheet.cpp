#include "mesh/shapes/pipe_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/index.h"
#include "mesh/shapes/planar_delaunay.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void add_triangle(TriangleSoup& soup, std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a != b && b != c && c != a) {
        soup.faces.push_back({a, b, c});
    }
}

double segment_distance(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
}

// Shortest image of b - a on a sheet that repeats along the arc.
Vector2d step_between(const PipeSheet& sheet, const Vector2d& a, const Vector2d& b) {
    Vector2d step = b - a;
    step.x() -= sheet.period_mm * std::round(step.x() / sheet.period_mm);
    return step;
}

std::size_t stripe_of(const PipeSheet& sheet, double arc_mm) {
    const double turns = into_period(arc_mm, sheet.period_mm) / sheet.period_mm;
    const auto stripes = static_cast<double>(sheet.by_arc.size());
    return static_cast<std::size_t>(std::min(std::floor(turns * stripes), stripes - 1.0));
}

// Sorts the segments of the contact curve by the stripes of arc that they start in. Stripes are a
// little wider than the curve's longest segment and `reach_mm` together: a segment that comes so
// near to a place along the arc starts in its stripe or in one beside it.
void sort_contact(PipeSheet& sheet, double reach_mm) {
    double longest = 0.0;
    for (std::int32_t i = 0; i < sheet.contact_count; ++i) {
        const Vector2d& next = sheet.flat[at((i + 1) % sheet.contact_count)];
        longest = std::max(longest, step_between(sheet, sheet.flat[at(i)], next).norm());
    }
    constexpr double kWider = 1.001;
    const double stripes = std::floor(sheet.period_mm / (kWider * (longest + reach_mm)));
    sheet.by_arc.assign(static_cast<std::size_t>(std::max(1.0, stripes)), {});
    for (std::int32_t i = 0; i < sheet.contact_count; ++i) {
        sheet.by_arc[stripe_of(sheet, sheet.flat[at(i)].x())].push_back(i);
    }
}

// Calls `visit` for the segments that may start within a stripe's width of a place along the arc,
// each once.
template <typename Visit>
void for_segments_near(const PipeSheet& sheet, double arc_mm, const Visit& visit) {
    const std::size_t stripes = sheet.by_arc.size();
    const std::size_t middle = stripe_of(sheet, arc_mm);
    const std::size_t sides = std::min<std::size_t>(stripes, 3);
    for (std::size_t k = 0; k < sides; ++k) {
        for (const std::int32_t i : sheet.by_arc[(middle + stripes - 1 + k) % stripes]) {
            visit(i);
        }
    }
}

// Whether the contact curve is nearer than what it was sorted for.
bool is_near_contact(const PipeSheet& sheet, const Vector2d& p, double distance_mm) {
    bool near = false;
    for_segments_near(sheet, p.x(), [&](std::int32_t i) {
        const Vector2d& a = sheet.flat[at(i)];
        const Vector2d& b = sheet.flat[at((i + 1) % sheet.contact_count)];
        const Vector2d start = step_between(sheet, p, a);
        near = near || segment_distance(Vector2d::Zero(), start,
                                        start + step_between(sheet, a, b)) <= distance_mm;
    });
    return near;
}

// Crossings of the curve by the ray from p towards smaller axial values: odd means p is above it (a
// curve around the period) or within it (a closed one).
bool is_across(const PipeSheet& sheet, const Vector2d& p) {
    bool odd = false;
    for_segments_near(sheet, p.x(), [&](std::int32_t i) {
        const Vector2d& first = sheet.flat[at(i)];
        const Vector2d a = step_between(sheet, p, first);
        const Vector2d b =
            a + step_between(sheet, first, sheet.flat[at((i + 1) % sheet.contact_count)]);
        if ((a.x() > 0.0) != (b.x() > 0.0)) {
            const double height = a.y() - a.x() * (b.y() - a.y()) / (b.x() - a.x());
            odd = odd != (height < 0.0);
        }
    });
    return odd;
}

// Rows of a triangular lattice, the last and for `from_mm` at a rim the first exactly on the rims.
void add_lattice(TriangleSoup& soup, PipeSheet& sheet, const SheetPiece& piece, double edge_mm) {
    // Nearer to the curve than this a point would only be collapsed again.
    const double clearance = 0.6 * edge_mm;
    sort_contact(sheet, clearance);
    const std::int32_t around = steps_of(sheet.period_mm, edge_mm, 6);
    const double length = piece.to_mm - piece.from_mm;
    const std::int32_t rows = steps_of(length, edge_mm * std::sqrt(0.75), 1);
    for (std::int32_t row = 0; row <= rows; ++row) {
        for (std::int32_t i = 0; i < around; ++i) {
            const double arc = sheet.period_mm * (i + 0.5 * (row % 2)) / around;
            const Vector2d flat(arc, piece.to_mm - length * row / rows);
            if (is_across(sheet, flat) == piece.piece_across &&
                !is_near_contact(sheet, flat, clearance)) {
                sheet.ids.push_back(static_cast<std::int32_t>(soup.points_mm.size()));
                sheet.flat.push_back(flat);
                soup.points_mm.push_back(piece.roll(flat));
            }
        }
    }
}

// Triangulates the sheet with copies of its margins on both sides, then keeps one period of it.
void triangulate(TriangleSoup& soup, const PipeSheet& sheet, bool piece_across, double edge_mm) {
    const double margin = std::min(0.5 * sheet.period_mm, 8.0 * edge_mm);
    std::vector<Vector2d> points;
    std::vector<std::int32_t> source;
    std::vector<std::array<std::int32_t, 3>> image(sheet.flat.size(), {-1, -1, -1});
    for (std::size_t i = 0; i < sheet.flat.size(); ++i) {
        for (std::int32_t copy = 0; copy < 3; ++copy) {
            const Vector2d p = sheet.flat[i] + Vector2d((copy - 1) * sheet.period_mm, 0.0);
            if (p.x() > -margin && p.x() < sheet.period_mm + margin) {
                image[i][at(copy)] = static_cast<std::int32_t>(points.size());
                points.push_back(p);
                source.push_back(sheet.ids[i]);
            }
        }
    }
    std::vector<std::array<std::int32_t, 2>> constraints;
    for (std::int32_t i = 0; i < sheet.contact_count; ++i) {
        const std::int32_t next = (i + 1) % sheet.contact_count;
        const double jump = sheet.flat[at(next)].x() - sheet.flat[at(i)].x();
        const auto shift = static_cast<std::int32_t>(std::lround(jump / sheet.period_mm));
        for (std::int32_t copy = std::max(0, shift); copy < std::min(3, 3 + shift); ++copy) {
            const std::int32_t a = image[at(i)][at(copy)];
            const std::int32_t b = image[at(next)][at(copy - shift)];
            if (a >= 0 && b >= 0) {
                constraints.push_back({a, b});
            }
        }
    }
    // Off the lattice's symmetry lines, where a centroid could fall on either side by rounding.
    const double cut = 0.13 * edge_mm;
    for (const auto& [a, b, c] : planar_delaunay(points, constraints)) {
        const Vector2d centroid = (points[at(a)] + points[at(b)] + points[at(c)]) / 3.0;
        if (centroid.x() >= cut && centroid.x() < cut + sheet.period_mm &&
            is_across(sheet, centroid) == piece_across) {
            soup.faces.push_back({source[at(a)], source[at(b)], source[at(c)]});
        }
    }
}

}  // namespace

double into_period(double value, double period) {
    return value - period * std::floor(value / period);
}

void join_rows(TriangleSoup& soup, const VertexRow& right, const VertexRow& left, bool closed) {
    for (std::size_t i = 0; i + (closed ? 0 : 1) < right.size(); ++i) {
        const std::size_t next = (i + 1) % right.size();
        const auto point = [&](std::int32_t id) { return soup.points_mm[at(id)]; };
        const bool rising = (point(right[i]) - point(left[next])).squaredNorm() <
                            (point(right[next]) - point(left[i])).squaredNorm();
        if (rising) {
            add_triangle(soup, right[i], left[next], right[next]);
            add_triangle(soup, right[i], left[i], left[next]);
        } else {
            add_triangle(soup, right[i], left[i], right[next]);
            add_triangle(soup, right[next], left[i], left[next]);
        }
    }
}

void mesh_piece(TriangleSoup& soup, PipeSheet& sheet, const SheetPiece& piece, double edge_mm) {
    add_lattice(soup, sheet, piece, edge_mm);
    triangulate(soup, sheet, piece.piece_across, edge_mm);
}

}  // namespace meshwind
