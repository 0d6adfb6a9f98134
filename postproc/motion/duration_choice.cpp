#include "postproc/motion/duration_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "core/interrupt.h"

namespace meshwind {
namespace {

// Shares by which all steps may become shorter or longer at once, in turn, each for as long as it
// saves this part of the share.
constexpr std::array<double, 9> kShares = {
    0.5, 0.25, 0.12, 0.06, 0.03, 0.015, 0.007, 0.003, kMinDurationShare};
constexpr double kWorthwhile = 0.01;
constexpr int kMaxRounds = 30;

// What happens at a step matters to so many before and after.
constexpr std::size_t kReach = 3;

// Durations of a step to choose from: shorter, as it is, longer.
constexpr std::size_t kChoices = 3;
constexpr std::size_t kPairs = kChoices * kChoices;

using Costs = std::array<double, kPairs>;  // of choice i of a step and j of the next

// A round: open steps may become shorter or longer by a factor.
struct Round {
    std::span<const double> duration_s;  // before
    std::vector<char> open;              // 3: the step has a choice
    double factor = 1.0;
};

// Durations of a step to choose from, and the velocities that they give.
struct Choices {
    std::array<double, kChoices> duration_s{};
    std::size_t count = 0;
    std::vector<AxisLanes> velocity_s;  // choices x groups
};

// What a step and the next may last: the ramps between, by pairs.
struct Corner {
    std::vector<AxisLanes> ramp_s;  // pairs x groups
    std::array<char, kPairs> allowed{};
};

// A step between its neighbours.
struct Triple {
    const Choices& last;
    const Choices& here;
    const Choices& next;
    const Corner& before;
    const Corner& after;
};

// Of each step the durations offered, and for each pair with the next step the best choice of the
// step before.
struct ChoiceTable {
    std::vector<std::array<double, kChoices>> offered_s;
    std::vector<std::array<std::uint8_t, kPairs>> from;
};

// Marks with 3 the steps that have a choice: not those far from all that changed in the round
// before, and not those at their least among others at theirs.
std::vector<char> open_steps(const MovingSteps& steps, std::span<const double> duration_s,
                             const std::vector<char>& changed) {
    std::vector<char> open(steps.count + 2, 0);
    std::size_t since_changed = kReach;  // how long ago, in steps
    std::size_t since_longer = kReach;
    const auto pass = [&](std::size_t m) {
        since_changed = changed[m] != 0 ? 0 : since_changed + 1;
        since_longer = duration_s[m] > steps.least_s[m] ? 0 : since_longer + 1;
        open[m] = static_cast<char>(open[m] | (since_changed <= kReach ? 1 : 0) |
                                    (since_longer <= kReach ? 2 : 0));
    };
    for (std::size_t m = 1; m <= steps.count; ++m) {
        pass(m);
    }
    since_changed = since_longer = kReach;
    for (std::size_t m = steps.count; m > 0; --m) {
        pass(m);
    }
    return open;
}

// Lists the choices of step m in place, for there are very many steps.
void list_choices(const MovingSteps& steps, const Round& round, std::size_t m, Choices& choices) {
    const double now_s = round.duration_s[m];
    if (round.open[m] != 3) {
        choices.duration_s = {now_s};
        choices.count = 1;
    } else if (now_s <= steps.least_s[m]) {
        choices.duration_s = {now_s, now_s * round.factor};
        choices.count = 2;
    } else {
        choices.duration_s = {std::max(now_s / round.factor, steps.least_s[m]), now_s,
                              now_s * round.factor};
        choices.count = kChoices;
    }
    for (std::size_t i = 0; i < choices.count; ++i) {
        const double rate = 1.0 / choices.duration_s[i];
        for (std::size_t g = 0; g < steps.groups; ++g) {
            choices.velocity_s[i * steps.groups + g] = rate * steps.move[m * steps.groups + g];
        }
    }
}

// Measures the corner after step m, in place as well.
void measure_corner(const MovingSteps& steps, std::size_t m, const Choices& here,
                    const Choices& next, Corner& corner) {
    const double most_mm = steps.corner.mm;
    const bool cuts = m != 0 && m != steps.count && !std::isinf(most_mm);
    for (std::size_t i = 0; i < here.count; ++i) {
        for (std::size_t j = 0; j < next.count; ++j) {
            const std::size_t pair = i * kChoices + j;
            CornerOffset offset;
            for (std::size_t g = 0; g < steps.groups; ++g) {
                const AxisLanes change_s =
                    next.velocity_s[j * steps.groups + g] - here.velocity_s[i * steps.groups + g];
                const AxisLanes ramp_s = ramps_s(steps.ramps, change_s.abs(), g);
                corner.ramp_s[pair * steps.groups + g] = ramp_s;
                if (cuts) {
                    add_offset(steps, m, g, change_s, ramp_s, offset);
                }
            }
            corner.allowed[pair] = offset.mm2() <= most_mm * most_mm * (1.0 + kStepSlack) ? 1 : 0;
        }
    }
}

// Whether a duration has room for half of the ramps before and after, by groups.
bool fits(const AxisLanes* before, const AxisLanes* after, std::size_t groups, double duration_s) {
    const double room_s = 2.0 * duration_s * (1.0 + kStepSlack);
    for (std::size_t g = 0; g < groups; ++g) {
        if ((before[g] + after[g]).maxCoeff() > room_s) {
            return false;
        }
    }
    return true;
}

// Least sums up to a step, by choices of it and the next, and the choices of the step before that
// lead there. \param cost the same one step earlier
Costs least_costs(const Triple& step, const Costs& cost, std::size_t groups,
                  std::array<std::uint8_t, kPairs>& from) {
    Costs now;
    now.fill(std::numeric_limits<double>::infinity());
    for (std::size_t j = 0; j < step.here.count; ++j) {
        for (std::size_t k = 0; k < step.next.count; ++k) {
            const std::size_t to = j * kChoices + k;
            for (std::size_t i = 0; step.after.allowed[to] != 0 && i < step.last.count; ++i) {
                const std::size_t pair = i * kChoices + j;
                const double sum_s = cost[pair] + step.here.duration_s[j];
                if (sum_s < now[to] &&
                    fits(&step.before.ramp_s[pair * groups], &step.after.ramp_s[to * groups],
                         groups, step.here.duration_s[j])) {
                    now[to] = sum_s;
                    from[to] = static_cast<std::uint8_t>(i);
                }
            }
        }
    }
    // Less the least, so that equal circuits give equal numbers wherever they are.
    const double least_s = *std::min_element(now.begin(), now.end());
    for (double& sum_s : now) {
        sum_s -= least_s;
    }
    return now;
}

// Goes along the path and fills the table. Returns the costs of the last step's choices.
Costs weigh_choices(const MovingSteps& steps, const Round& round, ChoiceTable& table) {
    std::array<Choices, 3> three;  // of the step before, this, and the next
    for (Choices& choices : three) {
        choices.velocity_s.resize(kChoices * steps.groups);
    }
    Corner before{std::vector<AxisLanes>(kPairs * steps.groups), {}};
    Corner after = before;
    Costs cost{};
    list_choices(steps, round, 0, three[0]);
    list_choices(steps, round, 1, three[1]);
    measure_corner(steps, 0, three[0], three[1], before);
    check_interrupt();
    for (std::size_t m = 1; m <= steps.count; ++m) {
        const Choices& last = three[(m - 1) % 3];
        const Choices& here = three[m % 3];
        Choices& next = three[(m + 1) % 3];
        list_choices(steps, round, m + 1, next);
        measure_corner(steps, m, here, next, after);
        table.offered_s[m] = here.duration_s;
        cost = least_costs({last, here, next, before, after}, cost, steps.groups, table.from[m]);
        std::swap(before, after);
    }
    return cost;
}

// Goes back along the best choice and marks the steps that it changes. The last step is beside
// rest, which has one choice.
void take_best(const ChoiceTable& table, const Costs& cost, std::vector<double>& duration_s,
               std::vector<char>& changed) {
    std::size_t here = 0;
    for (std::size_t i = 1; i < kChoices; ++i) {
        here = cost[i * kChoices] < cost[here * kChoices] ? i : here;
    }
    std::size_t next = 0;
    for (std::size_t m = table.from.size() - 1; m > 0; --m) {
        changed[m] = duration_s[m] != table.offered_s[m][here] ? 1 : 0;
        duration_s[m] = table.offered_s[m][here];
        const std::size_t before = table.from[m][here * kChoices + next];
        next = here;
        here = before;
    }
}

}  // namespace

std::vector<double> tightened_s(const MovingSteps& steps, std::vector<double> duration_s) {
    const auto sum_s = [&] { return std::accumulate(duration_s.begin(), duration_s.end(), 0.0); };
    ChoiceTable table;
    table.offered_s.resize(steps.count + 1);
    table.from.resize(steps.count + 1);
    for (const double share : kShares) {
        double saved = 1.0;  // share of the time
        std::vector<char> changed(steps.count + 2, 1);
        for (int round = 0; round < kMaxRounds && saved > kWorthwhile * share; ++round) {
            const double before_s = sum_s();
            const Costs cost = weigh_choices(
                steps, {duration_s, open_steps(steps, duration_s, changed), 1.0 + share}, table);
            take_best(table, cost, duration_s, changed);
            saved = 1.0 - sum_s() / before_s;
        }
    }
    return duration_s;
}

}  // namespace meshwind
