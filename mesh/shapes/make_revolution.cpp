#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "mesh/shapes/make_parts.h"
#include "mesh/shapes/make_walls.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

// Fewer would fold a polar cap; also the least around a small polar opening.
constexpr std::int32_t kMinAround = 5;

// Rings that follow each other around z, each turned against the last by half a step.
class Rings {
public:
    Rings(TriangleSoup& soup, double edge_mm) : soup_(soup), edge_mm_(edge_mm) {}

    VertexRow add(const Vector2d& radius_z) {
        VertexRow row;
        if (radius_z.x() == 0.0) {
            row.push_back(static_cast<std::int32_t>(soup_.points_mm.size()));
            soup_.points_mm.emplace_back(0.0, 0.0, radius_z.y());
            return row;
        }
        const std::int32_t count = steps_of(2.0 * kPi * radius_z.x(), edge_mm_, kMinAround);
        const double step = 2.0 * kPi / count;
        for (std::int32_t i = 0; i < count; ++i) {
            const double phi = turn_ + step * i;
            row.push_back(static_cast<std::int32_t>(soup_.points_mm.size()));
            soup_.points_mm.emplace_back(radius_z.x() * std::cos(phi), radius_z.x() * std::sin(phi),
                                         radius_z.y());
        }
        // Turned to and fro, so that equal rings repeat every second row.
        turn_ = turn_ > 0.0 ? 0.0 : 0.5 * step;
        return row;
    }

private:
    TriangleSoup& soup_;
    double edge_mm_;
    double turn_ = 0.0;
};

MadeWall closed_torus(const TorusShape& shape, double edge_mm) {
    MadeWall wall;
    Rings rings(wall.soup, edge_mm);
    // An even number, so that the half steps match where the rows close.
    const std::int32_t rows = 2 * steps_of(kPi * shape.tube_radius_mm, row_step_mm(edge_mm), 2);
    const auto ring_at = [&](std::int32_t i) {
        const double v = 2.0 * kPi * i / rows;
        return Vector2d(shape.ring_radius_mm + shape.tube_radius_mm * std::cos(v),
                        shape.tube_radius_mm * std::sin(v));
    };
    const VertexRow first = rings.add(ring_at(0));
    VertexRow last = first;
    for (std::int32_t i = 1; i < rows; ++i) {
        VertexRow next = rings.add(ring_at(i));
        stitch_rings(wall.soup, last, next);
        last = std::move(next);
    }
    stitch_rings(wall.soup, last, first);
    return wall;
}

// A bend: centre, and the directions from there to its start, along its start, and their cross
// product.
struct BendFrame {
    Eigen::Vector3d centre;
    Eigen::Vector3d radial;
    Eigen::Vector3d forward;
    Eigen::Vector3d side;
    double bend_radius_mm;
    double pipe_radius_mm;

    [[nodiscard]] Eigen::Vector3d point(double turn, double around) const {
        const double radius = bend_radius_mm + pipe_radius_mm * std::cos(around);
        return centre + radius * (std::cos(turn) * radial + std::sin(turn) * forward) +
               pipe_radius_mm * std::sin(around) * side;
    }
};

struct BendEnds {
    VertexRow start;
    VertexRow end;
};

BendEnds add_bend(TriangleSoup& soup, const BendFrame& frame, double angle, double edge_mm) {
    const std::int32_t around = steps_of(2.0 * kPi * frame.pipe_radius_mm, edge_mm, kMinAround);
    std::vector<VertexRow> strips;
    BendEnds ends;
    for (std::int32_t i = 0; i < around; ++i) {
        const double v = 2.0 * kPi * i / around;
        const double radius = frame.bend_radius_mm + frame.pipe_radius_mm * std::cos(v);
        const std::int32_t steps = steps_of(radius * angle, edge_mm, 1);
        VertexRow& strip = strips.emplace_back();
        for (std::int32_t k = 0; k <= steps; ++k) {
            strip.push_back(static_cast<std::int32_t>(soup.points_mm.size()));
            soup.points_mm.push_back(frame.point(angle * k / steps, v));
        }
        ends.start.push_back(strip.front());
        ends.end.push_back(strip.back());
    }
    for (std::size_t i = 0; i < strips.size(); ++i) {
        stitch_open(soup, strips[i], strips[(i + 1) % strips.size()]);
    }
    // Seen along the pipe, `around` turns clockwise; rings are wanted counter-clockwise.
    std::reverse(ends.start.begin(), ends.start.end());
    std::reverse(ends.end.begin(), ends.end.end());
    return ends;
}

