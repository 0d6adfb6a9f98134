#include "postproc/verify/motion_checks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/margins.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/motion/axis_loads.h"
#include "postproc/verify/check_kinds.h"
#include "postproc/verify/verify_head.h"

namespace meshwind {
namespace {

constexpr double kMmPerM = 1000.0;

// Rounding of positions and of the six digits of F against a limit that is just kept.
constexpr double kLimitSlack = 1e-3;

// The machine's, with room for the eye between the ends of blocks and for fibre that bridges.
std::pair<double, double> free_length_limits_mm(const VerifyTask& task) {
    const FreeFibreRule& rule = task.rules.collision.free_fibre;
    return {rule.min_mm - margin::kFreeLength_mm, rule.max_mm + task.wall.bridge_reach_mm()};
}

std::string free_length_words(const VerifyTask& task, double length_mm, std::size_t block) {
    const FreeFibreRule& rule = task.rules.collision.free_fibre;
    const auto [least_mm, most_mm] = free_length_limits_mm(task);
    const bool longer = length_mm > most_mm;
    const FixedPair shown = fixed_apart(length_mm, longer ? most_mm : least_mm, 1);
    return "the free length is " + shown.value + " mm in " + block_words(task.program, block) +
           ", " + (longer ? "over the " : "under the ") + shown.limit + " mm that the machine's " +
           (longer ? "longest of " + fixed(rule.max_mm, 1)
                   : "shortest of " + fixed(rule.min_mm, 1)) +
           " mm allows";
}

std::string past_end_words(const VerifyTask& task, const LimitViolation& past) {
    const std::size_t joint = task.machine.joint_of(past.axis).value_or(0);
    const bool rotary = task.machine.axis(joint).type == AxisType::Rotary;
    const double unit = rotary ? deg_from_rad(1.0) : 1.0;
    const FixedPair shown = fixed_apart(unit * past.value, unit * past.limit, 2);
    const std::string name = rotary ? " deg" : " mm";
    return std::string("axis ") + past.axis + " goes to " + shown.value + name +
           ", past its end at " + shown.limit + name + ", from " +
           block_words(task.program, past.first) + " on";
}

// An axis past its end fails the check: the one that is first.
void judge_travel(CheckFinding& finding, const VerifyTask& task, const LaidPath& laid,
                  const std::vector<LimitViolation>& violations) {
    if (!violations.empty()) {
        const LimitViolation& first = *std::min_element(
            violations.begin(), violations.end(),
            [](const LimitViolation& a, const LimitViolation& b) { return a.first < b.first; });
        put_at_block(finding.check, laid, first.first);
        finding.fail(first.first, past_end_words(task, first));
    }
}

// A load beyond its limit fails the check, unless something before has.
void judge_load(CheckFinding& finding, const VerifyTask& task, const LaidPath& laid,
                const AxisLoad& load, const std::string& what) {
    if (load.ratio > 1.0 + kLimitSlack && finding.check.ok) {
        put_at_block(finding.check, laid, load.step);
        finding.fail(load.step, std::string("axis ") + task.machine.axis(load.joint).letter +
                                    " needs " + fixed_apart(load.ratio, 1.0, 3).value +
                                    " times its " + what + " in " +
                                    block_words(task.program, load.step));
    }
}

// And so does a corner that is cut too far.
void judge_corner(CheckFinding& finding, const VerifyTask& task, const LaidPath& laid,
                  const CornerCut& corner, double limit_mm) {
    if (corner.mm > limit_mm * (1.0 + kLimitSlack) && finding.check.ok) {
        put_at_block(finding.check, laid, corner.step);
        const FixedPair shown = fixed_apart(corner.mm, limit_mm, 3);
        finding.fail(corner.step, "rounding the corner after " +
                                      block_words(task.program, corner.step) + " takes " +
                                      shown.value + " mm, more than the controller's " +
                                      shown.limit + " mm");
    }
}

}  // namespace

CheckFinding collision_finding(const VerifyTask& task, const LaidPath& laid) {
    CollisionRule rule = task.rules.collision;
    rule.least_only = true;
    const CollisionReport report = check_collisions(task.machine, task.envelope, task.obstacles,
                                                    laid.samples, laid.joints, rule);
    CheckFinding finding(check_kind::kCollision);
    Check& check = finding.check;
    check.numbers = {{"fibre_hits", static_cast<double>(report.fibre_hits.size())},
                     {"head_hits", static_cast<double>(report.head_hits.size())},
                     {"min_clearance_mm", report.min_clearance_mm}};
    if (!task.envelope.bodies.empty()) {
        check.numbers["body_hits"] = static_cast<double>(report.body_hits.size());
    }
    for (const auto* const hits : {&report.fibre_hits, &report.head_hits, &report.body_hits}) {
        for (const std::size_t sample : *hits) {
            finding.add_coarse(laid.block[sample]);
        }
    }
    const auto judge = [&](const std::vector<std::size_t>& hits, const std::string& words) {
        if (!hits.empty() && check.ok) {
            const std::size_t sample = hits.front();
            put_at_sample(check, laid, sample);
            finding.fail(laid.block[sample], words + " in " +
                                                 block_words(task.program, laid.block[sample]) +
                                                 place_words(laid.samples[sample].landing_mm));
        }
    };
    const std::string what = task.envelope.bodies.empty() ? "the mandrel" : "the mandrel or a body";
    judge(report.fibre_hits, "the free fibre meets " + what);
    judge(report.head_hits, "the head comes within " + fixed(task.rules.collision.clearance_mm, 1) +
                                " mm of " + what);
    judge(report.body_hits, "the mandrel meets a body that does not turn with it");
    return finding;
}

FreeLengthRange free_length_range(const LaidPath& laid) {
    FreeLengthRange range;
    for (std::size_t i = 0; i < laid.samples.size(); ++i) {
        const double length = laid.samples[i].free_length_mm;
        if (length < range.shortest_mm) {
            range.shortest_mm = length;
            range.shortest_at = i;
        }
        range.longest_mm = std::max(range.longest_mm, length);
    }
    return range;
}

CheckFinding free_length_finding(const VerifyTask& task, const LaidPath& laid,
                                 const FreeLengthRange& range) {
    const auto [least_mm, most_mm] = free_length_limits_mm(task);
    CheckFinding finding(check_kind::kFreeLength);
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < laid.samples.size(); ++i) {
        const double length = laid.samples[i].free_length_mm;
        if (length < least_mm || length > most_mm) {
            first = first.value_or(i);
            finding.add_coarse(laid.block[i]);
        }
    }
    finding.check.numbers = {{"min_mm", range.shortest_mm},
                             {"max_mm", range.longest_mm},
                             {"limit_min_mm", least_mm},
                             {"limit_max_mm", most_mm}};
    put_at_sample(finding.check, laid, first.value_or(range.shortest_at));
    if (first) {
        finding.fail(
            laid.block[*first],
            free_length_words(task, laid.samples[*first].free_length_mm, laid.block[*first]));
    }
    return finding;
}

