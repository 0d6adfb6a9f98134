/// Estimates the error of paths on a mesh without knowing the surface that it stands for.
#pragma once

#include "mesh/surface.h"

namespace meshwind {

/// Errors are drifts within the surface at the ends of geodesics: rms over the paths, in mm per
/// metre of path. Drift grows faster than length, so the length belongs to the figure.
struct PathAccuracy {
    int paths = 0;  ///< number traced; 0: no estimate, no path on the part is some edges long
    double length_mm = 0.0;         ///< of a path that meets no rim
    double walk_mm_per_m = 0.0;     ///< TraceMethod::Walk
    double patches_mm_per_m = 0.0;  ///< TraceMethod::Patches
};

/// Geodesics from `starts` evenly spread places, as long as the part's bounding box is wide (at
/// most 500 edges), are traced by both methods. Walk is compared with Patches. Patches is compared
/// with itself: on fits to three rings of neighbours instead of two, which err about three times as
/// much more; where the surface is known, by polynomials of one and of two degrees less, whose
/// errors fall as they go on to; and with steps so short that they do not err. The parts add as
/// squares. No random numbers are drawn. Errors that no vertex shows are not seen: creases that the
/// mesh has rounded off, or vertices beside the surface. Accuracy: within a factor of 3 on tori and
/// cylinders with edges of a fifth to a twentieth of the tube's radius
/// (tests/geodesic/path_accuracy_test.cpp).
[[nodiscard]] PathAccuracy estimate_path_accuracy(const Surface& surface, int starts = 32);

}  // namespace meshwind