struct Leg {
    Eigen::Vector3d centre;  // of the circle where it begins
    Eigen::Vector3d way;     // unit, away from the bend
    double length_mm;
    bool forward;  // along the pipe's direction, in which rings turn counter-clockwise
};

void add_leg(TriangleSoup& soup, VertexRow ring, const Leg& leg, double edge_mm) {
    if (leg.length_mm <= 0.0) {
        return;
    }
    const std::int32_t rows = steps_of(leg.length_mm, row_step_mm(edge_mm), 1);
    std::vector<Eigen::Vector3d> even;
    std::vector<Eigen::Vector3d> odd;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector3d a = soup.points_mm[at(ring[i])] - leg.centre;
        const Eigen::Vector3d b = soup.points_mm[at(ring[(i + 1) % ring.size()])] - leg.centre;
        even.push_back(a);
        odd.push_back((a + b).normalized() * a.norm());
    }
    for (std::int32_t row = 1; row <= rows; ++row) {
        VertexRow next;
        const Eigen::Vector3d centre = leg.centre + leg.way * (leg.length_mm * row / rows);
        for (const Eigen::Vector3d& spoke : row % 2 == 0 ? even : odd) {
            next.push_back(static_cast<std::int32_t>(soup.points_mm.size()));
            soup.points_mm.push_back(centre + spoke);
        }
        if (leg.forward) {
            stitch_rings(soup, ring, next);
        } else {
            stitch_rings(soup, next, ring);
        }
        ring = std::move(next);
    }
}

}  // namespace

MadeWall wall_of(const Profile& profile, double edge_mm) {
    MadeWall wall;
    Rings rings(wall.soup, edge_mm);
    VertexRow last = rings.add(profile.front().point_mm(0.0));
    wall.sharp.assign(wall.soup.points_mm.size(), 0);
    for (const ProfilePiece& piece : profile) {
        const std::int32_t rows = steps_of(piece.length_mm(), row_step_mm(edge_mm), 1);
        for (std::int32_t row = 1; row <= rows; ++row) {
            VertexRow next = rings.add(piece.point_mm(static_cast<double>(row) / rows));
            stitch_rings(wall.soup, last, next);
            last = std::move(next);
            wall.sharp.resize(wall.soup.points_mm.size(), row == rows && piece.sharp_end ? 1 : 0);
        }
    }
    return wall;
}

MadeWall wall_of(const TorusShape& shape, double edge_mm) {
    if (shape.angle_rad == 2.0 * kPi) {
        return closed_torus(shape, edge_mm);
    }
    MadeWall wall;
    const BendFrame frame{Eigen::Vector3d::Zero(),  Eigen::Vector3d::UnitX(),
                          Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                          shape.ring_radius_mm,     shape.tube_radius_mm};
    add_bend(wall.soup, frame, shape.angle_rad, edge_mm);
    return wall;
}

MadeWall wall_of(const ElbowShape& shape, double edge_mm) {
    MadeWall wall;
    const BendFrame frame{{shape.bend_radius_mm, 0.0, shape.leg1_mm},
                          -Eigen::Vector3d::UnitX(),
                          Eigen::Vector3d::UnitZ(),
                          Eigen::Vector3d::UnitY(),
                          shape.bend_radius_mm,
                          shape.pipe_radius_mm};
    const BendEnds ends = add_bend(wall.soup, frame, shape.angle_rad, edge_mm);
    const double c = std::cos(shape.angle_rad);
    const double s = std::sin(shape.angle_rad);
    const Eigen::Vector3d end = frame.centre + shape.bend_radius_mm * Eigen::Vector3d(-c, 0.0, s);
    add_leg(wall.soup, ends.start,
            {{0.0, 0.0, shape.leg1_mm}, -Eigen::Vector3d::UnitZ(), shape.leg1_mm, false}, edge_mm);
    add_leg(wall.soup, ends.end, {end, {s, 0.0, c}, shape.leg2_mm, true}, edge_mm);
    return wall;
}

}  // namespace meshwind
