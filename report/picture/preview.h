/// Writes a picture of a wound part, `--png FILE`.
#pragma once

#include <span>
#include <string>

#include "pipeline/wind_layer.h"

namespace meshwind {

/// Options of the command line.
struct PreviewOptions {
    std::string file;  ///< empty: no picture
    std::string size = "1600x1000";
    std::string colour = "course";  ///< as preview_colour() has them
};

/// Checks the options before a long run, so that writing does not fail after it. \throws InputError
/// cli.png_size; IoError output.unwritable where the folder is missing or `file` is one
void check_preview(const PreviewOptions& options);

/// Writes the picture; none where there is no file or no layer with a plan.
/// \throws as check_preview; IoError output.unwritable
void write_preview(const PreviewOptions& options, std::span<const WoundLayer> layers);

}  // namespace meshwind
