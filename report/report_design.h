/// Table, JSON and job of `meshwind design vessel`.
#pragma once

#include <ostream>
#include <string>

#include "winding/vessel/vessel_table.h"

namespace meshwind {

[[nodiscard]] std::string design_json(const DesignOutcome& outcome);

void print_design(std::ostream& out, const DesignOutcome& outcome);

/// The angle whose geodesics take the least fibre. \throws InputError vessel.no_geodesic where none
/// of the angles has any
[[nodiscard]] const VesselAngle& least_fibre(const DesignOutcome& outcome);

/// A job that winds the design at one of its angles: tow, helical layers, hoops over them.
[[nodiscard]] std::string design_job(const VesselDesign& design, const VesselAngle& angle);

}  // namespace meshwind
