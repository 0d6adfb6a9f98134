/// The phases of the main job, as a user is told of them.
#pragma once

#include <string>

namespace meshwind {

/// "3 of 8: looking for courses" for the step "library" of a run, "3 of 8: layer 2, looking for
/// courses" for "layer 2, library"; a step that is not known is told as it is. A pattern goes from
/// its plan to the motion at once; where it does not hold the run comes back to look for courses.
[[nodiscard]] std::string phase_text(const std::string& step);

}  // namespace meshwind
