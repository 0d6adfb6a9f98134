/// Checks before planning that programs can be written for a machine file's controller.
#pragma once

#include <filesystem>

#include "machines/machine.h"

namespace meshwind {

/// \param file the machine's, which messages name
/// \throws InputError dialect.unknown, and what Dialect::check throws
void check_controller(const Machine& machine, const std::filesystem::path& file);

}  // namespace meshwind
