/// Mirror images of courses on a mandrel that is its own mirror image.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "mesh/mandrel.h"
#include "mesh/ray_query.h"
#include "winding/cover/library.h"
#include "winding/laminate/samples.h"

namespace meshwind {

/// Finds planes in which a mandrel is its own mirror image. The mesh need not be: it is the surface
/// that counts. The planes tried pass through the wall's centre, square to the rims' axes, to the
/// principal axes, and to the directions square to those.
class MirrorImages {
public:
    /// \param tolerance_mm how far the image of a point of the wall may be off the wall
    MirrorImages(const Mandrel& mandrel, const CoverageSamples& samples, double tolerance_mm);

    /// Number of images of a place besides itself; the same for each place.
    [[nodiscard]] std::size_t size() const { return maps_.size(); }

    /// An image of a candidate. It runs near that of the candidate's course, as near as the mesh is
    /// like its own image. \param which < size(), in a fixed order
    [[nodiscard]] Candidate of(const Candidate& candidate, std::size_t which) const;

private:
    [[nodiscard]] bool keeps_the_wall(const Eigen::Matrix3d& map, std::span<const Eigen::Vector3d>,
                                      double tolerance_mm) const;
    void add_with_products(const Eigen::Matrix3d& map);

    const Surface& surface_;
    RayQuery wall_;
    Eigen::Vector3d centre_mm_;
    std::vector<Eigen::Matrix3d> maps_;  ///< about the centre; not the identity
};

}  // namespace meshwind
