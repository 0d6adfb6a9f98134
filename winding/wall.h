/// From paths over the ideal body to paths over the mesh.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "geodesic/field_walk.h"
#include "geodesic/surface_path.h"
#include "mesh/nearest.h"
#include "mesh/surface.h"
#include "winding/plan.h"
#include "winding/turn.h"

namespace meshwind {

/// Distance of the stations of a plan, as the other planners have it.
inline constexpr double kPatternStation_mm = 4.0;

/// The faces under a path. Its stations stay on the ideal body, from which the mesh is off by the
/// residual of its recognition.
class Wall {
public:
    /// \param surface must outlive the wall
    explicit Wall(const Surface& surface);

    /// Sets `at` of every station by its position. \pre neighbours lie a few edges apart at most
    void put(SurfacePath& path) const;

    /// Moves every station onto the mesh, to the place under it: position, normal, tangent and kn
    /// become those of the patches, and arc lengths are counted anew. \pre as put()
    /// \param direction of travel of station i at its new position; its part in the tangent plane
    /// counts
    void settle(
        SurfacePath& path,
        const std::function<Eigen::Vector3d(std::size_t i, const Eigen::Vector3d& position)>&
            direction) const;

private:
    void move_under(const Eigen::Vector3d& place_mm, std::optional<FieldWalker>& walker) const;

    const Surface& surface_;
    std::optional<NearestPoints> nearest_;
};

/// A course along a finished path: its taut string, and slip and kg measured on it.
/// \param path on the patches or the ideal body, with normals, tangents, kn and arc lengths
[[nodiscard]] Piece course_along(const Surface& surface, SurfacePath path, double friction);

/// A turn over a rim, and what it asks of the rim's extension.
struct LaidTurn {
    Piece piece;
    TurnsAtRim asks;
    std::int32_t rim = -1;
};

/// From where a course leaves over a rim to where the next one comes back.
/// \pre both can be turned (can_turn)
[[nodiscard]] LaidTurn turn_over(const Rim& rim, const PathPoint& from, const PathPoint& to,
                                 const TurnRule& rule);

/// Puts a piece at the plan's end and adds its length, slip, bridging and joint to the plan's.
void add_piece(Piece piece, Plan& plan);

/// The same of a turn, with what it asks of its rim. \pre plan.turns has an entry for the rim
void add_turn(LaidTurn turn, Plan& plan);

}  // namespace meshwind
