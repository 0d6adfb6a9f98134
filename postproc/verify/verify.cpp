#include "postproc/verify/verify.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/margins.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/motion/axis_loads.h"
#include "postproc/verify/check_kinds.h"
#include "postproc/verify/laid_slip.h"
#include "postproc/verify/roller_check.h"
#include "postproc/verify/verify_head.h"

namespace meshwind {
namespace {

constexpr double kMmPerM = 1000.0;

// The last landing point may lie so far from the planned one along the fibre: where it is straight
// the landing point is known no better.
constexpr double kEndGap_mm = 2.0;

// And no more than this share of the tow, 2 mm of 6 mm.
constexpr double kEndGapTows = 1.0 / 3.0;

// Rounding of positions and of the six digits of F against a limit that is just kept.
constexpr double kLimitSlack = 1e-3;

// Fibre off the plan was pulled there over about so many free lengths.
constexpr double kPulledShare = 1.5;

class Verifier {
public:
    explicit Verifier(const VerifyTask& task) : task_(task), rules_(task.rules) {}

    Verification run() {
        const Eigen::Vector3d tie_on_mm = tie_on_of(task_.program);
        coarse_.assign(task_.program.blocks.size(), 0);
        found_.laid =
            lay_down(task_.wall, task_.machine, task_.program, tie_on_mm, rules_.simulation);
        found_.fibre_length_mm = found_.laid.path.back().s_mm;
        found_.duration_s = task_.program.duration_s();
        check_head();
        check_laydown();
        check_slip();
        check_bridging();
        check_collision();
        check_free_length();
        check_roller();
        check_limits();
        check_payout();
        std::vector<std::size_t>& wrong = found_.wrong_blocks;
        std::sort(wrong.begin(), wrong.end());
        wrong.erase(std::unique(wrong.begin(), wrong.end()), wrong.end());
        for (std::size_t block = 0; block < coarse_.size(); ++block) {
            if (coarse_[block] != 0) {
                found_.coarse_blocks.push_back(block);
            }
        }
        return std::move(found_);
    }

private:
    [[nodiscard]] std::string words_of(std::size_t block) const {
        return block_words(task_.program, block);
    }

    [[nodiscard]] static std::string place_words(const Eigen::Vector3d& p) {
        return " at (" + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
    }

    [[nodiscard]] std::string station_words(std::size_t station) const {
        return words_of(found_.laid.at[station].block) +
               place_words(found_.laid.path[station].position_mm);
    }

    void fail(Check& check, std::size_t block, const std::string& words) {
        check.ok = false;
        check.words = words;
        found_.wrong_blocks.push_back(block);
        if (!found_.first_wrong_block || block < *found_.first_wrong_block) {
            found_.first_wrong_block = block;
        }
    }

    void put_at_station(Check& check, std::size_t station) const {
        const LaidPath& laid = found_.laid;
        check.place = {.position_mm = laid.path[station].position_mm,
                       .block = laid.at[station].block};
    }

    void put_at_sample(Check& check, std::size_t sample) const {
        const LaidPath& laid = found_.laid;
        check.place = {.position_mm = laid.samples[sample].landing_mm, .block = laid.block[sample]};
    }

    // Where the fibre lands while a block runs; samples end where the fibre cannot be followed.
    void put_at_block(Check& check, std::size_t block) const {
        const std::vector<std::size_t>& blocks = found_.laid.block;
        if (!blocks.empty()) {
            const auto at = std::lower_bound(blocks.begin(), blocks.end(), block);
            const auto sample = static_cast<std::size_t>(at - blocks.begin());
            put_at_sample(check, std::min(sample, blocks.size() - 1));
            check.place->block = block;
        }
    }

    // A block in which finer ones may help.
    void note_coarse(std::size_t block) {
        found_.wrong_blocks.push_back(block);
        coarse_[block] = 1;
    }

    void note_fast(std::size_t block, double ratio) {
        std::vector<FastBlock>& fast = found_.fast_blocks;
        if (fast.empty() || fast.back().block != block) {
            fast.push_back({block, ratio});
            found_.wrong_blocks.push_back(block);
        }
        fast.back().ratio = std::max(fast.back().ratio, ratio);
    }

    // The blocks that laid the fibre over `back_mm` up to a station. Stations come in ascending
    // order for a check, so what lies before the one noted last has been noted with it.
    void note_coarse_behind(std::size_t station, double back_mm,
                            std::optional<std::size_t>& noted_last) {
        const LaidPath& laid = found_.laid;
        const double from_mm = laid.path[station].s_mm - back_mm;
        found_.wrong_blocks.push_back(laid.at[station].block);
        for (std::size_t i = station;; --i) {
            coarse_[laid.at[i].block] = 1;
            if (i == 0 || laid.path[i].s_mm < from_mm || (noted_last && i <= *noted_last)) {
                break;
            }
        }
        noted_last = station;
    }

