#include "mesh/shapes/pipe_star.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/index.h"
#include "core/units.h"
#include "mesh/nearest_parameter.h"
#include "mesh/shapes/make_parts.h"
#include "mesh/shapes/pipe_sheet.h"
#include "mesh/shapes/remesh.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d axis_of(const StarPipe& pipe) {
    return {std::sin(pipe.azimuth_rad), 0.0, std::cos(pipe.azimuth_rad)};
}

// Square to a pipe's axis in the plane of the axes, the way the azimuth rises.
Vector3d side_of(const StarPipe& pipe) {
    return {std::cos(pipe.azimuth_rad), 0.0, -std::sin(pipe.azimuth_rad)};
}

// The crotch between pipe k and the next. The ball's centre moves on half an ellipse, in the plane
// between the pipes: at `theta_rad` from the plane of the axes, -pi/2 to pi/2.
struct Crotch {
    Vector3d middle;   // unit, between the two axes
    double out_mm;     // semi-axis along `middle`
    double offset_mm;  // radius of the pipes and of the ball together: semi-axis along y
    double cotangent;  // of half the angle between the axes

    Crotch(const PipeStar& star, std::size_t k)
        : offset_mm(star.pipe_radius_mm + star.blend_radius_mm) {
        const double half_rad = 0.5 * star.angle_after(k);
        const double azimuth_rad = star.pipes[k].azimuth_rad + half_rad;
        middle = Vector3d(std::sin(azimuth_rad), 0.0, std::cos(azimuth_rad));
        out_mm = offset_mm / std::sin(half_rad);
        cotangent = std::cos(half_rad) / std::sin(half_rad);
    }

    [[nodiscard]] Vector3d centre_mm(double theta_rad) const {
        return out_mm * std::cos(theta_rad) * middle +
               Vector3d(0.0, offset_mm * std::sin(theta_rad), 0.0);
    }
    // How far from the meeting point the ball touches either pipe.
    [[nodiscard]] double contact_mm(double theta_rad) const {
        return offset_mm * std::cos(theta_rad) * cotangent;
    }
    [[nodiscard]] double nearest_theta(const Vector3d& point_mm) const {
        const Vector2d seen(point_mm.dot(middle), std::abs(point_mm.y()));
        const auto off = [&](double theta) -> Vector2d {
            return Vector2d(out_mm * std::cos(theta), offset_mm * std::sin(theta)) - seen;
        };
        const double theta = nearest_parameter(
            {0.0, 0.5 * kPi}, [&](double at) { return off(at).squaredNorm(); },
            [&](double at) {
                return off(at).dot(Vector2d(-out_mm * std::sin(at), offset_mm * std::cos(at)));
            });
        return std::copysign(theta, point_mm.y());
    }
};

// The pipe after which the point stands, seen along y.
std::size_t sector_of(const PipeStar& star, const Vector3d& point_mm) {
    const double azimuth_rad = std::atan2(point_mm.x(), point_mm.z());
    const double from_first_rad =
        into_period(azimuth_rad - star.pipes.front().azimuth_rad, 2.0 * kPi);
    std::size_t k = 0;
    while (k + 1 < star.pipes.size() &&
           star.pipes[k + 1].azimuth_rad - star.pipes.front().azimuth_rad <= from_first_rad) {
        ++k;
    }
    return k;
}

std::size_t next_of(const PipeStar& star, std::size_t k) {
    return (k + 1) % star.pipes.size();
}

// On pipe k beside a crotch, where the point belongs to it: the normals along the contact curve
// pass through the ball's centres, so that seen from its own axis the curve bounds the pipe.
bool is_on_pipe(const PipeStar& star, const Crotch& crotch, std::size_t k,
                const Vector3d& point_mm) {
    const double across = std::abs(point_mm.dot(side_of(star.pipes[k])));
    const double theta = std::atan2(std::abs(point_mm.y()), across);
    return point_mm.dot(axis_of(star.pipes[k])) >= crotch.contact_mm(theta);
}

