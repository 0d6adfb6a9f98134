/// A mandrel: the winding surface, with the regions, rims, axis and repairs of its file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/cad_face.h"
#include "mesh/region.h"
#include "mesh/repair_report.h"
#include "mesh/rim.h"
#include "mesh/surface.h"
#include "mesh/triangle_soup.h"
#include "mesh/winding_mesh_report.h"

namespace meshwind {

/// How the spindle axis was found.
struct SpindleAxis {
    std::string rule;          ///< "given", "coaxial-rims", "revolution", "principal"
    double residual_mm = 0.0;  ///< residual of the rule: misfit of the rims or of the surface
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
    std::vector<std::string> keep_faces{};     ///< of a CAD file, as is_named(); empty: by regions
    /// Length cut off every end with a leg, mm; none: all that is no part of the leg
    /// (mesh/even/square_ends.h)
    std::optional<double> cut_ends_mm{};
    /// Details such as lettering are removed up to this height, mm (mesh/even/details.h); none:
    /// 1 mm
    std::optional<double> remove_details_mm{};
    /// Radius of the ball for which crotches and steps are filled up (mesh/even/blend.h); 0: not
    double blend_mm = 0.0;
    std::string solid{};   ///< of a CAD file, name or number from 1; empty: the only one
    double edge_mm = 0.0;  ///< longest edge over a CAD file's faces; 0: by the part's size
    enum class Mesh { File, Even };
    /// Even: uneven triangles of the file are replaced by even ones over the same surface
    /// (mesh/even/winding_mesh.h)
    Mesh mesh = Mesh::Even;
};

/// A connected piece of a winding surface.
struct WallPiece {
    double area_mm2 = 0.0;
    Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();  ///< of its area, mandrel frame
    std::vector<std::int32_t> regions;                    ///< ids, sorted
};

/// A flat face that ends a leg and is no circle (mesh/segment/end_caps.h).
struct AngularEnd {
    std::int32_t region = -1;
    double area_mm2 = 0.0;
    Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();  ///< mandrel frame
};

/// A place to which a remark refers.
struct RemarkPlace {
    std::size_t remark = 0;                           ///< index in Mandrel::remarks
    Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  ///< on the part, mandrel frame
};

/// The winding surface with all that was found in its file. Immutable once loaded.
struct Mandrel {
    std::string file;       ///< name without folder
    double unit_mm = 1.0;   ///< length of a file unit
    std::string unit_rule;  ///< "given" | "file" | "assumed"
    TriangleSoup whole;     ///< every repaired triangle, mandrel frame: for collision checks
    std::vector<std::int32_t> whole_region;  ///< region id per face of `whole`
    Surface surface;                         ///< the winding surface
    std::vector<Region> regions;
    std::vector<Rim> rims;
    std::vector<CadFace> cad_faces;        ///< of a CAD file, mandrel frame; empty of others
    std::vector<std::int32_t> cad_face;    ///< per face of `surface`: index in cad_faces, -1: none
    TriangleSoup details;                  ///< removed details such as lettering, mandrel frame
    std::vector<WallPiece> pieces;         ///< largest first; one where the surface is connected
    std::vector<AngularEnd> angular_ends;  ///< none where the job names the kept faces or regions
    SpindleAxis axis;
    /// Mandrel-frame point in mm = linear * file point in file units + translation; the linear part
    /// is a rotation times `unit_mm`.
    Eigen::Affine3d file_to_mandrel = Eigen::Affine3d::Identity();
    RepairReport repairs;
    WindingMeshReport winding_mesh;
    std::vector<std::string> remarks;  ///< one line each: what a user should know of this file
    std::vector<RemarkPlace> places;   ///< of the remarks that refer to a place
};

}  // namespace meshwind
