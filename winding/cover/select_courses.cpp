#include "winding/cover/select_courses.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "winding/bound/fibre_bound.h"
#include "winding/plan/figures.h"

namespace meshwind {
namespace {

// A course that fills less than this share of what it covers is too dear for any wall.
constexpr double kMinFill = 0.005;

// Courses are chosen anew without those that do not hold, so many times, until no more than this
// share is lost.
constexpr int kMaxChoices = 3;
constexpr double kFewLost = 0.03;

// Members whose gain one task works out.
constexpr std::size_t kGainChunk = 256;

}  // namespace

double lacking_share(std::span<const std::int32_t> layers, std::span<const char> reached,
                     const SelectOptions& options) {
    double in_reach = 0.0;
    double lacking = 0.0;
    for (std::int32_t i = 0; at(i) < layers.size(); ++i) {
        in_reach += reached[at(i)];
        lacking += reached[at(i)] != 0 && layers[at(i)] < options.target(i) ? 1.0 : 0.0;
    }
    return lacking / std::max(1.0, in_reach);
}

std::vector<std::int32_t> fill_thin_places(std::span<const LibraryCourse> members,
                                           std::span<const char> allowed,
                                           std::span<const char> reached,
                                           std::vector<std::int32_t> layers,
                                           const SelectOptions& options, double most_short) {
    double in_reach = 0.0;
    double lacking = 0.0;
    const auto lacks = [&](std::int32_t sample) {
        return reached[at(sample)] == 0 ? 0 : options.target(sample) - layers[at(sample)];
    };
    for (std::int32_t i = 0; at(i) < layers.size(); ++i) {
        in_reach += reached[at(i)];
        lacking += lacks(i) > 0 ? 1.0 : 0.0;
    }
    // A layer helps the more, the fewer lack with it.
    const auto gain = [&](const LibraryCourse& member) {
        double sum = 0.0;
        for (const std::int32_t sample : member.footprint) {
            const std::int32_t lack = lacks(sample);
            sum += lack > 0 ? 1.0 / lack : 0.0;
        }
        const double least = kMinFill * static_cast<double>(member.footprint.size());
        return sum < least ? 0.0 : sum / (member.length_mm + member.turn_mm);
    };
    std::vector<std::int32_t> taken;
    std::vector<char> open(allowed.begin(), allowed.end());
    std::vector<double> gains(members.size(), 0.0);
    while (lacking > most_short * in_reach) {
        parallel_for(members.size(), kGainChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                gains[i] = open[i] != 0 ? gain(members[i]) : 0.0;
            }
        });
        const auto best = std::max_element(gains.begin(), gains.end());
        if (best == gains.end() || *best <= 0.0) {
            break;
        }
        const auto member = static_cast<std::size_t>(best - gains.begin());
        taken.push_back(static_cast<std::int32_t>(member));
        open[member] = 0;
        for (const std::int32_t sample : members[member].footprint) {
            lacking -= lacks(sample) == 1 ? 1.0 : 0.0;
            ++layers[at(sample)];
        }
    }
    return taken;
}

FirstChoice choose_first(std::span<const LibraryCourse> members, std::span<const char> allowed,
                         std::span<const char> reached,
                         std::span<const Eigen::Vector3d> position_mm, std::size_t nodes,
                         const SelectOptions& options, const StageAsk& stage, const Holding& hold) {
    FirstChoice first;
    if (stage.stages_left == 0) {
        return first;  // thin places are filled one by one
    }
    const bool of_fibre =
        std::none_of(members.begin(), members.end(),
                     [](const LibraryCourse& member) { return member.off_angle_mm > 0.0; });
    FibreBoundFinder finder({.members = members,
                             .allowed = allowed,
                             .asked = stage.left,
                             .reached = reached,
                             .position_mm = position_mm,
                             .nodes = nodes,
                             .most_below = kMaxBelow,
                             .off_angle_cost = options.angle_weight});
    for (int round = 0; round < kMaxChoices; ++round) {
        const FibreBound bound = finder.find();
        if (of_fibre) {
            first.least_fibre_mm = bound.least_mm;
        }
        const std::vector<DirectedCourse> chosen =
            whole_courses(bound, members, 1.0 / stage.stages_left);
        const std::vector<char> holds = hold(chosen);
        first.courses.clear();
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            if (holds[i] != 0) {
                first.courses.push_back(chosen[i]);
            } else {
                finder.strike_off(chosen[i].member);
            }
        }
        const auto lost = static_cast<double>(chosen.size() - first.courses.size());
        if (lost <= kFewLost * static_cast<double>(first.courses.size())) {
            break;
        }
    }
    return first;
}

}  // namespace meshwind
