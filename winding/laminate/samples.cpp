#include "winding/laminate/samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/random.h"
#include "geodesic/trace.h"

namespace meshwind {
namespace {

// Smallest distance between samples as a share of the spacing: darts at this distance saturate at
// holes of about the spacing itself.
constexpr double kDiscShare = 0.7;

// Darts per disc area: eight leave fewer than one hole in a thousand discs.
constexpr double kDartsPerDisc = 8.0;

// Darts that are drawn at a time, and that one task draws.
constexpr std::uint64_t kDraw = 1U << 16U;
constexpr std::size_t kDrawChunk = 1024;

struct Dart {
    SurfacePoint at;
    Eigen::Vector3d position_mm;
    Eigen::Vector3d normal;
};

// Samples by cells of two discs' width: what is within a disc of a point lies in its own cell or
// in those on the nearer sides.
class Grid {
public:
    explicit Grid(double disc) : disc_(disc), slots_(kFirstSlots) {}

    // True where no sample is nearer to a dart than a disc on a surface facing the same way.
    [[nodiscard]] bool is_free(const Dart& dart, const CoverageSamples& samples) const {
        const Eigen::Array3d scaled = dart.position_mm.array() / (2.0 * disc_);
        const Eigen::Array3d cell = scaled.floor();
        const Eigen::Array3d nearer = (scaled - cell < 0.5).select(cell - 1.0, cell + 1.0);
        for (unsigned side = 0; side < 8; ++side) {
            const std::uint64_t key = key_of((side & 1U) != 0 ? nearer.x() : cell.x(),
                                             (side & 2U) != 0 ? nearer.y() : cell.y(),
                                             (side & 4U) != 0 ? nearer.z() : cell.z());
            if (taken(slots_[slot(key)], dart, samples)) {
                return false;
            }
        }
        return true;
    }

    // Notes that a dart becomes the next sample.
    void add(const Dart& dart, const CoverageSamples& samples) {
        const Eigen::Array3d cell = (dart.position_mm.array() / (2.0 * disc_)).floor();
        Slot& own = slots_[slot(key_of(cell.x(), cell.y(), cell.z()))];
        own.key = key_of(cell.x(), cell.y(), cell.z());
        cells_ += own.last < 0 ? 1 : 0;
        next_.push_back(own.last);
        own.last = static_cast<std::int32_t>(samples.size());
        if (2 * cells_ > slots_.size()) {
            grow();
        }
    }

private:
    // The samples of a cell: the last one added, then next_ back to the first.
    struct Slot {
        std::uint64_t key = 0;
        std::int32_t last = -1;
    };

    static std::uint64_t key_of(double x, double y, double z) {
        const auto part = [](double v) {
            return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)) & 0x1FFFFFU;
        };
        return (part(x) << 42U) | (part(y) << 21U) | part(z);
    }

    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        std::swap(old, slots_);
        for (const Slot& cell : old) {
            if (cell.last >= 0) {
                slots_[slot(cell.key)] = cell;
            }
        }
    }

    // Of a cell, or the empty one where it would be: open addressing with linear probing.
    [[nodiscard]] std::size_t slot(std::uint64_t key) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = random_bits(0, key) & mask;
        while (slots_[i].last >= 0 && slots_[i].key != key) {
            i = (i + 1) & mask;
        }
        return i;
    }

    [[nodiscard]] bool taken(const Slot& slot, const Dart& dart,
                             const CoverageSamples& samples) const {
        for (std::int32_t i = slot.last; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
            const auto k = static_cast<std::size_t>(i);
            if ((samples.position_mm[k] - dart.position_mm).squaredNorm() < disc_ * disc_ &&
                samples.normal[k].dot(dart.normal) > 0.0) {
                return true;
            }
        }
        return false;
    }

    static constexpr std::size_t kFirstSlots = 1U << 14U;  // a power of two, as all that follow

    double disc_;
    std::vector<Slot> slots_;
    std::size_t cells_ = 0;           // that hold samples
    std::vector<std::int32_t> next_;  // per sample
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
    std::vector<Dart> drawn;
    std::vector<char> free;  // of the samples before: most darts are not, which is seen in parallel
    for (std::uint64_t first = 0; first < darts; first += kDraw) {
        drawn.resize(std::min(kDraw, darts - first));
        free.resize(drawn.size());
        parallel_for(drawn.size(), kDrawChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const SurfacePoint point = dart(cumulative, seed, first + i);
                drawn[i] = {point, position_mm(surface, point), smooth_normal(surface, point)};
                free[i] = grid.is_free(drawn[i], samples) ? 1 : 0;
            }
        });
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            if (free[i] != 0 && grid.is_free(drawn[i], samples)) {
                grid.add(drawn[i], samples);
                samples.at.push_back(drawn[i].at);
                samples.position_mm.push_back(drawn[i].position_mm);
                samples.normal.push_back(drawn[i].normal);
            }
        }
    }
    samples.area_mm2 = cumulative.back() / static_cast<double>(samples.size());
    sort_by_face(samples);
    return samples;
}

CoverageSamples samples_at(const Surface& surface, std::vector<SurfacePoint> places) {
    CoverageSamples samples;
    for (const SurfacePoint& place : places) {
        samples.position_mm.push_back(position_mm(surface, place));
        samples.normal.push_back(smooth_normal(surface, place));
    }
    samples.area_mm2 = area_mm2({surface.position_mm, surface.face}) /
                       static_cast<double>(std::max<std::size_t>(1, places.size()));
    samples.at = std::move(places);
    return samples;
}

SampledFaces sampled_faces(const Surface& surface, const CoverageSamples& samples) {
    const auto at = [](std::int32_t face) { return static_cast<std::size_t>(face); };
    SampledFaces faces;
    faces.samples.assign(surface.face.size(), 0);
    faces.speaks.assign(surface.face.size(), {kNoFace, kNoFace, kNoFace});
    for (const SurfacePoint& place : samples.at) {
        ++faces.samples[at(place.face)];
    }
    std::vector<std::int32_t> ring;  // around the faces with samples, outwards
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        if (faces.samples[f] > 0) {
            faces.speaks[f][0] = static_cast<std::int32_t>(f);
            ring.push_back(static_cast<std::int32_t>(f));
        }
    }
    for (std::size_t i = 0; i < ring.size(); ++i) {
        for (const std::int32_t next : surface.neighbour[at(ring[i])]) {
            if (next == kNoFace || faces.speaks[at(next)][0] != kNoFace) {
                continue;
            }
            ring.push_back(next);
            if (faces.samples[at(ring[i])] == 0) {
                faces.speaks[at(next)] = faces.speaks[at(ring[i])];
                continue;
            }
            std::size_t n = 0;
            for (const std::int32_t beside : surface.neighbour[at(next)]) {
                if (beside != kNoFace && faces.samples[at(beside)] > 0) {
                    faces.speaks[at(next)][n++] = beside;
                }
            }
        }
    }
    return faces;
}

}  // namespace meshwind
