#include "winding/cover/balance_courses.h"

#include <algorithm>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "core/index.h"
#include "winding/cover/rim_joints.h"

namespace meshwind {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool can_wind(const LibraryCourse& member, bool backward) {
    return backward ? member.windable_backward : member.windable_forward;
}

// What is balanced, and how far.
struct BalanceTask {
    std::span<const LibraryCourse> members;  // the library
    std::span<const char> allowed;           // per member
    std::size_t rims;
    const SelectOptions& options;
    int fibres;  // so many may be left

    [[nodiscard]] std::size_t nodes() const { return 2 * rims; }
    [[nodiscard]] const LibraryCourse& member(const DirectedCourse& c) const {
        return members[at(c.member)];
    }
    [[nodiscard]] const RimCrossing& start(const DirectedCourse& c) const {
        return start_of(member(c), c.backward);
    }
    [[nodiscard]] const RimCrossing& end(const DirectedCourse& c) const {
        return end_of(member(c), c.backward);
    }
};

// From `from` along reversible courses to the nearest rim whose excess is <= `limit`.
bool reverse_chain(const BalanceTask& task, std::int32_t from, int limit, std::vector<int>& excess,
                   std::vector<DirectedCourse>& laid) {
    std::vector<std::size_t> came_by(task.rims, kNone);
    std::deque<std::int32_t> queue{from};
    while (!queue.empty()) {
        const std::int32_t rim = queue.front();
        queue.pop_front();
        if (excess[at(rim)] <= limit) {
            for (std::int32_t r = rim; r != from;) {
                DirectedCourse& c = laid[came_by[at(r)]];
                r = task.start(c).rim;
                c.backward = !c.backward;
            }
            excess[at(from)] -= 2;
            excess[at(rim)] += 2;
            return true;
        }
        for (std::size_t c = 0; c < laid.size(); ++c) {
            const std::int32_t next = task.end(laid[c]).rim;
            if (task.start(laid[c]).rim == rim && next != from && came_by[at(next)] == kNone &&
                can_wind(task.member(laid[c]), !laid[c].backward)) {
                came_by[at(next)] = c;
                queue.push_back(next);
            }
        }
    }
    return false;
}

// Reverses courses until departures and arrivals agree at every rim, as far as they can: each
// pass reverses a shortest chain of reversible courses from a rim with too many departures.
std::vector<DirectedCourse> directed(const BalanceTask& task, std::vector<DirectedCourse> laid) {
    std::vector<int> excess(task.rims, 0);
    for (const DirectedCourse& c : laid) {
        ++excess[at(task.start(c).rim)];
        --excess[at(task.end(c).rim)];
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t r = 0; r < task.rims && !changed; ++r) {
            if (excess[r] > 0) {
                changed = reverse_chain(task, static_cast<std::int32_t>(r),
                                        excess[r] >= 2 ? -1 : -2, excess, laid);
            }
        }
    }
    return laid;
}

RimJoints joints_of(const BalanceTask& task, const std::vector<DirectedCourse>& laid) {
    RimJoints joints(task.nodes());
    for (const DirectedCourse& c : laid) {
        joints.add(task.member(c), c.backward, 1);
    }
    return joints;
}

// Fibre of one more member, overlap included.
double cost_of(const BalanceTask& task, const Selection& selection, const LibraryCourse& member) {
    double waste = 0.0;
    for (const std::int32_t sample : member.footprint) {
        waste += std::max(0, selection.layers[at(sample)] - task.options.target(sample) + 1);
    }
    // Overlap counts as a share of the member's own fibre.
    const auto own = static_cast<double>(std::max<std::size_t>(1, member.footprint.size()));
    return member.turn_mm + member.length_mm * (1.0 + task.options.overlap_weight * waste / own);
}

// The cheapest way from a node to another.
struct ChainWay {
    double cost = std::numeric_limits<double>::infinity();
    DirectedCourse course;    // direct course between the nodes
    std::size_t via = kNone;  // or the first node of a chain
};

struct ChainWays {
    std::size_t nodes;
    std::vector<ChainWay> way = std::vector<ChainWay>(nodes * nodes);

    [[nodiscard]] ChainWay& between(std::size_t from, std::size_t to) {
        return way[from * nodes + to];
    }
    [[nodiscard]] const ChainWay& between(std::size_t from, std::size_t to) const {
        return way[from * nodes + to];
    }
};

// Cheapest course from node to node, then chains (Floyd and Warshall's all shortest paths).
ChainWays cheapest_ways(const BalanceTask& task, const Selection& selection) {
    ChainWays ways{task.nodes()};
    for (std::int32_t i = 0; at(i) < task.members.size(); ++i) {
        if (task.allowed[at(i)] == 0) {
            continue;
        }
        const LibraryCourse& member = task.members[at(i)];
        const double value = cost_of(task, selection, member);
        for (const bool backward : {false, true}) {
            const DirectedCourse c{i, backward};
            ChainWay& way = ways.between(departure_node(task.start(c)), arrival_node(task.end(c)));
            if (can_wind(member, backward) && value < way.cost) {
                way = {value, c, kNone};
            }
        }
    }
    for (std::size_t k = 0; k < ways.nodes; ++k) {
        for (std::size_t i = 0; i < ways.nodes; ++i) {
            for (std::size_t j = 0; j < ways.nodes; ++j) {
                const double sum = ways.between(i, k).cost + ways.between(k, j).cost;
                if (sum < ways.between(i, j).cost) {
                    ways.between(i, j) = {sum, {}, k};
                }
            }
        }
    }
    return ways;
}

