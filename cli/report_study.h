/// study.json.
#pragma once

#include <string>

#include "cli/study_command.h"

namespace meshwind {

/// Options, references, lines with their points, remarks and the judged advice; keys as in
/// docs/study.md. Timing is left out: it differs from run to run.
[[nodiscard]] std::string study_json(const StudyOutcome& outcome);

}  // namespace meshwind
