/// What was made of a file's mesh before it is wound.
#pragma once

#include <cstddef>
#include <string>

namespace meshwind {

struct WindingMeshReport {
    bool own = false;                ///< the program's own mesh; false: the file's
    double least_quality = 1.0;      ///< of the file's wall, see mesh/even/slivers.h
    int ruled_shapes = 0;            ///< cylinders and cones of long facets
    std::size_t triangles = 0;       ///< of the own mesh's wall
    std::size_t file_triangles = 0;  ///< of the file, repaired
    /// Largest distance of a vertex of the file's wall from the smooth surface of the own mesh.
    double deviation_mm = 0.0;
    std::string why_not;  ///< why the file's mesh stays although it is uneven; in words
};

}  // namespace meshwind
