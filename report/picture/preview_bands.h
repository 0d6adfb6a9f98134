/// Bands of a picture: the wound fibre as coloured triangles.
/// Included by .cpp files of this folder only.
#pragma once

#include <span>

#include "pipeline/wind_layer.h"
#include "report/picture/preview_render.h"
#include "report/picture/preview_scene.h"

namespace meshwind {

/// Bands in winding order, as wide as the first layer's tow. \pre colour is not Layers
[[nodiscard]] PreviewMesh preview_bands(std::span<const WoundLayer> layers, PreviewColour colour);

}  // namespace meshwind
