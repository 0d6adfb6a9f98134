/// Batch runs of the main job by a table: one row, and the merged results.
#pragma once

#include <cstddef>
#include <string>

#include "cli/commands.h"

namespace meshwind {

struct CaseArguments {
    std::string table;
    std::size_t row = 0;  ///< from 1
    std::string out = "cases";
    double effort = 1.0;
    bool left = false;  ///< of `study merge`: print only the rows still to be run, "3,7"
};

/// Winds one row into OUT/ID, and records the outcome in OUT/ID.json. Returns the main job's code.
int run_case(const CaseArguments& arguments, const Common& common);

/// Writes OUT/cases.csv of all rows. Returns 1 where one failed or is missing, else 0.
int run_merge(const CaseArguments& arguments, const Common& common);

}  // namespace meshwind
