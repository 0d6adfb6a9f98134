/// What one stage of a wall is asked for, at places that all stages keep.
#pragma once

#include <cstdint>
#include <vector>

#include "geodesic/surface_path.h"

namespace meshwind {

/// Places spread evenly over a wall, with what is still to be laid there.
struct AskedPlaces {
    std::vector<SurfacePoint> at;      ///< the triangles keep their numbers while the wall grows
    std::vector<std::int32_t> layers;  ///< per place; below 0 where more lies there already
};

struct StageAsk {
    AskedPlaces measured;  ///< on which courses are chosen and figures are taken
    AskedPlaces weighed;   ///< others, on which courses are made even (winding/cover/anneal.h)
    /// Per measured place: all that is still to be laid there, by this stage and those behind it;
    /// nothing where it is out of reach.
    std::vector<std::int32_t> left;
    /// This one included; thin places are filled by the last. 0 behind that, where some still lack.
    int stages_left = 1;
    /// An even cover has so many layers more than it is asked for.
    double beyond_layers = 1.0;
    /// Layers that most of the places which ask for the thinnest wall still want of this stage:
    /// what a pattern may lay everywhere.
    double everywhere = 0.0;
};

}  // namespace meshwind
