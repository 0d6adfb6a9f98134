#include "cli/trace_command.h"

#include <cmath>

#include <Eigen/Geometry>

#include "cli/output_files.h"
#include "core/error.h"
#include "core/text_number.h"
#include "core/tolerances.h"
#include "core/units.h"
#include "geodesic/measure.h"
#include "geodesic/trace.h"
#include "mesh/mandrel.h"
#include "mesh/ray_query.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// File units; from farther away no nearest point can be told from its neighbours.
constexpr double kFarthestStart = 1e9;

constexpr int kLengthDecimals = 6;  // 1 nm: what a study of accuracy needs
constexpr int kDirectionDecimals = 9;
constexpr int kCurvatureDecimals = 10;
constexpr int kRatioDecimals = 6;

SurfacePoint snap(const Mandrel& mandrel, const Vector3d& start_mm, double& distance_mm) {
    const TriangleSoup wall{mandrel.surface.position_mm, mandrel.surface.face};
    const RayQuery query({&wall, 1});
    const ClosestPoint found = query.closest(start_mm, start_mm.norm() + 10.0 * diagonal_mm(wall));
    distance_mm = found.distance_mm;
    return {found.face, found.bary};
}

Vector3d direction_at(const TraceRequest& request, const Mandrel& mandrel, const Vector3d& normal) {
    Vector3d direction = Vector3d::UnitZ();
    if (request.direction) {
        direction = mandrel.file_to_mandrel.linear() * *request.direction;
    }
    const double length = direction.norm();
    const Vector3d flat = direction - normal * normal.dot(direction);
    if (!(flat.norm() > kParallelSine * length)) {
        throw InputError("trace.direction", request.mandrel.string(),
                         "the direction is zero or along the surface normal at the start; give one "
                         "that lies in the surface");
    }
    if (!request.angle_deg) {
        return flat.normalized();
    }
    const double angle = rad_from_deg(*request.angle_deg);
    const Vector3d axial = flat.normalized();
    return std::cos(angle) * axial + std::sin(angle) * normal.cross(axial);
}

void append(std::string& text, double value, int decimals) {
    text += ',';
    append_fixed(text, value, decimals);
}

std::string table(const SurfacePath& path, const TautString& string, const SlipMeasure& slip,
                  const Eigen::Isometry3d& out_from_mandrel) {
    std::string text =
        "point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,bridge_mm\n";
    for (std::size_t i = 0; i < path.size(); ++i) {
        const PathPoint& p = path[i];
        text += std::to_string(i);
        append(text, p.s_mm, kLengthDecimals);
        for (const double x : Vector3d(out_from_mandrel * p.position_mm)) {
            append(text, x, kLengthDecimals);
        }
        for (const Vector3d& v : {p.normal, p.tangent}) {
            for (const double x : Vector3d(out_from_mandrel.linear() * v)) {
                append(text, x, kDirectionDecimals);
            }
        }
        append(text, p.kn_per_mm, kCurvatureDecimals);
        append(text, p.kg_per_mm, kCurvatureDecimals);
        append(text, slip.slip[i], kRatioDecimals);
        append(text, string.gap_mm[i], kLengthDecimals);
        text += '\n';
    }
    return text;
}

// The file's axes and origin, lengths in mm.
Eigen::Isometry3d file_from_mandrel_mm(const Mandrel& mandrel) {
    Eigen::Isometry3d mandrel_from_file = Eigen::Isometry3d::Identity();
    mandrel_from_file.linear() = mandrel.file_to_mandrel.linear() / mandrel.unit_mm;
    mandrel_from_file.translation() = mandrel.file_to_mandrel.translation();
    return mandrel_from_file.inverse();
}

}  // namespace

std::string run_trace(const TraceRequest& request) {
    if (!(request.length_mm > 0.0) || !std::isfinite(request.length_mm)) {
        throw InputError("trace.length", "--length", "must be positive and finite");
    }
    if (!std::isfinite(request.slip_ratio)) {
        throw InputError("trace.lambda", "--lambda", "must be a finite number");
    }
    if (request.angle_deg && !std::isfinite(*request.angle_deg)) {
        throw InputError("trace.angle", "--angle", "must be a finite number of degrees");
    }
    if (!(request.start.norm() < kFarthestStart)) {
        throw InputError("trace.start", "--start", "lies beyond any part; give a point near it");
    }
    const Mandrel mandrel = load_mandrel(request.mandrel, {.unit_mm = request.unit_mm});
    double off_mm = 0.0;
    const SurfacePoint start = snap(mandrel, mandrel.file_to_mandrel * request.start, off_mm);
    const Vector3d direction =
        direction_at(request, mandrel, smooth_normal(mandrel.surface, start));
    const TraceResult result =
        trace(mandrel.surface, start, direction, {request.slip_ratio, request.slip_ratio},
              {.max_length_mm = request.length_mm});
    const TautString string = taut_string(result.path);
    const SlipMeasure slip = measure_slip(mandrel.surface, result.path, string, {});
    write_file(request.out, table(result.path, string, slip,
                                  request.file_frame ? file_from_mandrel_mm(mandrel)
                                                     : Eigen::Isometry3d::Identity()));
    return request.out.string() + ": " + std::to_string(result.path.size()) + " points, " +
           fixed(result.path.back().s_mm, 3) + " mm, ended at: " + name_of(result.stop) +
           (result.rim >= 0 ? " " + std::to_string(result.rim) : std::string()) + ", start moved " +
           fixed(off_mm, 4) + " mm onto the surface, worst slip ratio " + fixed(slip.worst, 4) +
           ", bridging " + fixed(string.worst_gap_mm, 3) + " mm";
}

}  // namespace meshwind
