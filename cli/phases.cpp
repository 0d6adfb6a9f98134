#include "cli/phases.h"

#include <array>
#include <string_view>

namespace meshwind {
namespace {

struct Phase {
    std::string_view step;
    int number;
    std::string_view words;
};

constexpr int kPhases = 8;

constexpr std::array<Phase, 10> kPhaseWords = {{{"import", 1, "reading the part"},
                                                {"plan", 2, "planning a pattern"},
                                                {"library", 3, "looking for courses"},
                                                {"route", 4, "finding routes"},
                                                {"prove", 5, "checking courses"},
                                                {"anneal", 5, "improving courses"},
                                                {"post", 6, "making the motion"},
                                                {"verify", 7, "winding it again"},
                                                {"write", 8, "writing the files"},
                                                {"picture", 8, "drawing the picture"}}};

}  // namespace

std::string phase_text(const std::string& step) {
    const std::size_t comma = step.rfind(", ");
    const std::size_t begin = comma == std::string::npos ? 0 : comma + 2;
    for (const Phase& phase : kPhaseWords) {
        if (phase.step == std::string_view(step).substr(begin)) {
            return std::to_string(phase.number) + " of " + std::to_string(kPhases) + ": " +
                   step.substr(0, begin) + std::string(phase.words);
        }
    }
    return step;
}

}  // namespace meshwind