    // What fails before the first block is no matter of blocks.
    void add_head_check(Check check, std::size_t block) {
        if (!check.ok && block < found_.first_wrong_block.value_or(block + 1)) {
            found_.first_wrong_block = block;
        }
        found_.checks.push_back(std::move(check));
    }

    void check_head() {
        if (!task_.program.head) {
            return;
        }
        add_head_check(tie_on_check(task_, found_.laid.path.front().position_mm), 0);
        if (task_.program.head->has_approach) {
            add_head_check(approach_check(task_), 0);
            PathModeFinding mode = path_mode_check(task_);
            add_head_check(std::move(mode.check), mode.block);
        }
    }

    void check_roller() {
        const RollerFinding roller = find_roller(task_.machine, found_.laid);
        found_.turned_over = roller.turned_over;
        Check check(check_kind::kRoller);
        check.numbers = {{"worst_deg", deg_from_rad(roller.worst_rad)},
                         {"limit_deg", deg_from_rad(kRollerOff_rad)},
                         {"mean_twist_deg", deg_from_rad(roller.mean_twist_rad)},
                         {"worst_twist_deg", deg_from_rad(roller.worst_twist_rad)},
                         {"turned_over", static_cast<double>(roller.turned_over)}};
        // A program that lays no fibre twists none.
        const double laid_m = found_.fibre_length_mm / kMmPerM;
        const double turns_per_m = laid_m > 0.0 ? roller.turned_rad / (2.0 * kPi) / laid_m : 0.0;
        check.numbers["twist_per_m"] = turns_per_m;
        put_at_sample(check, roller.wrong_sample.value_or(roller.worst_sample));
        // Programs from elsewhere may be for an eye without a roller.
        const bool asked = !task_.program.head || keeps_form(task_);
        if (roller.wrong_sample && asked) {
            const std::size_t block = found_.laid.block[*roller.wrong_sample];
            fail(check, block,
                 "the fibre leans " + fixed(deg_from_rad(roller.wrong_rad), 2) +
                     " deg off the square to the roller, " +
                     fixed(deg_from_rad(roller.wrong_rad - roller.forced_rad), 2) +
                     " deg more than the machine forces, first in " + words_of(block));
        }
        if (rules_.most_twist_per_m) {
            check.numbers["limit_twist_per_m"] = *rules_.most_twist_per_m;
            if (check.ok && turns_per_m > *rules_.most_twist_per_m) {
                check.ok = false;
                check.words = "the head twists the band by " + fixed(turns_per_m, 3) +
                              " turns a metre, more than " + fixed(*rules_.most_twist_per_m, 3) +
                              ", and goes over to its other side " +
                              std::to_string(roller.turned_over) + " times";
            }
        }
        found_.checks.push_back(check);
    }

    void check_laydown() {
        const LaidPath& laid = found_.laid;
        Check check(check_kind::kLaydown);
        if (!task_.plan.empty()) {
            found_.deviation = compare(laid, task_.plan, rules_.laydown);
            const Deviation& off = *found_.deviation;
            check.numbers = {{"max_deviation_mm", off.max_mm},
                             {"max_angle_deg", deg_from_rad(off.max_angle_rad)},
                             {"limit_mm", rules_.laydown.deviation_mm},
                             {"limit_deg", deg_from_rad(rules_.laydown.angle_rad)},
                             {"end_gap_mm", off.end_gap_mm}};
            std::optional<std::size_t> noted;
            for (const std::size_t station : off.wrong) {
                note_coarse_behind(station, kPulledShare * rules_.collision.free_fibre.preferred_mm,
                                   noted);
            }
            const std::size_t last = task_.program.blocks.size() - 1;
            const double most_end_gap_mm = std::min(kEndGap_mm, kEndGapTows * rules_.tow_width_mm);
            put_at_station(check, off.wrong.empty() ? off.max_at : off.wrong.front());
            if (!off.wrong.empty()) {
                fail(check, laid.at[off.wrong.front()].block,
                     "the laid fibre leaves the plan in " + station_words(off.wrong.front()) +
                         ", by up to " + fixed(off.max_mm, 3) + " mm and " +
                         fixed(deg_from_rad(off.max_angle_rad), 3) + " deg");
            } else if (laid.failure.empty() && off.end_gap_mm > most_end_gap_mm) {
                put_at_block(check, last);
                fail(check, last,
                     "the program ends " + fixed(off.end_gap_mm, 1) +
                         " mm from the end of the plan");
            }
        }
        if (!laid.failure.empty()) {
            note_coarse(laid.failed_block);
            put_at_block(check, laid.failed_block);
            fail(check, laid.failed_block, laid.failure + " in " + words_of(laid.failed_block));
        }
        found_.checks.push_back(check);
    }

