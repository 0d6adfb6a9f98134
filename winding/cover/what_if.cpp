#include "winding/cover/what_if.h"

#include <algorithm>

namespace meshwind {
namespace {

// By how much rules are loosened, and what is worth telling.
constexpr double kLooser = 1.5;
constexpr double kWorthAWord = 0.001;

CourseRules loosened(CourseRules rules, WhatIf::Rule rule) {
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
    }
    return rules;
}

}  // namespace

std::vector<WhatIf> ask_what_if(const CourseRules& rules, const CoverageSamples& samples,
                                const Library& library, std::uint64_t seed) {
    const double now = reached_share(library.reached);
    std::vector<WhatIf> answers;
    for (const WhatIf::Rule rule :
         {WhatIf::Rule::Friction, WhatIf::Rule::Bridging, WhatIf::Rule::Extension}) {
        const double then =
            reach_with(loosened(rules, rule), samples, library.reached, library.judging, seed);
        if (then - now > kWorthAWord) {
            answers.push_back({rule, kLooser, then});
        }
    }
    std::stable_sort(answers.begin(), answers.end(),
                     [](const WhatIf& a, const WhatIf& b) { return a.reachable > b.reachable; });
    return answers;
}

}  // namespace meshwind
