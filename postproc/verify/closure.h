/// Whether a wound pattern closes: the laid fibre's circuits against the places they are to have.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/units.h"
#include "geodesic/surface_path.h"
#include "mesh/tube/centre_line.h"

namespace meshwind {

/// A pattern that is off by more than this when it ends does not count as closed. Following the
/// plan differs by more from place to place; but at the same places of each circuit alike.
inline constexpr double kClosureLimit_rad = rad_from_deg(0.01);

struct LaidClosure {
    /// Of the last circuit's end from the start of the first, about the spindle; the turn that
    /// would lead there, which no program has, counted as planned.
    double closure_rad = 0.0;
    /// How well that is known: circuits whose blocks are at other places lie otherwise, too.
    double resolution_rad = 0.0;
    double drift_rad = 0.0;         ///< largest distance of a circuit from its place
    std::size_t drift_circuit = 0;  ///< that one, from 0
    std::size_t parallels = 0;      ///< on which circuits were compared
    std::string failure;            ///< empty, or why nothing can be compared

    /// Of `closure_rad`. `drift_rad` has none: what follows the plan is off by more in places.
    [[nodiscard]] double limit_rad() const { return kClosureLimit_rad + resolution_rad; }
    [[nodiscard]] bool holds() const { return failure.empty() && closure_rad <= limit_rad(); }
};

/// The azimuths at which the fibre crosses parallels, held against the circuits' places. By how
/// much two circuits have moved apart is the mean over parallels, up and down, and known as well as
/// these agree (standard deviation): where the fibre lies beside its plan it does so alike wherever
/// blocks are alike. `closure` is the slope over all pairs, weighed by that, times the circuits;
/// `resolution` is what the best single pair gives. The fibre's first pass, which the tie-on still
/// pulls, does not count. `drift` is of medians over the parallels.
/// \param laid mandrel frame, two passes a circuit; passes before them, which lead there, do not
/// count; of fewer nothing is compared
/// \param starts_rad n >= 2, per circuit: planned azimuth from the first
/// \param low_mm, high_mm z between which every pass lies once
[[nodiscard]] LaidClosure laid_closure(std::span<const PathPoint> laid,
                                       std::span<const double> starts_rad, double low_mm,
                                       double high_mm);

/// The same of a tube that bends. Its circuits are not alike, nor are their blocks, so following
/// differs from one to the next by more than the limit; what is laid is held against what the same
/// blocks would lay with positions that are not rounded, to which following is common. Sections
/// square to the tube's line stand for the parallels and angles about the line for azimuths; of
/// each circuit's two passes the mean counts, in which moves along the tube cancel.
/// \param meant mandrel frame, of the blocks as planned \param circuits >= 2, of two passes each:
/// the last ones of both paths
/// \param sections_mm along the line; not all need be crossed
[[nodiscard]] LaidClosure laid_tube_closure(std::span<const PathPoint> laid,
                                            std::span<const PathPoint> meant, std::size_t circuits,
                                            const CentreLine& line,
                                            std::span<const double> sections_mm);

}  // namespace meshwind
