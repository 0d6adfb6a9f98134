/// Layers asked of one stage of a wall, at places that all stages keep.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"

namespace meshwind {

/// Places spread evenly over a wall, with the layers still to be laid there.
struct AskedPlaces {
    std::vector<SurfacePoint> at;      ///< the triangles keep their numbers while the wall grows
    std::vector<std::int32_t> layers;  ///< per place; below 0 where more lies there already
};

/// Layers that an even cover has on average beyond those asked for: one more for one layer; where
/// more are laid they vary as the root of their number. \return layers beyond those asked for
[[nodiscard]] inline double beyond_even_layers(std::int32_t asked) {
    return std::max(1.0, 0.5 * std::sqrt(asked));
}

struct StageAsk {
    AskedPlaces measured;  ///< on which courses are chosen and figures are taken
    AskedPlaces weighed;   ///< others, on which courses are made even (winding/cover/anneal.h)
    /// Per measured place: layers still to be laid there, by this stage and those after it; 0 where
    /// it is out of reach.
    std::vector<std::int32_t> left;
    /// This one included; thin places are filled by the last. 0 behind that, where some still lack.
    int stages_left = 1;
    /// Thin places are filled until no more than this share of those in reach lacks layers.
    double filled_to = 0.0;
    /// Layers that an even cover has beyond those asked for.
    double beyond_layers = 1.0;
    /// Layers that a pattern may lay everywhere: those that most of the places which ask for the
    /// thinnest wall still want of this stage.
    double everywhere = 0.0;
};

/// The ask of a single cover: a wall of `layers` everywhere, wound in one stage.
/// \param most_bare share of the wall in reach that may have fewer
[[nodiscard]] StageAsk whole_cover(const Surface& surface, double tow_width_mm, std::uint64_t seed,
                                   std::int32_t layers, double most_bare);

}  // namespace meshwind
