#include "study/path_errors.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/small_linear.h"
#include "geodesic/slip_and_bridging.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kPressedShare = 0.25;

// In free lengths: an eye nearer to the spindle axis has a turn that means little.
constexpr double kSpindleShare = 0.1;

// A slip ratio counts where its stated error is no larger: near an end, and where hardly anything
// presses the fibre on, there is none.
constexpr double kTrustedSlip = 0.05;

// In mean edges: landing points nearer to each other (a corner just cut, the path's end) are no
// three points to take a direction from.
constexpr double kMinSpacingEdges = 1e-3;

Vector3d turned_between(const Vector3d& vector, const Vector3d& from, const Vector3d& to) {
    return shortest_turn(from, to) * vector;
}

void add_slip(const Surface& surface, const SurfacePath& path, const PathErrorOptions& options,
              ErrorSum& sum) {
    const TautString string = taut_string(path);
    const SlipMeasure measured = measure_slip(surface, path, string, {.method = options.method});
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (measured.error[i] <= kTrustedSlip && string.gap_mm[i] == 0.0 &&
            path[i].kn_per_mm >= options.pressed_kn_per_mm) {
            sum.add(measured.slip[i] - std::abs(options.slip_ratio));
        }
    }
}

// The exact direction at the same arc length, in the tangent plane of the landing point.
Vector3d exact_direction(const CurveState& exact, const PathReference& reference,
                         const Vector3d& normal) {
    const Vector3d from = reference.foot(exact.position_mm).normal;
    return turned_between(exact.tangent, from, normal);
}

// What comes of the rules at a landing point with neighbours.
void add_eye(const Landing& landing, const Vector3d& exact, double free_length_mm,
             PathErrors& errors) {
    const Vector3d eye_mm = landing.here + free_length_mm * exact;
    const bool clear = std::hypot(eye_mm.x(), eye_mm.y()) >= kSpindleShare * free_length_mm;
    for (std::size_t r = 0; r < kTangentRules.size(); ++r) {
        const Vector3d tangent = tangent_by(kTangentRules[r], landing);
        const EyeError error = eye_error(landing.here, exact, tangent, free_length_mm);
        errors.eye_mm[r].add(error.eye_mm);
        if (clear) {
            errors.spindle_angle_rad[r].add(error.c_rad);
        }
    }
}

}  // namespace

void ErrorSum::add(double error) {
    squares += error * error;
    worst = std::max(worst, std::abs(error));
    ++count;
}

void ErrorSum::add(const ErrorSum& other) {
    squares += other.squares;
    worst = std::max(worst, other.worst);
    count += other.count;
}

void PathErrors::add(const PathErrors& other) {
    path_end_mm.add(other.path_end_mm);
    winding_angle_rad.add(other.winding_angle_rad);
    slip.add(other.slip);
    for (std::size_t r = 0; r < kTangentRules.size(); ++r) {
        spindle_angle_rad[r].add(other.spindle_angle_rad[r]);
        eye_mm[r].add(other.eye_mm[r]);
    }
}

double pressed_kn_per_mm(std::span<const TraceResult> traced) {
    double largest = 0.0;
    for (const TraceResult& result : traced) {
        for (const PathPoint& point : result.path) {
            largest = std::max(largest, point.kn_per_mm);
        }
    }
    return kPressedShare * largest;
}

PathErrors path_errors(const Surface& surface, const SurfacePath& path, const ReferencePath& exact,
                       const PathReference& reference, const PathErrorOptions& options) {
    PathErrors errors;
    const auto beyond = std::find_if(
        path.begin(), path.end(), [&](const PathPoint& p) { return p.s_mm > exact.length_mm(); });
    const double least_mm = kMinSpacingEdges * surface.mean_edge_mm;
    const auto count = static_cast<std::size_t>(beyond - path.begin());
    for (std::size_t i = 1; i < count; ++i) {
        const CurveState at = exact.at(path[i].s_mm);
        const Vector3d n = reference.foot(path[i].position_mm).normal;
        const Vector3d direction = exact_direction(at, reference, n);
        errors.winding_angle_rad.add(
            std::atan2(n.dot(direction.cross(path[i].tangent)), direction.dot(path[i].tangent)));
        if (i + 1 < path.size() && path[i].s_mm - path[i - 1].s_mm > least_mm &&
            path[i + 1].s_mm - path[i].s_mm > least_mm) {
            add_eye({path[i - 1].position_mm, path[i].position_mm, path[i + 1].position_mm,
                     path[i].tangent},
                    direction, options.free_length_mm, errors);
        }
    }
    if (count > 1) {
        const PathPoint& last = path[count - 1];
        errors.path_end_mm.add((last.position_mm - exact.at(last.s_mm).position_mm).norm());
    }
    add_slip(surface, path, options, errors.slip);
    return errors;
}

}  // namespace meshwind
