#include "winding/cover/what_if.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "winding/turn/course_turns.h"

namespace meshwind {
namespace {

// By how much rules are loosened, and what is worth telling.
constexpr double kLooser = 1.5;
constexpr double kWorthAWord = 0.001;

// Pins are a change of the tooling: nothing is said of them for less wall.
constexpr double kWorthPins = 0.01;

double worth_a_word(WhatIf::Rule rule) {
    return rule == WhatIf::Rule::Pins ? kWorthPins : kWorthAWord;
}

// Nothing where pins cannot stand, or do already.
std::optional<CourseRules> loosened(CourseRules rules, WhatIf::Rule rule) {
    switch (rule) {
        case WhatIf::Rule::Friction:
            rules.tow.friction = rules.tow.friction.share(kLooser);
            rules.turns.rule.friction = rules.turns.rule.friction.share(kLooser);
            break;
        case WhatIf::Rule::Bridging:
            rules.tow.bridging_tolerance_mm *= kLooser;
            break;
        case WhatIf::Rule::Extension:
            rules.turns.rule.extension_mm *= kLooser;
            break;
        case WhatIf::Rule::Pins: {
            std::string failure;
            std::vector<PinStand> pins = rules.turns.pins.empty()
                                             ? stand_pins(rules.mandrel.rims, {}, rules.tow,
                                                          rules.turns.rule.extension_mm, failure)
                                             : std::vector<PinStand>();
            if (pins.empty()) {
                return std::nullopt;
            }
            rules.turns.pins = std::move(pins);
            break;
        }
    }
    return rules;
}

}  // namespace

std::vector<WhatIf> ask_what_if(const CourseRules& rules, const CoverageSamples& samples,
                                const Library& library, std::uint64_t seed) {
    const double now = reached_share(library.reached);
    std::vector<WhatIf> answers;
    for (const WhatIf::Rule rule : {WhatIf::Rule::Friction, WhatIf::Rule::Bridging,
                                    WhatIf::Rule::Extension, WhatIf::Rule::Pins}) {
        const double worth = worth_a_word(rule);
        const auto then = 1.0 - now > worth ? loosened(rules, rule) : std::nullopt;
        const double reachable =
            then ? reach_with(*then, samples, library.reached, library.judging, seed) : now;
        if (reachable - now > worth) {
            answers.push_back({rule, rule == WhatIf::Rule::Pins ? 1.0 : kLooser, reachable});
        }
    }
    std::stable_sort(answers.begin(), answers.end(),
                     [](const WhatIf& a, const WhatIf& b) { return a.reachable > b.reachable; });
    return answers;
}

}  // namespace meshwind
