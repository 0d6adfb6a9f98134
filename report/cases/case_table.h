/// Batch runs of the main job: one case per row of a table.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meshwind {

struct Case {
    std::string id;  ///< a name of a folder: letters, digits, ".", "_" and "-"
    std::string mandrel;
    std::string machine = "six_axis.json";
    std::string job;                    ///< empty: none
    std::vector<std::string> settings;  ///< of the job, "tow.width=8", in the order of the columns
    int line = 0;                       ///< of the table
};

/// Columns `id` and `mandrel`, optionally `machine` and `job`; every other one is named like a
/// job's key, `tow.width` or `layers.0.angle`, and empty cells leave that key as it is. Blanks
/// around cells are skipped. \param file for the errors \throws InputError case.column, case.cell
/// (no or too many cells, an empty mandrel), case.id (not the name of a folder, or twice),
/// case.none (no row), each with its line
[[nodiscard]] std::vector<Case> read_cases(std::string_view text, const std::string& file);

}  // namespace meshwind
