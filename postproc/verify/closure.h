/// Closure of a wound pattern: the laid fibre's circuits against their planned places.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/units.h"
#include "geodesic/surface_path.h"
#include "mesh/tube/centre_line.h"

namespace meshwind {

/// A pattern with a larger closure error at its end does not count as closed. The fibre differs
/// from the plan by more from place to place, but by the same at the same places of each circuit.
inline constexpr double kClosureLimit_rad = rad_from_deg(0.01);

struct LaidClosure {
    /// Error of the last circuit's end against the start of the first, about the spindle; the turn
    /// between them, which no program has, is taken as planned.
    double closure_rad = 0.0;
    /// Resolution of that error: circuits whose blocks are at other places also lie elsewhere.
    double resolution_rad = 0.0;
    double drift_rad = 0.0;         ///< largest distance of a circuit from its place
    std::size_t drift_circuit = 0;  ///< the circuit with that distance, from 0
    std::size_t parallels = 0;      ///< number of parallels on which circuits were compared
    std::string failure;            ///< empty, or the reason why nothing can be compared

    /// Limit of `closure_rad`. `drift_rad` has none: fibre that follows the plan is off by more in
    /// places.
    [[nodiscard]] double limit_rad() const { return kClosureLimit_rad + resolution_rad; }
    [[nodiscard]] bool holds() const { return failure.empty() && closure_rad <= limit_rad(); }
};

/// Compares the azimuths at which the fibre crosses parallels with the circuits' places. The shift
/// between two circuits is the mean over parallels, up and down, and is known as well as these
/// agree (standard deviation): where the fibre lies beside its plan it does so alike wherever
/// blocks are alike. `closure` is the slope over all pairs, weighted by that, times the circuits;
/// `resolution` is that of the best single pair. The fibre's first pass, which the tie-on still
/// pulls, does not count. `drift` is of medians over the parallels.
/// \param laid mandrel frame, two passes a circuit; passes before them, which lead there, do not
/// count; with fewer nothing is compared
/// \param starts_rad n >= 2, per circuit: planned azimuth from the first
/// \param low_mm, high_mm z between which every pass lies once
[[nodiscard]] LaidClosure laid_closure(std::span<const PathPoint> laid,
                                       std::span<const double> starts_rad, double low_mm,
                                       double high_mm);

/// The same for a bent tube. Its circuits are not alike, nor are their blocks, so their error
/// against the plan differs from one to the next by more than the limit. The laid fibre is
/// therefore compared with the fibre of the same blocks without rounding, which has the same error
/// against the plan. Sections square to the tube's line stand for the parallels and angles about
/// the line for azimuths; the mean of each circuit's two passes counts, in which moves along the
/// tube cancel.
/// \param meant mandrel frame, of the blocks as planned \param circuits >= 2, of two passes each:
/// the last ones of both paths
/// \param sections_mm along the line; not all need be crossed
[[nodiscard]] LaidClosure laid_tube_closure(std::span<const PathPoint> laid,
                                            std::span<const PathPoint> meant, std::size_t circuits,
                                            const CentreLine& line,
                                            std::span<const double> sections_mm);

}  // namespace meshwind
