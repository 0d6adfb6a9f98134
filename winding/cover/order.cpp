#include "winding/cover/order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/index.h"
#include "core/units.h"

namespace meshwind {
namespace {

// More than all turns of a plan together, and less than what a double loses them beside.
constexpr double kClosed_rad = 1e6;

class Ordering {
public:
    Ordering(std::span<const Rim> rims, std::span<const Member> members,
             std::span<const LaidCourse> laid, const CourseTurns& turns, const ClosedTurns& closed)
        : members_(members),
          costs_(rims, members, turns, closed),
          laid_(laid.begin(), laid.end()) {}

    std::vector<OrderedCourse> run() {
        link();
        merge_cycles();
        merge_at_cuts();
        if (reverse_separate_cycles()) {
            merge_cycles();
            merge_at_cuts();
        }
        return sequence();
    }

private:
    [[nodiscard]] const Member& member(std::size_t c) const {
        return members_[at(laid_[c].member)];
    }
    [[nodiscard]] const RimCrossing& start(std::size_t c) const {
        return start_of(member(c), laid_[c].backward);
    }
    [[nodiscard]] const RimCrossing& end(std::size_t c) const {
        return end_of(member(c), laid_[c].backward);
    }
    [[nodiscard]] bool reversible(std::size_t c) const {
        return member(c).windable_forward && member(c).windable_backward;
    }
    [[nodiscard]] std::size_t arrives(std::size_t c) const { return arrival_node(end(c)); }
    [[nodiscard]] std::size_t departs(std::size_t c) const { return departure_node(start(c)); }

    [[nodiscard]] double cost(std::size_t from, std::size_t to) {
        return costs_.rad(laid_[from], laid_[to]);
    }

    // Pairs arrivals with departures at every node; what is left over is joined by cuts.
    void link() {
        next_.assign(laid_.size(), 0);
        cut_.assign(laid_.size(), 0);
        std::map<std::size_t, std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> nodes;
        for (std::size_t c = 0; c < laid_.size(); ++c) {
            nodes[arrives(c)].first.push_back(c);
            nodes[departs(c)].second.push_back(c);
        }
        std::vector<std::size_t> loose_ends;
        std::vector<std::size_t> loose_starts;
        for (auto& [node, ends] : nodes) {
            pair_up(ends.first, ends.second);
            loose_ends.insert(loose_ends.end(), ends.first.begin(), ends.first.end());
            loose_starts.insert(loose_starts.end(), ends.second.begin(), ends.second.end());
        }
        for (std::size_t i = 0; i < loose_ends.size(); ++i) {
            next_[loose_ends[i]] = loose_starts[i];
            cut_[loose_ends[i]] = 1;
        }
    }

    // Repeatedly joins the pair that costs least; removes what is paired from both lists.
    void pair_up(std::vector<std::size_t>& arrivals, std::vector<std::size_t>& departures) {
        struct Pair {
            double cost;
            std::size_t from, to;
        };
        std::vector<Pair> pairs;
        for (const std::size_t a : arrivals) {
            for (const std::size_t d : departures) {
                pairs.push_back({cost(a, d), a, d});
            }
        }
        std::stable_sort(pairs.begin(), pairs.end(),
                         [](const Pair& x, const Pair& y) { return x.cost < y.cost; });
        for (const Pair& pair : pairs) {
            const auto a = std::find(arrivals.begin(), arrivals.end(), pair.from);
            const auto d = std::find(departures.begin(), departures.end(), pair.to);
            if (a != arrivals.end() && d != departures.end()) {
                next_[pair.from] = pair.to;
                arrivals.erase(a);
                departures.erase(d);
            }
        }
    }

    [[nodiscard]] std::vector<std::size_t> cycle_of_each() const {
        std::vector<std::size_t> cycle(laid_.size(), laid_.size());
        for (std::size_t c = 0; c < laid_.size(); ++c) {
            for (std::size_t i = c; cycle[i] == laid_.size(); i = next_[i]) {
                cycle[i] = c;
            }
        }
        return cycle;
    }

    // Exchanges the successors of two courses that arrive at the same node in different cycles, the
    // cheapest exchange first, until no two cycles meet.
    void merge_cycles() {
        while (true) {
            const std::vector<std::size_t> cycle = cycle_of_each();
            double least = 0.0;
            std::pair<std::size_t, std::size_t> best{0, 0};
            for (std::size_t a = 0; a < laid_.size(); ++a) {
                for (std::size_t b = a + 1; b < laid_.size(); ++b) {
                    if (cycle[a] == cycle[b] || arrives(a) != arrives(b) || cut_[a] != 0 ||
                        cut_[b] != 0) {
                        continue;
                    }
                    const double change = cost(a, next_[b]) + cost(b, next_[a]) -
                                          cost(a, next_[a]) - cost(b, next_[b]);
                    if (best.first == best.second || change < least) {
                        least = change;
                        best = {a, b};
                    }
                }
            }
            if (best.first == best.second) {
                return;
            }
            std::swap(next_[best.first], next_[best.second]);
        }
    }

