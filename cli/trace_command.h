/// `meshwind trace`: one fibre path.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "geodesic/trace.h"

namespace meshwind {

struct TraceRequest {
    std::filesystem::path mandrel;
    double unit_mm = 0.0;  ///< length of a file unit; 0: found
    Eigen::Vector3d start =
        Eigen::Vector3d::Zero();  ///< file frame and file units; snapped to the surface
    std::optional<Eigen::Vector3d> direction;  ///< file frame, any length; or:
    std::optional<double> angle_deg;           ///< from the local axial direction (spindle),
                                               ///< counter-clockwise seen from outside; or:
    std::optional<Eigen::Vector3d> to;  ///< the path's end, file frame and file units; snapped
    double slip_ratio = 0.0;            ///< kg / kn
    double length_mm = 10000.0;         ///< > 0; not for a path to a given end
    TraceMethod method = TraceMethod::Patches;
    bool file_frame = false;  ///< output in the file's axes, in mm; else the mandrel frame
    std::filesystem::path out;
};

/// Traces from the start, or connects it with the given end, and writes a table:
/// `point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,bridge_mm`. The slip is
/// measured from the finished path. \return what happened, in one line \throws InputError trace.*,
/// mesh.*; IoError
[[nodiscard]] std::string run_trace(const TraceRequest& request);

}  // namespace meshwind
