/// Repeats the circuits of a table of landing points, and joins its courses.
#pragma once

#include <Eigen/Geometry>

#include "postproc/tables/landing_csv.h"

namespace meshwind {

/// The table's courses `times` over, each time turned on about the spindle. Courses of the second
/// circuit on are called "3 of circuit 2".
/// \param turn_rad about +Z of the mandrel frame from one circuit to the next
/// \param mandrel_from_table of the table in its units to the mandrel frame in mm \pre times >= 1
[[nodiscard]] LandingTable repeated(LandingTable table, int times, double turn_rad,
                                    const Eigen::Affine3d& mandrel_from_table);

/// Joins courses that begin where the one before ends, under its name, so that smoothing is smooth
/// over their joints too. \param meets_mm courses further apart stay two
[[nodiscard]] LandingTable joined(LandingTable table, double meets_mm,
                                  const Eigen::Affine3d& mandrel_from_table);

}  // namespace meshwind
