#include "mesh/radial_reach.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/index.h"

namespace meshwind {
namespace {

constexpr std::ptrdiff_t kBins = 1024;

// Below this a mandrel has no height worth bins.
constexpr double kMinHeight_mm = 1e-3;

// What rounding may take from a distance, as a share of it and of the place's radius.
constexpr double kRounding = 1e-12;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

RadialReach::RadialReach(std::span<const TriangleSoup> parts) {
    double low = kInfinity;
    double high = -kInfinity;
    for (const TriangleSoup& part : parts) {
        for (const Eigen::Vector3d& point : part.points_mm) {
            low = std::min(low, point.z());
            high = std::max(high, point.z());
        }
    }
    if (!(low <= high)) {
        return;
    }
    low_mm_ = low;
    bins_ = kBins;
    bin_mm_ = std::max(high - low, kMinHeight_mm) / static_cast<double>(kBins - 1);
    std::vector<double> largest(at(bins_), -kInfinity);
    for (const TriangleSoup& part : parts) {
        for (const auto& face : part.faces) {
            double from = kInfinity;
            double to = -kInfinity;
            double radius = 0.0;  // largest at a corner
            for (const std::int32_t v : face) {
                const Eigen::Vector3d& point = part.points_mm[static_cast<std::size_t>(v)];
                from = std::min(from, point.z());
                to = std::max(to, point.z());
                radius = std::max(radius, std::hypot(point.x(), point.y()));
            }
            for (std::ptrdiff_t bin = bin_of(from); bin <= bin_of(to); ++bin) {
                largest[at(bin)] = std::max(largest[at(bin)], radius);
            }
        }
    }
    largest_mm_.push_back(std::move(largest));
    for (std::ptrdiff_t half = 1; 2 * half <= bins_; half *= 2) {
        const std::vector<double>& last = largest_mm_.back();
        std::vector<double> next(at(bins_ - 2 * half + 1));
        for (std::size_t i = 0; i < next.size(); ++i) {
            next[i] = std::max(last[i], last[i + at(half)]);
        }
        largest_mm_.push_back(std::move(next));
    }
}

std::ptrdiff_t RadialReach::bin_of(double z_mm) const {
    const double bin = std::floor((z_mm - low_mm_) / bin_mm_);
    return static_cast<std::ptrdiff_t>(std::clamp(bin, -1.0, static_cast<double>(bins_)));
}

double RadialReach::largest_mm(double low_mm, double high_mm) const {
    if (bins_ == 0) {
        return -kInfinity;
    }
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(bin_of(low_mm), 0);
    const std::ptrdiff_t last = std::min(bin_of(high_mm), bins_ - 1);
    if (first > last) {
        return -kInfinity;
    }
    const auto level = static_cast<std::size_t>(std::bit_width(at(last - first + 1))) - 1;
    const std::vector<double>& largest = largest_mm_[level];
    return std::max(largest[at(first)], largest[at(last + 1) - (std::size_t{1} << level)]);
}

bool RadialReach::is_beyond(const Eigen::Vector3d& place_mm, double distance_mm) const {
    const double radius = std::hypot(place_mm.x(), place_mm.y());
    const double rounding = kRounding * (radius + distance_mm);
    const double near = largest_mm(place_mm.z() - distance_mm, place_mm.z() + distance_mm);
    return bins_ > 0 && radius - near >= distance_mm + rounding;
}

}  // namespace meshwind
