#include "winding/cover/fibre_routes.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/index.h"

namespace meshwind {
namespace {

// Routes that are looked into; so many only a mandrel of many rims has.
constexpr int kMaxRoutes = 2000;

// Nodes between which the fibre goes round and round.
struct NodeGroups {
    std::vector<int> of_node;  // -1 where nothing goes round
    int count = 0;
};

// Nodes that lead to each other by ways that abound, and single ones that lead to themselves.
NodeGroups groups_of(const KnownWays& ways, std::size_t nodes) {
    NodeGroups groups{std::vector<int>(nodes, -1)};
    std::vector<char> leads(nodes * nodes, 0);
    const bool any =
        std::any_of(ways.begin(), ways.end(), [](const auto& way) { return way.second.abounds; });
    for (const auto& [ends, way] : ways) {
        const bool taken = any ? way.abounds : !way.proven.empty();
        leads[ends.first * nodes + ends.second] = taken ? 1 : 0;
    }
    for (std::size_t k = 0; k < nodes; ++k) {
        for (std::size_t i = 0; i < nodes; ++i) {
            for (std::size_t j = 0; j < nodes; ++j) {
                if (leads[i * nodes + k] != 0 && leads[k * nodes + j] != 0) {
                    leads[i * nodes + j] = 1;
                }
            }
        }
    }
    for (std::size_t i = 0; i < nodes; ++i) {
        if (leads[i * nodes + i] == 0 || groups.of_node[i] >= 0) {
            continue;
        }
        for (std::size_t j = i; j < nodes; ++j) {
            if (leads[i * nodes + j] != 0 && leads[j * nodes + i] != 0) {
                groups.of_node[j] = groups.count;
            }
        }
        ++groups.count;
    }
    return groups;
}

// Per group and sample: 1 where a course within the group passes.
std::vector<std::vector<char>> covered_by(const NodeGroups& groups,
                                          std::span<const LibraryCourse> members,
                                          std::size_t samples) {
    std::vector<std::vector<char>> covered(static_cast<std::size_t>(groups.count),
                                           std::vector<char>(samples, 0));
    for (const LibraryCourse& member : members) {
        for (const bool backward : {false, true}) {
            const auto [departure, arrival] = nodes_of(member, backward);
            const int from = groups.of_node[departure];
            const int to = groups.of_node[arrival];
            if (from < 0 || from != to ||
                !(backward ? member.windable_backward : member.windable_forward)) {
                continue;
            }
            for (const std::int32_t sample : member.footprint) {
                covered[at(from)][at(sample)] = 1;
            }
        }
    }
    return covered;
}

// What routes are sought among.
struct RouteTask {
    std::span<const LibraryCourse> members;
    const KnownWays& ways;
    NodeGroups groups;
    std::vector<std::vector<char>> covered;  // per group and sample
};

// The proven course between two groups that reaches most that is not reached yet.
const DirectedCourse* best_link(const RouteTask& task, int from, int to,
                                const std::vector<char>& reached) {
    const DirectedCourse* best = nullptr;
    std::int64_t most = -1;
    for (const auto& [nodes, way] : task.ways) {
        if (task.groups.of_node[nodes.first] != from || task.groups.of_node[nodes.second] != to) {
            continue;
        }
        for (const DirectedCourse& course : way.proven) {
            const auto& footprint = task.members[at(course.member)].footprint;
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

std::int64_t count_reached(const std::vector<char>& reached) {
    return std::count(reached.begin(), reached.end(), 1);
}

std::vector<char> together(std::vector<char> reached, const std::vector<char>& more) {
    for (std::size_t i = 0; i < reached.size(); ++i) {
        reached[i] = static_cast<char>(reached[i] | more[i]);
    }
    return reached;
}

// Groups in the order of a route, and the courses that lead from each to the next.
struct GroupRoute {
    std::vector<int> groups;
    std::vector<DirectedCourse> links;
    std::vector<char> reached;  // with the routes before
};

// The best of the routes looked into.
struct BestRoute {
    GroupRoute route;
    std::int64_t most = 0;  // samples reached with it
    int tried = 0;
};

// Looks into a route and all that go on from it.
void extend(const RouteTask& task, const GroupRoute& route, BestRoute& best) {
    if (++best.tried > kMaxRoutes) {
        return;
    }
    if (count_reached(route.reached) > best.most) {
        best.most = count_reached(route.reached);
        best.route = route;
    }
    for (int next = 0; next < task.groups.count; ++next) {
        if (std::find(route.groups.begin(), route.groups.end(), next) != route.groups.end()) {
            continue;
        }
        GroupRoute longer = route;
        longer.reached = together(std::move(longer.reached), task.covered[at(next)]);
        const DirectedCourse* const course =
            best_link(task, route.groups.back(), next, longer.reached);
        if (course != nullptr) {
            for (const std::int32_t sample : task.members[at(course->member)].footprint) {
                longer.reached[at(sample)] = 1;
            }
            longer.groups.push_back(next);
            longer.links.push_back(*course);
            extend(task, longer, best);
        }
    }
}

// The route that reaches most, and enough to be worth a fibre; no groups where there is none.
// \param reached per sample: by the routes before
GroupRoute best_route(const RouteTask& task, const std::vector<char>& reached) {
    BestRoute best;
    best.most = static_cast<std::int64_t>(kWorthAFibre * static_cast<double>(reached.size()));
    best.most += count_reached(reached);
    for (int group = 0; group < task.groups.count; ++group) {
        extend(task, {{group}, {}, together(reached, task.covered[at(group)])}, best);
    }
    return std::move(best.route);
}

FibreRoute fibre_route(const GroupRoute& found, const NodeGroups& groups) {
    const std::size_t nodes = groups.of_node.size();
    FibreRoute route{std::vector<int>(nodes, -1), found.links};
    for (std::size_t node = 0; node < nodes; ++node) {
        const int group = groups.of_node[node];
        const auto stage = std::find(found.groups.begin(), found.groups.end(), group);
        if (group >= 0 && stage != found.groups.end()) {
            route.stage[node] = static_cast<int>(stage - found.groups.begin());
        }
    }
    route.reach = static_cast<double>(count_reached(found.reached)) /
                  static_cast<double>(found.reached.size());
    return route;
}

}  // namespace

std::vector<OrderedCourse> longest_fibres(std::span<const LibraryCourse> members,
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

std::vector<FibreRoute> best_routes(std::span<const LibraryCourse> members, const KnownWays& ways,
                                    std::size_t nodes, std::size_t samples, std::size_t most) {
    RouteTask task{members, ways, groups_of(ways, nodes), {}};
    task.covered = covered_by(task.groups, members, samples);
    std::vector<char> reached(samples, 0);
    std::vector<FibreRoute> routes;
    while (routes.size() < most) {
        GroupRoute best = best_route(task, reached);
        if (best.groups.empty()) {
            break;
        }
        routes.push_back(fibre_route(best, task.groups));
        reached = std::move(best.reached);
    }
    return routes;
}

}  // namespace meshwind
