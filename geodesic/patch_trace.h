/// The tracer on curved patches; callers use trace() of geodesic/trace.h.
#pragma once

#include <Eigen/Core>

#include "geodesic/trace.h"

namespace meshwind {

/// trace() by TraceMethod::Patches.
[[nodiscard]] TraceResult trace_on_patches(const Surface& surface, const SurfacePoint& start,
                                           const Eigen::Vector3d& direction,
                                           const Steering& steering, const TraceOptions& options);

}  // namespace meshwind
