/// Which coverage samples the band of a path covers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "geodesic/surface_path.h"
#include "winding/samples.h"

namespace meshwind {

/// Finds footprints; immutable once built, so one serves all threads.
class FootprintFinder {
public:
    /// \param band_mm width of the band laid down, > 0
    FootprintFinder(const Surface& surface, const CoverageSamples& samples, double band_mm);

    /// Scratch for one thread.
    struct Scratch {
        std::vector<double> last_seen_mm;
    };
    [[nodiscard]] Scratch make_scratch() const;

    /// Samples within half a band of `path`, measured across it in the tangent plane, in order of
    /// first contact. A sample that the path passes again, more than two bands later, is listed
    /// again.
    [[nodiscard]] std::vector<std::int32_t> footprint(const SurfacePath& path,
                                                      Scratch& scratch) const;

private:
    static constexpr int kLanes = 8;
    using Lanes = Eigen::Array<float, kLanes, 1>;

    // Faces that are taken together: their samples stay at hand while a path crosses them.
    struct Patch {
        Eigen::Vector3d centre_mm;
        Eigen::Vector3d normal;
        std::vector<std::int32_t> faces;
    };
    [[nodiscard]] std::vector<Patch> patches_of(const Surface& surface) const;

    // Samples that are tested at once, as offsets from the patch's centre: in single precision they
    // are good to a few nm. Lanes left over hold places far off.
    struct Block {
        std::array<Lanes, 3> offset_mm;
        std::array<std::int32_t, kLanes> sample;
    };
    [[nodiscard]] std::vector<Block> blocks_of(const std::vector<std::int32_t>& near,
                                               const Eigen::Vector3d& centre_mm) const;

    const CoverageSamples& samples_;
    double half_band_mm_;
    std::vector<std::int32_t> patch_of_;      // per face
    std::vector<Eigen::Vector3d> centre_mm_;  // per patch
    std::vector<std::int32_t> begin_;         // per patch: rows into near_
    std::vector<Block> near_;  // samples within half a band of the patch, on its side
};

}  // namespace meshwind
