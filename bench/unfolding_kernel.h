/// The yardstick of the tracing benches: the least work that can find a straight line over facets.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "geodesic/on_surface.h"
#include "geodesic/surface_path.h"
#include "mesh/surface.h"

namespace meshwind::bench {

/// A straight line unfolded from triangle to triangle into the plane. It knows no normals, no
/// steering and no positions in space: only where the line goes and how long it is.
class UnfoldingKernel {
public:
    /// \pre `surface` has no rims
    explicit UnfoldingKernel(const Surface& surface) {
        half_edges_.reserve(3 * surface.face.size());
        for (std::size_t f = 0; f < surface.face.size(); ++f) {
            for (std::size_t e = 0; e < 3; ++e) {
                const Eigen::Vector3d& from = corner_mm(surface, f, e);
                const Eigen::Vector3d base = corner_mm(surface, f, (e + 1) % 3) - from;
                const Eigen::Vector3d side = corner_mm(surface, f, (e + 2) % 3) - from;
                half_edges_.push_back({base.dot(side) / base.squaredNorm(),
                                       base.cross(side).norm() / base.squaredNorm(),
                                       twin(surface, f, (e + 1) % 3),
                                       twin(surface, f, (e + 2) % 3)});
            }
        }
    }

    /// Length in mm of the line from `start` into `direction` up to its crossing number `crossings`
    /// (>= 1). \pre `direction` is not normal to the face
    [[nodiscard]] double length_mm(const Surface& surface, const SurfacePoint& start,
                                   const Eigen::Vector3d& direction, std::size_t crossings) const {
        Crossing at = first_crossing(surface, start, direction);
        double length = 0.0;
        for (std::size_t i = 1; i < crossings; ++i) {
            const HalfEdge& h = half_edges_[static_cast<std::size_t>(at.half_edge)];
            const Point apex = {at.left.x + h.apex.x * (at.right.x - at.left.x) -
                                    h.apex.y * (at.right.y - at.left.y),
                                at.left.y + h.apex.x * (at.right.y - at.left.y) +
                                    h.apex.y * (at.right.x - at.left.x)};
            const bool apex_left = apex.y > 0.0;
            at.left = apex_left ? apex : at.left;
            at.right = apex_left ? at.right : apex;
            at.half_edge = apex_left ? h.across_right : h.across_left;
            length = at.abscissa();
        }
        return length;
    }

private:
    struct Point {
        double x = 0.0;
        double y = 0.0;
    };

    // As seen by the face that is entered: its edge from the left of the line to the right.
    struct HalfEdge {
        Point apex;                 // the third corner where the edge runs from (0, 0) to (1, 0)
        std::int32_t across_right;  // half-edge entered through the edge from apex to the right end
        std::int32_t across_left;   // and through the edge from the left end to the apex
    };
    static_assert(sizeof(HalfEdge) == 24);

    // In the plane where the line is the x axis: `left` has y > 0, `right` y <= 0.
    struct Crossing {
        Point left;
        Point right;
        std::int32_t half_edge;

        [[nodiscard]] double abscissa() const {
            return left.x + (right.x - left.x) * left.y / (left.y - right.y);
        }
    };

    static const Eigen::Vector3d& corner_mm(const Surface& surface, std::size_t f, std::size_t c) {
        return surface.position_mm[static_cast<std::size_t>(surface.face[f][c])];
    }

    // The half-edge on the other side of edge e of face f.
    static std::int32_t twin(const Surface& surface, std::size_t f, std::size_t e) {
        const std::int32_t next = surface.neighbour[f][e];
        const auto& v = surface.face[static_cast<std::size_t>(next)];
        const std::int32_t from = surface.face[f][(e + 1) % 3];
        return 3 * next + (v[0] == from ? 0 : (v[1] == from ? 1 : 2));
    }

    static Crossing first_crossing(const Surface& surface, const SurfacePoint& start,
                                   const Eigen::Vector3d& direction) {
        const auto f = static_cast<std::size_t>(start.face);
        const Eigen::Vector3d& a = corner_mm(surface, f, 0);
        const Eigen::Vector3d normal =
            (corner_mm(surface, f, 1) - a).cross(corner_mm(surface, f, 2) - a).normalized();
        const Eigen::Vector3d along = (direction - normal * normal.dot(direction)).normalized();
        const Eigen::Vector3d across = normal.cross(along);
        std::array<Point, 3> corner;
        for (std::size_t c = 0; c < 3; ++c) {
            const Eigen::Vector3d offset = corner_mm(surface, f, c) - position_mm(surface, start);
            corner[c] = {along.dot(offset), across.dot(offset)};
        }
        std::size_t e = 0;  // left through the edge that runs from right of the line to left of it
        while (e < 2 && !(corner[e].y <= 0.0 && corner[(e + 1) % 3].y > 0.0)) {
            ++e;
        }
        return {corner[(e + 1) % 3], corner[e], twin(surface, f, e)};
    }

    std::vector<HalfEdge> half_edges_;
};

}  // namespace meshwind::bench
