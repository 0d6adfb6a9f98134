/// Routes of continuous fibres among the nodes (see balance_courses.h) of a library.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "winding/cover/order_courses.h"

namespace meshwind {

/// The fibres of an order with the most course length, at most `most`, in their order.
[[nodiscard]] std::vector<OrderedCourse> longest_fibres(std::span<const LibraryCourse> members,
                                                        std::span<const OrderedCourse> order,
                                                        std::size_t most);

/// A route leads through stages, one after the other. A stage is a set of nodes between which the
/// fibre goes round and round; from each a single course leads on to the next, and none back. A
/// branch too slim for the head to pass on the way back makes such a stage: the fibre may end
/// there.
struct FibreRoute {
    std::vector<int> stage;             ///< per node; -1 where the fibre never comes
    std::vector<DirectedCourse> links;  ///< links[i] leads from stage i to stage i + 1
    double reach = 0.0;                 ///< share of the samples that it and those before it reach

    /// True when a course may lead from a node to another, as often as wanted.
    [[nodiscard]] bool holds(const NodePair& nodes) const {
        return stage[nodes.first] >= 0 && stage[nodes.first] == stage[nodes.second];
    }
    /// True when a course may lead from a node to another as often as there are fibres, too.
    [[nodiscard]] bool leads(const NodePair& nodes) const {
        return stage[nodes.first] >= 0 && stage[nodes.first] <= stage[nodes.second];
    }
};

/// The routes of a plan's fibres.
struct PlanRoutes {
    std::vector<FibreRoute> routes;  ///< of each fibre that needs one of its own
    int most_fibres = 1;             ///< that the plan may take

    [[nodiscard]] int fibres_needed() const { return std::max(1, static_cast<int>(routes.size())); }
    /// Fibres that no route needs may go from stage to stage by other courses than the links.
    [[nodiscard]] bool has_fibres_to_spare() const { return most_fibres > fibres_needed(); }
    [[nodiscard]] int fibres() const {
        return has_fibres_to_spare() ? most_fibres : fibres_needed();
    }
    /// True when courses may lead from a node to another.
    [[nodiscard]] bool hold(const NodePair& nodes) const {
        return std::any_of(routes.begin(), routes.end(), [&](const FibreRoute& route) {
            return has_fibres_to_spare() ? route.leads(nodes) : route.holds(nodes);
        });
    }
};

/// Known courses of the way between two nodes.
struct KnownWay {
    bool abounds = false;                ///< many courses lead there
    std::vector<DirectedCourse> proven;  ///< courses that hold, in the library's order
};

using KnownWays = std::map<NodePair, KnownWay>;

/// Routes of at most `most` fibres, chosen one after the other: each covers, by the courses of its
/// stages, most samples that those before it do not, and no less than kWorthAFibre of all.
/// \param nodes their number: two for each rim
[[nodiscard]] std::vector<FibreRoute> best_routes(std::span<const LibraryCourse> members,
                                                  const KnownWays& ways, std::size_t nodes,
                                                  std::size_t samples, std::size_t most);

/// Share of the wall that makes it worth cutting the fibre and tying on another.
inline constexpr double kWorthAFibre = 0.005;

}  // namespace meshwind
