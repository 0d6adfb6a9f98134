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

// Cosine between a sample's normal and the face's (60 deg): the wall opposite is never covered.
constexpr double kSameSide = 0.5;

// Of a lane without a sample: further from any face than a band is wide, mm.
constexpr float kNowhere = 1e9F;

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

}  // namespace

FootprintFinder::FootprintFinder(const Surface& surface, const CoverageSamples& samples,
                                 double band_mm)
    : samples_(samples), half_band_mm_(0.5 * band_mm) {
    const NearestPoints index(samples.position_mm);
    const std::size_t faces = surface.face.size();
    std::vector<std::vector<Block>> rows(faces);
    centre_mm_.resize(faces);
    parallel_for(faces, kFaceChunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t f = first; f < last; ++f) {
            const auto& v = surface.face[f];
            const Vector3d& a = surface.position_mm[at(v[0])];
            const Vector3d& b = surface.position_mm[at(v[1])];
            const Vector3d& c = surface.position_mm[at(v[2])];
            const Vector3d normal = (b - a).cross(c - a).normalized();
            centre_mm_[f] = (a + b + c) / 3.0;
            const double reach = std::sqrt(std::max({(a - centre_mm_[f]).squaredNorm(),
                                                     (b - centre_mm_[f]).squaredNorm(),
                                                     (c - centre_mm_[f]).squaredNorm()}));
            std::vector<std::int32_t> near = index.within(centre_mm_[f], reach + half_band_mm_);
            std::erase_if(near, [&](std::int32_t sample) {
                return samples.normal[at(sample)].dot(normal) < kSameSide;
            });
            rows[f] = blocks_of(near, centre_mm_[f]);
        }
    });
    begin_.reserve(faces + 1);
    begin_.push_back(0);
    for (const auto& row : rows) {
        near_.insert(near_.end(), row.begin(), row.end());
        begin_.push_back(static_cast<std::int32_t>(near_.size()));
    }
}

std::vector<FootprintFinder::Block> FootprintFinder::blocks_of(
    const std::vector<std::int32_t>& near, const Vector3d& centre_mm) const {
    std::vector<Block> blocks((near.size() + kLanes - 1) / kLanes);
    for (Block& block : blocks) {
        block.offset_mm.fill(Lanes::Constant(kNowhere));
        block.sample.fill(-1);
    }
    for (std::size_t i = 0; i < near.size(); ++i) {
        Block& block = blocks[i / kLanes];
        const std::size_t lane = i % kLanes;
        const Vector3d offset = samples_.position_mm[at(near[i])] - centre_mm;
        block.sample[lane] = near[i];
        for (std::size_t k = 0; k < 3; ++k) {
            block.offset_mm[k][static_cast<Eigen::Index>(lane)] =
                static_cast<float>(offset[static_cast<Eigen::Index>(k)]);
        }
    }
    return blocks;
}

FootprintFinder::Scratch FootprintFinder::make_scratch() const {
    return {std::vector<double>(samples_.size(), -std::numeric_limits<double>::infinity())};
}

std::vector<std::int32_t> FootprintFinder::footprint(const SurfacePath& path,
                                                     Scratch& scratch) const {
    std::vector<std::int32_t> found;
    const double again_mm = 4.0 * half_band_mm_;
    const auto half_band = static_cast<float>(half_band_mm_);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const PathPoint& from = path[i];
        const Vector3d step = path[i + 1].position_mm - from.position_mm;
        const double length = step.norm();
        if (length <= 0.0) {
            continue;
        }
        // The segment lies in the face that both ends share: the one its second end was reached in.
        const std::size_t face = at(path[i + 1].at.face);
        const Eigen::Vector3f along = (step / length).cast<float>();
        const Eigen::Vector3f up = from.normal.cast<float>();
        const Eigen::Vector3f across = up.cross(along);
        const Eigen::Vector3f start = (from.position_mm - centre_mm_[face]).cast<float>();
        for (std::int32_t k = begin_[face]; k < begin_[face + 1]; ++k) {
            const Block& block = near_[at(k)];
            const Lanes x = block.offset_mm[0] - start.x();
            const Lanes y = block.offset_mm[1] - start.y();
            const Lanes z = block.offset_mm[2] - start.z();
            const Lanes ahead = along.x() * x + along.y() * y + along.z() * z;
            const Lanes beside = across.x() * x + across.y() * y + across.z() * z;
            const Lanes above = up.x() * x + up.y() * y + up.z() * z;
            const Lanes inside = ahead.min(static_cast<float>(length) - ahead)
                                     .min(half_band - beside.abs())
                                     .min(half_band - above.abs());
            if (!(inside.maxCoeff() >= 0.0F)) {
                continue;
            }
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                if (inside[static_cast<Eigen::Index>(lane)] < 0.0F) {
                    continue;
                }
                const std::int32_t sample = block.sample[lane];
                double& seen = scratch.last_seen_mm[at(sample)];
                if (from.s_mm - seen > again_mm) {
                    found.push_back(sample);
                }
                seen = from.s_mm;
            }
        }
    }
    for (const std::int32_t sample : found) {
        scratch.last_seen_mm[at(sample)] = -std::numeric_limits<double>::infinity();
    }
    return found;
}

}  // namespace meshwind