// Courses that are laid, and which members and layers of the library they make.
struct Balanced {
    std::vector<DirectedCourse>& laid;
    Selection& selection;
};

void lay_way(const BalanceTask& task, const ChainWays& ways, std::size_t from, std::size_t to,
             const Balanced& balanced) {
    const ChainWay& way = ways.between(from, to);
    if (way.via != kNone) {
        lay_way(task, ways, from, way.via, balanced);
        lay_way(task, ways, way.via, to, balanced);
        return;
    }
    balanced.laid.push_back(way.course);
    balanced.selection.chosen.push_back(way.course.member);
    for (const std::int32_t sample : task.member(way.course).footprint) {
        ++balanced.selection.layers[at(sample)];
    }
}

// A chain that may be added.
struct Chain {
    double cost = std::numeric_limits<double>::infinity();
    std::size_t from = 0;
    std::size_t to = 0;
    bool and_back = false;
};

// The cheapest chain from a surplus node to a deficit node,
// unless it would only close a fibre that nothing else joins; or the cheapest way there and back
// between courses that nothing joins. Its cost is infinite where there is none.
Chain cheapest_chain(const ChainWays& ways, const RimJoints& joints) {
    const std::vector<std::size_t> part = joints.part_of();
    const std::vector<int> starts = joints.starts(part);
    Chain best;
    const auto weigh = [&](const Chain& chain) {
        if (chain.cost < best.cost) {
            best = chain;
        }
    };
    for (std::size_t i = 0; i < ways.nodes; ++i) {
        for (std::size_t j = 0; j < ways.nodes; ++j) {
            const bool apart = part[i] != part[j];
            const double there = ways.between(i, j).cost;
            if (joints.excess(i) > 0 && joints.excess(j) < 0 && (apart || starts[part[i]] > 1)) {
                weigh({there, i, j, false});
            }
            if (apart && joints.has_courses(i) && joints.has_courses(j)) {
                weigh({there + ways.between(j, i).cost, i, j, true});
            }
        }
    }
    return best;
}

// Adds the cheapest chain. False when there is none or no need.
bool add_chain(const BalanceTask& task, const Balanced& balanced) {
    const RimJoints joints = joints_of(task, balanced.laid);
    if (joints.fibres() <= task.fibres) {
        return false;
    }
    const ChainWays ways = cheapest_ways(task, balanced.selection);
    const Chain chain = cheapest_chain(ways, joints);
    if (chain.cost == std::numeric_limits<double>::infinity()) {
        return false;
    }
    lay_way(task, ways, chain.from, chain.to, balanced);
    if (chain.and_back) {
        lay_way(task, ways, chain.to, chain.from, balanced);
    }
    return true;
}

// The course without which there are fewer fibres and that bares least wall; kNone where there is
// none or no need.
std::size_t loose_course(const BalanceTask& task, const std::vector<DirectedCourse>& laid,
                         const Selection& selection) {
    RimJoints joints = joints_of(task, laid);
    const int fibres = joints.fibres();
    std::size_t best = kNone;
    std::int64_t least = 0;
    for (std::size_t c = 0; fibres > task.fibres && c < laid.size(); ++c) {
        const LibraryCourse& member = task.member(laid[c]);
        joints.add(member, laid[c].backward, -1);
        const bool helps = joints.fibres() < fibres;
        joints.add(member, laid[c].backward, 1);
        if (!helps) {
            continue;
        }
        const std::int64_t bared = std::count_if(
            member.footprint.begin(), member.footprint.end(), [&](std::int32_t sample) {
                return selection.layers[at(sample)] <= task.options.target(sample);
            });
        if (best == kNone || bared < least) {
            best = c;
            least = bared;
        }
    }
    return best;
}

// Where nothing can be added: drops a loose course. False when there is none.
bool drop_loose(const BalanceTask& task, const Balanced& balanced) {
    auto& [laid, selection] = balanced;
    const std::size_t loose = loose_course(task, laid, selection);
    if (loose == kNone) {
        return false;
    }
    const std::int32_t member = laid[loose].member;
    for (const std::int32_t sample : task.members[at(member)].footprint) {
        --selection.layers[at(sample)];
    }
    selection.chosen.erase(std::find(selection.chosen.begin(), selection.chosen.end(), member));
    laid.erase(laid.begin() + static_cast<std::ptrdiff_t>(loose));
    return true;
}

}  // namespace

std::vector<DirectedCourse> balance_courses(std::span<const LibraryCourse> members,
                                            std::span<const char> allowed, std::size_t rims,
                                            const SelectOptions& options, int fibres,
                                            Selection& selection) {
    const BalanceTask task{members, allowed, rims, options, fibres};
    std::vector<DirectedCourse> laid;
    for (const std::int32_t i : selection.chosen) {
        laid.push_back({i, !members[at(i)].windable_forward});
    }
    laid = directed(task, std::move(laid));
    const Balanced balanced{laid, selection};
    // Each chain mends two nodes; the guard is only against a library that could not.
    for (std::size_t guard = 0; guard <= 2 * laid.size() + task.nodes(); ++guard) {
        if (!add_chain(task, balanced)) {
            break;
        }
    }
    while (drop_loose(task, balanced)) {
    }
    return laid;
}

}  // namespace meshwind
