/// Setup of planning and verification: machine, job and mandrel, with derived data.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "machines/machine.h"
#include "mesh/mandrel.h"
#include "mesh/ray_query.h"
#include "pipeline/job/job.h"
#include "postproc/collision/collision.h"
#include "postproc/nc/dialect.h"
#include "postproc/verify/verify.h"
#include "winding/plan/friction.h"
#include "winding/plan/tow.h"
#include "winding/plan/turns.h"
#include "winding/turn/pin.h"

namespace meshwind {

/// Files of the inputs, as messages name them.
struct InputFiles {
    std::filesystem::path machine = "machine";
    std::filesystem::path job{};
};

struct Setup {
    Machine machine;
    Job job;
    Friction friction = 0.0;       ///< under the layer that is wound on this mandrel
    bool rule_of_machine = false;  ///< the machine keeps the job's eye rule by itself
    Mandrel mandrel;
    std::unique_ptr<Dialect> dialect;
    HeadEnvelope envelope;
    CollisionRule rule;
    std::unique_ptr<RayQuery> obstacles;   ///< mandrel, extensions and bodies that turn with them
    std::unique_ptr<LaydownSurface> wall;  ///< the surface with its extensions
    std::vector<PinRing> pins{};           ///< that stand on the extensions
};

/// Options for reading the mandrel of a job.
/// \param unit_mm overrides the job's units where > 0
/// \throws InputError job.blend_open where the blend is yet to be chosen (wind.h)
[[nodiscard]] MandrelOptions mandrel_options(const Job& job, double unit_mm = 0.0);

/// Setup for the first layer. \param machine from load_machine()
/// \param look_ahead called before steps that take longer than a second on large parts: rule,
/// obstacles and wall are not there yet. May refuse.
/// \throws InputError for input that cannot be used
[[nodiscard]] Setup make_setup(Mandrel mandrel, const Machine& machine, const Job& job,
                               const InputFiles& files = {},
                               const std::function<void(const Setup&)>& look_ahead = {});

/// The dialect that a machine file names. \throws InputError dialect.unknown with its place
[[nodiscard]] std::unique_ptr<Dialect> dialect_of(const Machine& machine,
                                                  const std::filesystem::path& file);

/// The same machine and job for another mandrel: the first one grown by the layers before.
/// \param layer wound on it, counted from 0
[[nodiscard]] Setup setup_for(const Setup& setup, Mandrel mandrel, std::size_t layer);

/// The tow for planning: with less than all friction.
[[nodiscard]] Tow planned_tow(const Setup& setup);

/// Puts the pins that a plan needs on the mandrel, as obstacles and as supports of the fibre. Where
/// the job gives no extensions they become as short as the pins allow.
void put_pins(Setup& setup, std::span<const PinRing> rings);

/// Whether to find the motion of least time: the job asks for it, and the machine leaves the
/// mandrel's turn free.
[[nodiscard]] bool wants_least_time(const Setup& setup);

/// Winds a program again and judges it by the job's tolerances. \param program as read from its
/// text, with the place of its tie-on \param plan to compare with; may be empty \param progress
/// receives the laid share
[[nodiscard]] Verification verify_program(const Setup& setup, const BlockList& program,
                                          const PlannedFibre& plan,
                                          const std::function<void(double share)>& progress = {});

}  // namespace meshwind
