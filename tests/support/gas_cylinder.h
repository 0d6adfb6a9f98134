/// The published gas cylinder, its numbers as printed and as computed apart from this program.
#pragma once

#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "winding/vessel/vessel_design.h"

namespace meshwind::test {

/// Lengths in cm.
inline nlohmann::json gas_cylinder() {
    std::ifstream in(std::string(MESHWIND_SOURCE_DIR) + "/data/reference/seed000.json");
    return nlohmann::json::parse(in)["vessel"];
}

inline IsotensoidDome published_dome(const nlohmann::json& ref, const std::string& id) {
    for (const nlohmann::json& row : ref["domes"]) {
        if (row["id"] == id) {
            return IsotensoidDome({ref["radius"], row["design_radius"], row["k_e"]});
        }
    }
    throw std::out_of_range(id);
}

}  // namespace meshwind::test
