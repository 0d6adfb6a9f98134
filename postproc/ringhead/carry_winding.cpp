#include "postproc/ringhead/carry_winding.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

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

// What every attempt winds: the tube, and the rings that turn about it.
struct RingWork {
    const CarryWindingTask& task;
    const CarryWindingOptions& options;
    const TubeSurface& tube;
    double spool_radius_mm = 0.0;
    double lag_mm = 0.0;  // from a ring to where its fibres land
};

// Part of the axis, mm.
struct AxisZone {
    double from_mm = 0.0;
    double to_mm = 0.0;
};

// Where the fibres of all passages lie.
AxisZone wound_zone(const std::vector<RingPassage>& passages, const RingWork& work) {
    AxisZone zone{0.0, work.task.axis.length_mm()};
    for (const RingPassage& passage : passages) {
        const auto [low, high] = std::minmax(passage.tie_s_mm, passage.end_s_mm);
        zone.from_mm = std::max(zone.from_mm, low);
        zone.to_mm = std::min(zone.to_mm, high);
    }
    if (!(zone.to_mm - zone.from_mm > kCoverRow_mm)) {
        throw InputError("carry.short", "--ring-distance",
                         "no part of the axis is wound by both rings: fibres land " +
                             fixed(work.lag_mm, 1) +
                             " mm behind a ring; take a longer axis or a steeper angle");
    }
    return zone;
}

// The programs that carry the frame, read back from their texts.
struct CarryingPrograms {
    KrlProgram forth;
    KrlProgram back;
    std::vector<double> back_s_mm;  // of the points of the one back

    [[nodiscard]] const KrlProgram& of(const RingPassage& passage) const {
        return passage.back ? back : forth;
    }
};

CarryingPrograms read_programs(const CarryWindingTask& task, bool at_once) {
    CarryingPrograms programs;
    programs.forth = read_krl(task.forth, "program.src");
    programs.back = at_once ? programs.forth : read_krl(task.back, "program_back.src");
    programs.back_s_mm.assign(task.s_mm.rbegin(), task.s_mm.rend());
    return programs;
}

// Text of rings.csv.
std::string drive_rings(const std::vector<RingPassage>& passages, const CarryingPrograms& programs,
                        const CarryWindingTask& task) {
    const double turns_per_mm = ring_turns_per_mm(task.angle_rad, task.tube_radius_mm);
    std::vector<std::vector<RingRow>> rows;
    rows.reserve(passages.size());
    for (const RingPassage& passage : passages) {
        rows.push_back(drive_ring(passage, programs.of(passage),
                                  passage.back ? programs.back_s_mm : task.s_mm, task.head,
                                  turns_per_mm));
    }
    return rings_csv(passages, rows);
}

RingSpools spools_of(const RingPassage& passage, const RingWork& work) {
    RingSpools spools;
    spools.ring = passage.ring;
    spools.count = work.task.tows;
    spools.radius_mm = work.spool_radius_mm;
    spools.phase_rad = passage.phase_rad;
    spools.tie_s_mm = passage.tie_s_mm;
    spools.right_handed = passage.right_handed;
    return spools;
}

// Fibres of all passages, by the text of rings.csv.
void lay_fibres(const RingWork& work, const CarryingPrograms& programs, CarryWinding& winding) {
    const CarryWindingTask& task = work.task;
    for (const RingPassage& passage : winding.passages) {
        const auto states =
            play_head(programs.of(passage), read_rings_csv(winding.rings, "rings.csv", passage),
                      task.head, work.tube);
        for (RingFibre& fibre :
             lay_ring_fibres(states, task.head, work.tube, spools_of(passage, work))) {
            fibre.pass = passage.pass;
            winding.fibre_mm += fibre.length_mm;
            winding.bridges += fibre.bridges.size();
            winding.fibres.push_back(std::move(fibre));
        }
    }
}

