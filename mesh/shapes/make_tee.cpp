#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "mesh/shapes/analytic.h"
#include "mesh/shapes/make_parts.h"
#include "mesh/shapes/make_walls.h"
#include "mesh/shapes/pipe_sheet.h"
#include "mesh/shapes/remesh.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Even steps along the contact curves; the quarters' ends are always among the angles, since equal
// radii have a kink there.
std::vector<double> contact_angles(const TeeShape& shape, double edge_mm) {
    TeeShape mirrored = shape;
    mirrored.lean_rad = -shape.lean_rad;
    const QuarterLengths near([&](double psi) { return tee_spine_mm(shape, psi); });
    const QuarterLengths far([&](double psi) { return tee_spine_mm(mirrored, psi); });
    std::vector<double> angles;
    for (std::int32_t corner = 0; corner < 4; ++corner) {
        const QuarterLengths& length = corner == 0 || corner == 3 ? near : far;
        const std::int32_t quarter = steps_of(length.whole_mm(), edge_mm, 3);
        const bool from_behind = corner % 2 == 1;
        for (std::int32_t step = 0; step < quarter; ++step) {
            const double psi = length.parameter(length.whole_mm() *
                                                (from_behind ? quarter - step : step) / quarter);
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
    const std::int32_t steps = steps_of(0.4 * kPi * shape.blend_radius_mm, edge_mm, 1);
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

void add_run(TriangleSoup& soup, const TeeShape& shape, const std::vector<std::int32_t>& contact,
             double edge_mm) {
    const double radius = shape.run_radius_mm;
    PipeSheet sheet;
    sheet.period_mm = 2.0 * kPi * radius;
    sheet.contact_count = static_cast<std::int32_t>(contact.size());
    sheet.ids = contact;
    for (const std::int32_t id : contact) {
        // The arc starts at the back of the branch, so that the hole lies inside one period.
        const Vector3d& p = soup.points_mm[at(id)];
        sheet.flat.emplace_back(radius * (kPi + std::atan2(p.y(), p.x())), p.z());
    }
    const double half = 0.5 * shape.run_length_mm;
    const auto roll = [&](const Vector2d& flat) {
        const double phi = flat.x() / radius - kPi;
        return Vector3d(radius * std::cos(phi), radius * std::sin(phi), flat.y());
    };
    mesh_piece(soup, sheet, {-half, half, false, roll}, edge_mm);
}

void add_branch(TriangleSoup& soup, const TeeShape& shape, const std::vector<std::int32_t>& contact,
                double edge_mm) {
    const double radius = shape.branch_radius_mm;
    // The cut between periods stays clear of the four symmetry lines of the contact curve.
    constexpr double kCutAngle = 0.4;
    PipeSheet sheet;
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
    const auto roll = [&](const Vector2d& flat) {
        const double psi = flat.x() / radius + kCutAngle;
        return seen_from_run(shape, {flat.y(), radius * std::cos(psi), radius * std::sin(psi)});
    };
    mesh_piece(soup, sheet, {lowest, shape.branch_length_mm, true, roll}, edge_mm);
}

}  // namespace

MadeWall wall_of(const TeeShape& shape, double edge_mm) {
    TriangleSoup soup;
    const std::vector<double> angles = contact_angles(shape, edge_mm);
    const auto rows = add_blend_rows(soup, shape, angles, edge_mm);
    for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
        join_rows(soup, rows[row], rows[row + 1], true);
    }
    add_run(soup, shape, rows.front(), edge_mm);
    add_branch(soup, shape, rows.back(), edge_mm);
    const auto project = [&](const Vector3d& p) { return tee_foot(shape, p).point_mm; };
    return {remesh_onto(soup, project, {.edge_mm = edge_mm}), {}};
}

}  // namespace meshwind
