/// What of a job may be loosened by itself where a plan fails, or leaves wall bare.
#pragma once

#include <optional>

#include "pipeline/job/job.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// The job with as many fibres, and with extensions as long, as the plan says reach a hundredth
/// more of the wall; where neither does and the plan covers, or nearly, with one fibre more. What
/// the job gives itself stays. None where nothing is left to loosen.
[[nodiscard]] std::optional<Job> more_room(const Job& job, const Plan& plan);

/// The job with as many fibres as reach a hundredth more of the wall, where its own cannot join
/// courses that would; none where the job gives their number itself.
[[nodiscard]] std::optional<Job> more_fibres(const Job& job, const Plan& plan);

}  // namespace meshwind