RingCoverTask cover_task(const CarryWinding& winding, double angle_rad) {
    RingCoverTask task;
    task.from_mm = winding.zone_from_mm;
    task.to_mm = winding.zone_to_mm;
    task.angle_rad = angle_rad;
    task.tow_width_mm = winding.pattern.tow_width_mm;
    task.settle_mm = kSettleLags * winding.lag_mm;
    return task;
}

// Winds a pattern, without checks. \param wanted gets the length of axis that is wound
CarryWinding wind_pattern(const RingWork& work, RingPatternTask& wanted) {
    const CarryWindingTask& task = work.task;
    const bool at_once = work.options.at_once;
    const RingPattern meant = ring_pattern(wanted);
    CarryWinding winding;
    winding.spool_radius_mm = work.spool_radius_mm;
    winding.lag_mm = work.lag_mm;
    winding.bend_radius_mm = wanted.bend_radius_mm;
    winding.passages = ring_passages(
        task.head, {task.axis.length_mm(), work.lag_mm, meant.passes, meant.offset_rad, at_once});
    const AxisZone zone = wound_zone(winding.passages, work);
    winding.zone_from_mm = zone.from_mm;
    winding.zone_to_mm = zone.to_mm;
    wanted.laid_mm = zone.to_mm - zone.from_mm;
    winding.pattern = ring_pattern(wanted);
    const CarryingPrograms programs = read_programs(task, at_once);
    winding.rings = drive_rings(winding.passages, programs, task);
    lay_fibres(work, programs, winding);
    const RingCoverTask cover = cover_task(winding, task.angle_rad);
    winding.cover = ring_cover(work.tube, winding.fibres, cover);
    winding.quality = ring_quality(work.tube, winding.fibres, cover);
    return winding;
}

bool is_wide_enough(const CarryWinding& winding) {
    return winding.cover.widest_mm <= winding.pattern.tow_width_mm;
}

// Winds with wider tows, then with more passes, until laid fibre covers: it is further apart
// outside a bend than even advance has it.
CarryWinding wind_until_covered(const RingWork& work) {
    const CarryWindingTask& task = work.task;
    RingPatternTask wanted{task.tube_radius_mm,  task.angle_rad,      task.tows,
                           task.tow_width_mm,    work.options.passes, tightest_bend_mm(work.tube),
                           task.axis.length_mm()};
    CarryWinding winding = wind_pattern(work, wanted);
    const auto wind_again = [&] {
        winding = CarryWinding{};  // long fibres are not kept twice
        winding = wind_pattern(work, wanted);
    };
    if (!(task.tow_width_mm > 0.0) && !is_wide_enough(winding)) {
        wanted.tow_width_mm = next_tow_width_mm(winding.cover.widest_mm);
        wanted.passes = winding.pattern.passes;
        wind_again();
    }
    for (int more = 0; work.options.passes == 0 && more < kMorePasses && !is_wide_enough(winding);
         ++more) {
        wanted.passes = winding.pattern.passes + 1;
        wind_again();
    }
    return winding;
}

// \param words where it failed
Check check_of(const CheckKind& kind, bool ok, const std::string& words,
               std::map<std::string, double> numbers) {
    return Check(kind, ok, ok ? "" : words, std::move(numbers));
}

Check laydown_check(const CarryWinding& winding, double angle_rad, double limit_deg) {
    const RingQuality& laid = winding.quality;
    const double arm_deg = deg_from_rad(laid.arm_off_rad);
    const double bend_deg = deg_from_rad(laid.bend_off_rad);
    const double bend_limit_deg = limit_deg + deg_from_rad(winding.pattern.inside_rad - angle_rad);
    const std::string words =
        arm_deg > limit_deg
            ? "fibre lies " + fixed(arm_deg, 2) + " deg off the wanted angle at " +
                  fixed(laid.arm_s_mm, 1) + " mm of the axis, on a regular arm"
            : "fibre lies " + fixed(bend_deg, 2) + " deg off even advance at " +
                  fixed(laid.bend_s_mm, 1) + " mm of the axis, " + fixed(bend_limit_deg, 2) +
                  " are allowed in or near a bend; bring the ring's fibres to land nearer to " +
                  "the head's centre";
    return check_of(check_kind::kLaydown, arm_deg <= limit_deg && bend_deg <= bend_limit_deg, words,
                    {{"arm_deg", arm_deg},
                     {"arm_limit_deg", limit_deg},
                     {"bend_deg", bend_deg},
                     {"bend_limit_deg", bend_limit_deg}});
}

