/// Builds the scene of a picture from wound layers: mandrel, extensions and bands as coloured
/// triangles.
#pragma once

#include <span>
#include <string_view>

#include "pipeline/wind_layer.h"
#include "report/picture/preview_render.h"

namespace meshwind {

/// Quantity shown by the colours.
enum class PreviewColour {
    Course,  ///< seven colours in turn; turns are paler than the course before them
    Layers,  ///< of the wall, 0 to the most; no bands are drawn
    Slip,    ///< of the fibre, 0 to the friction
    Angle,   ///< between fibre and spindle, 0 to 90 degrees
};

/// "course", "layers", "slip", "angle". \pre one of them
[[nodiscard]] PreviewColour preview_colour(std::string_view name);

/// Bands are as wide as the tow and follow the wall across; where the fibre is off the wall they
/// are flat. Extensions are drawn as far as fibre lies on them. The view is from beside the longest
/// principal axis of the wall, which lies in the picture, with the heavier tail of the second one
/// up. \param layers >= 1, the first with its setup; those without a plan are left out
[[nodiscard]] PreviewScene preview_scene(std::span<const WoundLayer> layers, PreviewColour colour);

}  // namespace meshwind
