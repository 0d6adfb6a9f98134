/// From a user's file to the surface that is wound: units, repair, regions, rims, spindle axis.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/surface.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

enum class RegionKind { OuterWall, EndCap, Bore, Other };

/// "outer-wall", "end-cap", "bore", "other": the words of report.json.
[[nodiscard]] std::string_view name_of(RegionKind kind);

/// A piece of the file's surface bounded by feature edges.
struct Region {
    std::int32_t id = 0;
    RegionKind kind = RegionKind::Other;
    bool kept = false;  ///< part of the winding surface
    int triangles = 0;
    double area_mm2 = 0.0;
    double visible_fraction = 0.0;  ///< share of its area from which most of the outside is seen
};

/// A boundary loop of the winding surface: where courses end. Mandrel frame.
struct Rim {
    std::int32_t id = 0;
    Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, pointing away from the mandrel
    double radius_mm = 0.0;       ///< mean distance of the loop from the axis, notches left out
    double circularity_mm = 0.0;  ///< largest distance of a vertex from that circle
    std::vector<std::int32_t> vertices;  ///< surface vertices in loop order
};

/// How the spindle axis was found.
struct SpindleAxis {
    std::string rule;          ///< "given", "coaxial-rims", "revolution", "principal"
    double residual_mm = 0.0;  ///< what the rule left over: misfit of the rims or of the surface
};

/// What was done to the triangles before they could be used; every count is what was changed.
struct RepairReport {
    int welded_points = 0;
    int degenerate_faces_removed = 0;
    int duplicate_faces_removed = 0;
    int faces_flipped = 0;
    int edges_stitched = 0;
    int non_manifold_vertices_split = 0;
    int self_intersecting_faces = 0;  ///< reported, not mended
    int components = 0;
};

struct MandrelOptions {
    double unit_mm =
        0.0;  ///< length of a file unit; 0: from the file, else mm (metres if < 10 units long)
    struct Axis {
        Eigen::Vector3d origin;
        Eigen::Vector3d direction;
    };
    std::optional<Axis> axis{};                ///< in the file's frame and units; none: found
    std::vector<std::int32_t> keep_regions{};  ///< region ids; empty: the outer wall
};

/// The winding surface with all that was found on the way. Immutable once loaded.
struct Mandrel {
    std::string file;       ///< name without folder
    double unit_mm = 1.0;   ///< length of a file unit
    std::string unit_rule;  ///< "given" | "file" | "assumed"
    TriangleSoup whole;     ///< every repaired triangle, mandrel frame: what can be hit
    std::vector<std::int32_t> whole_region;  ///< region id per face of `whole`
    Surface surface;                         ///< what is wound
    std::vector<Region> regions;
    std::vector<Rim> rims;
    SpindleAxis axis;
    /// Mandrel-frame point in mm = linear * file point in file units + translation; the linear part
    /// is a rotation times `unit_mm`.
    Eigen::Affine3d file_to_mandrel = Eigen::Affine3d::Identity();
    RepairReport repairs;
    std::vector<std::string> remarks;  ///< one line each: what a user should know of this file
};

/// Reads, repairs, segments and freezes a mandrel file (STL, OBJ, PLY, OFF).
/// \throws IoError mesh.unreadable; InputError mesh.* with the file, the place and the mend
[[nodiscard]] Mandrel load_mandrel(const std::filesystem::path& file,
                                   const MandrelOptions& options = {});

/// The same from triangles in memory; `name` stands in for the file's name.
[[nodiscard]] Mandrel build_mandrel(const TriangleSoup& file_units, const std::string& name,
                                    const MandrelOptions& options = {});

}  // namespace meshwind
