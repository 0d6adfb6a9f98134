#include "cli/plan_layer.h"

#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "cli/piece_program.h"
#include "core/text_number.h"
#include "core/units.h"
#include "mesh/grown_tube.h"
#include "mesh/triangle_soup.h"
#include "winding/cover.h"
#include "winding/elbow_plan.h"
#include "winding/hoop_path.h"
#include "winding/pattern_plan.h"

namespace meshwind {
namespace {

// Share of the friction that is planned with: the rest is for what the blocks add.
constexpr double kPlannedFriction = 0.96;

// Winding angles at the widest place that a helical layer without one is tried with.
constexpr double kFirstAngle_deg = 45.0;
constexpr double kLastAngle_deg = 80.0;
constexpr double kAngleStep_deg = 5.0;

PatternKind pattern_of(LayerKind kind) {
    switch (kind) {
        case LayerKind::Polar:
            return PatternKind::Polar;
        case LayerKind::Hoop:
            return PatternKind::Hoop;
        default:
            return PatternKind::Helical;
    }
}

PatternWish wish_of(const PatternJob& job) {
    PatternWish wish;
    wish.circuits = job.circuits;
    wish.starts = job.starts;
    wish.order = job.lead;
    wish.most_overlap = job.most_overlap;
    wish.least_dwell_rad = rad_from_deg(job.dwell_deg);
    if (job.most_dwell_deg) {
        wish.most_dwell_rad = rad_from_deg(*job.most_dwell_deg);
    }
    wish.band_offset_mm = job.band_offset_mm;
    return wish;
}

Rejection first_of(const std::map<std::size_t, Rejection>& refused) {
    return refused.empty() ? Rejection::None : refused.begin()->second;
}

class LayerPlanner {
public:
    LayerPlanner(const Setup& setup, const LayerJob& layer, const LayerPlanOptions& options)
        : setup_(setup), layer_(layer), options_(options) {}

    [[nodiscard]] Plan plan() const {
        if (setup_.job.mandrel.turn == TurnKind::Pole) {
            return plan_about_poles();
        }
        if (layer_.kind == LayerKind::Cover) {
            return plan_courses();
        }
        if (layer_.kind != LayerKind::Auto) {
            return plan_pattern_asked_for();
        }
        Plan pattern = plan_pattern_that_covers();
        std::string why = pattern.failure;
        bool has_patterns = true;
        if (!why.empty()) {
            const bool round = find_revolution(setup_.mandrel).body.has_value();
            pattern = plan_elbow_that_covers();
            why = round ? why : pattern.failure;
            has_patterns = round || !pattern.planner.empty();
        }
        if (pattern.failure.empty()) {
            const std::size_t refused = options_.refused(pattern.pieces).size();
            if (refused == 0) {
                return pattern;
            }
            why = std::to_string(refused) + " of " + std::to_string(pattern.pieces.size()) +
                  " courses and turns of the pattern cannot be wound: " + options_.why_refused();
        }
        pattern = {};  // its memory
        return has_patterns ? cover_instead(why) : plan_courses();
    }

private:
    // On a body that has patterns, for want of one.
    [[nodiscard]] Plan cover_instead(const std::string& why) const {
        const Surface& surface = setup_.mandrel.surface;
        const double tow_mm = setup_.job.tow.width_mm;
        const double wall_mm2 = area_mm2({surface.position_mm, surface.face});
        if (wall_mm2 > kMostTowSquares * tow_mm * tow_mm) {
            Plan plan;
            plan.planner = "pattern";
            plan.failure = "no pattern is laid: " + why + "; a wall of " +
                           fixed(wall_mm2 / 1e6, 3) +
                           " m2 is too large to be covered by single "
                           "courses of a tow of " +
                           fixed(tow_mm, 1) + " mm instead, unless \"kind\": \"cover\" asks for it";
            return plan;
        }
        if (options_.no_pattern) {
            options_.no_pattern(why);
        }
        Plan courses = plan_courses();
        if (!courses.failure.empty()) {
            courses.failure += "; of patterns the last one tried: " + why;
        }
        return courses;
    }

