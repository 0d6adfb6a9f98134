#include "postproc/verify/verify_head.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/verify/check_kinds.h"

namespace meshwind {
namespace {

std::string line_words(std::int32_t line) {
    return "line " + std::to_string(line);
}

double units(std::int64_t nano) {
    return static_cast<double>(nano) / static_cast<double>(kNanoPerUnit);
}

// The rapid moves, one after the other.
class Approach {
public:
    explicit Approach(const VerifyTask& task) : task_(task), head_(*task.program.head) {}

    Check check() {
        for (std::size_t i = 0; i < head_.approach.size() && words_.empty(); ++i) {
            look_at_ends(head_.approach[i]);
            look_at_order(head_.approach[i]);
            if (i > 0) {
                sweep(head_.approach[i - 1], head_.approach[i]);
            }
        }
        if (words_.empty() && head_.stop_line == 0 && keeps_form(task_)) {
            words_ =
                "the program does not stop (M0; Stop in RAPID, HALT in KRL, PAUSE in TP) between "
                "its last rapid move and its first feed move; the fibre could not be tied on";
        }
        return Check(check_kind::kApproach, words_.empty(), words_,
                     {{"rapid_moves", static_cast<double>(head_.approach.size())},
                      {"swept", static_cast<double>(swept_)},
                      {"stops", head_.stop_line > 0 ? 1.0 : 0.0}});
    }

private:
    [[nodiscard]] const BlockAxis& axis(std::size_t a) const { return task_.program.axes[a]; }

    [[nodiscard]] double joint(std::int64_t nano, std::size_t a) const {
        return axis(a).type == AxisType::Rotary ? rad_from_deg(units(nano)) : units(nano);
    }

    [[nodiscard]] std::string shown(double value, std::size_t a) const {
        return axis(a).type == AxisType::Rotary ? fixed(deg_from_rad(value), 2) + " deg"
                                                : fixed(value, 2) + " mm";
    }

    void look_at_ends(const RapidMove& move) {
        for (std::size_t a = 0; a < move.nano.size(); ++a) {
            const Axis& limits = task_.machine.axis(a);
            const double slack = joint(axis(a).resolution_nano, a);
            const double value = joint(move.nano[a], a);
            const bool below = value < limits.min - slack;
            if (move.known[a] && (below || value > limits.max + slack)) {
                words_ = "the rapid move of " + line_words(move.line) + " takes axis " +
                         axis(a).letter + " to " + shown(value, a) + ", past its end at " +
                         shown(below ? limits.min : limits.max, a);
                return;
            }
        }
    }

    // Rotary axes that turn from nobody knows where turn before the head is near.
    void look_at_order(const RapidMove& move) {
        bool linear_now = false;
        for (std::size_t a = 0; a < move.nano.size(); ++a) {
            const bool linear = axis(a).type == AxisType::Linear;
            linear_now = linear_now || (linear && move.named[a]);
            if (words_.empty() && !linear && move.known[a] && !rotary_known(a) && linear_before_) {
                words_ = "the rapid move of " + line_words(move.line) + " turns axis " +
                         axis(a).letter +
                         " while the linear axes stand near the mandrel already; "
                         "turn the rotary axes first";
            }
        }
        linear_before_ = linear_before_ || linear_now;
        known_ = move.known;
    }

    [[nodiscard]] bool rotary_known(std::size_t a) const { return !known_.empty() && known_[a]; }

    void sweep(const RapidMove& from, const RapidMove& to) {
        const auto all = [](const std::vector<bool>& known) {
            return std::find(known.begin(), known.end(), false) == known.end();
        };
        if (!words_.empty() || !all(from.known)) {
            return;
        }
        JointPath joints;
        joints.axis_count = from.nano.size();
        for (const RapidMove* const move : {&from, &to}) {
            for (std::size_t a = 0; a < move->nano.size(); ++a) {
                joints.joints.push_back(joint(move->nano[a], a));
            }
        }
        ++swept_;
        if (head_strikes(task_.machine, task_.envelope, task_.obstacles, joints,
                         task_.rules.collision.clearance_mm)) {
            words_ = "in the rapid move of " + line_words(to.line) + " the head comes within " +
                     fixed(task_.rules.collision.clearance_mm, 1) +
                     " mm of the mandrel or of a body, or the eye meets them";
        }
    }

