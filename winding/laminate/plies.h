/// The plies on each triangle of the wall: the bands over it, from the bottom to the top.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mesh/surface.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// One pass of a course's band over a triangle.
struct Ply {
    std::int32_t piece = -1;  ///< the course: index into the plan's pieces
    double share = 0.0;       ///< of the triangle that is under the band, 0 .. 1
    Eigen::Vector3d along;    ///< mean direction of the fibre, unit, in the triangle's plane
};

/// The plies of a surface's triangles. Those of a triangle are in winding order.
struct Plies {
    std::vector<std::size_t> begin;  ///< per triangle: first of its plies; one more at the end
    std::vector<Ply> ply;
    std::vector<std::int32_t> samples;  ///< per triangle: coverage samples on it
    std::vector<double> covered;        ///< per triangle: share of it under any band

    [[nodiscard]] std::span<const Ply> of(std::size_t face) const {
        return {ply.data() + begin[face], begin[face + 1] - begin[face]};
    }
};

struct PliesOptions {
    double tow_width_mm = 0.0;  ///< > 0
    std::uint64_t seed = 1;     ///< of the plan
    /// Bands reach over the rims as far as the turns lead them, as measure_plan() has it. The cover
    /// planner counts the courses alone.
    bool over_rims = true;
};

/// Measures plies as coverage is measured: by the samples of measure_plan() and the footprints on
/// them, so that the shares of a triangle's plies add up to Plan::face_layers, and the covered
/// shares of all samples to Coverage::fraction. A triangle without a sample has the plies of the
/// triangles that speak for it (sampled_faces()). A course that comes back over a triangle more
/// than two bands later lays another ply. The cover planner counts on stations that lie closer than
/// those of the plan; its sums differ by the samples at the bands' edges (docs/files.md,
/// "layup.json").
/// \param wall surface of the stations' faces: `surface`, or `surface` with more faces after its
/// own
[[nodiscard]] Plies plies_of(const Surface& surface, const Surface& wall,
                             std::span<const Piece> pieces, const PliesOptions& options);

}  // namespace meshwind
