/// A small pipe, a job and the machines that wind it within a second, for the tests of pipeline/.
#pragma once

#include <functional>
#include <ostream>
#include <string>

#include "core/error.h"
#include "mesh/mandrel.h"
#include "pipeline/job/job.h"
#include "pipeline/load_inputs.h"
#include "tests/support/fixtures.h"

namespace meshwind::test {

inline constexpr double kPipeRadius_mm = 30.0;
inline constexpr double kPipeLength_mm = 120.0;
inline constexpr double kPipeAngle_deg = 50.0;
inline constexpr double kPipeTow_mm = 12.0;

/// About z, its rims at z = -60 and 60 mm. Edges of 6 mm on a radius of 30: a chord is 0.15 mm
/// below the arc, edge^2 / (8 radius), and the curved patches are off it by fourth order.
inline Mandrel small_pipe() {
    return made_cylinder(kPipeRadius_mm, kPipeLength_mm, 6.0);
}

/// One helical layer at 50 degrees of a tow of 12 mm.
inline Job pipe_job(LayerKind kind = LayerKind::Helical) {
    Job job;
    job.tow.width_mm = kPipeTow_mm;
    job.layers.front().kind = kind;
    if (kind == LayerKind::Helical) {
        job.layers.front().angle_deg = kPipeAngle_deg;
    }
    return job;
}

/// The same without the search for the motion of least time, which takes as long as all else.
inline Job quick_job(LayerKind kind = LayerKind::Helical) {
    Job job = pipe_job(kind);
    job.redundancy = RedundancyRule::CentralAngle;
    return job;
}

/// A machine as it is shipped in machines/.
inline Machine shipped(const std::string& name) {
    return load_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/" + name + ".json");
}

/// What is refused, by code and place; both empty where nothing is.
struct Refused {
    std::string code;
    std::string place;

    friend bool operator==(const Refused&, const Refused&) = default;
};

inline Refused refusal_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.code(), error.place()};
    }
    return {};
}

inline void PrintTo(const Refused& refused, std::ostream* out) {
    *out << refused.code << " at \"" << refused.place << '"';
}

}  // namespace meshwind::test
