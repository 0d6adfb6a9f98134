/// The axis of a frame from its mesh, for `meshwind carry`.
#pragma once

#include <filesystem>

#include <Eigen/Geometry>

#include "postproc/tube_axis.h"

namespace meshwind {

struct MeshAxisOptions {
    double unit_mm = 0.0;  ///< MandrelOptions
    TubeAxisOptions axis;
};

struct MeshAxis {
    TubeAxis tube;
    double residual_mm = 0.0;  ///< Tube::residual_mm
    /// Pose of the axis' frame in the file's coordinates, these in mm.
    Eigen::Isometry3d frame_in_file = Eigen::Isometry3d::Identity();
};

/// By the ending of the name: .stl, .obj, .ply, .off, in any case.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& file);

/// The tube of one radius that a mesh is. \throws InputError carry.no_tube where it is none, or its
/// radius varies by more than the tube's residual may be (mesh/tube.h); what load_mandrel throws
[[nodiscard]] MeshAxis read_mesh_axis(const std::filesystem::path& file,
                                      const MeshAxisOptions& options);

}  // namespace meshwind
