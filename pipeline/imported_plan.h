/// Makes a plan from imported landing points.
#pragma once

#include <optional>
#include <string>

#include "pipeline/setup.h"
#include "winding/plan/plan.h"

namespace meshwind {

struct ImportRequest {
    LandingText points;
    bool mandrel_frame = false;  ///< else the axes of the mandrel's file
    double farthest_mm = 1.0;    ///< > 0; points further off the mandrel are refused
    int circuits = 1;            ///< number of times the table is wound, >= 1
    double turn_rad = 0.0;       ///< about the spindle from one to the next
    double smooth_mm =
        0.0;  ///< allowed distance of the smoothed fibre from the points; 0: no smoothing
};

/// How the points fit the mandrel, for the report.
struct ImportFit {
    std::string file;  ///< name without folder
    bool mandrel_frame = false;
    std::size_t points = 0;
    std::size_t repeated = 0;  ///< left out: at the place of the row before
    std::size_t joins = 0;     ///< paths that were added between courses
    double worst_mm = 0.0;     ///< largest distance of a point from the mandrel
    double mean_mm = 0.0;
    int worst_line = 0;  ///< of the file
    double limit_mm = 0.0;
    int circuits = 1;
    double smoothed_mm = 0.0;  ///< largest distance of a point on the wall from the fibre
};

/// The courses of the table as one fibre on the mandrel with its extensions. Where a course does
/// not start where the one before ends, a path over the wall joins them (geodesic/biarc.h) that
/// holds by friction and does not bridge. The slip is measured. Coverage is that of the courses;
/// the reachable share is not known.
/// \throws InputError import.*; IoError io.cannot_read
[[nodiscard]] Plan import_plan(const Setup& setup, const ImportRequest& request, std::uint64_t seed,
                               ImportFit& fit);

}  // namespace meshwind
