#include "pipeline/check_controller.h"

#include "pipeline/setup.h"
#include "postproc/nc/dialect.h"

namespace meshwind {

void check_controller(const Machine& machine, const std::filesystem::path& file) {
    Machine named = machine;
    named.name = file.string() + ": /controller";  // the place of what is wrong
    dialect_of(machine, file)->check(named);
}

}  // namespace meshwind
