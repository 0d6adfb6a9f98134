/// Planner and details of a plan: the pattern of a body of revolution, the lines of an elbow.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "mesh/tube/centre_line.h"

namespace meshwind {

/// None: nothing was planned.
enum class Planner { None, Cover, Pattern, Elbow, Imported };

/// "cover", "pattern", ...; "" for None.
[[nodiscard]] const char* name_of(Planner planner);

/// Side of the first band on which its neighbour is laid, in the direction in which circuits
/// advance: ahead of it or behind it.
enum class BandOrder { Leading, Lagging };

/// A closed pattern.
struct Pattern {
    std::int64_t circuits = 0;  ///< N
    std::int64_t turns = 0;     ///< K: of the mandrel in N circuits; gcd(N, K) = 1
    /// n, the pattern number: circuits after which a band lies beside the first one. It is also the
    /// number of diamonds of crossing bands around the mandrel. At most N / 2 for N > 1.
    std::int64_t starts = 0;
    std::int64_t skip = 0;  ///< k: whole turns in n circuits, n K = k N +- 1; gcd(n, k) = 1
    BandOrder order = BandOrder::Leading;  ///< + or - there; Leading where both hold (N <= 2)
    double turn_rad = 0.0;                 ///< T = 2 pi K / N, dwell and change included
    double step_rad = 0.0;                 ///< 2 pi / N, from band to band
    double dwell_rad = 0.0;         ///< >= 0, per circuit; half of it at either end, or all at one
    double change_rad = 0.0;        ///< of the circuit itself, besides dwell
    double overlap = 0.0;           ///< N band / (2 pi layers) - 1; a gap when below 0
    std::int64_t least_layers = 0;  ///< where bands are fewest, per direction
    std::int64_t most_layers = 0;   ///< where they are most
    double ripple = 0.0;            ///< coefficient of variation of the layers around the circle
};

/// A lattice as it is laid; lengths across the bands, at the widest place.
struct LaidLattice {
    std::int64_t series = 1;      ///< bands side by side in a rib
    std::int64_t plies = 1;       ///< times that all of it is wound
    double offset_rad = 0.0;      ///< about the spindle, between the bands of a rib
    double offset_mm = 0.0;       ///< the same
    double rib_mm = 0.0;          ///< width of a rib
    double rib_spacing_mm = 0.0;  ///< from rib to rib of one hand
    bool filled = false;          ///< the ribs close the wall
};

/// How the passes of a circuit's two directions cross on the wall.
struct Interlacing {
    std::int64_t crossing_rows = 0;  ///< parallels along which bands cross, N times each
    std::int64_t crossings = 0;
    /// Fields around the mandrel in which one direction is on top, the most of any row: n or, for
    /// few rows, less.
    std::int64_t diamonds_around = 0;
};

/// A pattern as it is laid.
struct LaidPattern {
    Pattern pattern;
    double angle_rad = 0.0;       ///< winding angle at the widest place
    double slip_ratio = 0.0;      ///< with which the courses are steered
    double closure_rad = 0.0;     ///< how far off its start the fibre ends, about the spindle
    double band_offset_mm = 0.0;  ///< between neighbouring bands, at the widest place
    Interlacing interlacing{};
    /// Per circuit, in winding order: where it begins, from the first one, 0 .. 2 pi. N of them, of
    /// lattices N for each series and ply.
    std::vector<double> starts_rad{};
    std::optional<LaidLattice> lattice{};
};

/// The lines on a leg of an elbow, see winding/elbow/elbow_lines.h.
struct LaidElbowLeg {
    double length_mm = 0.0;
    double run_mm = 0.0;     ///< over which they are steered, from the bend on
    double angle_rad = 0.0;  ///< to the leg's axis beyond that
    double even = 0.0;       ///< 1: one angle and even distances there
    double slip_ratio = 0.0;
    double widest_mm = 0.0;  ///< largest distance of neighbours
    double closed_mm = 0.0;  ///< from the bend on, without gaps
};

/// The lines of an elbow as they are laid.
struct LaidElbow {
    int lines = 0;           ///< of either hand
    int needed_by_bend = 0;  ///< dimovski_2018_elbows, eq. (18); more are for the legs
    double angle_rad = 0.0;  ///< to the tube's axis at the outer equator
    double inner_angle_rad = 0.0;
    double theta_cycle_rad = 0.0;
    double thinnest_layers = 0.0;       ///< on the bend, of both hands: at the outer equator
    double thickest_layers = 0.0;       ///< at the inner one
    std::array<LaidElbowLeg, 2> leg{};  ///< at the tube's first and second rim
    std::optional<CentreLine> line{};   ///< of the tube, from the first rim to the second
};

/// Empty where a planner adds nothing to the courses, or failed.
using PlanDetails = std::variant<std::monostate, LaidPattern, LaidElbow>;

}  // namespace meshwind
