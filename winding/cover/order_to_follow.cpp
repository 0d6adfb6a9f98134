#include "winding/cover/order_to_follow.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/parallel.h"
#include "winding/cover/arrange_courses.h"
#include "winding/cover/lay_out_plan.h"
#include "winding/cover/order_courses.h"

namespace meshwind {
namespace {

// Orders that are tried. Each closes turns that it found, so that later ones have fewer to choose
// from.
constexpr int kMaxOrders = 20;

class Follower {
public:
    Follower(const CourseRules& rules, const Windability* machine,
             std::span<const LibraryCourse> members, std::span<const DirectedCourse> laid,
             std::span<const double> lateness)
        : rules_(rules), machine_(machine), members_(members), laid_(laid) {
        for (std::size_t i = 0; i < laid.size(); ++i) {
            lateness_[laid[i].member] = lateness[i];
        }
    }

    FollowedOrder run(std::size_t fibres) {
        std::vector<OrderedCourse> best = put_in_order();
        if (machine_ == nullptr) {
            return {std::move(best)};
        }
        std::vector<OrderedCourse> order = best;
        std::pair<std::size_t, std::size_t> least;  // cuts, closed turns
        for (int tried = 0; tried < kMaxOrders; ++tried) {
            const std::size_t known = closed_.size();
            const std::pair<std::size_t, std::size_t> count{cuts(order), close_turns(order)};
            if (tried == 0 || count < least) {
                best = order;
                least = count;
            }
            if (least.second == 0 || closed_.size() == known) {
                break;
            }
            order = put_in_order();
        }
        const std::size_t cut = cut_at_closed(best, fibres - std::min(fibres, least.first));
        return {std::move(best), static_cast<int>(least.second - cut), std::move(closed_)};
    }

private:
    [[nodiscard]] std::vector<OrderedCourse> put_in_order() const {
        std::vector<OrderedCourse> order =
            order_courses(rules_.mandrel.rims, members_, laid_, rules_.turns, closed_);
        std::vector<double> lateness;
        lateness.reserve(order.size());
        for (const OrderedCourse& course : order) {
            lateness.push_back(lateness_.at(course.course.member));
        }
        arrange(rules_.mandrel.rims, members_, rules_.turns, lateness, order, closed_);
        return order;
    }

    static std::size_t cuts(std::span<const OrderedCourse> order) {
        return static_cast<std::size_t>(
            std::count_if(order.begin(), order.end(),
                          [](const OrderedCourse& course) { return course.cut_after; }));
    }

    // Ends fibres at the first closed turns, `most` of them. Returns how many it did.
    std::size_t cut_at_closed(std::vector<OrderedCourse>& order, std::size_t most) const {
        std::size_t done = 0;
        for (std::size_t i = 0; i + 1 < order.size() && done < most; ++i) {
            if (!order[i].cut_after && closed_.count({order[i].course, order[i + 1].course}) != 0) {
                order[i].cut_after = true;
                ++done;
            }
        }
        return done;
    }

    // Adds the turns of the order that the machine cannot follow. Returns how many they are.
    std::size_t close_turns(std::span<const OrderedCourse> order) {
        Plan plan;
        lay_out(rules_, members_, order, plan);
        std::vector<std::pair<DirectedCourse, DirectedCourse>> turns;
        std::vector<std::size_t> first;  // piece of each: the course before it
        std::size_t piece = 0;
        for (std::size_t i = 0; i + 1 < order.size(); ++i) {
            if (!order[i].cut_after) {
                turns.emplace_back(order[i].course, order[i + 1].course);
                first.push_back(piece);
                ++piece;
            }
            ++piece;
        }
        std::vector<char> refused(turns.size(), 0);
        parallel_for(turns.size(), 1, [&](std::size_t i, std::size_t) {
            constexpr std::size_t kCourseTurnCourse = 3;
            const auto pieces = std::span(plan.pieces).subspan(first[i], kCourseTurnCourse);
            refused[i] = static_cast<char>(closed_.count(turns[i]) != 0 ||
                                           machine_->follow(pieces) != CourseFault::None);
        });
        for (std::size_t i = 0; i < turns.size(); ++i) {
            if (refused[i] != 0) {
                closed_.insert(turns[i]);
            }
        }
        return static_cast<std::size_t>(std::count(refused.begin(), refused.end(), 1));
    }

    const CourseRules& rules_;
    const Windability* machine_;
    std::span<const LibraryCourse> members_;
    std::span<const DirectedCourse> laid_;
    std::map<std::int32_t, double> lateness_;  // by member
    ClosedTurns closed_;
};

// With fewer others a course may well be the first or the last of a fibre.
constexpr std::size_t kMinOthers = 3;

bool can_turn(const CourseRules& rules, const Windability& machine, const PlacedCourse& from,
              const PlacedCourse& to) {
    const std::array<LibraryCourse, 2> members{from.member, to.member};
    const std::array<OrderedCourse, 2> order{OrderedCourse{{0, from.backward}, false},
                                             OrderedCourse{{1, to.backward}, true}};
    Plan plan;
    lay_out(rules, members, order, plan);
    return machine.follow(plan.pieces) == CourseFault::None;
}

}  // namespace

FollowedOrder order_to_follow(const CourseRules& rules, const Windability* machine,
                              std::span<const LibraryCourse> members,
                              std::span<const DirectedCourse> laid,
                              std::span<const double> lateness, std::size_t fibres) {
    return Follower(rules, machine, members, laid, lateness).run(fibres);
}

bool can_be_turned(const CourseRules& rules, const Windability* machine, const PlacedCourse& course,
                   std::span<const PlacedCourse> others) {
    if (machine == nullptr) {
        return true;
    }
    const NodePair nodes = nodes_of(course.member, course.backward);
    std::size_t before = 0;  // others from which fibre may come
    std::size_t behind = 0;  // others to which it may go on
    bool comes = false;
    bool goes_on = false;
    for (const PlacedCourse& other : others) {
        const NodePair its = nodes_of(other.member, other.backward);
        if (its.second == nodes.first) {
            ++before;
            comes = comes || can_turn(rules, *machine, other, course);
        }
        if (its.first == nodes.second) {
            ++behind;
            goes_on = goes_on || can_turn(rules, *machine, course, other);
        }
    }
    return (comes || before < kMinOthers) && (goes_on || behind < kMinOthers);
}

}  // namespace meshwind
