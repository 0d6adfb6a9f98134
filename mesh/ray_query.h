/// Ray casting, closest points and clearance checks against triangles (Embree).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// The nearest point of a triangle set. Mandrel frame.
struct ClosestPoint {
    std::int32_t part =
        -1;  ///< which soup, in the order given; -1: nothing within the search radius
    std::int32_t face = -1;
    Eigen::Vector3d bary = Eigen::Vector3d::Zero();
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
    double distance_mm = 0.0;
};

/// Queries against triangles; thread-safe once built. Embree stores single precision: positions are
/// good to about 1e-7 of the scene's size; closest points are computed in double on Embree's
/// triangle order.
class RayQuery {
public:
    /// \param parts triangle soups, copied \pre face indices are valid
    /// \param field_reach_mm > 0: distances are tabulated up to this far around the parts, which
    /// answers most clearance questions without a search; 0: no table
    explicit RayQuery(std::span<const TriangleSoup> parts, double field_reach_mm = 0.0);
    ~RayQuery();
    RayQuery(RayQuery&&) noexcept;
    RayQuery& operator=(RayQuery&&) noexcept;

    /// Distance in mm from `origin` along unit `direction` to the first triangle, or `max_mm`.
    [[nodiscard]] double first_hit_mm(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double max_mm) const;

    /// True when a triangle crosses the straight segment.
    [[nodiscard]] bool occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

    /// Nearest point within `radius_mm`; part -1 and distance `radius_mm` when there is none.
    [[nodiscard]] ClosestPoint closest(const Eigen::Vector3d& query, double radius_mm) const;

    /// Lower bound of the distance to the nearest triangle, in mm: from the table, so a little less
    /// than the true distance; 0 without one.
    [[nodiscard]] double distance_at_least_mm(const Eigen::Vector3d& query) const;

    /// True when it is known that no triangle is nearer than `distance_mm`: from the table and the
    /// radius of the parts about the Z axis. False proves nothing.
    [[nodiscard]] bool is_beyond(const Eigen::Vector3d& query, double distance_mm) const;

    /// True when distances are tabulated.
    [[nodiscard]] bool has_table() const;

    /// Distance to the nearest triangle interpolated in the table, in mm; without one the true
    /// distance, up to 1000. Off by about cell^2 / 8 of the surface's curvature at that distance:
    /// some tenths of a mm around a pipe. Where the table's cells are longer than some mm, on
    /// mandrels of metres, it is the true distance close to the triangles. For searches only;
    /// limits are checked by the functions above and below.
    [[nodiscard]] double distance_estimate_mm(const Eigen::Vector3d& query) const;

    /// Radius about the Z axis beyond which, at this height, distance_estimate_mm() is at least
    /// `need_mm`. Infinite where none is known.
    [[nodiscard]] double room_from_mm(double z_mm, double need_mm) const;

    /// True when no triangle is nearer than `radius_mm` to the straight segment.
    /// Conservative: a triangle that is up to 1 % of the radius further away may count as too near.
    [[nodiscard]] bool capsule_clear(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                     double radius_mm) const;

private:
    void tabulate(double reach_mm);

    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace meshwind
