/// Relaxes a job on its own where a plan fails or leaves wall bare: more fibres, longer extensions.
#pragma once

#include <optional>

#include "pipeline/job/job.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// The job with the number of fibres and the length of extensions that by the plan reach a
/// hundredth more of the wall; where neither does and the plan covers, or nearly, with one more
/// fibre. Values given by the job stay. None where nothing is left to relax.
[[nodiscard]] std::optional<Job> more_room(const Job& job, const Plan& plan);

/// The job with the number of fibres that reaches a hundredth more of the wall, where its own
/// cannot join courses that would; none where the job gives their number itself.
[[nodiscard]] std::optional<Job> more_fibres(const Job& job, const Plan& plan);

}  // namespace meshwind
