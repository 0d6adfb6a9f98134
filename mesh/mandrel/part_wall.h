/// Steps of loading a mandrel's wall: detection, remeshing, filling up.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/even/labelled_mesh.h"
#include "mesh/mandrel.h"
#include "mesh/segment/rims.h"
#include "mesh/segment/segment.h"
#include "mesh/segment/spindle_axis.h"

namespace meshwind {

/// The winding surface with its ends and its spindle, still in the file's frame.
struct Wall {
    LabelledMesh kept;
    Rims rims;
    SpindleFrame frame;
};

[[nodiscard]] LabelledView view(const TriangleSoup& whole, const Segmentation& segmentation);

/// Per region whether it is wall.
[[nodiscard]] std::vector<char> kept_of(const std::vector<Region>& regions);

/// Updates area and triangles of changed regions. Pieces cut off an end are end caps.
/// \param count of regions
void count_regions(const TriangleSoup& whole, std::size_t count, Segmentation& segmentation);

void move(TriangleSoup& soup, const Eigen::Isometry3d& motion);
void move(std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& motion);
void move(std::vector<Rim>& rims, const Eigen::Isometry3d& motion);

/// \param axis_mm spindle axis, where it is given
[[nodiscard]] Wall find_wall(const TriangleSoup& whole, const Segmentation& segmentation,
                             const std::optional<MandrelOptions::Axis>& axis_mm);

/// Replaces the mandrel's whole by the part.
void take(LabelledMesh&& part, Mandrel& mandrel, Segmentation& segmentation);

/// Remeshes the wall of a body of revolution in rings where the file's triangles are uneven. The
/// spindle stays. \return whether it is one, and its rings are not too many
[[nodiscard]] bool make_rings(Mandrel& mandrel, Segmentation& segmentation, Wall& wall);

/// Remeshes the wall with triangles of our own where the file's are uneven.
void make_even(Mandrel& mandrel, Segmentation& segmentation, Wall& wall,
               const std::optional<MandrelOptions::Axis>& axis_mm,
               const std::optional<double>& details_mm);

/// Fills up the places that a ball of the radius cannot touch: the winding surface then differs
/// from the file's. A body of revolution stays one (rolled_meridian.h). The spindle stays.
/// \throws InputError mesh.no_blend
void blend(Mandrel& mandrel, Segmentation& segmentation, Wall& wall, double radius_mm,
           const std::string& name);

}  // namespace meshwind
