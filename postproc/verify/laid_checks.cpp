#include "postproc/verify/laid_checks.h"

#include <algorithm>

#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/verify/check_kinds.h"
#include "postproc/verify/laid_slip.h"

namespace meshwind {
namespace {

// The last landing point may lie so far from the planned one along the fibre: where it is straight
// the landing point is known no better.
constexpr double kEndGap_mm = 2.0;

// And no more than this share of the tow, 2 mm of 6 mm.
constexpr double kEndGapTows = 1.0 / 3.0;

// Fibre off the plan was pulled there over about so many free lengths.
constexpr double kPulledShare = 1.5;

std::string station_words(const VerifyTask& task, const LaidPath& laid, std::size_t station) {
    return block_words(task.program, laid.at[station].block) +
           place_words(laid.path[station].position_mm);
}

// Adds the blocks that laid the fibre over `back_mm` up to each station. What lies before the
// station before has been added with that.
// \param stations ascending
void add_coarse_behind(CheckFinding& finding, const LaidPath& laid,
                       const std::vector<std::size_t>& stations, double back_mm) {
    std::optional<std::size_t> last;
    for (const std::size_t station : stations) {
        const double from_mm = laid.path[station].s_mm - back_mm;
        for (std::size_t i = station;; --i) {
            finding.add_finer(laid.at[i].block);
            if (i == 0 || laid.path[i].s_mm < from_mm || (last && i <= *last)) {
                break;
            }
        }
        finding.add_wrong(laid.at[station].block);
        last = station;
    }
}

// The laid fibre against the plan.
void compare_with_plan(CheckFinding& finding, const VerifyTask& task, const LaidPath& laid,
                       const Deviation& off) {
    Check& check = finding.check;
    check.numbers = {{"max_deviation_mm", off.max_mm},
                     {"max_angle_deg", deg_from_rad(off.max_angle_rad)},
                     {"limit_mm", task.rules.laydown.deviation_mm},
                     {"limit_deg", deg_from_rad(task.rules.laydown.angle_rad)},
                     {"end_gap_mm", off.end_gap_mm}};
    add_coarse_behind(finding, laid, off.wrong,
                      kPulledShare * task.rules.collision.free_fibre.preferred_mm);
    const std::size_t last = task.program.blocks.size() - 1;
    const double most_end_gap_mm = std::min(kEndGap_mm, kEndGapTows * task.rules.tow_width_mm);
    put_at_station(check, laid, off.wrong.empty() ? off.max_at : off.wrong.front());
    if (!off.wrong.empty()) {
        finding.fail(laid.at[off.wrong.front()].block,
                     "the laid fibre leaves the plan in " +
                         station_words(task, laid, off.wrong.front()) + ", by up to " +
                         fixed(off.max_mm, 3) + " mm and " +
                         fixed(deg_from_rad(off.max_angle_rad), 3) + " deg");
    } else if (laid.failure.empty() && off.end_gap_mm > most_end_gap_mm) {
        put_at_block(check, laid, last);
        finding.fail(
            last, "the program ends " + fixed(off.end_gap_mm, 1) + " mm from the end of the plan");
    }
}

}  // namespace

CheckFinding laydown_finding(const VerifyTask& task, const LaidPath& laid,
                             const std::optional<Deviation>& deviation) {
    CheckFinding finding(check_kind::kLaydown);
    if (deviation) {
        compare_with_plan(finding, task, laid, *deviation);
    }
    if (!laid.failure.empty()) {
        finding.add_coarse(laid.failed_block);
        put_at_block(finding.check, laid, laid.failed_block);
        finding.fail(laid.failed_block,
                     laid.failure + " in " + block_words(task.program, laid.failed_block));
    }
    return finding;
}

std::vector<double> station_slip(const VerifyTask& task, const LaidPath& laid) {
    return laid_slip(task.wall.surface(), laid,
                     {.tow_width_mm = task.rules.tow_width_mm,
                      .friction = task.rules.friction.holds(),
                      .aside_mm = kUnnoticed * task.rules.laydown.deviation_mm});
}

CheckFinding slip_finding(const VerifyTask& task, const LaidPath& laid,
                          const std::vector<double>& slip) {
    const double limit = task.rules.friction.holds();
    std::size_t worst = 0;
    std::vector<std::size_t> slipping;
    for (std::size_t i = 0; i < slip.size(); ++i) {
        worst = slip[i] > slip[worst] ? i : worst;
        if (slip[i] > limit) {
            slipping.push_back(i);
        }
    }
    CheckFinding finding(check_kind::kSlip);
    finding.check.numbers = {{"limit", limit}, {"worst", slip[worst]}};
    add_coarse_behind(finding, laid, slipping, 2.0 * task.rules.tow_width_mm);
    put_at_station(finding.check, laid, slipping.empty() ? worst : slipping.front());
    if (!slipping.empty()) {
        const FixedPair shown = fixed_apart(slip[worst], limit, 4);
        finding.fail(laid.at[slipping.front()].block,
                     "the laid fibre slips: ratio " + shown.value + " exceeds the friction " +
                         shown.limit + ", first in " + station_words(task, laid, slipping.front()));
    }
    return finding;
}

CheckFinding bridging_finding(const VerifyTask& task, const LaidPath& laid) {
    const double limit_mm = task.rules.bridging_tolerance_mm;
    CheckFinding finding(check_kind::kBridging);
    std::size_t worst = 0;
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < laid.at.size(); ++i) {
        worst = laid.at[i].gap_mm > laid.at[worst].gap_mm ? i : worst;
        if (laid.at[i].gap_mm > limit_mm) {
            first = first.value_or(i);
            finding.add_coarse(laid.at[i].block);
        }
    }
    const double worst_mm = laid.at[worst].gap_mm;
    finding.check.numbers = {{"limit_mm", limit_mm}, {"worst_mm", worst_mm}};
    put_at_station(finding.check, laid, first.value_or(worst));
    if (first) {
        const FixedPair shown = fixed_apart(worst_mm, limit_mm, 3);
        finding.fail(laid.at[*first].block, "the laid fibre bridges by " + shown.value +
                                                " mm, more than " + shown.limit + " mm, first in " +
                                                station_words(task, laid, *first));
    }
    return finding;
}

}  // namespace meshwind
