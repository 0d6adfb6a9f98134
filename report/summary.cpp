#include "report/summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/counted.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "pipeline/part_words.h"
#include "report/report_checks.h"
#include "report/report_layers.h"
#include "report/write_run.h"

namespace meshwind {
namespace {

constexpr double kSPerMin = 60.0;

// Angles that differ by less are the same to whoever winds.
constexpr double kSameAngle_deg = 0.05;

// What the layer asks for, where another angle was laid.
std::optional<double> other_angle_asked(const LayerJob& job, double laid_rad) {
    const bool other =
        job.angle_deg && std::abs(*job.angle_deg - deg_from_rad(laid_rad)) > kSameAngle_deg;
    return other ? job.angle_deg : std::nullopt;
}

// Where the motion of least time is asked for and could not be had.
void print_first_motions(std::ostream& out, const WoundLayer& layer) {
    const std::vector<FibreProgram>& programs = layer.programs;
    if (!wants_least_time(layer.setup)) {
        return;
    }
    for (std::size_t fibre = 0; fibre < programs.size(); ++fibre) {
        if (!programs[fibre].made.optimal) {
            const std::string which =
                programs.size() > 1 ? " of fibre " + std::to_string(fibre + 1) : "";
            out << "  motion" << which
                << ": by the central angle; none of least time was found that keeps clear and lays "
                   "the fibre as planned\n";
        }
    }
}

std::string asked_words(const LayerJob& job, double laid_rad) {
    const std::optional<double> asked = other_angle_asked(job, laid_rad);
    return asked ? " (" + fixed(*asked, 2) + " asked for)" : "";
}

void print_pattern(std::ostream& out, const LaidPattern& laid, const LayerJob& job, Detail detail) {
    const Pattern& pattern = laid.pattern;
    out << "pattern: " << counted(pattern.circuits, "circuit") << " at "
        << fixed(deg_from_rad(laid.angle_rad), 2) << " deg" << asked_words(job, laid.angle_rad)
        << ", " << counted(pattern.starts, "start") << ' ' << word_of(pattern.order) << ", dwell "
        << fixed(deg_from_rad(pattern.dwell_rad), 2) << " deg a circuit, bands "
        << (pattern.overlap < 0.0 ? "leave gaps of " : "overlap by ")
        << percent(std::abs(pattern.overlap)) << '\n';
    if (detail == Detail::Full) {
        const Interlacing& cross = laid.interlacing;
        out << "  " << counted(cross.crossing_rows, "row") << " of "
            << counted(pattern.circuits, "crossing") << ", "
            << counted(cross.diamonds_around, "diamond") << " around\n";
    }
    if (laid.lattice) {
        const LaidLattice& lattice = *laid.lattice;
        out << "  lattice: " << counted(2 * pattern.circuits, "rib") << " of "
            << fixed(lattice.rib_mm, 2) << " mm, " << fixed(lattice.rib_spacing_mm, 2)
            << " mm apart at the widest place, " << lattice.series << " series "
            << fixed(lattice.offset_mm, 2) << " mm apart, "
            << counted(lattice.plies, "ply", "plies") << '\n';
    }
}

void print_elbow(std::ostream& out, const LaidElbow& laid, const LayerJob& job, Detail detail) {
    out << "elbow: " << counted(laid.lines, "line") << " of either hand (" << laid.needed_by_bend
        << " for the bend) at " << fixed(deg_from_rad(laid.angle_rad), 2) << " deg outside"
        << asked_words(job, laid.angle_rad) << ", " << fixed(deg_from_rad(laid.inner_angle_rad), 2)
        << " deg inside, " << fixed(laid.thinnest_layers, 2) << " to "
        << fixed(laid.thickest_layers, 2) << " layers on the bend\n";
    if (detail == Detail::Brief) {
        return;
    }
    for (const LaidElbowLeg& leg : laid.leg) {
        out << "leg: " << fixed(leg.length_mm, 1) << " mm, closed for " << fixed(leg.closed_mm, 1)
            << ", steered over " << fixed(leg.run_mm, 1) << " to "
            << fixed(deg_from_rad(leg.angle_rad), 2) << " deg, slip ratio "
            << fixed(leg.slip_ratio, 3) << '\n';
    }
}

// "with a friction of 0.30 instead of 0.20"
std::string words_of(const RelaxedRule& what_if, const WoundLayer& layer) {
    const Job& job = layer.setup.job;
    const auto looser = [&](const char* a, double now, const char* unit) {
        return std::string("with ") + a + " " + name_of(what_if.rule) + " of " +
               fixed(what_if.factor * now, 2) + unit + " instead of " + fixed(now, 2) + unit;
    };
    switch (what_if.rule) {
        case RelaxedRule::Rule::Friction:
            return looser("a", layer.setup.friction.holds(), "");
        case RelaxedRule::Rule::Bridging:
            return looser("a", job.tow.bridging_tolerance_mm, " mm");
        case RelaxedRule::Rule::Extension:
            return looser("an", job.mandrel.extension_mm, " mm");
        case RelaxedRule::Rule::Pins:
            return "with turns on pins (\"turn\": \"pins\", which do with shorter extensions)";
    }
    return {};
}

// Bare wall by reason, the largest first, and what looser rules would reach; briefly the first of
// each, of these if it is much.
void print_bare_wall(std::ostream& out, const WoundLayer& layer, Detail detail) {
    std::map<std::string, double> area_mm2;
    for (const Uncovered& bare : layer.plan.uncovered) {
        area_mm2[bare.rule] += bare.area_mm2;
    }
    std::vector<std::pair<std::string, double>> reasons(area_mm2.begin(), area_mm2.end());
    std::stable_sort(reasons.begin(), reasons.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    if (detail == Detail::Brief && !reasons.empty()) {
        reasons.resize(1);
    }
    for (const auto& [reason, mm2] : reasons) {
        out << "  bare: " << fixed(mm2 / 100.0, 2) << " cm2: " << reason << '\n';
    }
    const std::vector<double>& reach = layer.plan.reach_of_fibres;
    const auto fibres = static_cast<std::size_t>(layer.setup.job.fibres);
    if (detail == Detail::Full && reach.size() > fibres) {
        out << "  with \"fibres\": " << fibres + 1 << " in the job courses would reach "
            << percent(reach[fibres]) << " of the wall instead of " << percent(reach[fibres - 1])
            << '\n';
    }
    constexpr double kMuch = 0.02;  // of the wall
    for (const RelaxedRule& what_if : layer.plan.what_if) {
        if (detail == Detail::Brief && what_if.reachable < layer.plan.coverage.reachable + kMuch) {
            return;
        }
        out << "  " << words_of(what_if, layer) << " courses would reach "
            << percent(what_if.reachable) << " of the wall\n";
        if (detail == Detail::Brief) {
            return;
        }
    }
}

// What the run is about, and what of it nobody has said.
void print_part(std::ostream& out, const Run& run) {
    const Setup& setup = run.layers.front().setup;
    out << setup.mandrel.file << " on " << setup.machine.name << ": " << size_words(setup.mandrel)
        << '\n';
    if (setup.rule_of_machine) {
        out << "eye: " << fixed(setup.job.eye.radius_mm, 3) << " mm from the spindle axis, where "
            << setup.machine.name << " keeps it (eye rule \"cylinder\")\n";
    }
}

void print_courses(std::ostream& out, const Plan& plan) {
    out << "plan: " << counted(plan.courses, "course") << " in " << counted(plan.fibres, "fibre")
        << ", at " << fixed(deg_from_rad(plan.angle.mean_rad), 1)
        << " deg to the axis on average\n";
}

// What courses reach, and what of it the plan's fibres cannot join where that is much.
std::string reach_words(const WoundLayer& layer) {
    const Coverage& coverage = layer.plan.coverage;
    std::string words = "reachable " + percent(coverage.reachable);
    constexpr double kMuch = 0.005;  // of the wall
    if (coverage.joinable.value_or(coverage.reachable) + kMuch < coverage.reachable) {
        words +=
            ", " + percent(*coverage.joinable) + " by " + counted(layer.setup.job.fibres, "fibre");
    }
    return words;
}

// In the trade's words.
void print_plan(std::ostream& out, const WoundLayer& layer, Detail detail) {
    const Plan& plan = layer.plan;
    if (plan.pattern() != nullptr) {
        print_pattern(out, *plan.pattern(), layer.job, detail);
    } else if (plan.elbow() != nullptr) {
        print_elbow(out, *plan.elbow(), layer.job, detail);
    } else {
        print_courses(out, plan);
    }
    if (!layer.no_pattern.empty()) {
        out << "  no pattern is laid: " << layer.no_pattern << '\n';
    }
    out << "covered: " << percent(plan.coverage.fraction) << " of the wall"
        << (layer.import ? "" : " (" + reach_words(layer) + ")") << ", "
        << fixed(plan.coverage.mean_layers, 2) << " layers on average, at most "
        << plan.coverage.max_layers << ", at least " << plan.coverage.p1_layers
        << (layer.import ? " on 99 % of it\n" : " on 99 % of what is reachable\n");
    if (layer.import) {
        const ImportFit& fit = *layer.import;
        out << fit.points << " landing points of " << fit.file << ", off the mandrel by "
            << fixed(fit.mean_mm, 4) << " mm on average, at most " << fixed(fit.worst_mm, 4)
            << " mm in line " << fit.worst_line
            << (fit.smoothed_mm > 0.0 ? "; smoothed, the fibre passes them by " +
                                            fixed(fit.smoothed_mm, 3) + " mm at most"
                                      : "")
            << '\n';
    }
}

// Rings that have to be made and put on.
void print_pins(std::ostream& out, const std::vector<PinRing>& rings) {
    const char* before = "pins: ";
    for (const PinRing& ring : rings) {
        out << before << "at rim " << ring.rim << ' ' << ring.count << " of "
            << fixed(ring.diameter_mm, 1) << " x " << fixed(ring.height_mm, 1) << " mm, "
            << fixed(ring.offset_mm, 1) << " mm beyond it";
        before = "; ";
    }
    out << (rings.empty() ? "" : "\n");
}

void print_layer(std::ostream& out, const WoundLayer& layer, Detail detail) {
    if (layer.plan.failure.empty()) {
        print_plan(out, layer, detail);
        print_pins(out, layer.plan.pins);
        print_first_motions(out, layer);
        if (detail == Detail::Full && layer.plan.planner == Planner::Cover &&
            layer.job.kind != LayerKind::Wall) {
            out << "  fibre factor " << fixed(use_of_fibre(layer).factor, 2)
                << " (1 would be the layers asked for without gaps, overlaps and turns)\n";
        }
    }
    print_bare_wall(out, layer, detail);
}

// Fibre, what of it is cut off, and time: what it costs.
void print_cost(std::ostream& out, const Run& run) {
    const LayerFigures all = figures_of_all(run);
    if (!(all.fibre_m > 0.0)) {
        return;
    }
    std::size_t blocks = 0;
    double least_s = 0.0;
    double corner_s = 0.0;
    std::size_t turned_over = 0;
    for (const WoundLayer& layer : run.layers) {
        for (const FibreProgram& program : layer.programs) {
            blocks += program.made.blocks.moves();
            least_s += program.made.least_s;
            corner_s += program.made.corner_s;
            turned_over += program.made.verification.turned_over;
        }
    }
    out << "thickness: " << fixed(all.mean_thickness_mm, 2) << " mm on average, at most "
        << fixed(all.most_thickness_mm, 2) << " mm\n"
        << "fibre: " << fixed(all.fibre_m, 1) << " m, " << fixed(all.mass_g, 1) << " g; scrap "
        << fixed(all.scrap_m, 1) << " m (" << percent(all.scrap_m / all.fibre_m, 1) << ") in turns";
    if (all.price) {
        out << "; price " << fixed(*all.price, 2);
    }
    // A plan that covers too little takes less than all that is in reach would.
    if (const double least_m = least_fibre_m(run); least_m > 0.0 && least_m < all.fibre_m) {
        out << "; no choice of the courses found takes less than " << fixed(least_m, 1) << " m";
    }
    out << '\n';
    if (blocks > 0) {
        out << "time: " << fixed(all.time_s / kSPerMin, 1) << " min ("
            << fixed(least_s / kSPerMin, 1) << " at the fibre's full speed"
            << (corner_s > 0.0 ? ", " + fixed(corner_s / kSPerMin, 1) + " where blocks meet" : "")
            << "), " << counted(blocks, "block")
            << (turned_over > 0 ? "; the head turns over " + counted(turned_over, "time") +
                                      ", and the band with it"
                                : "")
            << '\n';
    }
}

void print_files(std::ostream& out, const Run& run, const std::filesystem::path& folder) {
    if (!run.usable) {
        out << "no program written\n";
    }
    for (const WoundLayer& layer : run.layers) {
        for (const FibreProgram& program : layer.programs) {
            if (run.usable) {
                out << "program: " << (folder / program.file).string() << '\n';
            }
        }
    }
    if (has_page(run)) {
        out << "page:    " << (folder / "report.html").string() << '\n';
    }
    out << "report:  " << (folder / "report.json").string() << '\n';
}

}  // namespace

void print_summary(std::ostream& out, const Run& run, const std::filesystem::path& folder,
                   Detail detail) {
    print_part(out, run);
    const Detail of_layers = run.passed() ? detail : Detail::Full;
    for (std::size_t i = 0; i < run.layers.size(); ++i) {
        const WoundLayer& layer = run.layers[i];
        const bool one_of_many = run.layers.size() > 1;
        if (one_of_many && layer.job.kind == LayerKind::Wall && of_layers == Detail::Brief) {
            continue;  // a stage of a wall: the table below has a line for each
        }
        if (one_of_many) {
            out << "layer " << i + 1 << ", " << name_of(layer.job.kind) << ": ";
        }
        print_layer(out, layer, of_layers);
    }
    if (run.layers.size() > 1) {
        print_laminate(out, run);
    }
    print_walls(out, run);
    print_cost(out, run);
    if (detail == Detail::Full) {
        print_checks(out, run.checks);
    } else {
        print_failed_checks(out, run.checks);
    }
    print_files(out, run, folder);
}

}  // namespace meshwind
