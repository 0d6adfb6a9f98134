/// Projection of paths over the ideal body onto the mesh.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "geodesic/field_walk.h"
#include "geodesic/surface_path.h"
#include "mesh/nearest.h"
#include "mesh/surface.h"

namespace meshwind {

/// Projects paths over the ideal body onto the mesh, which is off that body by the residual of its
/// recognition.
class MeshProjection {
public:
    /// \param surface must outlive the projection
    explicit MeshProjection(const Surface& surface);

    /// Sets `at` of every station to the face under it; the stations stay on the ideal body.
    /// \pre neighbours lie a few edges apart at most
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

}  // namespace meshwind
