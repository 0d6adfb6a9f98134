#include "pipeline/job/turn_kinds.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>

#include "pipeline/job/job.h"
#include "winding/revolution/pin_pattern.h"

namespace meshwind {
namespace {

std::unique_ptr<RimTurns> turns_by_friction(const Job& /*job*/, const Tow& tow,
                                            double extension_mm) {
    return friction_turns(tow, extension_mm);
}

std::unique_ptr<RimTurns> turns_on_pins(const Job& job, const Tow& tow, double extension_mm) {
    return pin_turns(job.mandrel.pins, tow, extension_mm);
}

std::unique_ptr<RimTurns> turns_about_poles(const Job& /*job*/, const Tow& /*tow*/,
                                            double /*extension_mm*/) {
    return no_rim_turns();
}

// Turns on pins belong to a pattern, which says how many there are and where.
std::string why_not_on_pins(const Job& job, bool points_given) {
    const std::string mend =
        " is not offered yet; give one layer of kind \"helical\" or \"lattice\" with its angle, or "
        "layers of kinds \"cover\" and \"wall\"";
    if (points_given) {
        return "turning on pins with landing points that are given is not offered yet; use "
               "\"friction\"";
    }
    const auto is_any_of = [](const LayerJob& layer, std::initializer_list<LayerKind> kinds) {
        return std::find(kinds.begin(), kinds.end(), layer.kind) != kinds.end();
    };
    const bool courses = std::all_of(job.layers.begin(), job.layers.end(), [&](const LayerJob& l) {
        return is_any_of(l, {LayerKind::Cover, LayerKind::Wall});
    });
    if (job.layers.size() > 1 && !courses) {
        return "turning on pins with several layers" + mend;
    }
    if (!courses &&
        !is_any_of(job.layers.front(), {LayerKind::Auto, LayerKind::Helical, LayerKind::Lattice})) {
        return "turning on pins with layers of other kinds" + mend;
    }
    return {};
}

constexpr std::array kTurnKinds{
    TurnKindTraits{
        .kind = TurnKind::Friction,
        .word = "friction",
        .takes_run = true,
        .turns = turns_by_friction,
    },
    TurnKindTraits{
        .kind = TurnKind::Pins,
        .word = "pins",
        .reads_pins = true,
        .why_not = why_not_on_pins,
        .turns = turns_on_pins,
    },
    TurnKindTraits{
        .kind = TurnKind::Pole,
        .word = "pole",
        .meaning = "not at all, only on domes, where a pattern turns by itself about the pole",
        .why_patterns =
            "fibre turns about a pole in patterns on the domes of a body of revolution only; use "
            "\"turn\": \"friction\"",
        .turns = turns_about_poles,
    },
};

}  // namespace

std::span<const TurnKindTraits> turn_kinds() {
    return kTurnKinds;
}

const TurnKindTraits& traits_of(TurnKind kind) {
    return kTurnKinds[static_cast<std::size_t>(kind)];
}

}  // namespace meshwind
