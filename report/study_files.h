/// Writes the files of a mesh-size study.
#pragma once

#include <string>

#include "study/study_run.h"

namespace meshwind {

/// `mandrel,method,lambda,quantity,unit,tangent_rule,edge_mm,mean_edge_mm,triangles,rms,worst,order`
[[nodiscard]] std::string study_csv(const MeshSizeStudy& study);

/// `mandrel,method,lambda,edge_mm,triangles,ns_per_crossing,ms_per_metre`
[[nodiscard]] std::string timing_csv(const MeshSizeStudy& study);

/// Errors over edge lengths on logarithmic axes: a row for each mandrel, a column for each
/// quantity.
[[nodiscard]] std::string study_svg(const StudyOutcome& outcome);

}  // namespace meshwind
