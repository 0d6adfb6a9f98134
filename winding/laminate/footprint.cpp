#include "winding/laminate/footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kGroupChunk = 32;

// Cosine between the normals of a sample and of the faces about it (60 deg): the wall opposite is
// never covered. And between those of faces that are taken together (25 deg).
constexpr double kSameSide = 0.5;
constexpr double kSameWay = 0.9;

// Between the ends of what is taken for straight (8 deg): half a band bulges by 1 % of it.
constexpr double kStraight = 0.99;

// How far a band and the facets beside it may lie apart: twice the bulge of the facets, for the
// path may lie on them or on what they stand for, and a share of the slab's length, for it cuts off
// what bends between its ends (by 0.25 at a crease of 53 deg).
constexpr double kBulges = 2.0;
constexpr double kCutOff = 0.25;

// A sample is passed again further on than in the next slab, times the length of this one.
constexpr double kNextSlab = 1.5;

// Of a lane without a sample: further from any face than a band is wide, mm.
constexpr float kNowhere = 1e9F;

// Height over a facet of the smooth surface that its corners' normals belong to: of an arc over its
// longest edge.
double bulge_of(const Surface& surface, std::size_t face) {
    const auto& v = surface.face[face];
    const std::array<Vector3d, 3> corner{surface.position_mm[at(v[0])],
                                         surface.position_mm[at(v[1])],
                                         surface.position_mm[at(v[2])]};
    const Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    double edge_mm = 0.0;
    double least_cos = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        edge_mm = std::max(edge_mm, (corner[(k + 1) % 3] - corner[k]).norm());
        least_cos = std::min(least_cos, surface.normal[at(surface.corner[face][k])].dot(normal));
    }
    return 0.5 * edge_mm * std::tan(0.5 * std::acos(std::max(kSameSide, least_cos)));
}

void forget(const std::vector<std::int32_t>& samples, FootprintFinder::Scratch& scratch) {
    for (const std::int32_t sample : samples) {
        scratch.last_seen_mm[at(sample)] = -std::numeric_limits<double>::infinity();
    }
}

}  // namespace

FootprintFinder::FootprintFinder(const Surface& surface, const CoverageSamples& samples,
                                 double band_mm)
    : samples_(samples), index_(samples.position_mm), half_band_mm_(0.5 * band_mm) {
    const std::vector<FaceGroup> groups = groups_of(surface);
    std::vector<std::vector<Block>> rows(groups.size());
    centre_mm_.resize(groups.size());
    reach_mm_.resize(groups.size());
    bulge_mm_.resize(groups.size());
    parallel_for(groups.size(), kGroupChunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t p = first; p < last; ++p) {
            centre_mm_[p] = groups[p].centre_mm;
            double reach = 0.0;
            for (const std::int32_t face : groups[p].faces) {
                for (const std::int32_t v : surface.face[at(face)]) {
                    reach = std::max(reach, (surface.position_mm[at(v)] - centre_mm_[p]).norm());
                }
                bulge_mm_[p] = std::max(bulge_mm_[p], bulge_of(surface, at(face)));
            }
            reach_mm_[p] = reach + half_band_mm_;
            std::vector<std::int32_t> near = index_.within(centre_mm_[p], reach_mm_[p]);
            std::erase_if(near, [&](std::int32_t sample) {
                return samples.normal[at(sample)].dot(groups[p].normal) < kSameSide;
            });
            rows[p] = blocks_of(near, centre_mm_[p]);
        }
    });
    group_of_.resize(surface.face.size());
    begin_.push_back(0);
    for (std::size_t p = 0; p < groups.size(); ++p) {
        for (const std::int32_t face : groups[p].faces) {
            group_of_[at(face)] = static_cast<std::int32_t>(p);
        }
        near_.insert(near_.end(), rows[p].begin(), rows[p].end());
        begin_.push_back(static_cast<std::int32_t>(near_.size()));
    }
}

