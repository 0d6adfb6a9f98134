/// Verifies a program: winds it again from its text, the machine and the mandrel, and checks the
/// laid fibre and the motion.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "machines/machine.h"
#include "mesh/ray_query.h"
#include "postproc/collision/collision.h"
#include "postproc/motion/block.h"
#include "postproc/verify/check.h"
#include "postproc/verify/deviation.h"
#include "postproc/verify/laydown.h"
#include "winding/plan/friction.h"

namespace meshwind {

/// Limits for the laid fibre and the motion.
struct VerifyRules {
    CollisionRule collision;  ///< with the free fibre's shortest and longest length
    Friction friction = 0.2;
    double bridging_tolerance_mm = 0.5;
    double tow_width_mm = 6.0;
    std::optional<double> most_twist_per_m{};  ///< >= 0, turns of the band; none: any
    /// Path mode at corners that the machine's own lines set, Dialect::path_mode.
    PathMode path_mode{};
    LaydownTolerance laydown;
    LaydownOptions simulation;
};

/// A program that was read back, with its machine, wall and obstacles.
struct VerifyTask {
    const BlockList& program;  ///< as a dialect's reader gave it, with the place of its tie-on
    const Machine& machine;
    const HeadEnvelope& envelope;
    const LaydownSurface& wall;
    const RayQuery& obstacles;  ///< everything that can be hit
    const VerifyRules& rules;
    const PlannedFibre& plan;  ///< for the last comparison; empty: nothing is compared
};

/// A block in which the fibre runs faster than the machine can pay out.
struct FastBlock {
    std::size_t block = 0;
    double ratio = 1.0;  ///< of its fastest stretch to the machine's limit, > 1
};

struct Verification {
    LaidPath laid;
    std::vector<double> slip;  ///< per laid station, |kg| / kn
    std::optional<Deviation> deviation;
    double fibre_length_mm = 0.0;
    double duration_s = 0.0;
    std::size_t turned_over = 0;  ///< blocks in which the head goes over to the band's other side
    double shortest_free_mm = 0.0;
    double longest_free_mm = 0.0;
    std::vector<Check> checks;                     ///< by name as verify() lists them
    std::optional<std::size_t> first_wrong_block;  ///< the first at which a check fails
    std::vector<std::size_t> wrong_blocks;         ///< ascending: all at which a check fails
    /// Blocks, ascending, to be made finer: those of laid stations beyond a tolerance with
    /// the way over which the fibre was pulled there, those in which something is hit, and those
    /// with a free length that the machine cannot wind with.
    std::vector<std::size_t> coarse_blocks;
    std::vector<FastBlock> fast_blocks;  ///< blocks that need more time, ascending
};

/// Where the program ties the fibre on, mandrel frame. \throws InputError verify.tie_on where it
/// does not say
[[nodiscard]] Eigen::Vector3d tie_on_of(const BlockList& program);

/// Lays the fibre (laydown.h) and checks on it, where the program was read from a text:
///  - tie_on, approach, path_mode: verify_head.h;
/// and always:
///  - laydown: the simulation reaches the end; against the plan, where there is one, sideways
///    deviation and angle are within tolerance and the last landing point is the planned one;
///  - slip: |kg / kn| of the laid path <= the friction (laid_slip.h);
///  - bridging: height of the straight fibre over the wall;
///  - collision: free fibre and head, swept between the samples;
///  - free_length: within the machine's limits;
///  - roller: the fibre leaves it at a right angle (roller_check.h);
///  - limits: travel, velocity and acceleration of the axes, and corners cut no more than the
///    controller may (axis_loads.h);
///  - payout: speed of the fibre through the eye, and length to be taken back, which is slack.
/// The words of a failed check name the block and its line.
/// A cancellation point again and again.
/// \throws InputError verify.too_long (laydown.h); verify.tie_on without a tie-on, or with one off
/// the mandrel
[[nodiscard]] Verification verify(const VerifyTask& task);

/// The landing points that the program lays, as a table with the columns
/// `block,line,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,slip,bridge_mm`.
[[nodiscard]] std::string laid_csv(const Verification& verification, const BlockList& program);

}  // namespace meshwind
