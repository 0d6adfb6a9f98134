#include "postproc/motion/joint_path.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/interrupt.h"
#include "machines/eye_inverse.h"

namespace meshwind {
namespace {

// A wrist within 1 degree of its singular pose asks for 57 times the speed of the fibre's turn.
constexpr double kNearSingularSine = 0.0175;
// An eye this near to the axis asks for a quarter turn of the spindle per few mm of path.
constexpr double kNearAxis_mm = 5.0;
// A way to begin is judged by every so many points of a path.
constexpr std::size_t kCoarse = 8;
// Axis::resolution_nano counts these per mm or degree.
constexpr double kNanoPerUnit = 1e9;

double eye_radius_mm(const EyePoint& point) {
    return std::hypot(point.eye_mm.x(), point.eye_mm.y());
}

// Extends the latest note of this kind when it ends just before `point`, else opens a new one.
void note(JointPath& path, JointNoteKind kind, std::size_t point, double measure) {
    const auto latest = std::find_if(path.notes.rbegin(), path.notes.rend(),
                                     [kind](const JointNote& other) { return other.kind == kind; });
    if (latest != path.notes.rend() && latest->last + 1 == point) {
        latest->last = point;
        const bool most = kind == JointNoteKind::WristFlip || kind == JointNoteKind::EyeOutOfReach;
        latest->measure =
            most ? std::max(latest->measure, measure) : std::min(latest->measure, measure);
    } else {
        path.notes.push_back({.kind = kind, .first = point, .last = point, .measure = measure});
    }
}

// Half of the smallest increment in axis units: what is less beyond a limit is not written.
double half_step(const Axis& axis) {
    const double step = static_cast<double>(axis.resolution_nano) / kNanoPerUnit;
    return 0.5 * (axis.type == AxisType::Rotary ? rad_from_deg(step) : step);
}

// Appends the runs in which `joint` passes one end of its travel.
void find_violations(const Axis& axis, std::size_t joint, JointPath& path) {
    const double slack = half_step(axis);
    for (const double side : {-1.0, 1.0}) {
        const double limit = side < 0.0 ? axis.min : axis.max;
        bool open = false;
        for (std::size_t i = 0; i < path.size(); ++i) {
            const double value = path.row(i)[joint];
            if (!(side * (value - limit) > slack)) {
                open = false;
                continue;
            }
            if (!open) {
                path.violations.push_back({.axis = axis.letter,
                                           .first = i,
                                           .last = i,
                                           .point = i,
                                           .value = value,
                                           .limit = limit});
                open = true;
            }
            LimitViolation& latest = path.violations.back();
            latest.last = i;
            if (side * (value - latest.value) > 0.0) {
                latest.point = i;
                latest.value = value;
            }
        }
    }
}

EyeTarget target_of(const EyePoint& point) {
    return {.eye_mm = point.eye_mm, .tangent = point.tangent, .binormal = point.binormal};
}

JointPath solve_from(const Machine& machine, const EyeInverse& inverse, const EyePath& path,
                     std::span<const double> turns_rad, std::vector<double> joints) {
    JointPath result;
    result.axis_count = machine.axis_count();
    result.joints.resize(path.size() * result.axis_count);
    for (std::size_t i = 0; i < path.size(); ++i) {
        check_interrupt();
        const WristState state = inverse.solve(target_of(path[i]), turns_rad[i], joints, joints);
        std::copy(joints.begin(), joints.end(),
                  result.joints.begin() + static_cast<std::ptrdiff_t>(i * result.axis_count));
        result.worst_twist_rad = std::max(result.worst_twist_rad, state.twist_rad);
        result.worst_miss_mm = std::max(result.worst_miss_mm, state.residual_mm);
        if (state.singular_sine < kNearSingularSine) {
            note(result, JointNoteKind::WristNearSingular, i, state.singular_sine);
        }
        if (state.flip && i > 0) {
            note(result, JointNoteKind::WristFlip, i, state.flip_rad);
        }
        if (eye_radius_mm(path[i]) < kNearAxis_mm) {
            note(result, JointNoteKind::EyeNearSpindleAxis, i, eye_radius_mm(path[i]));
        }
        if (state.residual_mm > kEyeThere_mm) {
            note(result, JointNoteKind::EyeOutOfReach, i, state.residual_mm);
        }
    }
    find_travel_violations(machine, result);
    return result;
}

// Points beyond the travel of an axis, and flips.
std::size_t troubles(const JointPath& path, std::optional<char> letter) {
    std::size_t count = 0;
    for (const LimitViolation& violation : path.violations) {
        count += !letter || violation.axis == *letter ? violation.last - violation.first + 1 : 0;
    }
    for (const JointNote& note : path.notes) {
        count += note.kind == JointNoteKind::WristFlip ? 1 : 0;
    }
    return count;
}

// How far the motion stays away from singular poses where it is nearest to one; 1 where no note
// speaks of it.
double singular_sine(const JointPath& path) {
    double least = 1.0;
    for (const JointNote& note : path.notes) {
        least =
            note.kind == JointNoteKind::WristNearSingular ? std::min(least, note.measure) : least;
    }
    return least;
}

// Of the ways to begin the one with the least trouble, then, where all come within a degree of a
// singular pose, the one that stays farthest away; every kCoarse-th point tells.
const std::vector<double>& best_start(const Machine& machine, const EyeInverse& inverse,
                                      const EyePath& path, std::span<const double> turns_rad,
                                      std::span<const std::vector<double>> starts) {
    EyePath coarse;
    std::vector<double> coarse_turns_rad;
    for (std::size_t i = 0; i < path.size(); i += kCoarse) {
        coarse.push_back(path[i]);
        coarse_turns_rad.push_back(turns_rad[i]);
    }
    std::size_t best = 0;
    std::size_t least = 0;
    double farthest = 0.0;
    for (std::size_t k = 0; k < starts.size(); ++k) {
        const JointPath joints = solve_from(machine, inverse, coarse, coarse_turns_rad, starts[k]);
        const std::size_t count = troubles(joints, {});
        const double sine = singular_sine(joints);
        if (k == 0 || count < least || (count == least && sine > farthest)) {
            best = k;
            least = count;
            farthest = sine;
        }
    }
    return starts[best];
}

// From all axes at zero, or from where an arm can begin. A head roll with end stops that runs into
// one on the way may start half a turn or a turn further back: the roller is the same.
JointPath solve(const Machine& machine, const EyeInverse& inverse, const EyePath& path,
                std::span<const double> turns_rad) {
    if (inverse.has_branches() && !path.empty()) {
        const std::vector<std::vector<double>> starts =
            inverse.starts(target_of(path.front()), turns_rad.front());
        if (!starts.empty()) {
            return solve_from(machine, inverse, path, turns_rad,
                              best_start(machine, inverse, path, turns_rad, starts));
        }
    }
    const std::vector<double> zero(machine.axis_count(), 0.0);
    JointPath best = solve_from(machine, inverse, path, turns_rad, zero);
    std::size_t roll = machine.mandrel_chain.size();
    while (roll < machine.axis_count() && machine.axis(roll).type != AxisType::Rotary) {
        ++roll;
    }
    if (roll == machine.axis_count()) {
        return best;
    }
    const Axis& axis = machine.axis(roll);
    if (!std::isfinite(axis.min) && !std::isfinite(axis.max)) {
        return best;
    }
    for (const double half_turns : {1.0, -1.0, 2.0, -2.0}) {
        const std::size_t least = troubles(best, axis.letter);
        if (least == 0) {
            break;
        }
        std::vector<double> start = zero;
        start[roll] = half_turns * kPi;
        JointPath other = solve_from(machine, inverse, path, turns_rad, start);
        if (troubles(other, axis.letter) < least) {
            best = std::move(other);
        }
    }
    return best;
}

double play_rad(RedundancyPolicy policy) {
    switch (policy) {
        case RedundancyPolicy::Hold:
            return kHoldPlay_rad;
        case RedundancyPolicy::Oscillate:
            return kOscillatePlay_rad;
        default:
            return 0.0;
    }
}

}  // namespace

std::vector<double> spindle_turns(const EyePath& path, RedundancyPolicy policy) {
    std::vector<double> turns(path.size(), 0.0);
    if (policy == RedundancyPolicy::Chosen) {
        std::transform(path.begin(), path.end(), turns.begin(),
                       [](const EyePoint& point) { return point.turn_rad; });
        return turns;
    }
    const double play = play_rad(policy);
    double central = 0.0;
    double turn = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (eye_radius_mm(path[i]) > kMinEyeRadius_mm) {
            const double wrapped =
                path[i].azimuth_rad - std::atan2(path[i].eye_mm.y(), path[i].eye_mm.x());
            central += std::remainder(wrapped - central, 2.0 * kPi);
        }
        turn = i == 0 ? central : std::clamp(turn, central - play, central + play);
        turns[i] = turn;
    }
    return turns;
}

JointPath solve_joints(const Machine& machine, const EyePath& path,
                       std::span<const double> turns_rad) {
    assert(turns_rad.size() == path.size());
    const std::unique_ptr<EyeInverse> inverse = make_eye_inverse(machine);
    return solve(machine, *inverse, path, turns_rad);
}

void find_travel_violations(const Machine& machine, JointPath& path) {
    for (std::size_t joint = 0; joint < path.axis_count; ++joint) {
        find_violations(machine.axis(joint), joint, path);
    }
}

JointPath solve_joints(const Machine& machine, const EyePath& path, RedundancyPolicy policy) {
    const std::unique_ptr<EyeInverse> inverse = make_eye_inverse(machine);
    std::vector<double> turns = spindle_turns(path, policy);
    double before = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        turns[i] = inverse->forced_turn(target_of(path[i]), before).value_or(turns[i]);
        before = turns[i];
    }
    return solve(machine, *inverse, path, turns);
}

}  // namespace meshwind
