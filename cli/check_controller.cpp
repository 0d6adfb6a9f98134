#include "cli/check_controller.h"

#include "cli/setup.h"
#include "postproc/dialect.h"

namespace meshwind {

void check_controller(const Machine& machine, const std::filesystem::path& file) {
    Machine named = machine;
    named.name = file.string() + ": /controller";  // the place of what is wrong
    dialect_of(machine, file)->check(named);
}

}  // namespace meshwind
