/// Writes pictures as PNG files.
#pragma once

#include <string>

#include "report/picture/preview_render.h"

namespace meshwind {

/// The bytes of a PNG file, eight bits a channel with alpha. \throws NumericalError preview.packing
[[nodiscard]] std::string png_bytes(const PreviewImage& image);

}  // namespace meshwind
