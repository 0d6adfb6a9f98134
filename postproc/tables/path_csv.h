/// Writes the table path.csv: every landing point of the plan.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "postproc/eye/eye_path.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Columns
/// `course,kind,point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,bridge_mm,
/// free_length_mm`, and `held` where fibre turns on pins; one row per station in winding order,
/// mandrel frame: where the path lies on the surface, s from the start of the program.
/// \pre path has one eye point per station of the pieces
[[nodiscard]] std::string path_csv(std::span<const Piece> pieces, const EyePath& path);

/// The same in pieces of some MB. \throws Interrupted; what `write` throws
void write_path_csv(std::span<const Piece> pieces, const EyePath& path,
                    const std::function<void(std::string_view)>& write);

}  // namespace meshwind