Check bridging_check(const CarryWinding& winding) {
    const RingQuality& laid = winding.quality;
    return check_of(
        check_kind::kBridging, winding.bridges == 0 && laid.least_kn_per_mm > 0.0,
        "the tube is hollow along the fibre at " + fixed(laid.least_kn_s_mm, 1) +
            " mm of the axis: " + std::to_string(winding.bridges) + " bridges; wind steeper than " +
            fixed(deg_from_rad(winding.pattern.bridging_rad), 2) + " deg inside the bend",
        {{"bridges", static_cast<double>(winding.bridges)},
         {"least_kn_per_mm", laid.least_kn_per_mm}});
}

Check slip_check(const RingQuality& laid, double friction) {
    return check_of(check_kind::kSlip, laid.slip <= friction,
                    "fibre needs a friction of " + fixed(laid.slip, 3) + " at " +
                        fixed(laid.slip_s_mm, 1) + " mm of the axis, " + fixed(friction, 3) +
                        " is given; wind at a steeper angle or make the bend wider",
                    {{"worst", laid.slip}, {"limit", friction}, {"s_mm", laid.slip_s_mm}});
}

Check coverage_check(const RingCover& cover, double tow_width_mm) {
    return check_of(check_kind::kCoverage, cover.covered >= kAllCovered,
                    "both rings' tows cover " + fixed(100.0 * cover.covered, 2) +
                        " % of the wound zone: they are " + fixed(tow_width_mm, 2) +
                        " mm wide and up to " + fixed(cover.widest_mm, 2) +
                        " mm apart; take wider tows, more of them or more passes",
                    {{"covered", cover.covered},
                     {"mean_layers", cover.mean_layers},
                     {"widest_mm", cover.widest_mm}});
}

// Of the regular arms.
Check thickness_check(const RingCover& cover) {
    return check_of(check_kind::kThickness, cover.regular_cv <= kRegularCv,
                    "the layers scatter by " + fixed(cover.regular_cv, 4) +
                        " on the regular arms, " + fixed(kRegularCv, 2) + " are allowed",
                    {{"regular_cv", cover.regular_cv}, {"limit", kRegularCv}});
}

std::vector<Check> checks_of(const CarryWinding& winding, const RingWork& work) {
    const CarryWindingOptions& options = work.options;
    std::vector<Check> checks{
        laydown_check(winding, work.task.angle_rad, options.angle_tolerance_deg),
        bridging_check(winding)};
    if (options.friction) {
        checks.push_back(slip_check(winding.quality, *options.friction));
    }
    checks.push_back(coverage_check(winding.cover, winding.pattern.tow_width_mm));
    if (winding.cover.regular_mm > 0.0) {
        checks.push_back(thickness_check(winding.cover));
    }
    return checks;
}

}  // namespace

CarryWinding wind_carried(const CarryWindingTask& task, const CarryWindingOptions& options) {
    const TubeSurface tube(task.axis, task.tube_radius_mm);
    const double spool_radius_mm = options.spool_radius_mm.value_or(task.head.ring_radius_mm);
    require_numbers(task, options, spool_radius_mm);
    const RingWork work{task, options, tube, spool_radius_mm,
                        landing_lag_mm(spool_radius_mm, task.tube_radius_mm, task.angle_rad)};
    CarryWinding winding = wind_until_covered(work);
    winding.checks = checks_of(winding, work);
    return winding;
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
