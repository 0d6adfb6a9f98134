/// Traces geodesics and steered fibre paths over the triangles.
#pragma once

#include <limits>

#include <Eigen/Core>

#include "geodesic/on_surface.h"
#include "geodesic/surface_path.h"

namespace meshwind {

/// Why a trace ended. Every value is a normal outcome, none is an error. Folded: only on curved
/// patches, where the mesh is so coarse that a patch turns over; the path ends before it.
enum class TraceStop { Length, Rim, FaceLimit, Folded };

/// "length", "rim", "face-limit", "folded".
[[nodiscard]] const char* name_of(TraceStop stop);

/// The law of steering: kg = slip_ratio * kn. A fibre is pressed on only where kn > 0, so a plan
/// may ask for another ratio (usually 0, the geodesic) where the surface is concave along it.
struct Steering {
    double slip_ratio = 0.0;
    double slip_ratio_concave = 0.0;  ///< where kn < 0
};

/// How a path is carried over the triangles. Both give one station per edge crossing.
enum class TraceMethod {
    Walk,    ///< straight on each facet, the tangent carried in the smooth normal field: fast
    Patches  ///< the path's equation solved on the curved patches: accurate
};

struct TraceOptions {
    double max_length_mm = 1e5;  ///< > 0; the path is cut exactly here
    int max_faces = 1'000'000;   ///< > 0; reached gives TraceStop::FaceLimit: a trace always ends
    TraceMethod method = TraceMethod::Walk;
    /// > 0; longest step by Patches. By default steps go from edge to edge, or where the surface
    /// turns by 0.2 rad.
    double max_step_mm = std::numeric_limits<double>::infinity();
};

struct TraceResult {
    SurfacePath path;  ///< n >= 1 stations: the start, every edge crossing, the end
    TraceStop stop = TraceStop::Length;
    std::int32_t rim = -1;  ///< where TraceStop::Rim: the rim's id
};

/// Fibre path from `start` into `direction`, which is projected into the tangent plane.
/// \pre start.face is a face of `surface`; direction is not parallel to the normal there
///
/// TraceMethod::Walk: on each facet the path is straight; from crossing to crossing the tangent is
/// turned by the minimal rotation between the interpolated smooth normals and by kg ds about the
/// normal. Convex feature edges are crossed by unfolding, for which the smooth normals of both
/// sides are used. Positions lie on the facets. Second order in edge length.
/// Source: the walk of polthier_1998_straightest, with the facet's angle rule replaced.
///
/// TraceMethod::Patches: t' = kg b - kn n in the parameters of each curved patch
/// (mesh/smooth/patch.h); edges are crossed by unfolding about the edge's tangent. Where two
/// patches meet with slightly different normals, the turn of the normal there is part of kn and is
/// steered for. So the sum of all that is steered for is the turn of the normal along the whole
/// path. Positions lie on the patches. Order 4 in edge length on smooth surfaces. Accuracy of both:
/// tests/geodesic/trace_order_test.cpp.
[[nodiscard]] TraceResult trace(const Surface& surface, const SurfacePoint& start,
                                const Eigen::Vector3d& direction, const Steering& steering = {},
                                const TraceOptions& options = {});

}  // namespace meshwind
