/// Converts a verified program into a run that the page can show.
#pragma once

#include <string>

#include "pipeline/verify_text.h"
#include "pipeline/wind.h"

namespace meshwind {

/// A run of one layer. Its pieces are the fibre that the program lays between its course marks, or
/// one piece without marks. Where it lays nothing the layer has no plan, and the reason.
/// \param text of the program
[[nodiscard]] Run run_of(VerifyOutcome outcome, std::string text, std::uint64_t seed);

}  // namespace meshwind
