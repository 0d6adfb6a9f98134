// A machine file, and what is asked of it before planning.
#include "machines/eye_inverse.h"
#include "machines/machine_json.h"
#include "postproc/collision/collision.h"
#include "postproc/robot/dialects.h"
#include "tests/fuzz/harness.h"

namespace meshwind::fuzz {

void run(std::span<const std::uint8_t> bytes) {
    const Machine machine = parse_machine(text_of(bytes), "machine.json");
    (void)machine_class(machine);
    make_dialect(machine.controller.dialect)->check(machine);
    (void)head_envelope(machine);
    (void)bodies_on_mandrel(machine);
}

}  // namespace meshwind::fuzz
