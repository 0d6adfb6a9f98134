// A machine file, and what is asked of it before planning.
#include "machines/eye_inverse.h"
#include "machines/machine_json.h"
#include "postproc/collision.h"
#include "postproc/dialect.h"
#include "tests/fuzz/harness.h"

namespace meshwind::fuzz {

void run(std::span<const std::uint8_t> bytes) {
    const Machine machine = parse_machine(text_of(bytes), "machine.json");
    (void)machine_class(machine);
    make_dialect(machine.controller.dialect)->check(machine);
    // Meshes of heads are files of their own.
    const auto no_mesh = [](const std::string&) { return TriangleSoup{}; };
    (void)head_envelope(machine, no_mesh);
    (void)bodies_on_mandrel(machine, no_mesh);
}

}  // namespace meshwind::fuzz
