#include "winding/order.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>

#include "core/units.h"

namespace meshwind {
namespace {

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

// A place where fibres may be joined: a rim and the sense in which the fibre circles its extension.
using Node = std::pair<std::int32_t, int>;

class Ordering {
public:
    Ordering(std::span<const Rim> rims, std::span<const Member> members,
             std::span<const std::int32_t> chosen, const TurnRule& rule)
        : rims_(rims), members_(members), rule_(rule), chosen_(chosen.begin(), chosen.end()) {
        for (const std::int32_t i : chosen_) {
            backward_.push_back(!members_[at(i)].windable_forward);
        }
    }

    std::vector<OrderedCourse> run() {
        balance_directions();
        link();
        merge_cycles();
        if (reverse_separate_cycles()) {
            merge_cycles();
        }
        return sequence();
    }

private:
    [[nodiscard]] const Member& member(std::size_t c) const { return members_[at(chosen_[c])]; }
    [[nodiscard]] const RimCrossing& start(std::size_t c) const {
        return start_of(member(c), backward_[c]);
    }
    [[nodiscard]] const RimCrossing& end(std::size_t c) const {
        return end_of(member(c), backward_[c]);
    }
    [[nodiscard]] bool reversible(std::size_t c) const {
        return member(c).windable_forward && member(c).windable_backward;
    }
    [[nodiscard]] Node arrives(std::size_t c) const { return {end(c).rim, end(c).sense}; }
    [[nodiscard]] Node departs(std::size_t c) const { return {start(c).rim, -start(c).sense}; }

    [[nodiscard]] double dwell(std::size_t from, std::size_t to) const {
        return dwell_rad(rims_[at(end(from).rim)], end(from), start(to), rule_);
    }

    // Reverses courses until departures and arrivals agree at every rim, as far as they can: each
    // pass reverses a shortest chain of reversible courses from a rim with too many departures.
    void balance_directions() {
        std::vector<int> excess(rims_.size(), 0);
        for (std::size_t c = 0; c < chosen_.size(); ++c) {
            ++excess[at(start(c).rim)];
            --excess[at(end(c).rim)];
        }
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t r = 0; r < excess.size() && !changed; ++r) {
                if (excess[r] >= 2) {
                    changed = reverse_chain(static_cast<std::int32_t>(r), excess, -1);
                } else if (excess[r] == 1) {
                    changed = reverse_chain(static_cast<std::int32_t>(r), excess, -2);
                }
            }
        }
    }

    // From `from` along reversible courses to the nearest rim whose excess is <= `limit`.
    bool reverse_chain(std::int32_t from, std::vector<int>& excess, int limit) {
        constexpr std::size_t kNone = static_cast<std::size_t>(-1);
        std::vector<std::size_t> came_by(rims_.size(), kNone);
        std::vector<char> seen(rims_.size(), 0);
        std::deque<std::int32_t> queue{from};
        seen[at(from)] = 1;
        while (!queue.empty()) {
            const std::int32_t rim = queue.front();
            queue.pop_front();
            if (excess[at(rim)] <= limit) {
                std::int32_t r = rim;
                while (r != from) {
                    const std::size_t c = came_by[at(r)];
                    const std::int32_t before = start(c).rim;
                    backward_[c] = !backward_[c];
                    r = before;
                }
                excess[at(from)] -= 2;
                excess[at(rim)] += 2;
                return true;
            }
            for (std::size_t c = 0; c < chosen_.size(); ++c) {
                if (reversible(c) && start(c).rim == rim && seen[at(end(c).rim)] == 0) {
                    seen[at(end(c).rim)] = 1;
                    came_by[at(end(c).rim)] = c;
                    queue.push_back(end(c).rim);
                }
            }
        }
        return false;
    }

    // Pairs arrivals with departures at every node; what is left over is joined by cuts.
    void link() {
        next_.assign(chosen_.size(), 0);
        cut_.assign(chosen_.size(), 0);
        std::map<Node, std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> nodes;
        for (std::size_t c = 0; c < chosen_.size(); ++c) {
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

    // Repeatedly joins the pair with the least dwell; removes what is paired from both lists.
    void pair_up(std::vector<std::size_t>& arrivals, std::vector<std::size_t>& departures) {
        struct Pair {
            double dwell;
            std::size_t from, to;
        };
        std::vector<Pair> pairs;
        for (const std::size_t a : arrivals) {
            for (const std::size_t d : departures) {
                pairs.push_back({dwell(a, d), a, d});
            }
        }
        std::stable_sort(pairs.begin(), pairs.end(),
                         [](const Pair& x, const Pair& y) { return x.dwell < y.dwell; });
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
        std::vector<std::size_t> cycle(chosen_.size(), chosen_.size());
        for (std::size_t c = 0; c < chosen_.size(); ++c) {
            for (std::size_t i = c; cycle[i] == chosen_.size(); i = next_[i]) {
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
            for (std::size_t a = 0; a < chosen_.size(); ++a) {
                for (std::size_t b = a + 1; b < chosen_.size(); ++b) {
                    if (cycle[a] == cycle[b] || arrives(a) != arrives(b) || cut_[a] != 0 ||
                        cut_[b] != 0) {
                        continue;
                    }
                    const double change = dwell(a, next_[b]) + dwell(b, next_[a]) -
                                          dwell(a, next_[a]) - dwell(b, next_[b]);
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

    // Winds every closed cycle of reversible courses the other way if it is apart from the first
    // one: it then circles the extensions in the other sense and may meet it.
    bool reverse_separate_cycles() {
        const std::vector<std::size_t> cycle = cycle_of_each();
        bool reversed_any = false;
        for (std::size_t c = 1; c < chosen_.size(); ++c) {
            if (cycle[c] != c || !can_reverse_cycle(c)) {
                continue;
            }
            std::vector<std::size_t> way;
            for (std::size_t i = c; way.empty() || i != c; i = next_[i]) {
                way.push_back(i);
            }
            for (std::size_t k = 0; k < way.size(); ++k) {
                next_[way[(k + 1) % way.size()]] = way[k];
                backward_[way[k]] = !backward_[way[k]];
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

    // The cycles one after the other, each opened at a cut, else at its longest dwell.
    [[nodiscard]] std::vector<OrderedCourse> sequence() const {
        std::vector<OrderedCourse> order;
        const std::vector<std::size_t> cycle = cycle_of_each();
        for (std::size_t c = 0; c < chosen_.size(); ++c) {
            if (cycle[c] != c) {
                continue;
            }
            std::size_t last = c;
            double longest = -1.0;
            for (std::size_t i = c, steps = 0; steps == 0 || i != c; i = next_[i], ++steps) {
                const double value = cut_[i] != 0 ? 2.0 * kPi : dwell(i, next_[i]);
                if (value > longest) {
                    longest = value;
                    last = i;
                }
            }
            const std::size_t first = next_[last];
            for (std::size_t i = first, steps = 0; steps == 0 || i != first;
                 i = next_[i], ++steps) {
                order.push_back({chosen_[i], backward_[i], cut_[i] != 0 || i == last});
            }
        }
        return order;
    }

    std::span<const Rim> rims_;
    std::span<const Member> members_;
    const TurnRule& rule_;
    std::vector<std::int32_t> chosen_;
    std::vector<bool> backward_;
    std::vector<std::size_t> next_;
    std::vector<char> cut_;
};

}  // namespace

std::vector<OrderedCourse> order_courses(std::span<const Rim> rims, std::span<const Member> members,
                                         std::span<const std::int32_t> chosen,
                                         const TurnRule& rule) {
    return Ordering(rims, members, chosen, rule).run();
}

}  // namespace meshwind
