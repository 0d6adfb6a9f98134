/// The summary of a run that a user reads on the terminal.
#pragma once

#include <filesystem>
#include <ostream>

#include "pipeline/wind.h"

namespace meshwind {

enum class Detail { Brief, Full };

/// Brief: ten lines for one layer. The part with unit and size, what is laid in the trade's words,
/// how it covers and how thick, fibre with mass and scrap, time, what failed and where, where the
/// files are. Full: all figures and every check as well.
void print_summary(std::ostream& out, const Run& run, const std::filesystem::path& folder,
                   Detail detail);

}  // namespace meshwind
