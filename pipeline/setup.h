/// What planning and verifying start from: machine, job and mandrel, and what follows from them.
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
    bool rule_of_machine = false;  ///< the job's eye rule is what the machine keeps to by itself
    Mandrel mandrel;
    std::unique_ptr<Dialect> dialect;
    HeadEnvelope envelope;
    CollisionRule rule;
    std::unique_ptr<RayQuery> obstacles;   ///< mandrel, extensions and bodies that turn with them
    std::unique_ptr<LaydownSurface> wall;  ///< the surface with its extensions
    std::vector<PinRing> pins{};           ///< that stand on the extensions
};

/// How a job asks for its mandrel to be read.
/// \param unit_mm overrides the job's units where > 0
/// \throws InputError job.blend_open where the blend is yet to be chosen (wind.h)
[[nodiscard]] MandrelOptions mandrel_options(const Job& job, double unit_mm = 0.0);

/// For the first layer. \param machine as load_machine() has it
/// \param look_ahead called before what takes longer than a second on large parts: rule, obstacles
/// and wall are not there yet. May refuse.
/// \throws InputError for input that cannot be used
[[nodiscard]] Setup make_setup(Mandrel mandrel, const Machine& machine, const Job& job,
                               const InputFiles& files = {},
                               const std::function<void(const Setup&)>& look_ahead = {});

/// The dialect that a machine file names. \throws InputError dialect.unknown with its place
[[nodiscard]] std::unique_ptr<Dialect> dialect_of(const Machine& machine,
                                                  const std::filesystem::path& file);

/// The same machine and job for another mandrel: what the layers before have made of the first.
/// \param layer that is wound on it, counted from 0
[[nodiscard]] Setup setup_for(const Setup& setup, Mandrel mandrel, std::size_t layer);

/// The tow that is planned with: with less than all friction.
[[nodiscard]] Tow planned_tow(const Setup& setup);

/// Puts the pins that a plan needs on the mandrel: what can be hit, and what holds the fibre. Where
/// the job gives no extensions they become as short as the pins allow.
void put_pins(Setup& setup, std::span<const PinRing> rings);

/// Whether the motion of least time is to be found: the job asks for it, and the machine leaves the
/// turn of the mandrel free.
[[nodiscard]] bool wants_least_time(const Setup& setup);

/// Winds a program again and judges it by the job's tolerances. \param program as read from its
/// text, with the place of its tie-on \param plan to compare with; may be empty \param progress is
/// told the share that is laid
[[nodiscard]] Verification verify_program(const Setup& setup, const BlockList& program,
                                          const PlannedFibre& plan,
                                          const std::function<void(double share)>& progress = {});

}  // namespace meshwind
