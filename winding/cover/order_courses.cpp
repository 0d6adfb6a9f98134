#include "winding/cover/order_courses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/units.h"

namespace meshwind {
namespace {

// More than all turns of a plan together, and less than what a double loses them beside.
constexpr double kClosed_rad = 1e6;

// Courses, each with the one that follows it: they make cycles.
struct CourseCycles {
    std::span<const LibraryCourse> members;
    std::vector<DirectedCourse> laid;
    std::vector<std::size_t> next;  // per course
    std::vector<char> cut;          // per course: 1 where the fibre is cut behind it

    [[nodiscard]] const LibraryCourse& member(std::size_t c) const {
        return members[at(laid[c].member)];
    }
    [[nodiscard]] bool reversible(std::size_t c) const {
        return member(c).windable_forward && member(c).windable_backward;
    }
    [[nodiscard]] std::size_t arrives(std::size_t c) const {
        return arrival_node(end_of(member(c), laid[c].backward));
    }
    [[nodiscard]] std::size_t departs(std::size_t c) const {
        return departure_node(start_of(member(c), laid[c].backward));
    }
    [[nodiscard]] double cost(std::size_t from, std::size_t to, TurnCosts& costs) const {
        return costs.rad(laid[from], laid[to]);
    }
    [[nodiscard]] std::vector<std::size_t> cycle_of_each() const {
        std::vector<std::size_t> cycle(laid.size(), laid.size());
        for (std::size_t c = 0; c < laid.size(); ++c) {
            for (std::size_t i = c; cycle[i] == laid.size(); i = next[i]) {
                cycle[i] = c;
            }
        }
        return cycle;
    }
};

// Repeatedly joins the pair that costs least; removes what is paired from both lists.
void pair_up(std::vector<std::size_t>& arrivals, std::vector<std::size_t>& departures,
             TurnCosts& costs, CourseCycles& cycles) {
    struct Pair {
        double cost;
        std::size_t from, to;
    };
    std::vector<Pair> pairs;
    for (const std::size_t a : arrivals) {
        for (const std::size_t d : departures) {
            pairs.push_back({cycles.cost(a, d, costs), a, d});
        }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& x, const Pair& y) { return x.cost < y.cost; });
    for (const Pair& pair : pairs) {
        const auto a = std::find(arrivals.begin(), arrivals.end(), pair.from);
        const auto d = std::find(departures.begin(), departures.end(), pair.to);
        if (a != arrivals.end() && d != departures.end()) {
            cycles.next[pair.from] = pair.to;
            arrivals.erase(a);
            departures.erase(d);
        }
    }
}

// Pairs arrivals with departures at every node; what is left over is joined by cuts.
CourseCycles linked(std::span<const LibraryCourse> members, std::span<const DirectedCourse> laid,
                    TurnCosts& costs) {
    CourseCycles cycles{members,
                        {laid.begin(), laid.end()},
                        std::vector<std::size_t>(laid.size(), 0),
                        std::vector<char>(laid.size(), 0)};
    std::map<std::size_t, std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> nodes;
    for (std::size_t c = 0; c < laid.size(); ++c) {
        nodes[cycles.arrives(c)].first.push_back(c);
        nodes[cycles.departs(c)].second.push_back(c);
    }
    std::vector<std::size_t> loose_ends;
    std::vector<std::size_t> loose_starts;
    for (auto& [node, ends] : nodes) {
        pair_up(ends.first, ends.second, costs, cycles);
        loose_ends.insert(loose_ends.end(), ends.first.begin(), ends.first.end());
        loose_starts.insert(loose_starts.end(), ends.second.begin(), ends.second.end());
    }
    for (std::size_t i = 0; i < loose_ends.size(); ++i) {
        cycles.next[loose_ends[i]] = loose_starts[i];
        cycles.cut[loose_ends[i]] = 1;
    }
    return cycles;
}

// Exchanges the successors of two courses that arrive at the same node in different cycles, at
// the cheapest exchange. False where no two cycles meet.
bool merge_cheapest(TurnCosts& costs, CourseCycles& cycles) {
    const std::vector<std::size_t>& next = cycles.next;
    const std::vector<std::size_t> cycle = cycles.cycle_of_each();
    double least = 0.0;
    std::pair<std::size_t, std::size_t> best{0, 0};
    for (std::size_t a = 0; a < next.size(); ++a) {
        for (std::size_t b = a + 1; b < next.size(); ++b) {
            if (cycle[a] == cycle[b] || cycles.arrives(a) != cycles.arrives(b) ||
                cycles.cut[a] != 0 || cycles.cut[b] != 0) {
                continue;
            }
            const double change = cycles.cost(a, next[b], costs) + cycles.cost(b, next[a], costs) -
                                  cycles.cost(a, next[a], costs) - cycles.cost(b, next[b], costs);
            if (best.first == best.second || change < least) {
                least = change;
                best = {a, b};
            }
        }
    }
    if (best.first == best.second) {
        return false;
    }
    std::swap(cycles.next[best.first], cycles.next[best.second]);
    return true;
}

// Takes a closed cycle into an open one that begins or ends at one of its nodes. False where there
// is none.
bool merge_at_a_cut(CourseCycles& cycles) {
    std::vector<std::size_t>& next = cycles.next;
    std::vector<char>& cut = cycles.cut;
    const std::vector<std::size_t> cycle = cycles.cycle_of_each();
    for (std::size_t a = 0; a < next.size(); ++a) {
        for (std::size_t b = 0; cut[a] != 0 && b < next.size(); ++b) {
            if (cycle[a] == cycle[b] || cut[b] != 0) {
                continue;
            }
            const bool at_end = cycles.arrives(a) == cycles.arrives(b);
            if (at_end || cycles.departs(next[a]) == cycles.arrives(b)) {
                std::swap(next[a], next[b]);
                if (at_end) {
                    std::swap(cut[a], cut[b]);
                }
                return true;
            }
        }
    }
    return false;
}

// No two cycles meet from then on.
CourseCycles merged(CourseCycles cycles, TurnCosts& costs) {
    while (merge_cheapest(costs, cycles)) {
    }
    while (merge_at_a_cut(cycles)) {
    }
    return cycles;
}

bool can_reverse_cycle(const CourseCycles& cycles, std::size_t c) {
    std::size_t i = c;
    do {
        if (!cycles.reversible(i) || cycles.cut[i] != 0) {
            return false;
        }
        i = cycles.next[i];
    } while (i != c);
    return true;
}

// Winds every closed cycle of reversible courses the other way if it is apart from the first
// one: it then circles the extensions in the other sense and may meet it.
bool reverse_separate_cycles(CourseCycles& cycles) {
    const std::vector<std::size_t> cycle = cycles.cycle_of_each();
    bool reversed_any = false;
    for (std::size_t c = 1; c < cycles.laid.size(); ++c) {
        if (cycle[c] != c || !can_reverse_cycle(cycles, c)) {
            continue;
        }
        std::vector<std::size_t> way;
        for (std::size_t i = c; way.empty() || i != c; i = cycles.next[i]) {
            way.push_back(i);
        }
        for (std::size_t k = 0; k < way.size(); ++k) {
            cycles.next[way[(k + 1) % way.size()]] = way[k];
            cycles.laid[way[k]].backward = !cycles.laid[way[k]].backward;
        }
        reversed_any = true;
    }
    return reversed_any;
}

// The course of a cycle behind which it is opened: at a cut, else where it costs most.
std::size_t last_of_cycle(const CourseCycles& cycles, std::size_t c, TurnCosts& costs) {
    std::size_t last = c;
    double most = -1.0;
    for (std::size_t i = c, steps = 0; steps == 0 || i != c; i = cycles.next[i], ++steps) {
        const double value = cycles.cut[i] != 0 ? std::numeric_limits<double>::infinity()
                                                : cycles.cost(i, cycles.next[i], costs);
        if (value > most) {
            most = value;
            last = i;
        }
    }
    return last;
}

// The cycles one after the other.
std::vector<OrderedCourse> sequence(const CourseCycles& cycles, TurnCosts& costs) {
    std::vector<OrderedCourse> order;
    const std::vector<std::size_t> cycle = cycles.cycle_of_each();
    for (std::size_t c = 0; c < cycles.laid.size(); ++c) {
        if (cycle[c] != c) {
            continue;
        }
        const std::size_t last = last_of_cycle(cycles, c, costs);
        const std::size_t first = cycles.next[last];
        for (std::size_t i = first, steps = 0; steps == 0 || i != first;
             i = cycles.next[i], ++steps) {
            order.push_back({cycles.laid[i], cycles.cut[i] != 0 || i == last});
        }
    }
    return order;
}

}  // namespace