CheckFinding roller_finding(const VerifyTask& task, const LaidPath& laid,
                            const RollerFinding& roller) {
    CheckFinding finding(check_kind::kRoller);
    Check& check = finding.check;
    check.numbers = {{"worst_deg", deg_from_rad(roller.worst_rad)},
                     {"limit_deg", deg_from_rad(kRollerOff_rad)},
                     {"mean_twist_deg", deg_from_rad(roller.mean_twist_rad)},
                     {"worst_twist_deg", deg_from_rad(roller.worst_twist_rad)},
                     {"turned_over", static_cast<double>(roller.turned_over)}};
    // A program that lays no fibre twists none.
    const double laid_m = laid.path.back().s_mm / kMmPerM;
    const double turns_per_m = laid_m > 0.0 ? roller.turned_rad / (2.0 * kPi) / laid_m : 0.0;
    check.numbers["twist_per_m"] = turns_per_m;
    put_at_sample(check, laid, roller.wrong_sample.value_or(roller.worst_sample));
    const bool asked = !task.program.head || keeps_form(task);
    if (roller.wrong_sample && asked) {
        const std::size_t block = laid.block[*roller.wrong_sample];
        finding.fail(block, "the fibre leans " + fixed(deg_from_rad(roller.wrong_rad), 2) +
                                " deg off the square to the roller, " +
                                fixed(deg_from_rad(roller.wrong_rad - roller.forced_rad), 2) +
                                " deg more than the machine forces, first in " +
                                block_words(task.program, block));
    }
    const std::optional<double>& most = task.rules.most_twist_per_m;
    if (most) {
        check.numbers["limit_twist_per_m"] = *most;
        if (check.ok && turns_per_m > *most) {
            check.ok = false;
            check.words = "the head twists the band by " + fixed(turns_per_m, 3) +
                          " turns a metre, more than " + fixed(*most, 3) +
                          ", and goes over to its other side " +
                          std::to_string(roller.turned_over) + " times";
        }
    }
    return finding;
}