// Faces side by side that look about the same way, up to half a band around the first.
std::vector<FootprintFinder::FaceGroup> FootprintFinder::groups_of(const Surface& surface) const {
    const auto centre = [&](std::int32_t face) -> Vector3d {
        const auto& v = surface.face[at(face)];
        return (surface.position_mm[at(v[0])] + surface.position_mm[at(v[1])] +
                surface.position_mm[at(v[2])]) /
               3.0;
    };
    const auto normal = [&](std::int32_t face) -> Vector3d {
        const auto& v = surface.face[at(face)];
        const Vector3d& a = surface.position_mm[at(v[0])];
        return (surface.position_mm[at(v[1])] - a)
            .cross(surface.position_mm[at(v[2])] - a)
            .normalized();
    };
    std::vector<FaceGroup> groups;
    std::vector<char> taken(surface.face.size(), 0);
    for (std::int32_t first = 0; at(first) < surface.face.size(); ++first) {
        if (taken[at(first)] != 0) {
            continue;
        }
        taken[at(first)] = 1;
        FaceGroup group{centre(first), normal(first), {first}};
        for (std::size_t i = 0; i < group.faces.size(); ++i) {
            for (const std::int32_t next : surface.neighbour[at(group.faces[i])]) {
                if (next != kNoFace && taken[at(next)] == 0 &&
                    (centre(next) - group.centre_mm).norm() < half_band_mm_ &&
                    normal(next).dot(group.normal) > kSameWay) {
                    taken[at(next)] = 1;
                    group.faces.push_back(next);
                }
            }
        }
        groups.push_back(std::move(group));
    }
    return groups;
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

bool FootprintFinder::holds(std::size_t group, const Slab& slab) const {
    const Eigen::Vector3f first = (slab.start_mm - centre_mm_[group]).cast<float>();
    const Eigen::Vector3f last = first + slab.length_mm * slab.along;
    const Eigen::Vector3f side = static_cast<float>(half_band_mm_) * slab.across;
    const float farthest_mm2 = std::max({(first + side).squaredNorm(), (first - side).squaredNorm(),
                                         (last + side).squaredNorm(), (last - side).squaredNorm()});
    return farthest_mm2 <= reach_mm_[group] * reach_mm_[group];
}

std::vector<FootprintFinder::Block> FootprintFinder::blocks_about(const Slab& slab,
                                                                  const Vector3d& centre_mm) const {
    const double reach_mm = std::hypot(0.5 * slab.length_mm, half_band_mm_, slab.half_height_mm);
    std::vector<std::int32_t> near = index_.within(centre_mm, reach_mm);
    const Vector3d up = slab.up.cast<double>();
    std::erase_if(
        near, [&](std::int32_t sample) { return samples_.normal[at(sample)].dot(up) < kSameSide; });
    return blocks_of(near, centre_mm);
}

template <typename Contact>
void FootprintFinder::visit_block(const Slab& slab, const Block& block,
                                  const Eigen::Vector3f& start_mm, const Contact& contact) const {
    const auto half_band = static_cast<float>(half_band_mm_);
    const Lanes x = block.offset_mm[0] - start_mm.x();
    const Lanes y = block.offset_mm[1] - start_mm.y();
    const Lanes z = block.offset_mm[2] - start_mm.z();
    const Lanes ahead = slab.along.x() * x + slab.along.y() * y + slab.along.z() * z;
    const Lanes beside = slab.across.x() * x + slab.across.y() * y + slab.across.z() * z;
    const Lanes above = slab.up.x() * x + slab.up.y() * y + slab.up.z() * z;
    const Lanes inside = ahead.min(slab.length_mm - ahead)
                             .min(half_band - beside.abs())
                             .min(slab.half_height_mm - above.abs());
    if (!(inside.maxCoeff() >= 0.0F)) {
        return;
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (inside[static_cast<Eigen::Index>(lane)] >= 0.0F) {
            contact(block.sample[lane], beside[static_cast<Eigen::Index>(lane)]);
        }
    }
}

template <typename Found>
void FootprintFinder::visit(const SurfacePath& path, Scratch& scratch, const Found& found) const {
    for (std::size_t i = 0; i + 1 < path.size();) {
        const std::size_t station = i;
        const PathPoint& from = path[i];
        // Most often the slab lies about the face that its second end was reached in.
        const std::int32_t group_index = group_of_[at(path[++i].at.face)];
        while (i + 1 < path.size() && group_of_[at(path[i + 1].at.face)] == group_index &&
               path[i + 1].s_mm - from.s_mm < half_band_mm_ &&
               path[i + 1].normal.dot(from.normal) > kStraight) {
            ++i;
        }
        const Vector3d step = path[i].position_mm - from.position_mm;
        const double length = step.norm();
        if (length <= 0.0) {
            continue;
        }
        const std::size_t group = at(group_index);
        Slab slab;
        slab.start_mm = from.position_mm;
        slab.length_mm = static_cast<float>(length);
        slab.half_height_mm = static_cast<float>(
            std::max(half_band_mm_, kBulges * bulge_mm_[group] + kCutOff * length));
        slab.along = (step / length).cast<float>();
        slab.up = from.normal.cast<float>();
        slab.across = slab.up.cross(slab.along);
        const double again_mm = std::max(4.0 * half_band_mm_, kNextSlab * length);
        const auto contact = [&](std::int32_t sample, float left_mm) {
            double& seen = scratch.last_seen_mm[at(sample)];
            if (from.s_mm - seen > again_mm) {
                found(sample, left_mm, station);
            }
            seen = from.s_mm;
        };
        if (holds(group, slab)) {
            const Eigen::Vector3f start = (slab.start_mm - centre_mm_[group]).cast<float>();
            for (std::int32_t k = begin_[group]; k < begin_[group + 1]; ++k) {
                visit_block(slab, near_[at(k)], start, contact);
            }
        } else {
            const Vector3d middle = from.position_mm + 0.5 * step;
            const Eigen::Vector3f start = (slab.start_mm - middle).cast<float>();
            for (const Block& block : blocks_about(slab, middle)) {
                visit_block(slab, block, start, contact);
            }
        }
    }
}

std::vector<std::int32_t> FootprintFinder::footprint(const SurfacePath& path,
                                                     Scratch& scratch) const {
    std::vector<std::int32_t> samples;
    visit(path, scratch, [&](std::int32_t sample, float /*left_mm*/, std::size_t /*station*/) {
        samples.push_back(sample);
    });
    forget(samples, scratch);
    return samples;
}

Strip FootprintFinder::strip(const SurfacePath& path, Scratch& scratch) const {
    Strip strip;
    visit(path, scratch, [&](std::int32_t sample, float left_mm, std::size_t station) {
        strip.sample.push_back(sample);
        strip.left_mm.push_back(left_mm);
        strip.station.push_back(static_cast<std::int32_t>(station));
    });
    forget(strip.sample, scratch);
    return strip;
}

}  // namespace meshwind
