#include "mesh/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <flann/flann.hpp>

namespace meshwind {

struct NearestPoints::Impl {
    std::vector<double> data;
    std::unique_ptr<flann::Index<flann::L2_3D<double>>> index;
};

NearestPoints::NearestPoints(std::span<const Eigen::Vector3d> points_mm)
    : impl_(std::make_unique<Impl>()) {
    impl_->data.reserve(points_mm.size() * 3);
    for (const Eigen::Vector3d& p : points_mm) {
        impl_->data.insert(impl_->data.end(), {p.x(), p.y(), p.z()});
    }
    if (!points_mm.empty()) {
        impl_->index = std::make_unique<flann::Index<flann::L2_3D<double>>>(
            flann::Matrix<double>(impl_->data.data(), points_mm.size(), 3),
            flann::KDTreeSingleIndexParams());
        impl_->index->buildIndex();
    }
}

NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;
NearestPoints& NearestPoints::operator=(NearestPoints&&) noexcept = default;

std::vector<std::int32_t> NearestPoints::within(const Eigen::Vector3d& query,
                                                double radius_mm) const {
    std::vector<std::int32_t> found;
    if (!impl_->index) {
        return found;
    }
    Eigen::Vector3d point = query;
    std::vector<std::vector<std::size_t>> indices;
    std::vector<std::vector<double>> squared;
    flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED);
    exact.sorted = false;
    // FLANN takes the squared radius in single precision: one step up, so that nothing is lost.
    const float widened =
        std::nextafter(static_cast<float>(radius_mm * radius_mm), std::numeric_limits<float>::max());
    impl_->index->radiusSearch(flann::Matrix<double>(point.data(), 1, 3), indices, squared, widened,
                               exact);
    found.reserve(indices[0].size());
    for (const std::size_t i : indices[0]) {
        found.push_back(static_cast<std::int32_t>(i));
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::int32_t NearestPoints::nearest(const Eigen::Vector3d& query) const {
    if (!impl_->index) {
        return -1;
    }
    Eigen::Vector3d point = query;
    std::vector<std::vector<std::size_t>> indices;
    std::vector<std::vector<double>> squared;
    impl_->index->knnSearch(flann::Matrix<double>(point.data(), 1, 3), indices, squared, 1,
                            flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    const std::vector<std::int32_t> ties = within(query, std::sqrt(squared[0][0]));
    return ties.empty() ? static_cast<std::int32_t>(indices[0][0]) : ties.front();
}

}  // namespace meshwind