    const VerifyTask& task_;
    const ProgramHead& head_;
    std::string words_;
    std::vector<bool> known_;     // before the move that is looked at
    bool linear_before_ = false;  // a linear axis has been placed
    std::size_t swept_ = 0;
};

}  // namespace

bool keeps_form(const VerifyTask& task) {
    return task.program.head->by_meshwind || !task.plan.empty();
}

double corner_limit_mm(const VerifyTask& task) {
    if (!task.program.head || !task.program.head->has_approach) {
        return task.rules.path_mode.corner_mm;
    }
    const std::vector<PathModeFrom>& modes = task.program.head->path_modes;
    double least_mm = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < modes.size(); ++i) {
        const bool runs = i + 1 == modes.size() ? modes[i].block < task.program.blocks.size()
                                                : modes[i].block < modes[i + 1].block;
        least_mm = runs ? std::min(least_mm, modes[i].mode.corner_mm) : least_mm;
    }
    return least_mm;
}

Check approach_check(const VerifyTask& task) {
    return Approach(task).check();
}

Check tie_on_check(const VerifyTask& task, const Eigen::Vector3d& landing_mm) {
    const Eigen::Vector3d& tie_on_mm = *task.program.tie_on_mm;
    Check check(check_kind::kTieOn);
    const auto look = [&](const char* key, double off_mm, const char* what) {
        check.numbers[key] = off_mm;
        if (check.ok && off_mm > kTieOnOff_mm) {
            check.ok = false;
            check.words = "the fibre is tied on at (" + fixed(tie_on_mm.x(), 3) + ", " +
                          fixed(tie_on_mm.y(), 3) + ", " + fixed(tie_on_mm.z(), 3) + "), " +
                          fixed(off_mm, 3) + " mm off " + what + ", more than " +
                          fixed(kTieOnOff_mm, 1) + " mm";
        }
    };
    look("off_wall_mm", (tie_on_mm - landing_mm).norm(), "the wall");
    if (!task.plan.empty()) {
        look("off_plan_mm", (tie_on_mm - task.plan.front().position_mm).norm(),
             "the plan's first point");
    }
    check.numbers["limit_mm"] = kTieOnOff_mm;
    check.place = {.position_mm = landing_mm, .block = 0};
    return check;
}

PathModeFinding path_mode_check(const VerifyTask& task) {
    PathModeFinding found{Check(check_kind::kPathMode), 0};
    const std::string& wanted = task.rules.path_mode.words;
    const auto say = [](const std::string& words) {
        return words.empty() ? std::string("without words on corners") : "in " + words;
    };
    std::vector<PathModeFrom> modes = task.program.head->path_modes;
    if (modes.empty() || modes.front().block > 1) {
        modes.insert(modes.begin(), PathModeFrom{.block = 1});
    }
    found.check.numbers["changes"] = static_cast<double>(modes.size() - 1);
    for (std::size_t i = 0; i < modes.size() && keeps_form(task); ++i) {
        const bool runs = modes[i].block < task.program.blocks.size() &&
                          (i + 1 == modes.size() || modes[i].block < modes[i + 1].block);
        if (runs && modes[i].mode.words != wanted) {
            found.block = modes[i].block;
            found.check.ok = false;
            found.check.words = block_words(task.program, found.block) + " runs " +
                                say(modes[i].mode.words) + ", the machine's own lines ask for it " +
                                say(wanted);
            break;
        }
    }
    return found;
}

}  // namespace meshwind