ShapeFoot pipe_foot(const PipeStar& star, std::size_t k, const Vector3d& point_mm) {
    const Vector3d axis = axis_of(star.pipes[k]);
    const Vector3d on_axis = point_mm.dot(axis) * axis;
    const double radius = (point_mm - on_axis).norm();
    const Vector3d normal = (point_mm - on_axis) / radius;
    return {on_axis + star.pipe_radius_mm * normal, normal, radius - star.pipe_radius_mm,
            k == 0 ? ShapePart::Run : ShapePart::Branch};
}

ShapeFoot blend_foot(const PipeStar& star, const Crotch& crotch, const Vector3d& point_mm) {
    const Vector3d inward = crotch.centre_mm(crotch.nearest_theta(point_mm)) - point_mm;
    const double distance = inward.norm();
    const Vector3d normal = inward / distance;
    return {point_mm + (distance - star.blend_radius_mm) * normal, normal,
            star.blend_radius_mm - distance, ShapePart::Blend};
}

// The two points above and below the meeting point, where all crotches end.
struct Poles {
    std::int32_t lower;
    std::int32_t upper;
};

// Angles of even steps along the ball's way, both ends left out; the middle is among them.
std::vector<double> inner_angles(const Crotch& crotch, double edge_mm) {
    const QuarterLengths length([&](double theta) { return crotch.centre_mm(theta); });
    const std::int32_t half = steps_of(length.whole_mm(), edge_mm, 3);
    std::vector<double> angles(at(2 * half - 1), 0.0);
    for (std::int32_t step = 1; step < half; ++step) {
        const double theta = length.parameter(length.whole_mm() * step / half);
        angles[at(half - 1 + step)] = theta;
        angles[at(half - 1 - step)] = -theta;
    }
    return angles;
}

// The blend between pipe k and the next: rows from pole to pole, joined.
struct BlendStrip {
    VertexRow on_pipe;
    VertexRow on_next;
};

BlendStrip add_blend(TriangleSoup& soup, const PipeStar& star, std::size_t k, const Poles& poles,
                     double edge_mm) {
    const Crotch crotch(star, k);
    const std::size_t next = next_of(star, k);
    const double turn_rad = kPi - star.angle_after(k);  // of the ball's arc in the middle
    const std::int32_t steps = steps_of(turn_rad * star.blend_radius_mm, edge_mm, 1);
    std::vector<VertexRow> rows(at(steps + 1), VertexRow{poles.lower});
    for (const double theta : inner_angles(crotch, edge_mm)) {
        const Vector3d centre = crotch.centre_mm(theta);
        const auto way_to = [&](std::size_t pipe) -> Vector3d {
            const Vector3d axis = axis_of(star.pipes[pipe]);
            return (centre.dot(axis) * axis - centre).normalized();
        };
        const Vector3d from = way_to(k);
        const Vector3d to = way_to(next);
        for (std::int32_t row = 0; row <= steps; ++row) {
            const double share = static_cast<double>(row) / steps;
            const Vector3d way = ((1.0 - share) * from + share * to).normalized();
            rows[at(row)].push_back(static_cast<std::int32_t>(soup.points_mm.size()));
            soup.points_mm.push_back(centre + star.blend_radius_mm * way);
        }
    }
    for (VertexRow& row : rows) {
        row.push_back(poles.upper);
    }
    for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
        join_rows(soup, rows[row], rows[row + 1], false);
    }
    return {rows.front(), rows.back()};
}

// \param before, after contact curves of the blends at either side of pipe k, from pole to pole
void add_pipe(TriangleSoup& soup, const PipeStar& star, std::size_t k, const VertexRow& before,
              const VertexRow& after, double edge_mm) {
    const double radius = star.pipe_radius_mm;
    const Vector3d axis = axis_of(star.pipes[k]);
    const Vector3d side = side_of(star.pipes[k]);
    // The cut between periods stays clear of the poles and of the middles of the crotches.
    constexpr double kCutAngle_rad = 0.4;
    PipeSheet sheet;
    sheet.period_mm = 2.0 * kPi * radius;
    sheet.ids.assign(after.begin(), after.end() - 1);
    sheet.ids.insert(sheet.ids.end(), before.rbegin(), before.rend() - 1);
    sheet.contact_count = static_cast<std::int32_t>(sheet.ids.size());
    double lowest = star.pipes[k].length_mm;
    for (const std::int32_t id : sheet.ids) {
        const Vector3d& p = soup.points_mm[at(id)];
        // From the side to +y: counter-clockwise seen from outside with the axis upward.
        const double arc = radius * (std::atan2(p.y(), p.dot(side)) - kCutAngle_rad);
        sheet.flat.emplace_back(into_period(arc, sheet.period_mm), p.dot(axis));
        lowest = std::min(lowest, p.dot(axis));
    }
    const auto roll = [&](const Vector2d& flat) -> Vector3d {
        const double around = flat.x() / radius + kCutAngle_rad;
        return flat.y() * axis + radius * std::cos(around) * side +
               Vector3d(0.0, radius * std::sin(around), 0.0);
    };
    mesh_piece(soup, sheet, {lowest, star.pipes[k].length_mm, true, roll}, edge_mm);
}

}  // namespace

