#include "postproc/ringhead/carry_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/verify/check_kinds.h"

namespace meshwind {
namespace {

// Rounding to a program's digits moves no axis by more.
constexpr double kRounded_mm = 1e-3;
constexpr double kRounded_deg = 1e-4;
// Loads are compared with 1; speeds are rounded up by at most a millionth m/s in a slow move.
constexpr double kLoadSlack = 1e-3;

std::string at_place(double s_mm) {
    return " at " + fixed(s_mm, 1) + " mm";
}

std::string at_sample(const std::vector<CarriedSample>& samples, std::size_t sample) {
    return at_place(samples[sample].s_mm);
}

Check made_check(const CheckKind& kind, bool ok, const std::string& words,
                 std::map<std::string, double> numbers) {
    return Check(kind, ok, ok ? "" : words, std::move(numbers));
}

// The axis that is furthest beyond its travel, in words.
std::string travel_words(const Machine& machine, const CarriedJoints& joints,
                         const std::vector<CarriedSample>& samples) {
    double most = 0.0;
    std::string words;
    for (const LimitViolation& run : joints.path.violations) {
        const double beyond = std::abs(run.value - run.limit);
        if (beyond > most) {
            most = beyond;
            words = "A" + std::to_string(machine.joint_of(run.axis).value() + 1) + " goes to " +
                    fixed(deg_from_rad(run.value), 2) + " deg" + at_sample(samples, run.point) +
                    " of the axis, " + fixed(deg_from_rad(beyond), 2) +
                    " deg beyond its end; mount the frame in another way";
        }
    }
    return words;
}

}  // namespace

Check ring_fit_check(const RingFit& fit, double ring_radius_mm) {
    const std::string words =
        fit.through ? "the frame reaches " + fixed(fit.reach_mm, 2) +
                          " mm from the centre of a ring of " + fixed(ring_radius_mm, 2) +
                          " mm while its axis" + at_place(fit.s_mm) + " is in the head"
                    : "the frame turns back inside the head while its axis" + at_place(fit.s_mm) +
                          " is in the middle; the bend is too tight for this head";
    return made_check(check_kind::kRing, fit.through && fit.reach_mm < ring_radius_mm, words,
                      {{"reach_mm", fit.reach_mm},
                       {"limit_mm", ring_radius_mm},
                       {"offset_mm", fit.offset_mm},
                       {"tilt_deg", deg_from_rad(fit.tilt_rad)}});
}

Check pose_reach_check(const CarriedJoints& joints, const std::vector<CarriedSample>& samples) {
    return made_check(
        check_kind::kReach, joints.reached(),
        "the robot stays " + fixed(joints.residual_mm, 3) + " mm and " +
            fixed(deg_from_rad(joints.residual_rad), 3) + " deg short" +
            at_sample(samples, joints.residual_at) + " of the axis; mount the frame in another way",
        {{"short_mm", joints.residual_mm}, {"short_deg", deg_from_rad(joints.residual_rad)}});
}

Check carried_limits_check(const Machine& machine, const CarriedJoints& joints,
                           const std::vector<CarriedSample>& samples, const AxisLoads& loads,
                           const std::vector<double>& s_mm) {
    std::string words = travel_words(machine, joints, samples);
    for (const auto& [name, load] :
         {std::pair("velocity", loads.velocity), std::pair("acceleration", loads.acceleration)}) {
        if (words.empty() && load.ratio > 1.0 + kLoadSlack) {
            words = "A" + std::to_string(load.joint + 1) + " needs " + fixed(load.ratio, 3) +
                    " times its " + name + at_place(s_mm[load.step]) +
                    " of the axis; pass more slowly";
        }
    }
    return made_check(check_kind::kLimits, words.empty(), words,
                      {{"travel_violations", static_cast<double>(joints.path.violations.size())},
                       {"velocity_ratio", loads.velocity.ratio},
                       {"acceleration_ratio", loads.acceleration.ratio}});
}

Check wrist_flip_check(const CarriedJoints& joints, const std::vector<CarriedSample>& samples) {
    return made_check(
        check_kind::kWrist, joints.flips == 0,
        "an axis jumps by more than a quarter turn" + at_sample(samples, joints.first_flip) +
            " of the axis; mount the frame in another way",
        {{"flips", static_cast<double>(joints.flips)}, {"least_singular", joints.singular}});
}

Check frame_clearance_check(const FrameClearance& found, const std::vector<CarriedSample>& samples,
                            double clearance_mm) {
    return made_check(check_kind::kClearance, found.least_mm >= clearance_mm,
                      "the frame comes within " + fixed(found.least_mm, 2) + " mm of body " +
                          std::to_string(found.body + 1) + " of the machine file" +
                          at_sample(samples, found.sample) +
                          " of the axis; mount the frame in another way",
                      {{"least_mm", found.least_mm}, {"limit_mm", clearance_mm}});
}

CarriedMovesError carried_moves_error(const RingHead& head, const FrameAxis& axis,
                                      const std::vector<double>& s_mm, const KrlProgram& program,
                                      const CarryRequest& request) {
    CarriedMovesError found;
    CarryError& largest = found.largest;
    for (std::size_t i = 1; i < s_mm.size(); ++i) {
        const CarryError error =
            lin_error(head, axis, s_mm[i - 1], s_mm[i], pose_of(program.moves[i - 1].to),
                      pose_of(program.moves[i].to));
        const double share = std::max(error.distance_mm / request.tolerance_mm,
                                      deg_from_rad(error.turn_rad) / request.tolerance_deg);
        if (share > found.share) {
            found.share = share;
            found.share_s_mm = s_mm[i - 1];
        }
        largest.distance_mm = std::max(largest.distance_mm, error.distance_mm);
        largest.tilt_rad = std::max(largest.tilt_rad, error.tilt_rad);
        largest.turn_rad = std::max(largest.turn_rad, error.turn_rad);
    }
    return found;
}

Check interpolation_error_check(const CarriedMovesError& error, const CarryRequest& request) {
    const CarryError& largest = error.largest;
    return made_check(
        check_kind::kInterpolation, error.share <= 1.0,
        "between two points the axis leaves the centre by up to " + fixed(largest.distance_mm, 4) +
            " mm and turns by up to " + fixed(deg_from_rad(largest.turn_rad), 4) + " deg, worst" +
            at_place(error.share_s_mm) + ", and shorter moves do not help; smooth the axis there",
        {{"distance_mm", largest.distance_mm},
         {"limit_mm", request.tolerance_mm},
         {"tilt_deg", deg_from_rad(largest.tilt_rad)},
         {"turn_deg", deg_from_rad(largest.turn_rad)},
         {"limit_deg", request.tolerance_deg}});
}

CarryError carried_points_error(const RingHead& head, const FrameAxis& axis,
                                const std::vector<double>& s_mm, const KrlProgram& program) {
    CarryError largest;
    for (std::size_t i = 0; i < s_mm.size(); ++i) {
        const CarryError error = carry_error(head, pose_of(program.moves[i].to), axis.at(s_mm[i]));
        largest.distance_mm = std::max(largest.distance_mm, error.distance_mm);
        largest.turn_rad = std::max(largest.turn_rad, error.turn_rad);
    }
    return largest;
}

Check krl_rounding_check(bool same, const CarryError& at_points) {
    const bool ok = same && at_points.distance_mm <= kRounded_mm &&
                    deg_from_rad(at_points.turn_rad) <= kRounded_deg;
    return made_check(
        check_kind::kRounding, ok,
        "the program that is read back is up to " + fixed(at_points.distance_mm, 6) + " mm and " +
            fixed(deg_from_rad(at_points.turn_rad), 6) + " deg off at its points",
        {{"worst_mm", at_points.distance_mm}, {"worst_deg", deg_from_rad(at_points.turn_rad)}});
}

}  // namespace meshwind
