/// What one continuous fibre can reach among the nodes (see balance.h) of a library.
#pragma once

#include <cstdint>
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

/// A node that the fibre can enter but not leave, such as a branch too slim for the head to pass on
/// the way back: it may still be where the fibre ends.
struct LastNode {
    std::size_t node = 0;
    std::vector<std::int32_t> entries;  ///< members that lead to it, largest footprint first
};

/// The nodes between which the fibre can go round and round, and the one where it may end.
struct FibreReach {
    std::vector<char> round;     ///< per node: 1 where the fibre can come and go
    std::vector<LastNode> last;  ///< none or one: that at which most courses turn round and round

    /// True when a course may be part of the fibre; `entry` is the only one that may enter the last
    /// node.
    [[nodiscard]] bool holds(std::size_t from, std::size_t to, bool is_entry) const;
};

/// What the fibre of `stretch` reaches, and can be extended to by courses that are windable.
/// \param nodes their number: two for each rim
[[nodiscard]] FibreReach reach_of(std::span<const Member> members,
                                  std::span<const OrderedCourse> order, const FibreStretch& stretch,
                                  std::size_t nodes);

}  // namespace meshwind
