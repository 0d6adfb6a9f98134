#include "winding/cover/select.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "core/parallel.h"
#include "winding/bound/fibre_bound.h"
#include "winding/plan/figures.h"

namespace meshwind {
namespace {

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

// A course that fills less than this share of what it covers is too dear for any wall.
constexpr double kLeastFill = 0.005;

// Members whose gain one task works out.
constexpr std::size_t kGainChunk = 256;

struct Gain {
    std::int64_t fresh = 0;  // samples still short of the target
    double value = 0.0;      // weighted, per mm of fibre
};

class Selector {
public:
    Selector(std::span<const Member> members, std::span<const char> allowed, std::size_t samples,
             const SelectOptions& options)
        : members_(members), allowed_(allowed), options_(options) {
        selection_.layers.assign(samples, 0);
    }

    Selection run(std::span<const std::int32_t> kept) {
        for (const std::int32_t i : kept) {
            lay(i, 1);
            selection_.chosen.push_back(i);
        }
        greedy();
        drop_superfluous();
        return std::move(selection_);
    }

private:
    [[nodiscard]] Gain gain(std::int32_t i) const {
        const Member& member = members_[at(i)];
        Gain gain;
        double waste = 0.0;
        for (const std::int32_t sample : member.footprint) {
            const std::int32_t layers = selection_.layers[at(sample)];
            if (layers < options_.target(sample)) {
                ++gain.fresh;
            } else {
                waste += 1.0 + layers - options_.target(sample);
            }
        }
        const double off = static_cast<double>(member.footprint.size()) * member.off_angle_mm /
                           std::max(1.0, member.length_mm);
        gain.value = (static_cast<double>(gain.fresh) - options_.overlap_weight * waste -
                      options_.overlap_weight * options_.angle_weight * off) /
                     (member.length_mm + member.turn_mm);
        return gain;
    }

    void lay(std::int32_t i, int times) {
        for (const std::int32_t sample : members_[at(i)].footprint) {
            selection_.layers[at(sample)] += times;
        }
    }

    void greedy() {
        // Gains only fall while layers grow, so a stale gain is an upper bound.
        using Entry = std::pair<double, std::int32_t>;
        const auto worse = [](const Entry& a, const Entry& b) {
            return a.first != b.first ? a.first < b.first : a.second > b.second;
        };
        std::priority_queue<Entry, std::vector<Entry>, decltype(worse)> queue(worse);
        for (std::int32_t i = 0; at(i) < members_.size(); ++i) {
            if (allowed_[at(i)] != 0) {
                queue.emplace(gain(i).value, i);
            }
        }
        while (!queue.empty()) {
            const std::int32_t i = queue.top().second;
            queue.pop();
            const Gain now = gain(i);
            const auto own = static_cast<double>(members_[at(i)].footprint.size());
            if (static_cast<double>(now.fresh) < options_.least_gain_share * own ||
                now.fresh == 0) {
                continue;
            }
            if (!queue.empty() && worse({now.value, i}, queue.top())) {
                queue.emplace(now.value, i);
                continue;
            }
            lay(i, 1);
            selection_.chosen.push_back(i);
        }
    }

    void drop_superfluous() {
        // The longest first: they free most fibre.
        std::vector<std::int32_t> order = selection_.chosen;
        std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
            return members_[at(a)].length_mm > members_[at(b)].length_mm;
        });
        for (const std::int32_t i : order) {
            lay(i, -1);
            const auto& footprint = members_[at(i)].footprint;
            const auto missed =
                std::count_if(footprint.begin(), footprint.end(), [&](std::int32_t sample) {
                    return selection_.layers[at(sample)] < options_.target(sample);
                });
            if (missed > 0 &&
                static_cast<double>(missed) >=
                    options_.least_gain_share * static_cast<double>(footprint.size())) {
                lay(i, 1);
                continue;
            }
            selection_.chosen.erase(
                std::find(selection_.chosen.begin(), selection_.chosen.end(), i));
        }
    }

    std::span<const Member> members_;
    std::span<const char> allowed_;
    const SelectOptions& options_;
    Selection selection_;
};

}  // namespace

Selection select_courses(std::span<const Member> members, std::span<const char> allowed,
                         std::size_t samples, const SelectOptions& options,
                         std::span<const std::int32_t> kept) {
    return Selector(members, allowed, samples, options).run(kept);
}

std::vector<std::int32_t> fill_thin_places(std::span<const Member> members,
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
    const auto gain = [&](const Member& member) {
        double sum = 0.0;
        for (const std::int32_t sample : member.footprint) {
            const std::int32_t lack = lacks(sample);
            sum += lack > 0 ? 1.0 / lack : 0.0;
        }
        const double least = kLeastFill * static_cast<double>(member.footprint.size());
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

FirstChoice choose_first(std::span<const Member> members, std::span<const char> allowed,
                         std::span<const char> reached, std::size_t nodes,
                         const SelectOptions& options, const StageAsk* stage) {
    FirstChoice first;
    if (stage != nullptr && stage->stages_left == 0) {
        return first;  // thin places are filled one by one
    }
    if (stage != nullptr) {
        const FibreBound bound =
            bound_fibre({members, allowed, stage->left, reached, nodes, kMostBelow});
        first.least_fibre_mm = bound.least_mm;
        first.courses = whole_courses(bound, 1.0 / stage->stages_left);
        return first;
    }
    for (const std::int32_t i : select_courses(members, allowed, reached.size(), options).chosen) {
        first.courses.push_back({i, !members[at(i)].windable_forward});
    }
    return first;
}

}  // namespace meshwind
