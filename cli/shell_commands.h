/// Commands for finite elements: decks of a wound wall, and its first failure.
#pragma once

#include <string>
#include <vector>

#include "cli/commands.h"
#include "report/report_strength.h"

namespace meshwind {

struct ShellArguments {
    std::string run = "meshwind-out", material = "carbon_epoxy.json";
    std::string format = "calculix";
    std::string out;  ///< a deck's file, or the folder of `strength`
    std::string moment = "0,0,0";
    std::vector<std::size_t> rims;  ///< two, from 1; empty: chosen
    ShellRequest request;
    bool pressure_given = false;
};

/// `export fe`: writes a deck.
int run_export_fe(ShellArguments& arguments, const Common& common);

/// `strength`: writes strength.json, strength.html, strength.vtu and CalculiX's own files.
int run_strength(ShellArguments& arguments, const Common& common);

}  // namespace meshwind
