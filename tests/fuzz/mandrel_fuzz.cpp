// The whole build of a mandrel from a spoilt mesh, and what is found out about it.
#include "core/parallel.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/revolution/revolution.h"
#include "mesh/tube/tube.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/spoilt_mesh.h"

namespace meshwind::fuzz {

void run(std::span<const std::uint8_t> bytes) {
    set_thread_count(1);
    const Mandrel mandrel = build_mandrel(spoilt_mesh(bytes), "spoilt");
    if (mandrel.surface.face.empty()) {
        found("a mandrel without a surface");
    }
    for (const Eigen::Vector3d& p : mandrel.surface.position_mm) {
        if (!p.allFinite()) {
            found("a surface with a point that is not finite");
        }
    }
    (void)find_revolution(mandrel);
    (void)find_tube(mandrel);
}

}  // namespace meshwind::fuzz
