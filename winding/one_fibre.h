/// The way that one continuous fibre takes among the nodes (see balance.h) of a library.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "winding/order.h"

namespace meshwind {

/// The courses of an order that one fibre winds: the first, and one past the last.
using FibreStretch = std::pair<std::size_t, std::size_t>;

/// All fibres of an order, in order.
[[nodiscard]] std::vector<FibreStretch> fibres_in(std::span<const OrderedCourse> order);

/// The fibre with the most course length; empty where there is none.
[[nodiscard]] FibreStretch main_fibre(std::span<const Member> members,
                                      std::span<const OrderedCourse> order);

/// Stages of nodes between which the fibre goes round and round, one stage after the other; from
/// each a single course leads on to the next, and none back. A branch too slim for the head to pass
/// on the way back makes such a stage: the fibre may end there.
struct FibreRoute {
    std::vector<int> stage;         ///< per node; -1 where the fibre never comes
    std::vector<LaidCourse> links;  ///< links[i] leads from stage i to stage i + 1

    /// True when a course may lead from a node to another, as often as wanted.
    [[nodiscard]] bool holds(const NodePair& nodes) const {
        return stage[nodes.first] >= 0 && stage[nodes.first] == stage[nodes.second];
    }
};

/// What is known of the way between two nodes.
struct KnownWay {
    bool abounds = false;            ///< many courses lead there
    std::vector<LaidCourse> proven;  ///< courses that hold, in the library's order
};

using KnownWays = std::map<NodePair, KnownWay>;

/// The route whose stages' courses cover most samples. \param nodes their number: two for each rim
[[nodiscard]] FibreRoute best_route(std::span<const Member> members, const KnownWays& ways,
                                    std::size_t nodes, std::size_t samples);

}  // namespace meshwind
