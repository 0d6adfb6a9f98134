/// Measures coverage and figures of a plan that was not made from coverage samples.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/random.h"
#include "mesh/surface.h"
#include "winding/laminate/samples.h"
#include "winding/plan/plan.h"
#include "winding/plan/tow.h"

namespace meshwind {

/// Parts of a surface by position; an empty zone is all of it.
struct PlanZones {
    using Zone = std::function<bool(const Eigen::Vector3d& position_mm)>;

    /// The zone to be covered. Wall elsewhere is left out of mean, maximum and scatter, and
    /// Coverage::reachable is the share of this zone; without one it is left at 0.
    Zone asked_for{};
    /// Where the winding is regular: Coverage::regular_cv is measured there; none without one.
    Zone regular{};
    /// Layers that the pattern lays at a place of `regular`: where they vary by geometry, the
    /// scatter is that of the layers over these. Empty: the same everywhere.
    std::function<double(const Eigen::Vector3d& position_mm)> meant{};
};

/// The samples that a plan's coverage is measured on: four to a tow width each way, so that a gap
/// of a quarter is seen. \param seed of the plan \param stream Sampling, or that of others in their
/// number
[[nodiscard]] CoverageSamples plan_samples(const Surface& surface, double tow_width_mm,
                                           std::uint64_t seed, Stream stream = Stream::Sampling);

/// The path of course `i`, with those parts of the turns before and after it from which its band
/// still covers wall.
[[nodiscard]] SurfacePath course_with_ends(std::span<const Piece> pieces, std::size_t i,
                                           double tow_width_mm);

/// Layers that the courses of a plan lay at each sample, with their ends. \param wall as in
/// measure_plan()
[[nodiscard]] std::vector<std::int32_t> layers_of_courses(const Surface& wall,
                                                          const CoverageSamples& samples,
                                                          std::span<const Piece> pieces,
                                                          double tow_width_mm);

/// Coverage by a fibre as it lies, with its turns. \param wall surface of the stations' faces, as
/// in measure_plan() \return `reachable` is left at 0
[[nodiscard]] Coverage coverage_of_fibre(const Surface& surface, const Surface& wall,
                                         double tow_width_mm, std::uint64_t seed,
                                         const SurfacePath& fibre);

/// Fills in winding angles, places in the order and families of a plan's courses. \param wall as in
/// measure_plan() \param wish_rad wanted winding angle
void describe_courses(const Surface& wall, double tow_width_mm, std::optional<double> wish_rad,
                      Plan& plan);

/// Fills in coverage, layers per face, winding angles and places of a plan's courses.
/// \param surface to be covered \param wall surface of the stations' faces: `surface`, or `surface`
/// with more faces after its own \param seed of the samples
void measure_plan(const Surface& surface, const Surface& wall, double tow_width_mm,
                  std::uint64_t seed, const PlanZones& zones, Plan& plan);

}  // namespace meshwind
