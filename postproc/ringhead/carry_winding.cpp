#include "postproc/ringhead/carry_winding.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/verify/check_kinds.h"

namespace meshwind {
namespace {

// A change of the angle has died down to exp(-3) = 5 percent after so many lags.
constexpr double kSettleLags = 3.0;
// A covered share is a sum of cells: all but rounding.
constexpr double kAllCovered = 1.0 - 1e-9;
// More passes than even advance asks for: a bend does not spread tows to a fifth.
constexpr int kMorePasses = 4;
constexpr double kFibreStep_mm = 2.0;  // of fibre.csv

void require_numbers(const CarryWindingTask& task, const CarryWindingOptions& options,
                     double spool_radius_mm) {
    if (!(spool_radius_mm > task.tube_radius_mm)) {
        throw InputError(
            "carry.spool", "--spool-radius",
            "must be above the tube's radius of " + fixed(task.tube_radius_mm, 3) + " mm");
    }
    const auto positive = [](const char* option, double value) {
        if (!(value > 0.0) || !std::isfinite(value)) {
            throw InputError("carry.not_positive", option, "must be a number above 0");
        }
    };
    positive("--passes", std::max(1, options.passes + 1));
    positive("--angle-tolerance", options.angle_tolerance_deg);
    positive("--friction", options.friction.value_or(1.0));
    positive("--tow-tex", options.tow_tex.value_or(1.0));
}

class Winder {
public:
    Winder(const CarryWindingTask& task, const CarryWindingOptions& options)
        : task_(task), options_(options), tube_(task.axis, task.tube_radius_mm) {}

    CarryWinding run() {
        result_.spool_radius_mm = options_.spool_radius_mm.value_or(task_.head.ring_radius_mm);
        require_numbers(task_, options_, result_.spool_radius_mm);
        result_.lag_mm =
            landing_lag_mm(result_.spool_radius_mm, task_.tube_radius_mm, task_.angle_rad);
        result_.bend_radius_mm = tightest_bend_mm(tube_);
        pattern_ = {task_.tube_radius_mm,  task_.angle_rad, task_.tows,
                    task_.tow_width_mm,    options_.passes, result_.bend_radius_mm,
                    task_.axis.length_mm()};
        attempt();
        // Laid fibre is further apart outside a bend than even advance has it.
        if (!(task_.tow_width_mm > 0.0) && !wide_enough()) {
            pattern_.tow_width_mm = next_tow_width_mm(result_.cover.widest_mm);
            pattern_.passes = result_.pattern.passes;
            attempt();
        }
        for (int more = 0; options_.passes == 0 && more < kMorePasses && !wide_enough(); ++more) {
            pattern_.passes = result_.pattern.passes + 1;
            attempt();
        }
        check_laydown();
        check_bridging();
        check_slip();
        check_cover();
        return std::move(result_);
    }

private:
    [[nodiscard]] bool wide_enough() const {
        return result_.cover.widest_mm <= result_.pattern.tow_width_mm;
    }

    void attempt() {
        result_.pattern = ring_pattern(pattern_);
        plan();
        lay();
        judge();
    }

    void plan() {
        result_.passages = ring_passages(
            task_.head, {task_.axis.length_mm(), result_.lag_mm, result_.pattern.passes,
                         result_.pattern.offset_rad, options_.at_once});
        result_.zone_from_mm = 0.0;
        result_.zone_to_mm = task_.axis.length_mm();
        for (const RingPassage& passage : result_.passages) {
            const auto [low, high] = std::minmax(passage.tie_s_mm, passage.end_s_mm);
            result_.zone_from_mm = std::max(result_.zone_from_mm, low);
            result_.zone_to_mm = std::min(result_.zone_to_mm, high);
        }
        if (!(result_.zone_to_mm - result_.zone_from_mm > kCoverRow_mm)) {
            throw InputError("carry.short", "--ring-distance",
                             "no part of the axis is wound by both rings: fibres land " +
                                 fixed(result_.lag_mm, 1) +
                                 " mm behind a ring; take a longer axis or a steeper angle");
        }
        pattern_.laid_mm = result_.zone_to_mm - result_.zone_from_mm;
        result_.pattern = ring_pattern(pattern_);
    }

