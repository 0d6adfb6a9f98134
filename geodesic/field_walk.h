/// Integrates a direction field over the curved patches.
#pragma once

#include <functional>

#include <Eigen/Core>

#include "geodesic/surface_path.h"
#include "mesh/smooth/patch.h"

namespace meshwind {

/// Value of a direction field at a place.
struct Aim {
    Eigen::Vector3d direction;  ///< its part in the tangent plane is followed; any length
    double beyond = 0.0;        ///< the walk ends where this rises to zero
    /// Rise of `beyond` per mm of the walk: per_length + per_curvature * kn.
    double per_length = 0.0;
    double per_curvature = 0.0;
};

/// \param position_mm, normal of a place on the surface
using AimField =
    std::function<Aim(const Eigen::Vector3d& position_mm, const Eigen::Vector3d& normal)>;

/// Arrived: `beyond` is zero. Stalled: it rises no more. Length: the walk is as long as allowed.
/// Folded: the mesh is so coarse that a patch turns over. All are normal outcomes.
enum class FieldStop { Arrived, Stalled, Length, Rim, Folded };

struct FieldWalk {
    FieldStop stop = FieldStop::Arrived;
    double length_mm = 0.0;
    std::int32_t rim = -1;  ///< where FieldStop::Rim
};

/// A point that walks over the patches. Steps are of fourth order (Runge-Kutta) and end on the
/// edges of faces. Where the two patches at an edge disagree on which of them the field leads into,
/// the walk slides along the edge.
class FieldWalker {
public:
    /// Called at every edge: the station on its near side, and on its far side where it is a
    /// feature edge; s_mm counts from the start of the walk, kg is left at zero.
    using Visit = std::function<void(const PathPoint&)>;

    FieldWalker(const Surface& surface, const SurfacePoint& start);

    void move_to(const SurfacePoint& place);

    /// Moves over the faces to the place nearest to a point, by Newton's method on the patches;
    /// false where that is beyond a rim, or not found.
    bool move_under(const Eigen::Vector3d& point_mm);

    /// \param longest_step_mm longest step, for fields that bend more than the surface
    FieldWalk walk(const AimField& field, double longest_mm, double longest_step_mm,
                   const Visit& visit = {});

    [[nodiscard]] const Eigen::Vector3d& position_mm() const { return place_.position_mm; }
    [[nodiscard]] const Eigen::Vector3d& normal() const { return normal_; }
    [[nodiscard]] std::int32_t face() const { return face_; }

    /// The station here, with the tangent `direction`, which is projected.
    [[nodiscard]] PathPoint station(const Eigen::Vector3d& direction) const;

private:
    struct Heading;

    [[nodiscard]] Eigen::Vector2d rate_at(const Eigen::Vector2d& uv, const PatchPlace& place,
                                          const Eigen::Vector3d& direction) const;
    [[nodiscard]] Eigen::Vector2d field_rate(const Eigen::Vector2d& uv,
                                             const AimField& field) const;
    [[nodiscard]] Heading heading(const AimField& field) const;
    [[nodiscard]] Eigen::Vector2d stepped(const Heading& from, double h,
                                          const AimField& field) const;
    [[nodiscard]] std::size_t step(const Heading& from, double& h, const AimField& field);
    [[nodiscard]] Eigen::Vector2d towards(const Eigen::Vector3d& point_mm) const;
    [[nodiscard]] bool goes_back(const Eigen::Vector2d& uv, const Eigen::Vector2d& rate) const;
    [[nodiscard]] Eigen::Vector2d entry_edge() const;
    void settle(const Eigen::Vector2d& uv);
    [[nodiscard]] FieldStop enter(std::size_t opposite);
    bool cross(const Heading& heading, std::size_t opposite, const Visit& visit, FieldWalk& walk);

    const Surface* surface_;
    Patch patch_;
    std::int32_t face_;
    std::size_t entry_;  // bary index that is zero on the edge just crossed
    Eigen::Vector2d uv_;
    PatchPlace place_;
    Eigen::Vector3d normal_;
};

}  // namespace meshwind
