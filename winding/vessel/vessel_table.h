/// Table of a vessel's figures by winding angle, without a mesh.
#pragma once

#include <optional>
#include <vector>

#include "winding/vessel/vessel_design.h"

namespace meshwind {

struct DesignRequest {
    VesselDesign design;             ///< but for angles and k_e
    std::vector<double> angles_deg;  ///< on the cylinder, from the axis
    std::optional<double> ke;        ///< neither this nor a ply: the design's default
    std::optional<PlyStiffness> ply;
};

struct DesignOutcome {
    VesselDesign design;
    IsotensoidDome dome;
    std::vector<VesselAngle> rows;

    /// The dome's parameter at its opening.
    [[nodiscard]] double opening_parameter() const {
        return dome.parameter_at(design.opening_radius_mm);
    }
};

/// \throws InputError vessel.*, make.*
[[nodiscard]] DesignOutcome run_design(const DesignRequest& request);

}  // namespace meshwind
