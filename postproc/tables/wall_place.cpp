#include "postproc/tables/wall_place.h"

namespace meshwind {

FieldWalker wall_place(const Surface& wall, const RayQuery& facets,
                       const Eigen::Vector3d& point_mm) {
    double reach_mm = 1.0;
    ClosestPoint closest = facets.closest(point_mm, reach_mm);
    while (closest.part < 0) {
        reach_mm *= 10.0;
        closest = facets.closest(point_mm, reach_mm);
    }
    const SurfacePoint on_facet{closest.face, closest.bary};
    FieldWalker walker(wall, on_facet);
    if (!walker.move_under(point_mm)) {
        walker.move_to(on_facet);
    }
    return walker;
}

}  // namespace meshwind
