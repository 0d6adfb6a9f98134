#include "winding/vessel/vessel_table.h"

#include "core/units.h"

namespace meshwind {

DesignOutcome run_design(const DesignRequest& request) {
    VesselDesign design = request.design;
    if (request.ke) {
        design.stiffness_ratio = *request.ke;
    } else if (request.ply) {
        design.stiffness_ratio = stiffness_ratio(*request.ply);
    }
    for (const double angle_deg : request.angles_deg) {
        design.angles_rad.push_back(rad_from_deg(angle_deg));
    }
    std::vector<VesselAngle> rows = vessel_angles(design);
    return {design, IsotensoidDome(design.dome()), std::move(rows)};
}

}  // namespace meshwind