double PipeStar::angle_after(std::size_t k) const {
    const bool last = k + 1 == pipes.size();
    const double next_rad = last ? pipes.front().azimuth_rad + 2.0 * kPi : pipes[k + 1].azimuth_rad;
    return next_rad - pipes[k].azimuth_rad;
}

double PipeStar::blend_end_mm(std::size_t k) const {
    const std::size_t before = (k + pipes.size() - 1) % pipes.size();
    return std::max(Crotch(*this, k).contact_mm(0.0), Crotch(*this, before).contact_mm(0.0));
}

PipeStar star_of(const WyeShape& shape) {
    return {shape.pipe_radius_mm,
            shape.blend_radius_mm,
            {{-kPi, shape.stem_length_mm},
             {-0.5 * shape.angle_rad, shape.arm_length_mm},
             {0.5 * shape.angle_rad, shape.arm_length_mm}}};
}

PipeStar star_of(const CrossShape& shape) {
    const double half_mm = 0.5 * shape.run_length_mm;
    return {shape.pipe_radius_mm,
            shape.blend_radius_mm,
            {{0.0, half_mm},
             {0.5 * kPi, shape.branch_length_mm},
             {kPi, half_mm},
             {1.5 * kPi, shape.branch_length_mm}}};
}

ShapeFoot star_foot(const PipeStar& star, const Vector3d& point_mm) {
    const std::size_t k = sector_of(star, point_mm);
    const std::size_t next = next_of(star, k);
    const Crotch crotch(star, k);
    const bool on_first = is_on_pipe(star, crotch, k, point_mm);
    const bool on_next = is_on_pipe(star, crotch, next, point_mm);
    if (on_first && on_next) {
        const ShapeFoot first = pipe_foot(star, k, point_mm);
        const ShapeFoot other = pipe_foot(star, next, point_mm);
        return std::abs(first.distance_mm) <= std::abs(other.distance_mm) ? first : other;
    }
    if (on_first) {
        return pipe_foot(star, k, point_mm);
    }
    return on_next ? pipe_foot(star, next, point_mm) : blend_foot(star, crotch, point_mm);
}

ShapeFoot wye_foot(const WyeShape& shape, const Vector3d& point_mm) {
    return star_foot(star_of(shape), point_mm);
}

ShapeFoot cross_foot(const CrossShape& shape, const Vector3d& point_mm) {
    return star_foot(star_of(shape), point_mm);
}

MadeWall wall_of(const PipeStar& star, double edge_mm) {
    TriangleSoup soup;
    soup.points_mm = {{0.0, -star.pipe_radius_mm, 0.0}, {0.0, star.pipe_radius_mm, 0.0}};
    std::vector<BlendStrip> blends;
    for (std::size_t k = 0; k < star.pipes.size(); ++k) {
        blends.push_back(add_blend(soup, star, k, {.lower = 0, .upper = 1}, edge_mm));
    }
    for (std::size_t k = 0; k < star.pipes.size(); ++k) {
        const BlendStrip& before = blends[(k + blends.size() - 1) % blends.size()];
        add_pipe(soup, star, k, before.on_next, blends[k].on_pipe, edge_mm);
    }
    const auto project = [&](const Vector3d& p) { return star_foot(star, p).point_mm; };
    return {remesh_onto(soup, project, {.edge_mm = edge_mm}), {}};
}

}  // namespace meshwind
