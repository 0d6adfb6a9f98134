/// Errors of one traced path against the exact one, summed over its landing points.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "study/path_reference.h"
#include "study/tangent_rules.h"

namespace meshwind {

struct ErrorSum {
    double squares = 0.0;
    double worst = 0.0;  ///< largest magnitude
    std::size_t count = 0;

    void add(double error);
    void add(const ErrorSum& other);
    [[nodiscard]] double rms() const {
        return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
    }
};

/// As Quantity of mesh_size.h; the arrays in the order of kTangentRules.
struct PathErrors {
    ErrorSum path_end_mm;
    ErrorSum winding_angle_rad;
    ErrorSum slip;
    std::array<ErrorSum, kTangentRules.size()> spindle_angle_rad;
    std::array<ErrorSum, kTangentRules.size()> eye_mm;

    void add(const PathErrors& other);
};

struct PathErrorOptions {
    double slip_ratio = 0.0;  ///< steered with
    double free_length_mm = 200.0;
    TraceMethod method = TraceMethod::Walk;  ///< traced with
    double pressed_kn_per_mm = 0.0;          ///< slip is measured from this normal curvature on
};

/// A quarter of the largest normal curvature on the paths.
[[nodiscard]] double pressed_kn_per_mm(std::span<const TraceResult> traced);

/// \param exact from the same start; where it is shorter (a rim), the path counts up to there
[[nodiscard]] PathErrors path_errors(const Surface& surface, const SurfacePath& path,
                                     const ReferencePath& exact, const PathReference& reference,
                                     const PathErrorOptions& options);

}  // namespace meshwind
