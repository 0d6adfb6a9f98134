/// Largest radius of triangles about the Z axis, by height.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Proves without a search that places outside the bodies turning about the Z axis are clear of
/// them.
class RadialReach {
public:
    RadialReach() = default;
    explicit RadialReach(std::span<const TriangleSoup> parts);

    /// Upper bound of the radius of all triangle points with a height from `low_mm` to `high_mm`,
    /// less than a bin's height too high where the wall is steep; minus infinity where there are
    /// none.
    [[nodiscard]] double largest_mm(double low_mm, double high_mm) const;

    /// True when it is known that no triangle is nearer than `distance_mm` to a place.
    [[nodiscard]] bool is_beyond(const Eigen::Vector3d& place_mm, double distance_mm) const;

private:
    [[nodiscard]] std::ptrdiff_t bin_of(double z_mm) const;

    double low_mm_ = 0.0;
    double bin_mm_ = 0.0;
    std::ptrdiff_t bins_ = 0;
    std::vector<std::vector<double>> largest_mm_;  // per power of two n: of n bins from each on
};

}  // namespace meshwind
