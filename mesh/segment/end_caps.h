/// Detects the end caps of a part: flat ends that close its openings and are not wound.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "mesh/segment/segment.h"

namespace meshwind {

/// Measures of a region that decide its kind.
struct RegionFacts {
    double area_mm2 = 0.0;
    Eigen::Vector3d area_normal = Eigen::Vector3d::Zero();
    Eigen::AlignedBox3d box;
    double boundary_mm = 0.0;
    double convex_mm = 0.0;
    bool open = false;         ///< has open edges
    double planar_mm2 = 0.0;   ///< area that lies in the region's plane
    double outline_mm2 = 0.0;  ///< area within its outline, holes included
    std::vector<std::int32_t> faces;
    std::vector<std::int32_t> beside;          ///< regions across its edges, sorted
    std::vector<std::int32_t> beyond_outline;  ///< regions across the outline, once per edge
    std::vector<std::int32_t> in_holes;        ///< regions across the edges of its holes
};

/// Facts of every region of `s.region`, all but those about outlines.
/// \param normals unit, per face \param face_area mm^2, per face
[[nodiscard]] std::vector<RegionFacts> region_facts(const TriangleSoup& soup, const Segmentation& s,
                                                    const std::vector<Eigen::Vector3d>& normals,
                                                    const std::vector<double>& face_area);

/// Walks the region's boundary loops: the outline turns left about the region's normal, holes
/// right. Fills `outline_mm2`, `beyond_outline` and `in_holes`.
void trace_outline(const TriangleSoup& soup, const Segmentation& s, std::int32_t id,
                   RegionFacts& facts);

/// Sets the kind of the regions that are end caps: flat ends, and regions that are mostly planar
/// with all edges convex, so that nothing stands before them. They are as large as the part's other
/// ends, and no mere speck of it. A disc beside another such region is the flat of a box, not an
/// end.
/// \param flat_end per face, see flat_ends.h; each end is a region of its own
void mark_end_caps(const TriangleSoup& soup, const std::vector<std::int32_t>& flat_end,
                   Segmentation& s, std::vector<RegionFacts>& facts);

/// Regions that end a leg of angular section, as the end of a square bar does: plateaus of the wall
/// without a hole, beside nothing but other plateaus, and at least half as large as the smallest
/// end cap. None where there is no end cap. \param facts with the outlines of all end caps
[[nodiscard]] std::vector<std::int32_t> angular_ends(const TriangleSoup& soup,
                                                     const Segmentation& s,
                                                     std::vector<RegionFacts> facts);

}  // namespace meshwind
