#include "pipeline/job/job_friction.h"

#include <algorithm>

namespace meshwind {

Friction friction_of(const Job& job, std::size_t layer) {
    const bool on_fibre = layer > 0;
    return on_fibre ? job.tow.friction_on_fibre.value_or(job.tow.friction) : job.tow.friction;
}

Friction most_friction_of(const Job& job) {
    const bool on_fibre = job.layers.size() > 1 || job.layers.front().kind == LayerKind::Wall;
    return std::max(friction_of(job, 0).holds(), friction_of(job, on_fibre ? 1 : 0).holds());
}

}  // namespace meshwind
