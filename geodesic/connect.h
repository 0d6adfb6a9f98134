/// The geodesic or steered path between two surface points, found by shooting.
#pragma once

#include "geodesic/shortest_path.h"
#include "geodesic/trace.h"
#include "mesh/surface.h"

namespace meshwind {

/// Why a search for a connecting path ended. Every value is a normal outcome, none is an error.
enum class ConnectStop {
    Reached,     ///< the path ends at the target within the tolerance
    SamePoint,   ///< start and target are one point: there is nothing to connect
    Detour,      ///< reached by a geodesic that is not near the shortest way: there are several
    Conjugate,   ///< neighbouring paths meet at the target: the start angle is not determined
    Gap,         ///< traces pass on both sides of the target, none nearer than the miss
    Rim,         ///< the path ends at a rim before the target
    TraceLimit,  ///< the path needs more length or faces than the trace options grant
    Stalled,     ///< no step leads nearer, or max_iterations were not enough
    Unreachable  ///< the target lies on another piece of the surface
};

/// "reached", "same-point", "detour", "conjugate", "gap", "rim", "trace-limit",
/// "stalled", "unreachable".
[[nodiscard]] const char* name_of(ConnectStop stop);

struct ConnectOptions {
    TraceOptions trace{};        ///< of every shot; its max_length_mm bounds the path
    double tolerance_mm = 1e-6;  ///< > 0, of the miss: far below the accuracy of a trace
    int max_iterations = 100;    ///< > 0; bisection to the tolerance alone takes about 40
};

/// Start values of the shooting.
struct ConnectGuess {
    Eigen::Vector3d direction;  ///< any length, projected into the tangent plane
    double length_mm = 0.0;     ///< > 0; the target is looked for near this arc length
};

struct ConnectResult {
    ConnectStop stop = ConnectStop::Unreachable;
    SurfacePath path;            ///< the nearest found, ending beside the target; may be empty
    double length_mm = 0.0;      ///< of `path`
    double miss_mm = 0.0;        ///< from the path's end to the target, in the tangent plane
    double across_mm = 0.0;      ///< its part across the path, > 0: the target is to the left
    double along_mm = 0.0;       ///< its part along the path, > 0: the target is beyond the end
    double jacobi_mm = 0.0;      ///< at the path's end, see jacobi_field.h
    int conjugate_points = 0;    ///< between start and end: with any, the path is not the shortest
    int iterations = 0;          ///< shots that were tried
    double polyhedral_mm = 0.0;  ///< length of the shortest way over the facets; 0 with a guess
    std::int32_t rim = -1;       ///< where ConnectStop::Rim: the rim's id
};

/// Path from `from` to `to` with kg = slip_ratio * kn everywhere, concave places too; a geodesic
/// for 0. The start angle is found by Newton's method with the Jacobi field as slope, kept within a
/// bracket once the target was passed on both sides. Where several paths exist, the answer is the
/// one that the search meets from `guess`; other guesses find others.
/// \pre both points are on faces of `surface`; guess.direction is not along the normal
/// Accuracy: that of `trace`; the miss is in the tangent plane at the target, where the height of
/// a facet or patch over the smooth surface does not count (tests/geodesic/connect_test.cpp).
[[nodiscard]] ConnectResult connect(const Surface& surface, const SurfacePoint& from,
                                    const SurfacePoint& to, const ConnectGuess& guess,
                                    double slip_ratio = 0.0, const ConnectOptions& options = {});

/// The same with the shortest way over the facets as guess. Where that fails at once (the end
/// depends strongly on the start angle, as after a long run along a saddle), the target is
/// approached by stages: paths to points ever farther along the way, each the guess for the next.
/// The iterations are those of all stages.
[[nodiscard]] ConnectResult connect(const Surface& surface, const SurfacePoint& from,
                                    const SurfacePoint& to, const PolyhedralPath& way,
                                    double slip_ratio = 0.0, const ConnectOptions& options = {});

/// The same, and finds the shortest way first, which takes far longer than the shooting
/// (bench/connect_bench.cpp).
[[nodiscard]] ConnectResult connect(const Surface& surface, const SurfacePoint& from,
                                    const SurfacePoint& to, double slip_ratio = 0.0,
                                    const ConnectOptions& options = {});

}  // namespace meshwind