    // Takes a closed cycle into an open one that begins or ends at one of its nodes.
    void merge_at_cuts() {
        while (merge_at_a_cut()) {
        }
    }

    bool merge_at_a_cut() {
        const std::vector<std::size_t> cycle = cycle_of_each();
        for (std::size_t a = 0; a < laid_.size(); ++a) {
            for (std::size_t b = 0; cut_[a] != 0 && b < laid_.size(); ++b) {
                if (cycle[a] == cycle[b] || cut_[b] != 0) {
                    continue;
                }
                const bool at_end = arrives(a) == arrives(b);
                if (at_end || departs(next_[a]) == arrives(b)) {
                    std::swap(next_[a], next_[b]);
                    if (at_end) {
                        std::swap(cut_[a], cut_[b]);
                    }
                    return true;
                }
            }
        }
        return false;
    }

    // Winds every closed cycle of reversible courses the other way if it is apart from the first
    // one: it then circles the extensions in the other sense and may meet it.
    bool reverse_separate_cycles() {
        const std::vector<std::size_t> cycle = cycle_of_each();
        bool reversed_any = false;
        for (std::size_t c = 1; c < laid_.size(); ++c) {
            if (cycle[c] != c || !can_reverse_cycle(c)) {
                continue;
            }
            std::vector<std::size_t> way;
            for (std::size_t i = c; way.empty() || i != c; i = next_[i]) {
                way.push_back(i);
            }
            for (std::size_t k = 0; k < way.size(); ++k) {
                next_[way[(k + 1) % way.size()]] = way[k];
                laid_[way[k]].backward = !laid_[way[k]].backward;
            }
            reversed_any = true;
        }
        return reversed_any;
    }

    [[nodiscard]] bool can_reverse_cycle(std::size_t c) const {
        std::size_t i = c;
        do {
            if (!reversible(i) || cut_[i] != 0) {
                return false;
            }
            i = next_[i];
        } while (i != c);
        return true;
    }

    // The cycles one after the other, each opened at a cut, else where it costs most.
    [[nodiscard]] std::vector<OrderedCourse> sequence() {
        std::vector<OrderedCourse> order;
        const std::vector<std::size_t> cycle = cycle_of_each();
        for (std::size_t c = 0; c < laid_.size(); ++c) {
            if (cycle[c] != c) {
                continue;
            }
            std::size_t last = c;
            double most = -1.0;
            for (std::size_t i = c, steps = 0; steps == 0 || i != c; i = next_[i], ++steps) {
                const double value =
                    cut_[i] != 0 ? std::numeric_limits<double>::infinity() : cost(i, next_[i]);
                if (value > most) {
                    most = value;
                    last = i;
                }
            }
            const std::size_t first = next_[last];
            for (std::size_t i = first, steps = 0; steps == 0 || i != first;
                 i = next_[i], ++steps) {
                order.push_back({laid_[i], cut_[i] != 0 || i == last});
            }
        }
        return order;
    }

    std::span<const Member> members_;
    TurnCosts costs_;
    std::vector<LaidCourse> laid_;
    std::vector<std::size_t> next_;
    std::vector<char> cut_;
};

}  // namespace

double TurnCosts::rad(const LaidCourse& from, const LaidCourse& to) {
    const auto row = [this](const LaidCourse& course) {
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

double TurnCosts::work_out_rad(const LaidCourse& from, const LaidCourse& to) const {
    const RimCrossing& end = end_of(members_[at(from.member)], from.backward);
    const RimCrossing& start = start_of(members_[at(to.member)], to.backward);
    const Rim& rim = rims_[at(end.rim)];
    const double turn_rad = turn_mm(rim, end, start, turns_) / rim.radius_mm;
    return closed_.count({from, to}) != 0 ? turn_rad + kClosed_rad : turn_rad;
}

std::vector<OrderedCourse> order_courses(std::span<const Rim> rims, std::span<const Member> members,
                                         std::span<const LaidCourse> laid, const CourseTurns& turns,
                                         const ClosedTurns& closed) {
    return Ordering(rims, members, laid, turns, closed).run();
}

}  // namespace meshwind
