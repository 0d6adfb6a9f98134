#include "mesh/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <flann/flann.hpp>

namespace meshwind {

struct NearestPoints::Impl {
    std::vector<double> data;
    std::unique_ptr<flann::Index<flann::L2_3D<double>>> index;

    // Indices within a squared distance, ascending.
    [[nodiscard]] std::vector<std::int32_t> within(Eigen::Vector3d query,
                                                   double squared_mm2) const {
        std::vector<std::vector<std::size_t>> indices;
        std::vector<std::vector<double>> squared;
        flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED);
        exact.sorted = false;
        // FLANN takes the squared radius in single precision and leaves out what lies on it: one
        // step up, so that nothing is lost, and what is too far is dropped below.
        const float widened =
            std::nextafter(static_cast<float>(squared_mm2), std::numeric_limits<float>::max());
        index->radiusSearch(flann::Matrix<double>(query.data(), 1, 3), indices, squared, widened,
                            exact);
        std::vector<std::int32_t> found;
        found.reserve(indices[0].size());
        for (std::size_t i = 0; i < indices[0].size(); ++i) {
            if (squared[0][i] <= squared_mm2) {
                found.push_back(static_cast<std::int32_t>(indices[0][i]));
            }
        }
        std::sort(found.begin(), found.end());
        return found;
    }
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
    return impl_->index ? impl_->within(query, radius_mm * radius_mm) : std::vector<std::int32_t>{};
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
    const std::vector<std::int32_t> ties = impl_->within(query, squared[0][0]);
    return ties.empty() ? static_cast<std::int32_t>(indices[0][0]) : ties.front();
}

}  // namespace meshwind
