/// The friction law: the friction of each layer of a job.
#pragma once

#include <cstddef>

#include "pipeline/job/job.h"
#include "winding/plan/friction.h"

namespace meshwind {

/// Friction under a layer of the job; nothing else reads the job's friction. Another law, by
/// ground, layer or tension, belongs here.
/// \param layer counted from 0, which lies on the bare mandrel; all others lie on fibre
[[nodiscard]] Friction friction_of(const Job& job, std::size_t layer);

/// The largest of all layers: fibre that slips with it slips on all of them.
[[nodiscard]] Friction most_friction_of(const Job& job);

}  // namespace meshwind
