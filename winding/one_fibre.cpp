#include "winding/one_fibre.h"

#include <algorithm>

namespace meshwind {
namespace {

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

// Routes that are looked into; so many only a mandrel of many rims has.
constexpr int kMostRoutes = 2000;

class RouteSearch {
public:
    RouteSearch(std::span<const Member> members, const KnownWays& ways, std::size_t nodes,
                std::size_t samples)
        : ways_(ways), nodes_(nodes), group_(nodes, -1) {
        find_groups();
        covered_.assign(static_cast<std::size_t>(groups_), std::vector<char>(samples, 0));
        for (const Member& member : members) {
            for (const bool backward : {false, true}) {
                const auto [departure, arrival] = nodes_of(member, backward);
                const int from = group_[departure];
                const int to = group_[arrival];
                if (from < 0 || from != to ||
                    !(backward ? member.windable_backward : member.windable_forward)) {
                    continue;
                }
                for (const std::int32_t sample : member.footprint) {
                    covered_[at(from)][at(sample)] = 1;
                }
            }
        }
    }

    FibreRoute run() {
        for (int group = 0; group < groups_; ++group) {
            std::vector<int> route{group};
            extend(route, covered_[at(group)]);
        }
        FibreRoute found{std::vector<int>(nodes_, -1), {}};
        for (std::size_t node = 0; node < nodes_; ++node) {
            const auto stage = std::find(best_.begin(), best_.end(), group_[node]);
            if (group_[node] >= 0 && stage != best_.end()) {
                found.stage[node] = static_cast<int>(stage - best_.begin());
            }
        }
        for (std::size_t i = 0; i + 1 < best_.size(); ++i) {
            found.links.push_back(*link(best_[i], best_[i + 1]));
        }
        return found;
    }

private:
    // Nodes that lead to each other by ways that abound, and single ones that lead to themselves.
    void find_groups() {
        std::vector<char> leads(nodes_ * nodes_, 0);
        const bool any = std::any_of(ways_.begin(), ways_.end(),
                                     [](const auto& way) { return way.second.abounds; });
        for (const auto& [nodes, way] : ways_) {
            const bool taken = any ? way.abounds : !way.proven.empty();
            leads[nodes.first * nodes_ + nodes.second] = taken ? 1 : 0;
        }
        for (std::size_t k = 0; k < nodes_; ++k) {
            for (std::size_t i = 0; i < nodes_; ++i) {
                for (std::size_t j = 0; j < nodes_; ++j) {
                    if (leads[i * nodes_ + k] != 0 && leads[k * nodes_ + j] != 0) {
                        leads[i * nodes_ + j] = 1;
                    }
                }
            }
        }
        for (std::size_t i = 0; i < nodes_; ++i) {
            if (leads[i * nodes_ + i] == 0 || group_[i] >= 0) {
                continue;
            }
            for (std::size_t j = i; j < nodes_; ++j) {
                if (leads[i * nodes_ + j] != 0 && leads[j * nodes_ + i] != 0) {
                    group_[j] = groups_;
                }
            }
            ++groups_;
        }
    }

    [[nodiscard]] const LaidCourse* link(int from, int to) const {
        for (const auto& [nodes, way] : ways_) {
            if (group_[nodes.first] == from && group_[nodes.second] == to && !way.proven.empty()) {
                return &way.proven.front();
            }
        }
        return nullptr;
    }

    void extend(std::vector<int>& route, const std::vector<char>& covered) {
        if (++routes_ > kMostRoutes) {
            return;
        }
        const auto worth = std::count(covered.begin(), covered.end(), 1);
        if (worth > most_) {
            most_ = worth;
            best_ = route;
        }
        for (int next = 0; next < groups_; ++next) {
            if (std::find(route.begin(), route.end(), next) != route.end() ||
                link(route.back(), next) == nullptr) {
                continue;
            }
            std::vector<char> both = covered;
            for (std::size_t i = 0; i < both.size(); ++i) {
                both[i] = static_cast<char>(both[i] | covered_[at(next)][i]);
            }
            route.push_back(next);
            extend(route, both);
            route.pop_back();
        }
    }

    const KnownWays& ways_;
    std::size_t nodes_;
    std::vector<int> group_;  // per node; -1 where nothing goes round
    int groups_ = 0;
    std::vector<std::vector<char>> covered_;  // per group and sample
    std::vector<int> best_;                   // groups in the order of the route
    std::int64_t most_ = -1;
    int routes_ = 0;
};

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

FibreRoute best_route(std::span<const Member> members, const KnownWays& ways, std::size_t nodes,
                      std::size_t samples) {
    return RouteSearch(members, ways, nodes, samples).run();
}

}  // namespace meshwind
