/// Prints the summary of a run on the terminal.
#pragma once

#include <filesystem>
#include <ostream>

#include "pipeline/wind.h"

namespace meshwind {

enum class Detail { Brief, Full };

/// Brief: ten lines for one layer. The part with unit and size, the lay-up in the trade's words,
/// its coverage and thickness, fibre with mass and scrap, time, failures with their places, and the
/// folder of the files. Full: all figures and every check as well.
void print_summary(std::ostream& out, const Run& run, const std::filesystem::path& folder,
                   Detail detail);

}  // namespace meshwind
