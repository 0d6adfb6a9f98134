/// Output of `meshwind carry`: report.json, the other files, and the summary.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "postproc/ringhead/carry.h"
#include "report/folder/output_files.h"

namespace meshwind {

[[nodiscard]] std::string carry_json(const CarryOutcome& outcome);

/// \param folder where the files are
void print_carry(std::ostream& out, const CarryOutcome& outcome,
                 const std::filesystem::path& folder);

/// NAME.src and, unless all is wound at once, NAME_back.src where the outcome is usable, motion.csv
/// and report.json, with an angle also rings.csv and fibre.csv.
void write_carry(const CarryOutcome& outcome, OutputFolder& folder);

}  // namespace meshwind
