// Paths over a spoilt mesh, as `meshwind inspect` traces them for its estimate, but fewer, and over
// the triangles that it has: more meshes are seen in the same time.
#include <cmath>

#include "core/parallel.h"
#include "geodesic/path_accuracy.h"
#include "mesh/mandrel/load_mandrel.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/spoilt_mesh.h"

namespace meshwind::fuzz {

void run(std::span<const std::uint8_t> bytes) {
    set_thread_count(1);
    constexpr int kStarts = 2;
    MandrelOptions options;
    options.mesh = MandrelOptions::Mesh::File;
    const Mandrel mandrel = build_mandrel(spoilt_mesh(bytes), "spoilt", options);
    const PathAccuracy accuracy = estimate_path_accuracy(mandrel.surface, kStarts);
    if (!std::isfinite(accuracy.walk_mm_per_m) || !std::isfinite(accuracy.patches_mm_per_m)) {
        found("an estimate that is no number");
    }
}

}  // namespace meshwind::fuzz
