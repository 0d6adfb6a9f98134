/// `--png FILE`: a picture of what was wound.
#pragma once

#include <span>
#include <string>

#include "pipeline/wind_layer.h"

namespace meshwind {

/// What the command line says.
struct PreviewOptions {
    std::string file;  ///< empty: no picture
    std::string size = "1600x1000";
    std::string colour = "course";  ///< as preview_colour() has them
};

/// Refuses before a long run what would fail after it. \throws InputError cli.png_size; IoError
/// output.unwritable where the folder is missing or `file` is one
void check_preview(const PreviewOptions& options);

/// Writes the picture, or nothing where there is no file or no layer with a plan.
/// \throws as check_preview; IoError output.unwritable
void write_preview(const PreviewOptions& options, std::span<const WoundLayer> layers);

}  // namespace meshwind
