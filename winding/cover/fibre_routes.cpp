#include "winding/cover/fibre_routes.h"

#include <algorithm>

#include "core/index.h"

namespace meshwind {
namespace {

// Routes that are looked into; so many only a mandrel of many rims has.
constexpr int kMostRoutes = 2000;

class RouteSearch {
public:
    RouteSearch(std::span<const Member> members, const KnownWays& ways, std::size_t nodes,
                std::size_t samples)
        : members_(members), ways_(ways), nodes_(nodes), group_(nodes, -1), reached_(samples, 0) {
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

    std::vector<FibreRoute> run(std::size_t most) {
        std::vector<FibreRoute> routes;
        while (routes.size() < most) {
            best_ = {};
            most_ = static_cast<std::int64_t>(kWorthAFibre * static_cast<double>(reached_.size()));
            most_ += count(reached_);
            tried_ = 0;
            for (int group = 0; group < groups_; ++group) {
                extend({{group}, {}, together(reached_, covered_[at(group)])});
            }
            if (best_.groups.empty()) {
                break;
            }
            routes.push_back(taken());
        }
        return routes;
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

    // The proven course between two groups that reaches most that is not reached yet.
    [[nodiscard]] const LaidCourse* link(int from, int to, const std::vector<char>& reached) const {
        const LaidCourse* best = nullptr;
        std::int64_t most = -1;
        for (const auto& [nodes, way] : ways_) {
            if (group_[nodes.first] != from || group_[nodes.second] != to) {
                continue;
            }
            for (const LaidCourse& course : way.proven) {
                const auto& footprint = members_[at(course.member)].footprint;
                const std::int64_t more =
                    std::count_if(footprint.begin(), footprint.end(),
                                  [&](std::int32_t sample) { return reached[at(sample)] == 0; });
                if (more > most) {
                    most = more;
                    best = &course;
                }
            }
        }
        return best;
    }

    [[nodiscard]] static std::int64_t count(const std::vector<char>& reached) {
        return std::count(reached.begin(), reached.end(), 1);
    }

    [[nodiscard]] static std::vector<char> together(std::vector<char> reached,
                                                    const std::vector<char>& more) {
        for (std::size_t i = 0; i < reached.size(); ++i) {
            reached[i] = static_cast<char>(reached[i] | more[i]);
        }
        return reached;
    }

    // Groups in the order of a route, and the courses that lead from each to the next.
    struct Way {
        std::vector<int> groups;
        std::vector<LaidCourse> links;
        std::vector<char> reached;  // with the routes before
    };

    void extend(const Way& way) {
        if (++tried_ > kMostRoutes) {
            return;
        }
        if (count(way.reached) > most_) {
            most_ = count(way.reached);
            best_ = way;
        }
        for (int next = 0; next < groups_; ++next) {
            if (std::find(way.groups.begin(), way.groups.end(), next) != way.groups.end()) {
                continue;
            }
            Way longer = way;
            longer.reached = together(std::move(longer.reached), covered_[at(next)]);
            const LaidCourse* const course = link(way.groups.back(), next, longer.reached);
            if (course != nullptr) {
                for (const std::int32_t sample : members_[at(course->member)].footprint) {
                    longer.reached[at(sample)] = 1;
                }
                longer.groups.push_back(next);
                longer.links.push_back(*course);
                extend(longer);
            }
        }
    }

    // The best route found, whose samples count as reached from now on.
    FibreRoute taken() {
        FibreRoute route{std::vector<int>(nodes_, -1), std::move(best_.links)};
        for (std::size_t node = 0; node < nodes_; ++node) {
            const auto stage = std::find(best_.groups.begin(), best_.groups.end(), group_[node]);
            if (group_[node] >= 0 && stage != best_.groups.end()) {
                route.stage[node] = static_cast<int>(stage - best_.groups.begin());
            }
        }
        reached_ = std::move(best_.reached);
        route.reach = static_cast<double>(count(reached_)) / static_cast<double>(reached_.size());
        return route;
    }

    std::span<const Member> members_;
    const KnownWays& ways_;
    std::size_t nodes_;
    std::vector<int> group_;  // per node; -1 where nothing goes round
    int groups_ = 0;
    std::vector<std::vector<char>> covered_;  // per group and sample
    std::vector<char> reached_;               // per sample: by the routes before
    Way best_;
    std::int64_t most_ = 0;  // samples reached with it
    int tried_ = 0;
};

}  // namespace

std::vector<OrderedCourse> longest_fibres(std::span<const Member> members,
                                          std::span<const OrderedCourse> order, std::size_t most) {
    struct Fibre {
        double length_mm = 0.0;
        std::vector<OrderedCourse> courses;
    };
    std::vector<Fibre> fibres;
    bool fresh = true;
    for (const OrderedCourse& course : order) {
        if (fresh) {
            fibres.emplace_back();
        }
        fibres.back().length_mm += members[at(course.course.member)].length_mm;
        fibres.back().courses.push_back(course);
        fresh = course.cut_after;
    }
    while (fibres.size() > most) {
        fibres.erase(std::min_element(
            fibres.begin(), fibres.end(),
            [](const Fibre& a, const Fibre& b) { return a.length_mm < b.length_mm; }));
    }
    std::vector<OrderedCourse> kept;
    for (const Fibre& fibre : fibres) {
        kept.insert(kept.end(), fibre.courses.begin(), fibre.courses.end());
    }
    return kept;
}

std::vector<FibreRoute> best_routes(std::span<const Member> members, const KnownWays& ways,
                                    std::size_t nodes, std::size_t samples, std::size_t most) {
    return RouteSearch(members, ways, nodes, samples).run(most);
}

}  // namespace meshwind
