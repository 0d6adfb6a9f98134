/// Traces one fibre path, as a table.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geodesic/trace.h"
#include "mesh/mandrel.h"

namespace meshwind {

struct TraceRequest {
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
};

/// A path of the surface, with its taut string and slip. Mandrel frame.
struct TracedPath {
    SurfacePath path;
    TautString string;
    std::vector<double> slip;  ///< per station, measured from the finished path
    std::string words;         ///< what happened, in one line
};

/// Traces from the start, or connects it with the given end. \throws InputError trace.*
[[nodiscard]] TracedPath trace_path(const Mandrel& mandrel, const TraceRequest& request);

struct TraceTable {
    std::string csv;
    std::string words;  ///< what happened, in one line
};

/// trace_path() as a table with the columns
/// `point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,bridge_mm`.
/// \throws InputError trace.*
[[nodiscard]] TraceTable trace_table(const Mandrel& mandrel, const TraceRequest& request);

}  // namespace meshwind
