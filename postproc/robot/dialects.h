/// All controller languages by their names.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "postproc/nc/dialect.h"

namespace meshwind {

/// Names of all languages, in the order in which messages list them.
[[nodiscard]] std::vector<std::string> dialect_names();

/// \throws InputError dialect.unknown with the names that exist
[[nodiscard]] std::unique_ptr<Dialect> make_dialect(std::string_view name);

}  // namespace meshwind
