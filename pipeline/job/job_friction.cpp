#include "pipeline/job/job_friction.h"

#include <algorithm>

namespace meshwind {

Friction friction_of(const Job& job, std::size_t layer) {
    const bool on_fibre = layer > 0;
    return on_fibre ? job.tow.friction_on_fibre.value_or(job.tow.friction) : job.tow.friction;
}

Friction most_friction_of(const Job& job) {
    double most = 0.0;
    for (std::size_t layer = 0; layer < job.layers.size(); ++layer) {
        most = std::max(most, friction_of(job, layer).holds());
    }
    return most;
}

}  // namespace meshwind