CheckFinding limits_finding(const VerifyTask& task, const LaidPath& laid) {
    JointPath joints = joint_path(task.program);
    std::vector<double> step_s;
    for (const Block& block : task.program.blocks) {
        step_s.push_back(block.duration_s);
    }
    find_travel_violations(task.machine, joints);
    const AxisLoads loads = axis_loads(task.machine, joints, step_s);
    CheckFinding finding(check_kind::kLimits);
    Check& check = finding.check;
    put_at_block(check, laid,
                 loads.acceleration.ratio > loads.velocity.ratio ? loads.acceleration.step
                                                                 : loads.velocity.step);
    check.numbers = {{"violations", static_cast<double>(joints.violations.size())},
                     {"velocity_ratio", loads.velocity.ratio},
                     {"acceleration_ratio", loads.acceleration.ratio},
                     {"corner_mm", loads.linear.mm},
                     {"corner_eye_mm", loads.eye.mm}};
    const double corner_limit = corner_limit_mm(task);
    if (!std::isinf(corner_limit)) {
        check.numbers.emplace("limit_corner_mm", corner_limit);
    }
    judge_travel(finding, task, laid, joints.violations);
    judge_load(finding, task, laid, loads.velocity, "velocity");
    judge_load(finding, task, laid, loads.acceleration, "acceleration");
    judge_corner(finding, task, laid, loads.linear.mm > loads.eye.mm ? loads.linear : loads.eye,
                 corner_limit);
    return finding;
}

LaidPayout find_payout(const LaidPath& laid, const FibreLimits& limits) {
    LaidPayout payout;
    double paid_most = -std::numeric_limits<double>::infinity();
    double before = 0.0;
    for (std::size_t i = 0; i < laid.samples.size(); ++i) {
        const double paid = laid.samples[i].s_mm + laid.samples[i].free_length_mm;
        const double dt = i > 0 ? laid.time_s[i] - laid.time_s[i - 1] : 0.0;
        if (dt > 0.0) {
            const double speed = std::abs(paid - before) / dt;
            payout.fastest_mm_s = std::max(payout.fastest_mm_s, speed);
            if (speed > limits.max_speed_mm_s * (1.0 + kLimitSlack)) {
                payout.too_fast = payout.too_fast.value_or(i);
                std::vector<FastBlock>& fast = payout.fast_blocks;
                const double ratio = speed / limits.max_speed_mm_s;
                if (fast.empty() || fast.back().block != laid.block[i]) {
                    fast.push_back({laid.block[i], ratio});
                }
                fast.back().ratio = std::max(fast.back().ratio, ratio);
            }
        }
        paid_most = std::max(paid_most, paid);
        if (paid_most - paid > payout.back_mm) {
            payout.back_mm = paid_most - paid;
            payout.back_at = i;
        }
        if (!payout.slack && paid_most - paid > limits.take_up_mm) {
            payout.slack = i;
        }
        before = paid;
    }
    return payout;
}

CheckFinding payout_finding(const VerifyTask& task, const LaidPath& laid,
                            const LaidPayout& payout) {
    const FibreLimits& limits = task.machine.fibre;
    CheckFinding finding(check_kind::kPayout);
    for (const FastBlock& fast : payout.fast_blocks) {
        finding.add_wrong(fast.block);
    }
    finding.check.numbers = {{"limit_mm", limits.take_up_mm},
                             {"worst_mm", payout.back_mm},
                             {"max_speed_mm_s", payout.fastest_mm_s},
                             {"limit_mm_s", limits.max_speed_mm_s}};
    put_at_sample(finding.check, laid,
                  payout.slack ? *payout.slack : payout.too_fast.value_or(payout.back_at));
    if (payout.slack) {
        const std::size_t block = laid.block[*payout.slack];
        const FixedPair shown = fixed_apart(payout.back_mm, limits.take_up_mm, 1);
        finding.fail(block, "the fibre goes slack: " + shown.value +
                                " mm would have to be taken back, more than the " + shown.limit +
                                " mm of the tensioner, first in " +
                                block_words(task.program, block));
    } else if (payout.too_fast) {
        const std::size_t block = laid.block[*payout.too_fast];
        const FixedPair shown = fixed_apart(payout.fastest_mm_s, limits.max_speed_mm_s, 0);
        finding.fail(block, "the fibre runs at " + shown.value +
                                " mm/s, faster than the machine's " + shown.limit +
                                " mm/s, first in " + block_words(task.program, block));
    }
    return finding;
}

}  // namespace meshwind
