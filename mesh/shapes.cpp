#include "mesh/shapes.h"

#include "mesh/make_checks.h"

namespace meshwind {

void TeeShape::validate() const {
    require_positive("run-radius", run_radius_mm);
    require_positive("branch-radius", branch_radius_mm);
    require_positive("blend-radius", blend_radius_mm);
    require_positive("run-length", run_length_mm);
    require_positive("branch-length", branch_length_mm);
    require(branch_radius_mm <= run_radius_mm, "make.branch_too_wide", "branch-radius",
            branch_radius_mm, "at most the run radius", run_radius_mm);
    require(blend_radius_mm < 0.5 * run_length_mm - branch_radius_mm, "make.blend_too_large",
            "blend-radius", blend_radius_mm,
            "less than half the run length less the branch radius:",
            0.5 * run_length_mm - branch_radius_mm);
    require(blend_radius_mm < branch_length_mm - run_radius_mm, "make.blend_too_large",
            "blend-radius", blend_radius_mm,
            "less than the branch length less the run radius:", branch_length_mm - run_radius_mm);
}

}  // namespace meshwind