    void check_slip() {
        const LaidPath& laid = found_.laid;
        const double limit = rules_.friction.holds();
        found_.slip = laid_slip(task_.wall.surface(), laid,
                                {.tow_width_mm = rules_.tow_width_mm,
                                 .friction = limit,
                                 .aside_mm = kUnnoticed * rules_.laydown.deviation_mm});
        std::size_t worst = 0;
        std::optional<std::size_t> first;
        std::optional<std::size_t> noted;
        for (std::size_t i = 0; i < found_.slip.size(); ++i) {
            worst = found_.slip[i] > found_.slip[worst] ? i : worst;
            if (found_.slip[i] > limit) {
                first = first.value_or(i);
                note_coarse_behind(i, 2.0 * rules_.tow_width_mm, noted);
            }
        }
        Check check(check_kind::kSlip);
        check.numbers = {{"limit", limit}, {"worst", found_.slip[worst]}};
        put_at_station(check, first.value_or(worst));
        if (first) {
            const FixedPair shown = fixed_apart(found_.slip[worst], limit, 4);
            fail(check, laid.at[*first].block,
                 "the laid fibre slips: ratio " + shown.value + " exceeds the friction " +
                     shown.limit + ", first in " + station_words(*first));
        }
        found_.checks.push_back(check);
    }

    void check_bridging() {
        const LaidPath& laid = found_.laid;
        std::size_t worst = 0;
        std::optional<std::size_t> first;
        for (std::size_t i = 0; i < laid.at.size(); ++i) {
            worst = laid.at[i].gap_mm > laid.at[worst].gap_mm ? i : worst;
            if (laid.at[i].gap_mm > rules_.bridging_tolerance_mm) {
                first = first.value_or(i);
                note_coarse(laid.at[i].block);
            }
        }
        Check check(check_kind::kBridging);
        const double worst_mm = laid.at[worst].gap_mm;
        check.numbers = {{"limit_mm", rules_.bridging_tolerance_mm}, {"worst_mm", worst_mm}};
        put_at_station(check, first.value_or(worst));
        if (first) {
            const FixedPair shown = fixed_apart(worst_mm, rules_.bridging_tolerance_mm, 3);
            fail(check, laid.at[*first].block,
                 "the laid fibre bridges by " + shown.value + " mm, more than " + shown.limit +
                     " mm, first in " + station_words(*first));
        }
        found_.checks.push_back(check);
    }

    void check_collision() {
        const LaidPath& laid = found_.laid;
        CollisionRule rule = rules_.collision;
        rule.least_only = true;
        const CollisionReport report = check_collisions(
            task_.machine, task_.envelope, task_.obstacles, laid.samples, laid.joints, rule);
        Check check(check_kind::kCollision);
        check.numbers = {{"fibre_hits", static_cast<double>(report.fibre_hits.size())},
                         {"head_hits", static_cast<double>(report.head_hits.size())},
                         {"min_clearance_mm", report.min_clearance_mm}};
        const auto say = [&](const std::vector<std::size_t>& hits, const std::string& words) {
            if (!hits.empty() && check.ok) {
                const std::size_t sample = hits.front();
                put_at_sample(check, sample);
                fail(check, laid.block[sample],
                     words + " in " + words_of(laid.block[sample]) +
                         place_words(laid.samples[sample].landing_mm));
            }
        };
        if (!task_.envelope.bodies.empty()) {
            check.numbers["body_hits"] = static_cast<double>(report.body_hits.size());
        }
        for (const auto* const hits : {&report.fibre_hits, &report.head_hits, &report.body_hits}) {
            for (const std::size_t sample : *hits) {
                note_coarse(laid.block[sample]);
            }
        }
        const std::string what =
            task_.envelope.bodies.empty() ? "the mandrel" : "the mandrel or a body";
        say(report.fibre_hits, "the free fibre meets " + what);
        say(report.head_hits,
            "the head comes within " + fixed(rules_.collision.clearance_mm, 1) + " mm of " + what);
        say(report.body_hits, "the mandrel meets a body that does not turn with it");
        found_.checks.push_back(check);
    }

