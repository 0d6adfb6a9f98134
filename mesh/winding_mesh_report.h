/// Report on the remeshing of a file's mesh before winding.
#pragma once

#include <cstddef>
#include <string>

namespace meshwind {

struct WindingMeshReport {
    bool own = false;                ///< the program's own mesh; false: the file's
    bool swept = false;              ///< in rings about the axis of a body of revolution
    double least_quality = 1.0;      ///< of the file's wall, see mesh/even/slivers.h
    int ruled_shapes = 0;            ///< cylinders and cones of long facets
    std::size_t triangles = 0;       ///< of the own mesh's wall
    std::size_t file_triangles = 0;  ///< of the file, repaired
    /// Largest distance of a vertex of the file's wall from the smooth surface of the own mesh.
    double deviation_mm = 0.0;
    int details = 0;           ///< number of details, such as lettering, that were removed
    double details_mm2 = 0.0;  ///< their area
    double details_mm = 0.0;   ///< largest height or depth of one from the wall
    double blend_mm = 0.0;     ///< radius of the ball that rolled over the wall; 0: none
    double blended_mm2 = 0.0;  ///< area of the wall that it did not touch, now filled up
    double filled_mm3 = 0.0;   ///< volume between the part and the winding surface
    std::string why_not;       ///< why the file's mesh stays although it is uneven; in words
};

}  // namespace meshwind
