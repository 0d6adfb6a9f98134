/// Table and JSON of `meshwind design vessel`.
#pragma once

#include <ostream>
#include <string>

#include "winding/vessel/vessel_table.h"

namespace meshwind {

[[nodiscard]] std::string design_json(const DesignOutcome& outcome);

void print_design(std::ostream& out, const DesignOutcome& outcome);

}  // namespace meshwind