    void check_free_length() {
        const LaidPath& laid = found_.laid;
        const auto [least_mm, most_mm] = free_length_limits_mm();
        Check check(check_kind::kFreeLength);
        found_.shortest_free_mm = std::numeric_limits<double>::infinity();
        std::size_t shortest = 0;
        std::optional<std::size_t> first;
        for (std::size_t i = 0; i < laid.samples.size(); ++i) {
            const double length = laid.samples[i].free_length_mm;
            if (length < found_.shortest_free_mm) {
                found_.shortest_free_mm = length;
                shortest = i;
            }
            found_.longest_free_mm = std::max(found_.longest_free_mm, length);
            if (length < least_mm || length > most_mm) {
                first = first.value_or(i);
                note_coarse(laid.block[i]);
            }
        }
        check.numbers = {{"min_mm", found_.shortest_free_mm},
                         {"max_mm", found_.longest_free_mm},
                         {"limit_min_mm", least_mm},
                         {"limit_max_mm", most_mm}};
        put_at_sample(check, first.value_or(shortest));
        if (first) {
            fail(check, laid.block[*first],
                 free_length_words(laid.samples[*first].free_length_mm, laid.block[*first]));
        }
        found_.checks.push_back(check);
    }

    // The machine's, with room for the eye between the ends of blocks and for fibre that bridges.
    [[nodiscard]] std::pair<double, double> free_length_limits_mm() const {
        const FreeFibreRule& rule = rules_.collision.free_fibre;
        return {rule.min_mm - margin::kFreeLength_mm, rule.max_mm + task_.wall.bridge_reach_mm()};
    }

    [[nodiscard]] std::string free_length_words(double length_mm, std::size_t block) const {
        const FreeFibreRule& rule = rules_.collision.free_fibre;
        const auto [least_mm, most_mm] = free_length_limits_mm();
        const bool longer = length_mm > most_mm;
        const FixedPair shown = fixed_apart(length_mm, longer ? most_mm : least_mm, 1);
        return "the free length is " + shown.value + " mm in " + words_of(block) + ", " +
               (longer ? "over the " : "under the ") + shown.limit + " mm that the machine's " +
               (longer ? "longest of " + fixed(rule.max_mm, 1)
                       : "shortest of " + fixed(rule.min_mm, 1)) +
               " mm allows";
    }

    [[nodiscard]] std::string past_end_words(const LimitViolation& past) const {
        const std::size_t joint = task_.machine.joint_of(past.axis).value_or(0);
        const bool rotary = task_.machine.axis(joint).type == AxisType::Rotary;
        const double unit = rotary ? deg_from_rad(1.0) : 1.0;
        const FixedPair shown = fixed_apart(unit * past.value, unit * past.limit, 2);
        const std::string name = rotary ? " deg" : " mm";
        return std::string("axis ") + past.axis + " goes to " + shown.value + name +
               ", past its end at " + shown.limit + name + ", from " + words_of(past.first) + " on";
    }

    void check_limits() {
        const BlockList& list = task_.program;
        Check check(check_kind::kLimits);
        JointPath joints = joint_path(list);
        std::vector<double> step_s;
        for (const Block& block : list.blocks) {
            step_s.push_back(block.duration_s);
        }
        find_travel_violations(task_.machine, joints);
        const AxisLoads loads = axis_loads(task_.machine, joints, step_s);
        put_at_block(check, loads.acceleration.ratio > loads.velocity.ratio
                                ? loads.acceleration.step
                                : loads.velocity.step);
        check.numbers = {{"violations", static_cast<double>(joints.violations.size())},
                         {"velocity_ratio", loads.velocity.ratio},
                         {"acceleration_ratio", loads.acceleration.ratio},
                         {"corner_mm", loads.linear.mm},
                         {"corner_eye_mm", loads.eye.mm}};
        const double corner_limit = corner_limit_mm(task_);
        if (!std::isinf(corner_limit)) {
            check.numbers.emplace("limit_corner_mm", corner_limit);
        }
        if (!joints.violations.empty()) {
            const LimitViolation& first = *std::min_element(
                joints.violations.begin(), joints.violations.end(),
                [](const LimitViolation& a, const LimitViolation& b) { return a.first < b.first; });
            put_at_block(check, first.first);
            fail(check, first.first, past_end_words(first));
        }
        say_load(check, loads.velocity, "velocity");
        say_load(check, loads.acceleration, "acceleration");
        const CornerCut& corner = loads.linear.mm > loads.eye.mm ? loads.linear : loads.eye;
        if (corner.mm > corner_limit * (1.0 + kLimitSlack) && check.ok) {
            put_at_block(check, corner.step);
            const FixedPair shown = fixed_apart(corner.mm, corner_limit, 3);
            fail(check, corner.step,
                 "rounding the corner after " + words_of(corner.step) + " takes " + shown.value +
                     " mm, more than the controller's " + shown.limit + " mm");
        }
        found_.checks.push_back(check);
    }

