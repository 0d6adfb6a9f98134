#include "winding/one_fibre.h"

#include <algorithm>

namespace meshwind {
namespace {

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

// Calls `visit(member index, from node, to node)` for every windable direction of every member.
template <typename Visit>
void for_each_windable(std::span<const Member> members, const Visit& visit) {
    for (std::size_t i = 0; i < members.size(); ++i) {
        for (const bool backward : {false, true}) {
            const Member& member = members[i];
            if (backward ? member.windable_backward : member.windable_forward) {
                visit(static_cast<std::int32_t>(i), departure_node(start_of(member, backward)),
                      arrival_node(end_of(member, backward)));
            }
        }
    }
}

// Unmarks nodes from which no course leads to another marked one: the fibre can only end there.
void forget_dead_ends(std::span<const Member> members, std::vector<char>& round) {
    if (std::count(round.begin(), round.end(), 1) < 2) {
        return;
    }
    std::vector<char> leads_on(round.size(), 0);
    for_each_windable(members, [&](std::int32_t, std::size_t from, std::size_t to) {
        if (from != to && round[to] != 0) {
            leads_on[from] = 1;
        }
    });
    for (std::size_t node = 0; node < round.size(); ++node) {
        round[node] = static_cast<char>(round[node] != 0 && leads_on[node] != 0);
    }
}

std::vector<LastNode> find_last_node(std::span<const Member> members,
                                     const std::vector<char>& round) {
    std::vector<int> turning(round.size(), 0);
    std::vector<LastNode> found(round.size());
    for_each_windable(members, [&](std::int32_t i, std::size_t from, std::size_t to) {
        turning[to] += from == to ? 1 : 0;
        if (round[from] != 0 && round[to] == 0) {
            found[to].entries.push_back(i);
        }
    });
    std::size_t best = round.size();
    for (std::size_t node = 0; node < round.size(); ++node) {
        found[node].node = node;
        if (!found[node].entries.empty() &&
            (best == round.size() || turning[node] > turning[best])) {
            best = node;
        }
    }
    if (best == round.size()) {
        return {};
    }
    auto& entries = found[best].entries;
    std::stable_sort(entries.begin(), entries.end(), [&](std::int32_t a, std::int32_t b) {
        return members[at(a)].footprint.size() > members[at(b)].footprint.size();
    });
    return {found[best]};
}

}  // namespace

std::vector<FibreStretch> fibres_in(std::span<const OrderedCourse> order) {
    std::vector<FibreStretch> fibres;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (order[i].cut_after) {
            fibres.emplace_back(begin, i + 1);
            begin = i + 1;
        }
    }
    return fibres;
}

FibreStretch main_fibre(std::span<const Member> members, std::span<const OrderedCourse> order) {
    FibreStretch best{0, 0};
    double longest = -1.0;
    for (const FibreStretch& fibre : fibres_in(order)) {
        double length = 0.0;
        for (std::size_t i = fibre.first; i < fibre.second; ++i) {
            length += members[at(order[i].course.member)].length_mm;
        }
        if (length > longest) {
            longest = length;
            best = fibre;
        }
    }
    return best;
}

bool FibreReach::holds(std::size_t from, std::size_t to, bool is_entry) const {
    if (round[from] != 0 && round[to] != 0) {
        return true;
    }
    return !last.empty() && to == last.front().node && (from == to || is_entry);
}

FibreReach reach_of(std::span<const Member> members, std::span<const OrderedCourse> order,
                    const FibreStretch& stretch, std::size_t nodes) {
    FibreReach reach{std::vector<char>(nodes, 0), {}};
    for (std::size_t i = stretch.first; i < stretch.second; ++i) {
        const auto [member, backward] = order[i].course;
        reach.round[departure_node(start_of(members[at(member)], backward))] = 1;
        reach.round[arrival_node(end_of(members[at(member)], backward))] = 1;
    }
    forget_dead_ends(members, reach.round);
    reach.last = find_last_node(members, reach.round);
    return reach;
}

}  // namespace meshwind
