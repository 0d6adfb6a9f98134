/// Nearest neighbours among points (FLANN).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// A static k-d tree. Answers are exact and independent of the number of threads.
class NearestPoints {
public:
    explicit NearestPoints(std::span<const Eigen::Vector3d> points_mm);
    ~NearestPoints();
    NearestPoints(NearestPoints&&) noexcept;
    NearestPoints& operator=(NearestPoints&&) noexcept;

    /// Indices of the points within `radius_mm` of `query`, ascending.
    [[nodiscard]] std::vector<std::int32_t> within(const Eigen::Vector3d& query,
                                                   double radius_mm) const;

    /// Index of the nearest point, the lowest of equals; -1 when there are no points.
    [[nodiscard]] std::int32_t nearest(const Eigen::Vector3d& query) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace meshwind