    void say_load(Check& check, const AxisLoad& load, const std::string& what) {
        if (load.ratio > 1.0 + kLimitSlack && check.ok) {
            put_at_block(check, load.step);
            fail(check, load.step,
                 std::string("axis ") + task_.machine.axis(load.joint).letter + " needs " +
                     fixed_apart(load.ratio, 1.0, 3).value + " times its " + what + " in " +
                     words_of(load.step));
        }
    }

    void check_payout() {
        const LaidPath& laid = found_.laid;
        const FibreLimits& fibre = task_.machine.fibre;
        Check check(check_kind::kPayout);
        double fastest = 0.0;
        double back = 0.0;
        double paid_most = -std::numeric_limits<double>::infinity();
        std::optional<std::size_t> too_fast;
        std::optional<std::size_t> slack;
        std::size_t furthest_back = 0;
        double before = 0.0;
        for (std::size_t i = 0; i < laid.samples.size(); ++i) {
            const double paid = laid.samples[i].s_mm + laid.samples[i].free_length_mm;
            const double dt = i > 0 ? laid.time_s[i] - laid.time_s[i - 1] : 0.0;
            if (dt > 0.0) {
                const double speed = std::abs(paid - before) / dt;
                fastest = std::max(fastest, speed);
                if (speed > fibre.max_speed_mm_s * (1.0 + kLimitSlack)) {
                    too_fast = too_fast.value_or(i);
                    note_fast(laid.block[i], speed / fibre.max_speed_mm_s);
                }
            }
            paid_most = std::max(paid_most, paid);
            if (paid_most - paid > back) {
                back = paid_most - paid;
                furthest_back = i;
            }
            if (!slack && paid_most - paid > fibre.take_up_mm) {
                slack = i;
            }
            before = paid;
        }
        check.numbers = {{"limit_mm", fibre.take_up_mm},
                         {"worst_mm", back},
                         {"max_speed_mm_s", fastest},
                         {"limit_mm_s", fibre.max_speed_mm_s}};
        put_at_sample(check, slack ? *slack : too_fast.value_or(furthest_back));
        if (slack) {
            const FixedPair shown = fixed_apart(back, fibre.take_up_mm, 1);
            fail(check, laid.block[*slack],
                 "the fibre goes slack: " + shown.value +
                     " mm would have to be taken back, more than the " + shown.limit +
                     " mm of the tensioner, first in " + words_of(laid.block[*slack]));
        } else if (too_fast) {
            const FixedPair shown = fixed_apart(fastest, fibre.max_speed_mm_s, 0);
            fail(check, laid.block[*too_fast],
                 "the fibre runs at " + shown.value + " mm/s, faster than the machine's " +
                     shown.limit + " mm/s, first in " + words_of(laid.block[*too_fast]));
        }
        found_.checks.push_back(check);
    }

    const VerifyTask& task_;
    const VerifyRules& rules_;
    Verification found_;
    std::vector<char> coarse_;  // per block
};

void append_cells(std::string& text, const Eigen::Vector3d& v, int decimals) {
    for (const double x : v) {
        text += ',';
        append_fixed(text, x, decimals);
    }
}

}  // namespace

Eigen::Vector3d tie_on_of(const BlockList& program) {
    if (!program.tie_on_mm) {
        throw InputError("verify.tie_on", "",
                         "the program does not say where the fibre is tied on; give --tie-on "
                         "X,Y,Z in the mandrel's frame");
    }
    return *program.tie_on_mm;
}

Verification verify(const VerifyTask& task) {
    return Verifier(task).run();
}

std::string laid_csv(const Verification& verification, const BlockList& program) {
    const LaidPath& laid = verification.laid;
    std::string text =
        "block,line,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,slip,bridge_mm\n";
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        const PathPoint& station = laid.path[i];
        text += std::to_string(laid.at[i].block);
        text += ',' + std::to_string(program.blocks[laid.at[i].block].line) + ',';
        append_fixed(text, station.s_mm, 4);
        append_cells(text, station.position_mm, 4);
        append_cells(text, station.normal, 7);
        append_cells(text, station.tangent, 7);
        text += ',';
        append_fixed(text, station.kn_per_mm, 8);
        text += ',';
        append_fixed(text, verification.slip[i], 5);
        text += ',';
        append_fixed(text, laid.at[i].gap_mm, 4);
        text += '\n';
    }
    return text;
}

}  // namespace meshwind
