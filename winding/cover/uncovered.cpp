#include "winding/cover/uncovered.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "core/index.h"
#include "winding/turn/course_turns.h"

namespace meshwind {
namespace {

// What samples that are bare for the same reason have in common.
struct Reason {
    std::int32_t region = -1;
    bool passed = false;  // by a member of the library
    CourseFault rejection = CourseFault::None;
    CandidateFault refusal = CandidateFault::None;

    [[nodiscard]] bool operator<(const Reason& other) const {
        return std::tie(region, passed, rejection, refusal) <
               std::tie(other.region, other.passed, other.rejection, other.refusal);
    }
};

// Per sample that members pass: what became of most of them. Where one of them holds it is None
// unless more were refused than not; where none of those tried does, the others do not count.
std::vector<std::optional<CourseFault>> commonest_rejections(
    const Library& library, std::span<const CourseFault> rejection) {
    std::vector<std::array<std::int32_t, kRejections>> tally(library.reached.size());
    for (std::size_t i = 0; i < library.members.size(); ++i) {
        for (const std::int32_t sample : library.members[i].footprint) {
            ++tally[at(sample)][static_cast<std::size_t>(rejection[i])];
        }
    }
    std::vector<std::optional<CourseFault>> commonest(tally.size());
    for (std::size_t i = 0; i < tally.size(); ++i) {
        const auto& counts = tally[i];
        const auto most = std::max_element(counts.begin() + 1, counts.end()) - counts.begin();
        const std::int32_t refused = std::accumulate(counts.begin() + 1, counts.end(), 0);
        const std::int32_t others = library.reached[i] != 0 ? counts[0] : 0;
        if (refused > others) {
            commonest[i] = static_cast<CourseFault>(most);
        } else if (counts[0] > 0) {
            commonest[i] = CourseFault::None;
        }
    }
    return commonest;
}

std::string rule_of(const Reason& reason) {
    if (!reason.passed) {
        return reason.refusal == CandidateFault::None ? "no candidate was tried here"
                                                      : name_of(reason.refusal);
    }
    return reason.rejection == CourseFault::None
               ? "a course for it would lay more fibre over covered wall than it gains"
               : name_of(reason.rejection);
}

// Of how many courses a rejection is the reason.
std::string so_with(const Reason& reason, int courses) {
    return reason.rejection == CourseFault::None
               ? ""
               : " (so with " + std::to_string(courses) + (courses == 1 ? " course" : " courses") +
                     " that would cover it)";
}

// By how much rules are loosened, and what is worth telling.
constexpr double kLooser = 1.5;
constexpr double kWorthAWord = 0.001;

// Pins are a change of the tooling: nothing is said of them for less wall.
constexpr double kWorthPins = 0.01;

double worth_a_word(RelaxedRule::Rule rule) {
    return rule == RelaxedRule::Rule::Pins ? kWorthPins : kWorthAWord;
}

// Nothing where pins cannot stand, or do already.
std::optional<CourseRules> loosened(CourseRules rules, RelaxedRule::Rule rule) {
    switch (rule) {
        case RelaxedRule::Rule::Friction:
            rules.tow.friction = rules.tow.friction.share(kLooser);
            rules.turns.rule.friction = rules.turns.rule.friction.share(kLooser);
            break;
        case RelaxedRule::Rule::Bridging:
            rules.tow.bridging_tolerance_mm *= kLooser;
            break;
        case RelaxedRule::Rule::Extension:
            rules.turns.rule.extension_mm *= kLooser;
            break;
        case RelaxedRule::Rule::Pins: {
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

std::vector<Uncovered> uncovered_wall(const Surface& surface, const CoverageSamples& samples,
                                      const Library& library,
                                      std::span<const CourseFault> rejection,
                                      std::span<const std::int32_t> layers) {
    const auto commonest = commonest_rejections(library, rejection);
    const auto reason_of = [&](std::size_t sample) {
        const std::int32_t region = surface.region[at(samples.at[sample].face)];
        return commonest[sample]
                   ? Reason{region, true, *commonest[sample], CandidateFault::None}
                   : Reason{region, false, CourseFault::None, library.closest_miss[sample]};
    };
    std::map<Reason, double> area_mm2;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (layers[i] == 0) {
            area_mm2[reason_of(i)] += samples.area_mm2;
        }
    }
    std::map<Reason, int> courses;
    for (std::size_t i = 0; i < library.members.size(); ++i) {
        std::set<Reason> kept_bare;
        for (const std::int32_t sample : library.members[i].footprint) {
            if (layers[at(sample)] == 0 && commonest[at(sample)] == rejection[i]) {
                kept_bare.insert(reason_of(at(sample)));
            }
        }
        for (const Reason& reason : kept_bare) {
            ++courses[reason];
        }
    }
    std::vector<Uncovered> uncovered;
    uncovered.reserve(area_mm2.size());
    for (const auto& [reason, mm2] : area_mm2) {
        const std::string rule = rule_of(reason);
        uncovered.push_back({reason.region, mm2, rule + so_with(reason, courses[reason]), rule});
    }
    return uncovered;
}

std::vector<RelaxedRule> coverage_if_relaxed(const CourseRules& rules,
                                             const CoverageSamples& samples, const Library& library,
                                             std::uint64_t seed) {
    const double now = reached_share(library.reached);
    std::vector<RelaxedRule> answers;
    for (const RelaxedRule::Rule rule : {RelaxedRule::Rule::Friction, RelaxedRule::Rule::Bridging,
                                         RelaxedRule::Rule::Extension, RelaxedRule::Rule::Pins}) {
        const double worth = worth_a_word(rule);
        const auto then = 1.0 - now > worth ? loosened(rules, rule) : std::nullopt;
        const double reachable =
            then ? reach_with(*then, samples, library.reached, library.judging, seed) : now;
        if (reachable - now > worth) {
            answers.push_back({rule, rule == RelaxedRule::Rule::Pins ? 1.0 : kLooser, reachable});
        }
    }
    std::stable_sort(
        answers.begin(), answers.end(),
        [](const RelaxedRule& a, const RelaxedRule& b) { return a.reachable > b.reachable; });
    return answers;
}

}  // namespace meshwind
