/// The axis of a frame from its table or its mesh.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "postproc/ringhead/frame_axis.h"
#include "postproc/ringhead/tube_axis.h"

namespace meshwind {

struct MeshAxisOptions {
    double unit_mm = 0.0;  ///< MandrelOptions
    TubeAxisOptions axis;
};

/// The axis of a frame, from a table or a mesh.
struct CarryAxis {
    std::string file{};    ///< name without folder
    std::string digest{};  ///< SHA-256 of the file
    FrameAxis axis;
    std::optional<double> radius_mm{};  ///< of the tube that a mesh is; none of a table
    double residual_mm = 0.0;           ///< of the mesh's vertices from the tube
    /// For a mesh: pose of the axis' frame in the file's coordinates, these in mm.
    std::optional<Eigen::Isometry3d> frame_in_file{};
};

/// Reads a table of postproc/ringhead/frame_axis.h or, by the ending of the name (.stl, .obj, .ply,
/// .off, in any case), the mesh of a tube of one radius. \throws InputError carry.no_tube where it
/// is none, or its radius varies by more than the tube's residual may be (mesh/tube/tube.h);
/// axis.*; what load_mandrel throws; IoError
[[nodiscard]] CarryAxis read_carry_axis(const std::filesystem::path& file,
                                        const MeshAxisOptions& options);

}  // namespace meshwind