    // Without an extension to turn on, patterns are all there is.
    [[nodiscard]] Plan plan_about_poles() const {
        Plan plan;
        if (layer_.kind == LayerKind::Auto) {
            plan = plan_pattern_that_covers();
        } else if (layer_.kind != LayerKind::Cover) {
            plan = plan_pattern_asked_for();
        }
        if (plan.failure.empty() && plan.planner != "pattern") {
            plan = {};
            plan.failure =
                "fibre turns about a pole in patterns on the domes of a body of revolution only; "
                "use \"turn\": \"friction\"";
        }
        return plan;
    }

    [[nodiscard]] Plan plan_pattern_asked_for() const {
        const RevolutionFinding found = find_revolution(setup_.mandrel);
        if (!found.body) {
            const TubeFinding tube = tube_of_wall();
            return layer_.kind == LayerKind::Helical && tube.tube ? plan_elbow_on(*tube.tube)
                                                                  : no_pattern(found);
        }
        return plan_pattern_on(*found.body, pattern_of(layer_.kind),
                               rad_from_deg(layer_.angle_deg.value_or(kFirstAngle_deg)));
    }

    static Plan no_pattern(const RevolutionFinding& found) {
        Plan plan;
        plan.planner = "pattern";
        plan.failure =
            "patterns are wound on bodies of revolution, helical ones on elbows, too, and this is "
            "none: " +
            found.why_not + "; use \"cover\"";
        return plan;
    }

    // Polar where both ends are narrow, else helical, by the angle asked for or the smallest that
    // holds. Fails where there is none.
    [[nodiscard]] Plan plan_pattern_that_covers() const {
        const RevolutionFinding found = find_revolution(setup_.mandrel);
        if (!found.body) {
            return no_pattern(found);
        }
        if (layer_.angle_deg) {
            return covering(*found.body, PatternKind::Helical, rad_from_deg(*layer_.angle_deg));
        }
        Plan plan = covering(*found.body, PatternKind::Polar, 0.0);
        for (double next_deg = kFirstAngle_deg; !plan.failure.empty() && next_deg <= kLastAngle_deg;
             next_deg += kAngleStep_deg) {
            plan = covering(*found.body, PatternKind::Helical, rad_from_deg(next_deg));
        }
        return plan;
    }

    // Layers follow the bare tube's line, whatever shape they have.
    [[nodiscard]] TubeFinding tube_of_wall() const {
        if (options_.bare == nullptr) {
            return find_tube(setup_.mandrel);
        }
        TubeFinding bare = find_tube(*options_.bare);
        return bare.tube ? grown_tube(*bare.tube, setup_.mandrel, options_.build_up_mm) : bare;
    }

    [[nodiscard]] Plan plan_elbow_that_covers() const {
        const TubeFinding found = tube_of_wall();
        Plan plan;
        plan.failure = found.why_not;
        return found.tube ? covering(plan_elbow_on(*found.tube)) : plan;
    }

    [[nodiscard]] Plan plan_elbow_on(const Tube& tube) const {
        if (layer_.pattern) {
            Plan plan;
            plan.planner = "elbow";
            plan.failure =
                "\"pattern\" says how circuits of a body of revolution close; the lines of an "
                "elbow "
                "follow from its bend, so leave it out";
            return plan;
        }
        ElbowPlanOptions elbow;
        if (layer_.angle_deg) {
            elbow.angle_rad = rad_from_deg(*layer_.angle_deg);
        }
        elbow.layers = layer_.target_layers;
        elbow.tow = planned_tow();
        elbow.turn.extension_mm = setup_.job.mandrel.extension_mm;
        elbow.seed = options_.seed;
        elbow.on_layers = options_.bare != nullptr;
        Plan plan = plan_elbow(setup_.mandrel, tube, elbow);
        if (options_.before != nullptr) {
            plan.cut_because = "the lines of an elbow are not led on from another layer";
        }
        return plan;
    }

