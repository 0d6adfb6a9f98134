/// The friction law: what a job says of friction, as a layer has it.
#pragma once

#include <cstddef>

#include "pipeline/job/job.h"
#include "winding/plan/friction.h"

namespace meshwind {

/// Under a layer of the job; nothing else reads the job's friction. Another law, by ground, layer
/// or tension, is written here.
/// \param layer counted from 0, which lies on the bare mandrel; all others lie on fibre
[[nodiscard]] Friction friction_of(const Job& job, std::size_t layer);

/// The largest of all layers: what it does not hold none of them holds.
[[nodiscard]] Friction most_friction_of(const Job& job);

}  // namespace meshwind
