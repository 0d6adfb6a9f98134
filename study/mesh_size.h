/// Study of mesh size: accuracy of fibre paths and machine motion over the edge length.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/run_context.h"
#include "study/study_mandrel.h"
#include "study/tangent_rules.h"

namespace meshwind {

/// A tracing method with its name in the study.
struct PathMethod {
    const char* name;
    TraceMethod method;
};

/// Every method of geodesic/trace.h.
[[nodiscard]] std::span<const PathMethod> path_methods();

/// Error measured on a mesh.
///  PathEnd       mm: distance of the path's end from that of the exact path of the same length.
///  WindingAngle  rad: angle between path and exact path at the same arc length, the exact one
///                turned by the minimal rotation into the tangent plane; on a cylinder the
///                difference of winding angles. Signed, > 0 to the left of travel.
///  Slip          ratio: |kg| / kn by measure_slip minus the one steered with, where kn is at least
///                a quarter of its largest value and the fibre does not bridge.
///  SpindleAngle  rad, EyePoint mm: with the tangent by one of the rules instead of the exact
///                fibre's at the same landing point (tangent_rules.h), so that the drift of the
///                path does not count again. C is left out where the eye is nearer to the spindle
///                axis than a tenth of the free length.
enum class Quantity { PathEnd, WindingAngle, Slip, SpindleAngle, EyePoint };

/// "path-end", "winding-angle", "slip", "spindle-angle", "eye-point".
[[nodiscard]] const char* name_of(Quantity quantity);

struct MeshSizeOptions {
    std::vector<double> edges_mm{20.0, 10.0, 5.0, 2.5};  ///< > 0
    std::vector<double> slip_ratios{0.0, 0.2};  ///< geodesics, and what dry fibre just holds
    int paths = 100;                            ///< > 0, per mesh; random starts and directions
    double length_mm = 300.0;                   ///< > 0, or to the rim
    double free_length_mm = 200.0;              ///< > 0; as in fu_2009_post_processing
    bool irregular = true;
    bool timing = false;   ///< measure, on one thread; the rest does not depend on it
    RunContext context{};  ///< progress is reported from one thread at a time

    /// \throws InputError study.not_positive, study.slip_ratio, study.too_long
    void validate() const;
};

struct MeshSizePoint {
    double edge_mm = 0.0;       ///< asked for
    double mean_edge_mm = 0.0;  ///< of the mesh
    std::size_t triangles = 0;
    double rms = 0.0;
    double worst = 0.0;           ///< largest magnitude
    std::optional<double> order;  ///< against the next coarser mesh: d log rms / d log mean edge
};

/// One error against the edge length, coarsest mesh first.
struct MeshSizeLine {
    std::string mandrel;
    std::string method;
    double slip_ratio = 0.0;
    Quantity quantity = Quantity::PathEnd;
    std::optional<TangentRule> rule;  ///< of SpindleAngle and EyePoint
    std::vector<MeshSizePoint> points;
};

/// Cost of tracing on one mesh.
struct MeshSizeTiming {
    std::string mandrel;
    std::string method;
    double slip_ratio = 0.0;
    double edge_mm = 0.0;
    std::size_t triangles = 0;
    double ns_per_crossing = 0.0;
    double ms_per_metre = 0.0;
};

struct MeshSizeStudy {
    std::vector<double> edges_mm;  ///< asked for, longest first, each once
    std::vector<MeshSizeLine> lines;
    std::vector<MeshSizeTiming> timing;  ///< empty unless asked for
    std::vector<std::string> remarks;    ///< meshes that could not be made, in words
};

/// Traces the same random paths on every mesh of every mandrel. The same for any number of threads.
/// \throws InputError as MeshSizeOptions::validate; study.no_mesh for a mandrel left without a mesh
[[nodiscard]] MeshSizeStudy mesh_size_study(std::span<const StudyMandrel> mandrels,
                                            const MeshSizeOptions& options);

/// Slope of log rms over log mean edge by least squares; none for fewer than two meshes with an
/// error above 0.
[[nodiscard]] std::optional<double> fitted_order(const MeshSizeLine& line);

}  // namespace meshwind
