#include "geodesic/surface_path.h"

namespace meshwind {

SurfacePath reversed(const SurfacePath& path) {
    SurfacePath back(path.rbegin(), path.rend());
    const double length = path.empty() ? 0.0 : path.back().s_mm;
    for (PathPoint& point : back) {
        point.tangent = -point.tangent;
        point.kg_per_mm = -point.kg_per_mm;
        point.s_mm = length - point.s_mm;
    }
    return back;
}

StringPoint string_point(const PathPoint& point, double gap_mm, double slope) {
    return {point.position_mm + gap_mm * point.normal,
            (point.tangent + slope * point.normal).normalized()};
}

}  // namespace meshwind