    void lay() {
        const KrlProgram forth = read_krl(task_.forth, "program.src");
        const KrlProgram back = options_.at_once ? forth : read_krl(task_.back, "program_back.src");
        const std::vector<double> back_s_mm(task_.s_mm.rbegin(), task_.s_mm.rend());
        const double turns_per_mm = ring_turns_per_mm(task_.angle_rad, task_.tube_radius_mm);
        std::vector<std::vector<RingRow>> rows;
        for (const RingPassage& passage : result_.passages) {
            rows.push_back(drive_ring(passage, passage.back ? back : forth,
                                      passage.back ? back_s_mm : task_.s_mm, task_.head,
                                      turns_per_mm));
        }
        result_.rings = rings_csv(result_.passages, rows);
        result_.fibres.clear();
        result_.fibre_mm = 0.0;
        result_.bridges = 0;
        for (const RingPassage& passage : result_.passages) {
            const auto states =
                play_head(passage.back ? back : forth,
                          read_rings_csv(result_.rings, "rings.csv", passage), task_.head, tube_);
            RingSpools spools;
            spools.ring = passage.ring;
            spools.count = task_.tows;
            spools.radius_mm = result_.spool_radius_mm;
            spools.phase_rad = passage.phase_rad;
            spools.tie_s_mm = passage.tie_s_mm;
            spools.right_handed = passage.right_handed;
            for (RingFibre& fibre : lay_ring_fibres(states, task_.head, tube_, spools)) {
                fibre.pass = passage.pass;
                result_.fibre_mm += fibre.length_mm;
                result_.bridges += fibre.bridges.size();
                result_.fibres.push_back(std::move(fibre));
            }
        }
    }

    void judge() {
        RingCoverTask task;
        task.from_mm = result_.zone_from_mm;
        task.to_mm = result_.zone_to_mm;
        task.angle_rad = task_.angle_rad;
        task.tow_width_mm = result_.pattern.tow_width_mm;
        task.settle_mm = kSettleLags * result_.lag_mm;
        result_.cover = ring_cover(tube_, result_.fibres, task);
        result_.quality = ring_quality(tube_, result_.fibres, task);
    }

    void add(const CheckKind& kind, bool ok, const std::string& words,
             std::map<std::string, double> numbers) {
        result_.checks.emplace_back(kind, ok, ok ? "" : words, std::move(numbers));
    }

    void check_laydown() {
        const RingQuality& laid = result_.quality;
        const double arm_deg = deg_from_rad(laid.arm_off_rad);
        const double bend_deg = deg_from_rad(laid.bend_off_rad);
        const double limit_deg = options_.angle_tolerance_deg;
        const double bend_limit_deg =
            limit_deg + deg_from_rad(result_.pattern.inside_rad - task_.angle_rad);
        const std::string words =
            arm_deg > limit_deg
                ? "fibre lies " + fixed(arm_deg, 2) + " deg off the wanted angle at " +
                      fixed(laid.arm_s_mm, 1) + " mm of the axis, on a regular arm"
                : "fibre lies " + fixed(bend_deg, 2) + " deg off even advance at " +
                      fixed(laid.bend_s_mm, 1) + " mm of the axis, " + fixed(bend_limit_deg, 2) +
                      " are allowed in or near a bend; bring the ring's fibres to land nearer to " +
                      "the head's centre";
        add(check_kind::kLaydown, arm_deg <= limit_deg && bend_deg <= bend_limit_deg, words,
            {{"arm_deg", arm_deg},
             {"arm_limit_deg", limit_deg},
             {"bend_deg", bend_deg},
             {"bend_limit_deg", bend_limit_deg}});
    }

