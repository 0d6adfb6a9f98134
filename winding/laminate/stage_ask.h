/// What one stage of a wall is asked for, at places that all stages keep.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"

namespace meshwind {

/// Places spread evenly over a wall, with what is still to be laid there.
struct AskedPlaces {
    std::vector<SurfacePoint> at;      ///< the triangles keep their numbers while the wall grows
    std::vector<std::int32_t> layers;  ///< per place; below 0 where more lies there already
};

/// An even cover of one layer has one more on average; where more are laid they vary as the root
/// of their number. \return layers beyond those asked for
[[nodiscard]] inline double beyond_even_layers(std::int32_t asked) {
    return std::max(1.0, 0.5 * std::sqrt(asked));
}

struct StageAsk {
    AskedPlaces measured;  ///< on which courses are chosen and figures are taken
    AskedPlaces weighed;   ///< others, on which courses are made even (winding/cover/anneal.h)
    /// Per measured place: all that is still to be laid there, by this stage and those behind it;
    /// nothing where it is out of reach.
    std::vector<std::int32_t> left;
    /// This one included; thin places are filled by the last. 0 behind that, where some still lack.
    int stages_left = 1;
    /// Thin places are filled until no more than this share of those in reach lacks layers.
    double filled_to = 0.0;
    /// An even cover has so many layers more than it is asked for.
    double beyond_layers = 1.0;
    /// Layers that most of the places which ask for the thinnest wall still want of this stage:
    /// what a pattern may lay everywhere.
    double everywhere = 0.0;
};

/// A cover by itself is a wall of so many layers everywhere, wound in one stage.
/// \param most_bare share of the wall in reach that may have fewer
[[nodiscard]] StageAsk whole_cover(const Surface& surface, double tow_width_mm, std::uint64_t seed,
                                   std::int32_t layers, double most_bare);

}  // namespace meshwind
