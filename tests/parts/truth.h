/// What is true of a part, as JSON.
#pragma once

#include <cstdint>
#include <string>

#include "part.h"
#include "tessellate.h"

namespace cad_part {

/// Lengths and places are in the file's frame and units, unless a key's name has the unit.
[[nodiscard]] std::string truth_json(std::uint64_t seed, const std::string& file, const Part& part,
                                     const ExportOptions& options, std::size_t triangles);

}  // namespace cad_part
