/// Coverage samples: points spread evenly over the winding surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"

namespace meshwind {

/// Each sample stands for `area_mm2` of the surface. Structure of arrays, all n long.
struct CoverageSamples {
    std::vector<SurfacePoint> at;
    std::vector<Eigen::Vector3d> position_mm;
    std::vector<Eigen::Vector3d> normal;
    double area_mm2 = 0.0;  ///< surface area divided by n

    [[nodiscard]] std::size_t size() const { return at.size(); }
};

/// Poisson-disc samples by dart throwing: no two closer than 0.7 `spacing_mm`, no hole wider than
/// about `spacing_mm`. The same for a seed on every machine. \param spacing_mm > 0
[[nodiscard]] CoverageSamples sample_surface(const Surface& surface, double spacing_mm,
                                             std::uint64_t seed);

/// Samples at given places: those of another surface with the same triangles, say.
[[nodiscard]] CoverageSamples samples_at(const Surface& surface, std::vector<SurfacePoint> places);

/// Samples that speak for each face: of how many and of which faces.
struct SampledFaces {
    std::vector<std::int32_t> samples;  ///< per face: how many lie on it
    /// Per face: itself where it has a sample, else its neighbours that have one, else the faces
    /// that speak for its neighbour nearest to those; kNoFace behind the last. None in a piece
    /// without any.
    std::vector<std::array<std::int32_t, 3>> speaks;
};
[[nodiscard]] SampledFaces sampled_faces(const Surface& surface, const CoverageSamples& samples);

}  // namespace meshwind
