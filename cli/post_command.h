/// `meshwind post`: a program for landing points that were made elsewhere.
#pragma once

#include <string>

#include "cli/wind.h"

namespace meshwind {

/// For `meshwind post --help`.
inline constexpr const char* kPostHelp =
    "A program for landing points made elsewhere.\n"
    "The table has columns x_mm,y_mm,z_mm (or x,y,z in the units of the mandrel's file), perhaps\n"
    "course, nx,ny,nz and tx,ty,tz; its rows are in winding order. The points are laid on the\n"
    "mandrel, courses that do not meet are joined over it, and from there on all is as for a\n"
    "planned mandrel: the same checks, the same output folder, exit code 1 and no program where\n"
    "a check fails.\n"
    "  meshwind post points.csv --mandrel tee.stl --machine six_axis.json\n"
    "  meshwind post meshwind-out/path.csv --frame mandrel --mandrel tee.stl --machine "
    "six_axis.json";

/// What the command line says.
struct PostOptions {
    std::string points, mandrel, machine, job;
    std::string frame = "file";  ///< "file" or "mandrel"
    std::string out = "meshwind-out";
    double within_mm = 1.0;  ///< > 0; a coarse mesh of the same part is nearer than that
};

/// The main job with the points in place of a planned layer. Names are looked up as find_input()
/// does, the points apart.
[[nodiscard]] WindRequest wind_request(const PostOptions& options);

}  // namespace meshwind
