#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/units.h"
#include "mesh/shapes/analytic.h"
#include "mesh/shapes/make_parts.h"
#include "mesh/shapes/make_walls.h"
#include "mesh/shapes/planar_delaunay.h"
#include "mesh/shapes/remesh.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::int32_t count_of(double length, double step) {
    return static_cast<std::int32_t>(std::lround(length / step));
}

// A cylinder unrolled to (arc, axial), with its closed contact curve and the lattice on its piece
// side.
struct Sheet {
    double period_mm = 0.0;
    std::vector<Vector2d> flat;      // contact curve first, then the lattice; arc within one period
    std::vector<std::int32_t> ids;   // of the points in the soup
    std::int32_t contact_count = 0;  // the curve closes over the period or within it
    std::vector<std::vector<std::int32_t>> by_arc;  // segments of the curve, by stripes of arc
};

constexpr int kTable = 512;

// Lengths along the spine from psi = 0, at kTable steps to pi / 2.
std::vector<double> quarter_lengths(const TeeShape& shape) {
    std::vector<double> length(kTable + 1, 0.0);
    Vector3d last = tee_spine_mm(shape, 0.0);
    for (int i = 1; i <= kTable; ++i) {
        const Vector3d next = tee_spine_mm(shape, 0.5 * kPi * i / kTable);
        length[at(i)] = length[at(i - 1)] + (next - last).norm();
        last = next;
    }
    return length;
}

// Even steps along the contact curves; the quarters' ends are always among the angles, since equal
// radii have a kink there.
std::vector<double> contact_angles(const TeeShape& shape, double edge_mm) {
    TeeShape mirrored = shape;
    mirrored.lean_rad = -shape.lean_rad;
    const std::vector<double> near = quarter_lengths(shape);
    const std::vector<double> far = quarter_lengths(mirrored);
    std::vector<double> angles;
    for (std::int32_t corner = 0; corner < 4; ++corner) {
        const std::vector<double>& length = corner == 0 || corner == 3 ? near : far;
        const std::int32_t quarter = std::max(3, count_of(length.back(), edge_mm));
        const bool from_behind = corner % 2 == 1;
        for (std::int32_t step = 0; step < quarter; ++step) {
            const double wanted = length.back() * (from_behind ? quarter - step : step) / quarter;
            const auto above = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
            const double fraction = (wanted - *(above - 1)) / (*above - *(above - 1));
            const double psi =
                0.5 * kPi * (static_cast<double>(above - 1 - length.begin()) + fraction) / kTable;
            const double base = 0.5 * kPi * corner;
            angles.push_back(from_behind ? base + 0.5 * kPi - psi : base + psi);
        }
    }
    return angles;
}

// Rows across the blend between the two contact curves, the curves included. \return ids per row
std::vector<std::vector<std::int32_t>> add_blend_rows(TriangleSoup& soup, const TeeShape& shape,
                                                      const std::vector<double>& angles,
                                                      double edge_mm) {
    const std::int32_t steps = std::max(1, count_of(0.4 * kPi * shape.blend_radius_mm, edge_mm));
    std::vector<std::vector<std::int32_t>> rows(at(steps + 1));
    for (const double psi : angles) {
        const BlendArc arc = blend_arc(shape, psi);
        // Below a micrometre the blend has vanished (equal radii): one point stands for all rows.
        const bool vanished = (arc.to_run - arc.to_branch).norm() * shape.blend_radius_mm < 1e-3;
        for (std::int32_t row = 0; row <= steps; ++row) {
            if (row == 0 || !vanished) {
                const Vector3d way = arc.direction(static_cast<double>(row) / steps);
                soup.points_mm.push_back(arc.centre_mm + shape.blend_radius_mm * way);
            }
            rows[at(row)].push_back(static_cast<std::int32_t>(soup.points_mm.size()) - 1);
        }
    }
    return rows;
}

void add_triangle(TriangleSoup& soup, std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a != b && b != c && c != a) {
        soup.faces.push_back({a, b, c});
    }
}

void join_rows(TriangleSoup& soup, const std::vector<std::int32_t>& run_side,
               const std::vector<std::int32_t>& branch_side) {
    for (std::size_t i = 0; i < run_side.size(); ++i) {
        const std::size_t next = (i + 1) % run_side.size();
        const auto point = [&](std::int32_t id) { return soup.points_mm[at(id)]; };
        const bool rising = (point(run_side[i]) - point(branch_side[next])).squaredNorm() <
                            (point(run_side[next]) - point(branch_side[i])).squaredNorm();
        if (rising) {
            add_triangle(soup, run_side[i], branch_side[next], run_side[next]);
            add_triangle(soup, run_side[i], branch_side[i], branch_side[next]);
        } else {
            add_triangle(soup, run_side[i], branch_side[i], run_side[next]);
            add_triangle(soup, run_side[next], branch_side[i], branch_side[next]);
        }
    }
}

// Shift by whole periods that brings `arc` into [0, period).
double into_period(double arc, double period) {
    return arc - period * std::floor(arc / period);
}

double segment_distance(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
}

// Shortest image of b - a on a sheet that repeats along the arc.
Vector2d step_between(const Sheet& sheet, const Vector2d& a, const Vector2d& b) {
    Vector2d step = b - a;
    step.x() -= sheet.period_mm * std::round(step.x() / sheet.period_mm);
    return step;
}