double TurnCosts::rad(const DirectedCourse& from, const DirectedCourse& to) {
    const auto row = [this](const DirectedCourse& course) {
        std::size_t& number = row_[2 * at(course.member) + (course.backward ? 1U : 0U)];
        if (number == 0) {
            known_.emplace_back();
            number = known_.size();
        }
        return number - 1;
    };
    const std::size_t column = row(to);
    std::vector<double>& costs = known_[row(from)];
    if (costs.size() <= column) {
        costs.resize(known_.size(), std::numeric_limits<double>::quiet_NaN());
    }
    if (std::isnan(costs[column])) {
        costs[column] = work_out_rad(from, to);
    }
    return costs[column];
}

double TurnCosts::work_out_rad(const DirectedCourse& from, const DirectedCourse& to) const {
    const RimCrossing& end = end_of(members_[at(from.member)], from.backward);
    const RimCrossing& start = start_of(members_[at(to.member)], to.backward);
    const Rim& rim = rims_[at(end.rim)];
    const double turn_rad = turn_mm(rim, end, start, turns_) / rim.radius_mm;
    return closed_.count({from, to}) != 0 ? turn_rad + kClosed_rad : turn_rad;
}

std::vector<OrderedCourse> order_courses(std::span<const Rim> rims,
                                         std::span<const LibraryCourse> members,
                                         std::span<const DirectedCourse> laid,
                                         const CourseTurns& turns, const ClosedTurns& closed) {
    TurnCosts costs(rims, members, turns, closed);
    CourseCycles cycles = merged(linked(members, laid, costs), costs);
    if (reverse_separate_cycles(cycles)) {
        cycles = merged(std::move(cycles), costs);
    }
    return sequence(cycles, costs);
}

}  // namespace meshwind
