#include "winding/samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "geodesic/trace.h"
#include "winding/random.h"

namespace meshwind {
namespace {

// Smallest distance between samples as a share of the spacing: darts at this distance saturate at
// holes of about the spacing itself.
constexpr double kDiscShare = 0.7;

// Darts per disc area: eight leave fewer than one hole in a thousand discs.
constexpr double kDartsPerDisc = 8.0;

// Cells beside a dart's own, which is the likeliest to be taken: most darts come too late.
constexpr std::array kOwnFirst = {0, -1, 1};

class Grid {
public:
    explicit Grid(double cell) : cell_(cell) {}

    // Adds `point` unless another one is nearer than the cell size on a surface facing the same
    // way.
    bool add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
             const CoverageSamples& samples) {
        const Eigen::Vector3d scaled = point / cell_;
        const std::array<std::int64_t, 3> c = {static_cast<std::int64_t>(std::floor(scaled.x())),
                                               static_cast<std::int64_t>(std::floor(scaled.y())),
                                               static_cast<std::int64_t>(std::floor(scaled.z()))};
        for (const int x : kOwnFirst) {
            for (const int y : kOwnFirst) {
                for (const int z : kOwnFirst) {
                    if (taken(key(c[0] + x, c[1] + y, c[2] + z), point, normal, samples)) {
                        return false;
                    }
                }
            }
        }
        cells_[key(c[0], c[1], c[2])].push_back(static_cast<std::int32_t>(samples.size()));
        return true;
    }

private:
    static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
        const auto part = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x1FFFFFU; };
        return (part(x) << 42U) | (part(y) << 21U) | part(z);
    }

    bool taken(std::uint64_t cell, const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
               const CoverageSamples& samples) const {
        const auto found = cells_.find(cell);
        if (found == cells_.end()) {
            return false;
        }
        return std::any_of(found->second.begin(), found->second.end(), [&](std::int32_t i) {
            const auto k = static_cast<std::size_t>(i);
            return (samples.position_mm[k] - point).squaredNorm() < cell_ * cell_ &&
                   samples.normal[k].dot(normal) > 0.0;
        });
    }

    double cell_;
    std::unordered_map<std::uint64_t, std::vector<std::int32_t>> cells_;
};

std::vector<double> cumulative_area(const Surface& surface) {
    std::vector<double> cumulative;
    cumulative.reserve(surface.face.size());
    double area = 0.0;
    for (const auto& v : surface.face) {
        const Eigen::Vector3d& a = surface.position_mm[static_cast<std::size_t>(v[0])];
        area += 0.5 * (surface.position_mm[static_cast<std::size_t>(v[1])] - a)
                          .cross(surface.position_mm[static_cast<std::size_t>(v[2])] - a)
                          .norm();
        cumulative.push_back(area);
    }
    return cumulative;
}

SurfacePoint dart(const std::vector<double>& cumulative, std::uint64_t seed, std::uint64_t index) {
    const double pick = random_unit(seed, 3 * index) * cumulative.back();
    const auto face = std::upper_bound(cumulative.begin(), cumulative.end() - 1, pick);
    const double r = std::sqrt(random_unit(seed, 3 * index + 1));
    const double v = random_unit(seed, 3 * index + 2);
    return {static_cast<std::int32_t>(face - cumulative.begin()), {1.0 - r, r * (1.0 - v), r * v}};
}

// Samples that a path meets one after the other then lie side by side in memory.
void sort_by_face(CoverageSamples& samples) {
    std::vector<std::size_t> order(samples.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return samples.at[a].face < samples.at[b].face;
    });
    CoverageSamples sorted;
    sorted.area_mm2 = samples.area_mm2;
    for (const std::size_t i : order) {
        sorted.at.push_back(samples.at[i]);
        sorted.position_mm.push_back(samples.position_mm[i]);
        sorted.normal.push_back(samples.normal[i]);
    }
    samples = std::move(sorted);
}

}  // namespace

CoverageSamples sample_surface(const Surface& surface, double spacing_mm, std::uint64_t seed) {
    CoverageSamples samples;
    const std::vector<double> cumulative = cumulative_area(surface);
    if (cumulative.empty()) {
        return samples;
    }
    const double disc = kDiscShare * spacing_mm;
    const auto darts =
        static_cast<std::uint64_t>(kDartsPerDisc * cumulative.back() / (disc * disc)) + 1;
    Grid grid(disc);
    for (std::uint64_t i = 0; i < darts; ++i) {
        const SurfacePoint point = dart(cumulative, seed, i);
        const Eigen::Vector3d position = position_mm(surface, point);
        const Eigen::Vector3d normal = smooth_normal(surface, point);
        if (grid.add(position, normal, samples)) {
            samples.at.push_back(point);
            samples.position_mm.push_back(position);
            samples.normal.push_back(normal);
        }
    }
    samples.area_mm2 = cumulative.back() / static_cast<double>(samples.size());
    sort_by_face(samples);
    return samples;
}

}  // namespace meshwind
