/// Whether a machine file's controller can be written for, before anything is planned.
#pragma once

#include <filesystem>

#include "machines/machine.h"

namespace meshwind {

/// \param file the machine's, which messages name
/// \throws InputError dialect.unknown, and what Dialect::check throws
void check_controller(const Machine& machine, const std::filesystem::path& file);

}  // namespace meshwind
