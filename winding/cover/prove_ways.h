/// Which ways between nodes (balance.h) are open to the machine.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "winding/cover/fibre_routes.h"
#include "winding/cover/grow.h"
#include "winding/cover/placed_course.h"
#include "winding/plan/plan.h"

namespace meshwind {

struct ProvenWays {
    KnownWays known;                                          ///< the open ones
    std::vector<std::pair<std::int32_t, Rejection>> refused;  ///< members that do not hold
};

/// Proves a few courses of each way, and more of those of which none holds. \param ways of the
/// members \param prove the last word on a course; thread-safe \param progress told a share
[[nodiscard]] ProvenWays prove_ways(std::span<const Member> members, const Ways& ways,
                                    const std::function<Rejection(PlacedCourse&)>& prove,
                                    const std::function<void(double share)>& progress);

/// The courses besides `route.links[stage]` that lead from that stage to the next, the best last:
/// proven ones, then others.
[[nodiscard]] std::vector<LaidCourse> spare_links(std::span<const Member> members, const Ways& ways,
                                                  const KnownWays& known, const FibreRoute& route,
                                                  std::size_t stage);

}  // namespace meshwind
