/// Zones of regular winding on a body of revolution, and the layers there.
#pragma once

#include <array>

#include "mesh/revolution/revolution.h"
#include "winding/laminate/measure_plan.h"
#include "winding/revolution/meridian_path.h"

namespace meshwind {

/// Sets `regular` and `meant` of the zones. The cylinders and the cones that lean by less than 45
/// deg are regular, but for two tow widths at either end of each and at the turns. The bands that
/// cross a parallel of radius r at the angle a take 1 / (2 pi r cos(a)) of it each, so the layers
/// go as 1 / (r cos(a)) of the pass: that is `meant`, in 1/mm. Hoops have the same everywhere.
/// \param pass without stations: hoops \param wound_mm arc lengths between which there is fibre
void regular_parts(const BodyOfRevolution& body, const MeridianPass& pass,
                   const std::array<double, 2>& wound_mm, double tow_width_mm, PlanZones& zones);

/// Share of the body's wall between two arc lengths, to 1e-3: more than a pattern that turns back
/// there covers. \param wound_mm in order; beyond the ends there is no wall
[[nodiscard]] double share_between(const Meridian& meridian, const std::array<double, 2>& wound_mm);

}  // namespace meshwind