    void check_bridging() {
        const RingQuality& laid = result_.quality;
        add(check_kind::kBridging, result_.bridges == 0 && laid.least_kn_per_mm > 0.0,
            "the tube is hollow along the fibre at " + fixed(laid.least_kn_s_mm, 1) +
                " mm of the axis: " + std::to_string(result_.bridges) +
                " bridges; wind steeper than " +
                fixed(deg_from_rad(result_.pattern.bridging_rad), 2) + " deg inside the bend",
            {{"bridges", static_cast<double>(result_.bridges)},
             {"least_kn_per_mm", laid.least_kn_per_mm}});
    }

    void check_slip() {
        const RingQuality& laid = result_.quality;
        if (options_.friction) {
            add(check_kind::kSlip, laid.slip <= *options_.friction,
                "fibre needs a friction of " + fixed(laid.slip, 3) + " at " +
                    fixed(laid.slip_s_mm, 1) + " mm of the axis, " + fixed(*options_.friction, 3) +
                    " is given; wind at a steeper angle or make the bend wider",
                {{"worst", laid.slip}, {"limit", *options_.friction}, {"s_mm", laid.slip_s_mm}});
        }
    }

    void check_cover() {
        const RingCover& cover = result_.cover;
        const RingPattern& pattern = result_.pattern;
        add(check_kind::kCoverage, cover.covered >= kAllCovered,
            "both rings' tows cover " + fixed(100.0 * cover.covered, 2) +
                " % of the wound zone: they are " + fixed(pattern.tow_width_mm, 2) +
                " mm wide and up to " + fixed(cover.widest_mm, 2) +
                " mm apart; take wider tows, more of them or more passes",
            {{"covered", cover.covered},
             {"mean_layers", cover.mean_layers},
             {"widest_mm", cover.widest_mm}});
        if (cover.regular_mm > 0.0) {
            add(check_kind::kThickness, cover.regular_cv <= kRegularCv,
                "the layers scatter by " + fixed(cover.regular_cv, 4) + " on the regular arms, " +
                    fixed(kRegularCv, 2) + " are allowed",
                {{"regular_cv", cover.regular_cv}, {"limit", kRegularCv}});
        }
    }

    const CarryWindingTask& task_;
    const CarryWindingOptions& options_;
    TubeSurface tube_;
    RingPatternTask pattern_;
    CarryWinding result_;
};

}  // namespace

CarryWinding wind_carried(const CarryWindingTask& task, const CarryWindingOptions& options) {
    return Winder(task, options).run();
}

std::string fibre_csv(const std::vector<RingFibre>& fibres) {
    std::string text = "pass,ring,spool,s_mm,round_deg,x_mm,y_mm,z_mm,angle_deg\n";
    for (const RingFibre& fibre : fibres) {
        const std::string head = std::to_string(fibre.pass + 1) + ',' +
                                 std::to_string(fibre.ring + 1) + ',' +
                                 std::to_string(fibre.spool + 1);
        double since_mm = kFibreStep_mm;
        for (std::size_t i = 0; i < fibre.points.size(); ++i) {
            const LaidRingPoint& point = fibre.points[i];
            since_mm += i > 0 ? (point.point_mm - fibre.points[i - 1].point_mm).norm() : 0.0;
            if (since_mm < kFibreStep_mm && i + 1 < fibre.points.size()) {
                continue;
            }
            since_mm = 0.0;
            text += head;
            const auto append = [&](double value, int decimals) {
                text += ',';
                append_fixed(text, value, decimals);
            };
            append(point.s_mm, 3);
            append(deg_from_rad(point.round_rad), 3);
            for (const double length : point.point_mm) {
                append(length, 4);
            }
            append(deg_from_rad(point.angle_rad), 3);
            text += '\n';
        }
    }
    return text;
}

}  // namespace meshwind
