/// Names of the main job's phases for the user.
#pragma once

#include <string>

namespace meshwind {

/// "3 of 8: looking for courses" for the step "library" of a run, "3 of 8: layer 2, looking for
/// courses" for "layer 2, library"; an unknown step is shown as it is. A pattern goes from its plan
/// to the motion at once; where it does not hold, the run comes back to look for courses.
[[nodiscard]] std::string phase_text(const std::string& step);

}  // namespace meshwind
