/// Machine, extensions and pins of a page. Included by .cpp files of the report only.
#pragma once

#include <nlohmann/json.hpp>

#include "machines/machine.h"
#include "pipeline/setup.h"
#include "report/page/page_arrays.h"

namespace meshwind {

/// The machine's entry in the page's header; adds the meshes of its head, then of bodies.
[[nodiscard]] nlohmann::json page_machine(const Machine& machine, PageArrays& arrays);

/// Extensions and pins of a mandrel as one mesh, which is added; null where there are none.
[[nodiscard]] nlohmann::json page_extension(const Setup& first, PageArrays& arrays);

}  // namespace meshwind
