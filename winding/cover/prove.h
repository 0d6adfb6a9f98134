/// The last word on courses before they enter a plan; which ways between nodes (balance.h) and
/// which scarce places are open to the machine.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "winding/cover/fibre_routes.h"
#include "winding/cover/grow.h"
#include "winding/cover/placed_course.h"
#include "winding/plan/plan.h"
#include "winding/plan/windability.h"

namespace meshwind {

/// Follows a course accurately, by every rule, and asks the machine to follow the course between
/// the halves of turns that lead to it and on from it; without one (null) a free length must be
/// found all along the course. On Rejection::None the course becomes what was found, its footprint
/// that of `rules`, windable in this direction alone; on others it is unchanged.
[[nodiscard]] Rejection prove_course(const CourseRules& rules, const Windability* machine,
                                     PlacedCourse& course);

/// Proves courses and winds their own programs. Thread-safe. References must outlive it.
class CourseProver {
public:
    /// \param machine null: none
    CourseProver(const CourseRules& rules, const Windability* machine)
        : rules_(rules), machine_(machine) {}

    [[nodiscard]] Rejection prove(PlacedCourse& course) const {
        return prove_course(rules_, machine_, course);
    }

    /// Of a proven course that is to stay; once.
    [[nodiscard]] Rejection wind(PlacedCourse& course) const;

    [[nodiscard]] Rejection prove_and_wind(PlacedCourse& course) const;

    /// In parallel. \param to_stay their own programs are wound as well
    [[nodiscard]] std::vector<Rejection> prove_all(std::span<PlacedCourse> courses,
                                                   bool to_stay) const;

    /// In parallel, of proven courses. \return the numbers of those that are refused, in order
    [[nodiscard]] std::vector<std::pair<std::size_t, Rejection>> wind_all(
        std::span<PlacedCourse> courses) const;

private:
    const CourseRules& rules_;
    const Windability* machine_;
};

struct ProvenWays {
    KnownWays known;                                          ///< the open ones
    std::vector<std::pair<std::int32_t, Rejection>> refused;  ///< members that do not hold
};

/// Proves a few courses of each way, and more of those of which none holds. \param ways of the
/// members \param prove the last word on a course; thread-safe \param progress told a share
[[nodiscard]] ProvenWays prove_ways(std::span<const Member> members, const Ways& ways,
                                    const std::function<Rejection(PlacedCourse&)>& prove,
                                    const std::function<void(double share)>& progress);

/// Which places are reached by members that hold: at a place that few members pass all of
/// them are proven, elsewhere one after the other until one holds, so many at most.
class ReachProver {
public:
    /// \param samples their number \param prove thread-safe
    ReachProver(std::size_t samples, std::function<Rejection(PlacedCourse&)> prove)
        : samples_(samples), prove_(std::move(prove)) {}

    /// Members that are proven have the footprint that was found, and are windable in the
    /// directions that hold. Called again, with directions taken away or more members, it proves
    /// what that leaves to prove. \return per sample, 1 where a member that holds passes
    [[nodiscard]] std::vector<char> prove(std::span<Member> members);

    /// Members that the last call found to hold in no direction.
    [[nodiscard]] std::span<const std::pair<std::int32_t, Rejection>> refused() const {
        return refused_;
    }

private:
    void try_out(std::span<Member> members, std::span<const std::int32_t> some,
                 std::vector<char>& reached);

    std::size_t samples_;
    std::function<Rejection(PlacedCourse&)> prove_;
    std::vector<char> tried_;  // per member
    std::vector<std::pair<std::int32_t, Rejection>> refused_;
};

/// The courses besides `route.links[stage]` that lead from that stage to the next, the best last:
/// proven ones, then others.
[[nodiscard]] std::vector<LaidCourse> spare_links(std::span<const Member> members, const Ways& ways,
                                                  const KnownWays& known, const FibreRoute& route,
                                                  std::size_t stage);

}  // namespace meshwind
