#include "winding/footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "mesh/nearest.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFaceChunk = 256;

// Cosine between a sample's normal and the path's (60 deg): the wall opposite is never covered.
constexpr double kSameSide = 0.5;

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

}  // namespace

FootprintFinder::FootprintFinder(const Surface& surface, const CoverageSamples& samples,
                                 double band_mm)
    : samples_(samples), half_band_mm_(0.5 * band_mm) {
    const NearestPoints index(samples.position_mm);
    const std::size_t faces = surface.face.size();
    std::vector<std::vector<std::int32_t>> rows(faces);
    parallel_for(faces, kFaceChunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t f = first; f < last; ++f) {
            const auto& v = surface.face[f];
            const Vector3d& a = surface.position_mm[at(v[0])];
            const Vector3d& b = surface.position_mm[at(v[1])];
            const Vector3d& c = surface.position_mm[at(v[2])];
            const Vector3d centre = (a + b + c) / 3.0;
            const double reach =
                std::sqrt(std::max({(a - centre).squaredNorm(), (b - centre).squaredNorm(),
                                    (c - centre).squaredNorm()}));
            rows[f] = index.within(centre, reach + half_band_mm_);
        }
    });
    begin_.reserve(faces + 1);
    begin_.push_back(0);
    for (const auto& row : rows) {
        near_.insert(near_.end(), row.begin(), row.end());
        begin_.push_back(static_cast<std::int32_t>(near_.size()));
    }
}

FootprintFinder::Scratch FootprintFinder::make_scratch() const {
    return {std::vector<double>(samples_.size(), -std::numeric_limits<double>::infinity())};
}

std::vector<std::int32_t> FootprintFinder::footprint(const SurfacePath& path,
                                                     Scratch& scratch) const {
    std::vector<std::int32_t> found;
    const double again_mm = 4.0 * half_band_mm_;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const PathPoint& from = path[i];
        const Vector3d step = path[i + 1].position_mm - from.position_mm;
        const double length = step.norm();
        if (length <= 0.0) {
            continue;
        }
        // The segment lies in the face that both ends share: the one its second end was reached in.
        const std::size_t face = at(path[i + 1].at.face);
        const Vector3d along = step / length;
        const Vector3d across = from.normal.cross(along);
        for (std::int32_t k = begin_[face]; k < begin_[face + 1]; ++k) {
            const std::int32_t sample = near_[at(k)];
            const Vector3d d = samples_.position_mm[at(sample)] - from.position_mm;
            const double x = along.dot(d);
            if (x < 0.0 || x > length || std::abs(across.dot(d)) > half_band_mm_ ||
                std::abs(from.normal.dot(d)) > half_band_mm_ ||
                samples_.normal[at(sample)].dot(from.normal) < kSameSide) {
                continue;
            }
            double& seen = scratch.last_seen_mm[at(sample)];
            if (from.s_mm - seen > again_mm) {
                found.push_back(sample);
            }
            seen = from.s_mm;
        }
    }
    for (const std::int32_t sample : found) {
        scratch.last_seen_mm[at(sample)] = -std::numeric_limits<double>::infinity();
    }
    return found;
}

}  // namespace meshwind
