/// Axis values along the eye path, with the redundant spindle angle chosen by a policy.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/units.h"
#include "machines/machine.h"
#include "postproc/eye/eye_path.h"

namespace meshwind {

/// Choice of the mandrel's turn, which the eye position leaves free.
enum class RedundancyPolicy {
    /// The eye stays in the half-plane y = 0, x > 0 of the machine: the mandrel turns about +Z by
    /// -atan2(E_y, E_x), unwrapped so that each step is within half a turn.
    CentralAngle,
    /// The mandrel stands still at the central angle of the first eye point as long as the eye is
    /// within kHoldPlay_rad of the half-plane, and is dragged along beyond: a run is wound as with
    /// the central angle but late, and it does not turn round a branch.
    Hold,
    /// The same with kOscillatePlay_rad: round a branch it swings a little.
    Oscillate,
    /// The turns of the eye path.
    Chosen,
};

/// A run of neighbouring points at which one axis is beyond one end of its travel by more than half
/// of its resolution.
struct LimitViolation {
    char axis = '?';
    std::size_t first = 0;  ///< index of the run's first point in the eye path
    std::size_t last = 0;   ///< index of its last point
    std::size_t point = 0;  ///< the worst of them
    double value = 0.0;     ///< there, axis units (mm or rad)
    double limit = 0.0;     ///< the end that it passes, axis units
};

enum class JointNoteKind {
    WristNearSingular,   ///< measure: least WristState::singular_sine of the run
    WristFlip,           ///< measure: step of the wrist joint in rad, above a quarter turn
    EyeNearSpindleAxis,  ///< measure: least distance of the run in mm
    EyeOutOfReach,       ///< measure: largest distance of the run in mm between eye and eye point
};

/// Remark on a run of neighbouring points that slow the machine or hint at a bad set-up.
struct JointNote {
    JointNoteKind kind = JointNoteKind::WristNearSingular;
    std::size_t first = 0;
    std::size_t last = 0;
    double measure = 0.0;
};

struct JointPath {
    std::size_t axis_count = 0;
    std::vector<double> joints;  ///< n x axis_count by rows, one row per eye point; mm and rad
    std::vector<LimitViolation> violations;
    std::vector<JointNote> notes;
    double worst_twist_rad = 0.0;  ///< largest angle between roller and binormal; 0 with A and B
    /// Largest distance of the eye from where it should be; 0 with three linear axes.
    double worst_miss_mm = 0.0;

    [[nodiscard]] std::size_t size() const {
        return axis_count == 0 ? 0 : joints.size() / axis_count;
    }
    [[nodiscard]] std::span<const double> row(std::size_t point) const {
        return {joints.data() + point * axis_count, axis_count};
    }
};

/// Eyes that miss their place by less count as there: rounding of positions of some metres over a
/// thousand turns.
inline constexpr double kEyeThere_mm = 1e-6;

/// Below this distance the direction of the eye from the spindle axis is rounding noise of
/// positions of some metres; the policy CentralAngle then keeps the previous turn.
inline constexpr double kMinEyeRadius_mm = 1e-6;

/// Largest angle of the eye from the half-plane before the mandrel follows. Hold: up to the plane x
/// = 0 of the machine, where cross feeds end. Oscillate: for a head that can go up or down by half
/// of its distance from the spindle axis.
inline constexpr double kHoldPlay_rad = 0.5 * kPi;
inline constexpr double kOscillatePlay_rad = kPi / 6.0;

/// Turn of the mandrel about +Z of the machine at each eye point, in rad; n values, unwrapped.
/// The first one is within half a turn of zero. With a play, and c the turn by CentralAngle, each
/// turn is the one within the play of c that is nearest to the turn before: the backlash of a loose
/// gear. Source of holding and swinging: docs/post.md.
[[nodiscard]] std::vector<double> spindle_turns(const EyePath& path, RedundancyPolicy policy);

/// Axis values with the spindle turns given (n values). Steps of the wrist are the smallest
/// possible, starting from all axes at zero; where a head roll with end stops would run into one or
/// flip, from up to a turn further on or back, whichever has the least of both. Source:
/// fu_2009_post_processing, machine transform; the turn has the opposite sign of its C, which
/// counts the eye around the mandrel. Machines of any class (machines/eye_inverse.h); what the axes
/// do not reach is noted.
[[nodiscard]] JointPath solve_joints(const Machine& machine, const EyePath& path,
                                     std::span<const double> turns_rad);

/// Appends the runs of points beyond an axis' travel to `path.violations`.
void find_travel_violations(const Machine& machine, JointPath& path);

/// The same with the turns of a policy, or where axes are missing with those that the eye points
/// force (EyeInverse::forced_turn).
[[nodiscard]] JointPath solve_joints(const Machine& machine, const EyePath& path,
                                     RedundancyPolicy policy);

}  // namespace meshwind
