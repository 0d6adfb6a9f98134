/// Checks courses by every rule and on the machine, before they enter a plan. Finds the ways
/// between nodes (balance_courses.h) and the scarce places that are open to the machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "winding/cover/fibre_routes.h"
#include "winding/cover/grow_library.h"
#include "winding/cover/placed_course.h"
#include "winding/plan/plan.h"
#include "winding/plan/windability.h"

namespace meshwind {

/// Follows a course accurately, by every rule, and asks the machine to follow the course between
/// the halves of turns that lead to it and on from it; without one (null) a free length must be
/// found all along the course. On CourseFault::None the course becomes the one found, its footprint
/// that of `rules`, windable in this direction alone; on others it is unchanged.
[[nodiscard]] CourseFault prove_course(const CourseRules& rules, const Windability* machine,
                                       PlacedCourse& course);

/// Proves courses and winds their own programs. Thread-safe. References must outlive it.
class CourseProver {
public:
    /// \param machine null: none
    CourseProver(const CourseRules& rules, const Windability* machine)
        : rules_(rules), machine_(machine) {}

    [[nodiscard]] CourseFault prove(PlacedCourse& course) const {
        return prove_course(rules_, machine_, course);
    }

    /// Winds the program of a proven course that is to stay; once.
    [[nodiscard]] CourseFault wind(PlacedCourse& course) const;

    /// In parallel, of proven courses. \return the numbers of those that are refused, in order
    [[nodiscard]] std::vector<std::pair<std::size_t, CourseFault>> wind_all(
        std::span<PlacedCourse> courses) const;

private:
    const CourseRules& rules_;
    const Windability* machine_;
};

/// The library with the verdict on its members, and refused courses that are no members. Refusals
/// are counted in the plan's effort.
class ProvenLibrary {
public:
    /// \param effort of the plan; must outlive it
    ProvenLibrary(Library library, PlanEffort& effort);

    [[nodiscard]] const Library& grown() const { return library_; }
    /// Number of members of the library itself.
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::span<LibraryCourse> members() {
        return std::span(library_.members).first(size_);
    }
    /// With the courses of the plan behind those of the library, where gather() put them.
    [[nodiscard]] std::vector<LibraryCourse>& members_and_placed() { return library_.members; }
    /// Per sample.
    [[nodiscard]] std::vector<char>& reached() { return library_.reached; }
    /// Per member of the library: whether it may be laid.
    [[nodiscard]] std::span<const char> allowed() const { return allowed_; }
    /// Per member of the library, then per course besides: why it may not.
    [[nodiscard]] std::span<const CourseFault> rejection() const { return rejection_; }
    [[nodiscard]] PlanEffort& effort() const { return effort_; }

    /// A member of the library as a course; not followed yet.
    [[nodiscard]] PlacedCourse placed(const DirectedCourse& course) const {
        return {.member = library_.members[static_cast<std::size_t>(course.member)],
                .path = {},
                .backward = course.backward,
                .of_library = course.member};
    }

    void strike_off(std::size_t member, CourseFault reason);

    /// Strikes off all members, which are not counted.
    void strike_off_all(CourseFault reason);

    /// Notes a refused course that is no member. Thread-safe.
    void note_refused(std::vector<std::int32_t> footprint, CourseFault reason);

    /// Strikes off the member that the course is, if that is still allowed; else notes the course.
    void refuse(const PlacedCourse& course, CourseFault reason);

    /// Puts the courses that were noted behind the members, in place of those of the plan.
    void append_refused();

private:
    Library library_;
    std::size_t size_;
    std::vector<char> allowed_;
    std::vector<CourseFault> rejection_;
    PlanEffort& effort_;
    std::mutex refused_mutex_;
    std::vector<std::pair<std::vector<std::int32_t>, CourseFault>> refused_;  // in any order
};

struct ProvenWays {
    KnownWays known;                                            ///< the open ones
    std::vector<std::pair<std::int32_t, CourseFault>> refused;  ///< members that do not hold
};

/// Proves a few courses of each way, and more of those of which none holds. \param ways of the
/// members \param prove final check of a course; thread-safe \param progress told a share
[[nodiscard]] ProvenWays prove_ways(std::span<const LibraryCourse> members, const Ways& ways,
                                    const std::function<CourseFault(PlacedCourse&)>& prove,
                                    const std::function<void(double share)>& progress);

/// Finds the places reached by members that hold. At a place that few members pass all of them are
/// proven, elsewhere one after the other until one holds, up to a fixed number.
class ReachProver {
public:
    /// \param samples their number \param prove thread-safe
    ReachProver(std::size_t samples, std::function<CourseFault(PlacedCourse&)> prove)
        : samples_(samples), prove_(std::move(prove)) {}

    /// Members that are proven have the footprint that was found, and are windable in the
    /// directions that hold. Called again, with directions taken away or more members, it proves
    /// only the rest. \return per sample, 1 where a member that holds passes
    [[nodiscard]] std::vector<char> prove(std::span<LibraryCourse> members);

    /// Members that the last call found to hold in no direction.
    [[nodiscard]] std::span<const std::pair<std::int32_t, CourseFault>> refused() const {
        return refused_;
    }

private:
    void try_out(std::span<LibraryCourse> members, std::span<const std::int32_t> some,
                 std::vector<char>& reached);

    std::size_t samples_;
    std::function<CourseFault(PlacedCourse&)> prove_;
    std::vector<char> tried_;  // per member
    std::vector<std::pair<std::int32_t, CourseFault>> refused_;
};

/// The courses besides `route.links[stage]` that lead from that stage to the next, the best last:
/// proven ones, then others.
[[nodiscard]] std::vector<DirectedCourse> spare_links(std::span<const LibraryCourse> members,
                                                      const Ways& ways, const KnownWays& known,
                                                      const FibreRoute& route, std::size_t stage);

}  // namespace meshwind
