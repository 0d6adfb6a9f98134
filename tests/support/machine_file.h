/// Machines as they are shipped.
#pragma once

#include <string>

#include "machines/machine_json.h"

namespace meshwind::test {

/// As it is shipped in machines/, without the triangles of its meshes.
inline Machine machine_file(const std::string& name) {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/" + name + ".json");
}

}  // namespace meshwind::test
