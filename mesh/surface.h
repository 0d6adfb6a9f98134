/// The winding surface as flat arrays for path tracing: frozen, in the mandrel frame.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mesh/height_jet.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// How the smooth normals and shape operators were obtained.
struct FitReport {
    int quartic = 0;    ///< corners whose neighbours carried a height fit of degree four
    int cubic = 0;      ///< fell back: too few or badly placed neighbours for degree four
    int quadratic = 0;  ///< fell back again, to degree two
    int reduced = 0;    ///< ruled where nothing is known: long facets between two end circles
    int averaged = 0;   ///< last: angle-weighted facet normal, curvature from facets
    int exact = 0;      ///< not fitted: a CAD file's faces
};

/// A cylinder that faces are known to lie on, as those of CAD files do.
struct KnownCylinder {
    Eigen::Vector3d point_mm;   ///< of its axis
    Eigen::Vector3d direction;  ///< unit
    double radius_mm = 0.0;
};

/// Data of a face that a walk reads, packed into one cache line.
struct alignas(32) WalkFace {
    /// 4 * face across edge e + that face's number of the edge; negative at a rim
    std::array<std::int32_t, 3> across;
    std::array<std::int32_t, 3> corner;   ///< as Surface::corner
    std::array<std::uint8_t, 3> feature;  ///< as Surface::feature
};

/// Data of a corner index that a walk reads, packed into two cache lines.
struct alignas(32) WalkCorner {
    Eigen::Vector3d position_mm;
    Eigen::Vector3d normal;
    Eigen::Matrix<double, 6, 1> shape_operator_per_mm;  ///< xx, yy, zz, xy, xz, yz
};

/// Positions, adjacency, smooth normals and curvature. Edge e of a face runs from its corner e to
/// its corner (e + 1) % 3. Vertices on a feature edge have one normal
/// per smooth side, so normals and shape operators belong to `corner` indices, not to vertices.
struct Surface {
    std::vector<Eigen::Vector3d> position_mm;       ///< per vertex
    std::vector<std::array<std::int32_t, 3>> face;  ///< vertex indices, outside = counter-clockwise
    std::vector<std::array<std::int32_t, 3>> neighbour;  ///< face across edge e, kNoFace at a rim
    std::vector<std::array<std::uint8_t, 3>> feature;    ///< 1 where edge e is a feature edge
    std::vector<std::array<std::int32_t, 3>> corner;     ///< index of the smooth normal of corner e
    std::vector<std::int32_t> region;                    ///< per face: region id of the mandrel
    std::vector<std::array<std::int32_t, 3>> rim;  ///< rim id of edge e where it is a rim, else -1
    std::vector<Eigen::Vector3d> normal;           ///< per corner index, unit, outward
    /// Per corner index: dn, symmetric, with `normal` in its kernel; t . S t = kn in 1/mm, > 0
    /// convex.
    std::vector<Eigen::Matrix3d> shape_operator_per_mm;
    std::vector<HeightJet> jet;       ///< per corner index: the fitted surface about the corner
    std::vector<std::uint8_t> exact;  ///< per corner index: 1 where it is not fitted but known
    std::vector<KnownCylinder> cylinder;
    std::vector<std::int32_t> cylinder_of;  ///< per face: index in `cylinder`, -1: none; or empty
    std::vector<WalkFace> walk_face;        ///< per face: a packed copy for the walk
    std::vector<WalkCorner> walk_corner;    ///< per corner index: a packed copy for the walk
    double mean_edge_mm = 0.0;
    FitReport fit;
};

}  // namespace meshwind
