/// Report of a mesh-size study: study.json, the files of its folder, and the table on the terminal.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

#include "report/folder/output_files.h"
#include "study/study_run.h"

namespace meshwind {

/// Options, references, lines with their points, remarks and the judged advice; keys as in
/// docs/study.md. Timing is left out: it differs from run to run.
[[nodiscard]] std::string study_json(const StudyOutcome& outcome);

/// The plot and the tables, for a browser: one file that needs no network.
[[nodiscard]] std::string study_page(const StudyOutcome& outcome);

/// Prints the table and its verdict on the advice of fu_2009_post_processing.
void print_study(std::ostream& out, const StudyOutcome& outcome,
                 const std::filesystem::path& folder);

/// Writes study.html, study.csv, study.json, study.svg and, where timing was asked for, timing.csv.
void write_study(const StudyOutcome& outcome, OutputFolder& folder);

}  // namespace meshwind