std::size_t stripe_of(const Sheet& sheet, double arc_mm) {
    const double turns = into_period(arc_mm, sheet.period_mm) / sheet.period_mm;
    const auto stripes = static_cast<double>(sheet.by_arc.size());
    return static_cast<std::size_t>(std::min(std::floor(turns * stripes), stripes - 1.0));
}

// Sorts the segments of the contact curve by the stripes of arc that they start in. Stripes are a
// little wider than the curve's longest segment and `reach_mm` together: a segment that comes so
// near to a place along the arc starts in its stripe or in one beside it.
void sort_contact(Sheet& sheet, double reach_mm) {
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
void for_segments_near(const Sheet& sheet, double arc_mm, const Visit& visit) {
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
bool is_near_contact(const Sheet& sheet, const Vector2d& p, double distance_mm) {
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
bool is_across(const Sheet& sheet, const Vector2d& p) {
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

struct Lattice {
    double from_mm;     // axial, a rim or below the piece
    double to_mm;       // axial, a rim
    bool piece_across;  // which side of the contact curve is meshed
};

// Rows of a triangular lattice, the last and for `from_mm` at a rim the first exactly on the rims.
void add_lattice(TriangleSoup& soup, Sheet& sheet, const Lattice& lattice, double edge_mm,
                 const std::function<Vector3d(const Vector2d&)>& roll) {
    // Nearer to the curve than this a point would only be collapsed again.
    const double clearance = 0.6 * edge_mm;
    sort_contact(sheet, clearance);
    const std::int32_t around = std::max(6, count_of(sheet.period_mm, edge_mm));
    const double length = lattice.to_mm - lattice.from_mm;
    const std::int32_t rows = std::max(1, count_of(length, edge_mm * std::sqrt(0.75)));
    for (std::int32_t row = 0; row <= rows; ++row) {
        for (std::int32_t i = 0; i < around; ++i) {
            const double arc = sheet.period_mm * (i + 0.5 * (row % 2)) / around;
            const Vector2d flat(arc, lattice.to_mm - length * row / rows);
            if (is_across(sheet, flat) == lattice.piece_across &&
                !is_near_contact(sheet, flat, clearance)) {
                sheet.ids.push_back(static_cast<std::int32_t>(soup.points_mm.size()));
                sheet.flat.push_back(flat);
                soup.points_mm.push_back(roll(flat));
            }
        }
    }
}

// Triangulates the sheet with copies of its margins on both sides, then keeps one period of it.
void mesh_sheet(TriangleSoup& soup, const Sheet& sheet, bool piece_across, double edge_mm) {
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

void add_run(TriangleSoup& soup, const TeeShape& shape, const std::vector<std::int32_t>& contact,
             double edge_mm) {
    const double radius = shape.run_radius_mm;
    Sheet sheet;
    sheet.period_mm = 2.0 * kPi * radius;
    sheet.contact_count = static_cast<std::int32_t>(contact.size());
    sheet.ids = contact;
    for (const std::int32_t id : contact) {
        // The arc starts at the back of the branch, so that the hole lies inside one period.
        const Vector3d& p = soup.points_mm[at(id)];
        sheet.flat.emplace_back(radius * (kPi + std::atan2(p.y(), p.x())), p.z());
    }
    const double half = 0.5 * shape.run_length_mm;
    add_lattice(soup, sheet, {-half, half, false}, edge_mm, [&](const Vector2d& flat) {
        const double phi = flat.x() / radius - kPi;
        return Vector3d(radius * std::cos(phi), radius * std::sin(phi), flat.y());
    });
    mesh_sheet(soup, sheet, false, edge_mm);
}

void add_branch(TriangleSoup& soup, const TeeShape& shape, const std::vector<std::int32_t>& contact,
                double edge_mm) {
    const double radius = shape.branch_radius_mm;
    // The cut between periods stays clear of the four symmetry lines of the contact curve.
    constexpr double kCutAngle = 0.4;
    Sheet sheet;
    sheet.period_mm = 2.0 * kPi * radius;
    sheet.contact_count = static_cast<std::int32_t>(contact.size());
    sheet.ids = contact;
    double lowest = shape.branch_length_mm;
    for (const std::int32_t id : contact) {
        const Vector3d p = seen_from_branch(shape, soup.points_mm[at(id)]);
        // From +y to +z around +x: counter-clockwise seen from outside with the axis upward.
        const double arc = radius * (std::atan2(p.z(), p.y()) - kCutAngle);
        sheet.flat.emplace_back(into_period(arc, sheet.period_mm), p.x());
        lowest = std::min(lowest, p.x());
    }
    add_lattice(
        soup, sheet, {lowest, shape.branch_length_mm, true}, edge_mm, [&](const Vector2d& flat) {
            const double psi = flat.x() / radius + kCutAngle;
            return seen_from_run(shape, {flat.y(), radius * std::cos(psi), radius * std::sin(psi)});
        });
    mesh_sheet(soup, sheet, true, edge_mm);
}

}  // namespace

MadeWall wall_of(const TeeShape& shape, double edge_mm) {
    TriangleSoup soup;
    const std::vector<double> angles = contact_angles(shape, edge_mm);
    const auto rows = add_blend_rows(soup, shape, angles, edge_mm);
    for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
        join_rows(soup, rows[row], rows[row + 1]);
    }
    add_run(soup, shape, rows.front(), edge_mm);
    add_branch(soup, shape, rows.back(), edge_mm);
    const auto project = [&](const Vector3d& p) { return tee_foot(shape, p).point_mm; };
    return {remesh_onto(soup, project, {.edge_mm = edge_mm}), {}};
}

}  // namespace meshwind
