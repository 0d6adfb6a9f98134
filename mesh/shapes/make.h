/// Makes meshes of parametric mandrels, for `meshwind make` and the accuracy studies.
#pragma once

#include <cstdint>

#include "mesh/shapes/shapes.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

struct MakeOptions {
    double edge_mm =
        5.0;  ///< > 0; edge length aimed at; edges are 0.5 to 1.5 of it, irregular 0.25 to 2
    bool irregular = false;  ///< jittered vertices and random diagonals; rims stay exact circles
    std::uint64_t seed = 1;  ///< of the irregular mesh; another seed, another mesh
    bool solid = false;      ///< with inner wall and end faces, watertight, as CAD gives it
    double wall_mm = 5.0;    ///< > 0; of the solid, measured inward
};

/// The shape's outer surface, counter-clockwise seen from outside, manifold, in the frame stated at
/// the shape. Every vertex lies on the ideal surface (mesh/shapes/analytic.h) to rounding; rims are
/// exact circles with evenly spaced vertices. The same arguments give the same mesh. Angles: at
/// least 30 degrees, irregular 15; tests/mesh/shapes/make_test.cpp. The tee's edges do not follow
/// the contact curves.
///
/// Solids: the inner wall lies wall_mm inside, for domes and ellipsoids as an ellipsoid with
/// semi-axes shorter by wall_mm, for isotensoid domes as those of the smaller radius; polar
/// openings go straight through. A closed shape becomes two closed walls. \throws InputError what
/// the shape's validate throws; make.not_positive, make.edge_too_large, make.wall_too_thick
[[nodiscard]] TriangleSoup make_cylinder(const CylinderShape& shape,
                                         const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_cone(const ConeShape& shape, const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_vessel(const VesselShape& shape, const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_isotensoid(const IsotensoidShape& shape,
                                           const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_elbow(const ElbowShape& shape, const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_tee(const TeeShape& shape, const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_wye(const WyeShape& shape, const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_cross(const CrossShape& shape, const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_combination(const CombinationShape& shape,
                                            const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_torus(const TorusShape& shape, const MakeOptions& options = {});
[[nodiscard]] TriangleSoup make_ellipsoid(const EllipsoidShape& shape,
                                          const MakeOptions& options = {});

}  // namespace meshwind
