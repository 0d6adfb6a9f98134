/// Results of a table's cases, and their merged table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/cases/case_table.h"

namespace meshwind {

/// Outcome of one case, FOLDER/ID.json: its inputs, and how it ended. Written last, whole or not at
/// all: a case without it is not done. The main job's files are in FOLDER/ID/.
struct CaseEnd {
    int exit_code = 0;            ///< of the main job: 0 all passed, 1 a check failed, 2 bad input
    std::string code{}, words{};  ///< of bad input
};

/// \throws IoError output.unwritable
void write_case_end(const std::filesystem::path& folder, const Case& of, const CaseEnd& end);

/// Removes the outcome before a case is run again. \throws IoError output.unwritable
void forget_case_end(const std::filesystem::path& folder, const Case& of);

struct MergedCases {
    std::string csv;  ///< a line a case, in the table's order: id, outcome, words, inputs, figures
    int passed = 0;
    std::vector<std::size_t> failed;  ///< a check failed, or bad input: numbers of rows from 1
    std::vector<std::size_t>
        missing;  ///< not run to the end, or with other inputs than the table's
};

/// Figures are those of each case's report.json. \throws IoError io.cannot_read
[[nodiscard]] MergedCases merge_cases(const std::filesystem::path& folder,
                                      const std::vector<Case>& cases);

/// The counts and numbers as a line of JSON. \param file of the merged table
[[nodiscard]] std::string merged_json(const MergedCases& merged, const std::filesystem::path& file);

/// "3,7,9": for an array of jobs. Empty where there are none.
[[nodiscard]] std::string numbers_text(const std::vector<std::size_t>& rows);

}  // namespace meshwind
