/// `meshwind post`: a program for landing points that were made elsewhere.
#pragma once

#include <string>

#include "cli/preview.h"
#include "cli/wind.h"

namespace meshwind {

/// What the command line says.
struct PostOptions {
    std::string points, mandrel, machine, job;
    std::string frame = "file";  ///< "file" or "mandrel"
    std::string out = "meshwind-out";
    double within_mm = 1.0;  ///< > 0; a coarse mesh of the same part is nearer than that
    PreviewOptions png;
};

/// The main job with the points in place of a planned layer. Names are looked up as find_input()
/// does, the points apart.
[[nodiscard]] WindRequest wind_request(const PostOptions& options);

}  // namespace meshwind