    [[nodiscard]] static Plan covering(Plan plan) {
        if (plan.failure.empty() && plan.coverage.fraction < kCoveredShare) {
            plan.failure = "the pattern covers too little";
        }
        return plan;
    }

    [[nodiscard]] Plan covering(const BodyOfRevolution& body, PatternKind kind,
                                double angle_rad) const {
        return covering(plan_pattern_on(body, kind, angle_rad));
    }

    [[nodiscard]] Plan plan_pattern_on(const BodyOfRevolution& body, PatternKind kind,
                                       double angle_rad) const {
        PatternOptions pattern;
        pattern.kind = kind;
        pattern.angle_rad = angle_rad;
        pattern.layers = layer_.target_layers;
        pattern.tow = planned_tow();
        pattern.turn.extension_mm = setup_.job.mandrel.extension_mm;
        if (kind == PatternKind::Hoop && options_.bare != nullptr) {
            pattern.hoop_z_mm = cylinder_of(*options_.bare);
        }
        if (options_.before != nullptr) {
            pattern.before = fibre_end_of(*options_.before);
        }
        pattern.seed = options_.seed;
        pattern.lattice = layer_.lattice;
        pattern.over_rims = setup_.job.mandrel.turn != TurnKind::Pole;
        if (setup_.job.mandrel.turn == TurnKind::Pins) {
            pattern.pins = setup_.job.mandrel.pins;
        }
        if (layer_.pattern) {
            pattern.wish = wish_of(*layer_.pattern);
        }
        return plan_pattern(setup_.mandrel, body, pattern);
    }

    // Heights between which the bare body is a cylinder, at its widest place.
    static std::optional<std::array<double, 2>> cylinder_of(const Mandrel& bare) {
        const RevolutionFinding found = find_revolution(bare);
        if (!found.body) {
            return std::nullopt;
        }
        const Meridian& meridian = found.body->meridian;
        const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
        if (part.from_mm == part.to_mm) {
            return std::nullopt;
        }
        return std::array{meridian.at(part.from_mm).z_mm, meridian.at(part.to_mm).z_mm};
    }

    [[nodiscard]] Tow planned_tow() const {
        const Job::TowJob& tow = setup_.job.tow;
        return {tow.width_mm, tow.thickness_mm, kPlannedFriction * tow.friction,
                tow.bridging_tolerance_mm};
    }

    [[nodiscard]] Plan plan_courses() const {
        const Job& job = setup_.job;
        CoverOptions cover;
        cover.tow = planned_tow();
        cover.turn.extension_mm = job.mandrel.extension_mm;
        cover.free_fibre = setup_.rule.free_fibre;
        cover.select.target_layers = static_cast<int>(std::ceil(layer_.target_layers));
        if (layer_.angle_deg) {
            cover.angle_rad = rad_from_deg(*layer_.angle_deg);
        }
        cover.fibres = job.fibres;
        cover.seed = options_.seed;
        cover.effort = options_.effort;
        cover.accept = [this](std::span<const Piece> pieces) {
            return first_of(refused_by_machine(setup_, pieces));
        };
        cover.wind = [this](std::span<const Piece> pieces) {
            return first_of(program_of(setup_, pieces).refused);
        };
        cover.refused = options_.refused;
        cover.progress = [this](const char* step, double share) { options_.progress(step, share); };
        return plan_cover(setup_.mandrel, *setup_.obstacles, cover);
    }

    const Setup& setup_;
    const LayerJob& layer_;
    const LayerPlanOptions& options_;
};

}  // namespace

Plan plan_layer(const Setup& setup, const LayerJob& layer, const LayerPlanOptions& options) {
    if (options.progress) {
        options.progress("plan", 0.0);
    }
    return LayerPlanner(setup, layer, options).plan();
}

}  // namespace meshwind
