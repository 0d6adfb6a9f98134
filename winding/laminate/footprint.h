/// Footprints: the coverage samples that the band of a path covers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "geodesic/surface_path.h"
#include "mesh/nearest.h"
#include "mesh/surface.h"
#include "winding/laminate/samples.h"

namespace meshwind {

/// Samples in a strip along a path, with where they lie.
struct Strip {
    std::vector<std::int32_t> sample;
    std::vector<float> left_mm;         ///< distance to the left of the path
    std::vector<std::int32_t> station;  ///< of the path, just before
};

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

    /// The same samples, with where they lie beside the path.
    [[nodiscard]] Strip strip(const SurfacePath& path, Scratch& scratch) const;

private:
    static constexpr int kLanes = 8;
    using Lanes = Eigen::Array<float, kLanes, 1>;

    // Calls `found(sample, left_mm, station)` for every sample of a footprint.
    template <typename Found>
    void visit(const SurfacePath& path, Scratch& scratch, const Found& found) const;

    // A straight piece of a band, as long as it is flat.
    struct Slab {
        Eigen::Vector3d start_mm;
        float length_mm;
        float half_height_mm;  // distance from its plane within which the wall is sought
        Eigen::Vector3f along;
        Eigen::Vector3f across;
        Eigen::Vector3f up;
    };

    // Faces that are taken together: their samples stay at hand while a path crosses them.
    struct FaceGroup {
        Eigen::Vector3d centre_mm;
        Eigen::Vector3d normal;
        std::vector<std::int32_t> faces;
    };
    [[nodiscard]] std::vector<FaceGroup> groups_of(const Surface& surface) const;

    // Samples that are tested at once, as offsets from the group's centre: in single precision they
    // are good to a few nm. Lanes left over hold places far off.
    struct Block {
        std::array<Lanes, 3> offset_mm;
        std::array<std::int32_t, kLanes> sample;
    };
    [[nodiscard]] std::vector<Block> blocks_of(const std::vector<std::int32_t>& near,
                                               const Eigen::Vector3d& centre_mm) const;

    // Calls `contact(sample, left_mm)` for every sample of a block in a slab.
    template <typename Contact>
    void visit_block(const Slab& slab, const Block& block, const Eigen::Vector3f& start_mm,
                     const Contact& contact) const;

    // True where all samples of a slab are near a group.
    [[nodiscard]] bool holds(std::size_t group, const Slab& slab) const;
    // Samples near a slab that lies elsewhere, as offsets from `centre_mm`.
    [[nodiscard]] std::vector<Block> blocks_about(const Slab& slab,
                                                  const Eigen::Vector3d& centre_mm) const;

    const CoverageSamples& samples_;
    NearestPoints index_;  // of the samples
    double half_band_mm_;
    std::vector<std::int32_t> group_of_;      // per face
    std::vector<Eigen::Vector3d> centre_mm_;  // per group
    std::vector<double> reach_mm_;            // per group: how far from its centre near_ reaches
    std::vector<double> bulge_mm_;            // per group: of the surface that its facets stand for
    std::vector<std::int32_t> begin_;         // per group: rows into near_
    std::vector<Block> near_;  // samples within half a band of the group, on its side
};

}  // namespace meshwind
