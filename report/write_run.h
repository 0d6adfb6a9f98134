/// Writes the output folder of the main job.
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/wind.h"
#include "report/folder/output_files.h"

namespace meshwind {

/// Whether report.html is written: not where the program was built without its pages.
[[nodiscard]] bool has_page(const Run& run);

/// That page; empty where the program was built without it.
[[nodiscard]] std::string run_page(const Run& run);

/// Writes a run, whole or not at all: path.csv, motion.csv, report.json, report.html, lay-up and
/// fibre (layup_files.h), and the programs if the run is usable. A job that could not be planned
/// has report.json and a page of the part that says why (inspection.h). Each further layer and
/// fibre has program, path, motion and fibre of its own, each further layer its mandrel
/// (run_names.h). Files of an earlier run in the folder are removed. \return the text of
/// report.json \throws IoError output.unwritable; the folder is then as it was before
std::string write_run(const Run& run, OutputFolder& folder);

/// \throws IoError output.locked while another run has the folder; output.unwritable
std::string write_run(const Run& run, const std::filesystem::path& folder);

}  // namespace meshwind
