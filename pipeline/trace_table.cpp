#include "pipeline/trace_table.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "geodesic/connect.h"
#include "geodesic/slip_and_bridging.h"
#include "geodesic/trace.h"
#include "mesh/ray_query.h"
#include "mesh/smooth/patch.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// File units; from farther away no nearest point can be told from its neighbours.
constexpr double kFarthestStart = 1e9;

// Sine of the angle to the normal up to which a direction has no share in the surface: on a coarse
// mesh the normal itself is known no better.
constexpr double kAlongNormalSine = 1e-3;

constexpr int kLengthDecimals = 6;  // 1 nm: what a study of accuracy needs
constexpr int kDirectionDecimals = 9;
constexpr int kCurvatureDecimals = 10;
constexpr int kRatioDecimals = 6;

// A point of the command line on the surface.
struct Snapped {
    SurfacePoint at;
    double moved_mm;
};

Snapped snap(const Mandrel& mandrel, const Vector3d& point_file) {
    const Vector3d point_mm = mandrel.file_to_mandrel * point_file;
    const TriangleSoup wall{mandrel.surface.position_mm, mandrel.surface.face};
    const RayQuery query({&wall, 1});
    const ClosestPoint found = query.closest(point_mm, point_mm.norm() + 10.0 * diagonal_mm(wall));
    return {{found.face, found.bary}, found.distance_mm};
}

Vector3d direction_at(const TraceRequest& request, const Mandrel& mandrel, const Vector3d& normal) {
    Vector3d direction = Vector3d::UnitZ();
    if (request.direction) {
        direction = mandrel.file_to_mandrel.linear() * *request.direction;
    }
    const double length = direction.norm();
    const Vector3d flat = direction - normal * normal.dot(direction);
    if (!(flat.norm() > kAlongNormalSine * length)) {
        throw InputError("trace.direction", mandrel.file,
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

std::string table(const TracedPath& traced, const Eigen::Isometry3d& out_from_mandrel) {
    const SurfacePath& path = traced.path;
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
        append(text, traced.slip[i], kRatioDecimals);
        append(text, traced.string.gap_mm[i], kLengthDecimals);
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

void check(const TraceRequest& request) {
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
    if (request.to && !(request.to->norm() < kFarthestStart)) {
        throw InputError("trace.to", "--to", "lies beyond any part; give a point near it");
    }
}

// A path and how it came to its end, in words.
struct Traced {
    SurfacePath path;
    std::string end;
};

Traced trace_from(const TraceRequest& request, const Mandrel& mandrel, const SurfacePoint& start) {
    const Vector3d normal = request.method == TraceMethod::Walk
                                ? smooth_normal(mandrel.surface, start)
                                : on_patch(mandrel.surface, start.face, start.bary).normal();
    TraceResult result = trace(mandrel.surface, start, direction_at(request, mandrel, normal),
                               {request.slip_ratio, request.slip_ratio},
                               {.max_length_mm = request.length_mm, .method = request.method});
    return {std::move(result.path),
            name_of(result.stop) +
                (result.rim >= 0 ? " " + std::to_string(result.rim) : std::string())};
}

std::string reason_of(const ConnectResult& result) {
    const std::string nearest = "the nearest path found is " + fixed(result.length_mm, 3) +
                                " mm long and misses by " + fixed(result.miss_mm, 6) + " mm";
    switch (result.stop) {
        case ConnectStop::Unreachable:
            return "lies on another piece of the surface than --start; choose both on one";
        case ConnectStop::SamePoint:
            return "is the same point of the surface as --start; choose another";
        case ConnectStop::Conjugate:
            return "no path reaches it: neighbouring paths meet before; " + nearest +
                   "; choose a nearer point or another --lambda";
        case ConnectStop::Rim:
            return "the path there leaves the surface at rim " + std::to_string(result.rim) + "; " +
                   nearest + "; choose a point that is not behind a rim";
        case ConnectStop::Gap:
            return "traces pass on both sides of it; " + nearest +
                   "; a finer mesh or a nearer point helps";
        default:
            return "no path was found (" + std::string(name_of(result.stop)) + "); " + nearest +
                   "; choose a nearer point or another --lambda";
    }
}

Traced trace_between(const TraceRequest& request, const Mandrel& mandrel, const SurfacePoint& start,
                     const Snapped& to) {
    const ConnectOptions options{.trace = {.method = request.method}};
    ConnectResult result = connect(mandrel.surface, start, to.at, request.slip_ratio, options);
    if (result.path.empty() || result.miss_mm > options.tolerance_mm) {
        throw InputError("trace.not_connected", "--to", reason_of(result));
    }
    std::string end = "target, which moved " + fixed(to.moved_mm, 4) + " mm onto the surface, " +
                      fixed(result.length_mm - result.polyhedral_mm, 4) +
                      " mm longer than the shortest way over the facets";
    if (result.stop != ConnectStop::Reached) {
        end += std::string(", ") + name_of(result.stop);
    }
    return {std::move(result.path), std::move(end)};
}

}  // namespace

TracedPath trace_path(const Mandrel& mandrel, const TraceRequest& request) {
    check(request);
    const Snapped start = snap(mandrel, request.start);
    auto [path, end] = request.to
                           ? trace_between(request, mandrel, start.at, snap(mandrel, *request.to))
                           : trace_from(request, mandrel, start.at);
    TautString string = taut_string(path);
    SlipMeasure slip = measure_slip(mandrel.surface, path, string, {.method = request.method});
    std::string words = std::to_string(path.size()) + " points, " + fixed(path.back().s_mm, 3) +
                        " mm, ended at: " + end + ", start moved " + fixed(start.moved_mm, 4) +
                        " mm onto the surface, worst slip ratio " + fixed(slip.worst, 4) +
                        ", bridging " + fixed(string.worst_gap_mm, 3) + " mm";
    return {std::move(path), std::move(string), std::move(slip.slip), std::move(words)};
}

TraceTable trace_table(const Mandrel& mandrel, const TraceRequest& request) {
    TracedPath traced = trace_path(mandrel, request);
    return {table(traced, request.file_frame ? file_from_mandrel_mm(mandrel)
                                             : Eigen::Isometry3d::Identity()),
            std::move(traced.words)};
}

}  // namespace meshwind
