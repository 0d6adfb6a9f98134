#include "winding/cover/balance.h"

#include <algorithm>
#include <deque>
#include <limits>

#include "core/index.h"
#include "winding/cover/joints.h"

namespace meshwind {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool can_wind(const Member& member, bool backward) {
    return backward ? member.windable_backward : member.windable_forward;
}

class Balancer {
public:
    Balancer(std::span<const Member> members, std::span<const char> allowed, std::size_t rims,
             const SelectOptions& options, int fibres, Selection& selection)
        : members_(members),
          allowed_(allowed),
          rims_(rims),
          nodes_(2 * rims),
          options_(options),
          fibres_(fibres),
          selection_(selection) {
        for (const std::int32_t i : selection.chosen) {
            laid_.push_back({i, !members[at(i)].windable_forward});
        }
    }

    std::vector<LaidCourse> run() {
        direct();
        // Each chain mends two nodes; the guard is only against a library that could not.
        for (std::size_t guard = 0; guard <= 2 * laid_.size() + nodes_; ++guard) {
            if (!add_chain()) {
                break;
            }
        }
        while (drop_loose()) {
        }
        return std::move(laid_);
    }

private:
    [[nodiscard]] const RimCrossing& start(const LaidCourse& c) const {
        return start_of(members_[at(c.member)], c.backward);
    }
    [[nodiscard]] const RimCrossing& end(const LaidCourse& c) const {
        return end_of(members_[at(c.member)], c.backward);
    }

    // Reverses courses until departures and arrivals agree at every rim, as far as they can: each
    // pass reverses a shortest chain of reversible courses from a rim with too many departures.
    void direct() {
        std::vector<int> excess(rims_, 0);
        for (const LaidCourse& c : laid_) {
            ++excess[at(start(c).rim)];
            --excess[at(end(c).rim)];
        }
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t r = 0; r < rims_ && !changed; ++r) {
                if (excess[r] > 0) {
                    changed = reverse_chain(static_cast<std::int32_t>(r), excess,
                                            excess[r] >= 2 ? -1 : -2);
                }
            }
        }
    }

    // From `from` along reversible courses to the nearest rim whose excess is <= `limit`.
    bool reverse_chain(std::int32_t from, std::vector<int>& excess, int limit) {
        std::vector<std::size_t> came_by(rims_, kNone);
        std::deque<std::int32_t> queue{from};
        while (!queue.empty()) {
            const std::int32_t rim = queue.front();
            queue.pop_front();
            if (excess[at(rim)] <= limit) {
                for (std::int32_t r = rim; r != from;) {
                    LaidCourse& c = laid_[came_by[at(r)]];
                    r = start(c).rim;
                    c.backward = !c.backward;
                }
                excess[at(from)] -= 2;
                excess[at(rim)] += 2;
                return true;
            }
            for (std::size_t c = 0; c < laid_.size(); ++c) {
                const std::int32_t next = end(laid_[c]).rim;
                if (start(laid_[c]).rim == rim && next != from && came_by[at(next)] == kNone &&
                    can_wind(members_[at(laid_[c].member)], !laid_[c].backward)) {
                    came_by[at(next)] = c;
                    queue.push_back(next);
                }
            }
        }
        return false;
    }

    [[nodiscard]] Joints joints() const {
        Joints joints(nodes_);
        for (const LaidCourse& c : laid_) {
            joints.add(members_[at(c.member)], c.backward, 1);
        }
        return joints;
    }

    [[nodiscard]] double cost(std::int32_t i) const {
        const Member& member = members_[at(i)];
        double waste = 0.0;
        for (const std::int32_t sample : member.footprint) {
            waste += std::max(0, selection_.layers[at(sample)] - options_.target(sample) + 1);
        }
        // Overlap counts as a share of the member's own fibre.
        const auto own = static_cast<double>(std::max<std::size_t>(1, member.footprint.size()));
        return member.turn_mm + member.length_mm * (1.0 + options_.overlap_weight * waste / own);
    }

    struct Way {
        double cost = std::numeric_limits<double>::infinity();
        LaidCourse course;        // direct course between the nodes
        std::size_t via = kNone;  // or the first node of a chain
    };

    // Cheapest course from node to node, then chains (Floyd and Warshall's all shortest paths).
    [[nodiscard]] std::vector<Way> cheapest_ways() const {
        std::vector<Way> ways(nodes_ * nodes_);
        for (std::int32_t i = 0; at(i) < members_.size(); ++i) {
            if (allowed_[at(i)] == 0) {
                continue;
            }
            const double value = cost(i);
            for (const bool backward : {false, true}) {
                const LaidCourse c{i, backward};
                Way& way = ways[departure_node(start(c)) * nodes_ + arrival_node(end(c))];
                if (can_wind(members_[at(i)], backward) && value < way.cost) {
                    way = {value, c, kNone};
                }
            }
        }
        for (std::size_t k = 0; k < nodes_; ++k) {
            for (std::size_t i = 0; i < nodes_; ++i) {
                for (std::size_t j = 0; j < nodes_; ++j) {
                    const double sum = ways[i * nodes_ + k].cost + ways[k * nodes_ + j].cost;
                    if (sum < ways[i * nodes_ + j].cost) {
                        ways[i * nodes_ + j] = {sum, {}, k};
                    }
                }
            }
        }
        return ways;
    }

    void lay_way(const std::vector<Way>& ways, std::size_t from, std::size_t to) {
        const Way& way = ways[from * nodes_ + to];
        if (way.via != kNone) {
            lay_way(ways, from, way.via);
            lay_way(ways, way.via, to);
            return;
        }
        laid_.push_back(way.course);
        selection_.chosen.push_back(way.course.member);
        for (const std::int32_t sample : members_[at(way.course.member)].footprint) {
            ++selection_.layers[at(sample)];
        }
    }

    // Adds the cheapest chain from a node where fibres arrive in vain to one where they are
    // missing, unless it would only close a fibre that nothing else joins; or the cheapest way
    // there and back between courses that nothing joins.
    bool add_chain() {
        const Joints joints = this->joints();
        if (joints.fibres() <= fibres_) {
            return false;
        }
        const std::vector<std::size_t> part = joints.part_of();
        const std::vector<int> starts = joints.starts(part);
        const std::vector<Way> ways = cheapest_ways();
        double least = std::numeric_limits<double>::infinity();
        std::pair<std::size_t, std::size_t> best;
        bool and_back = false;
        const auto weigh = [&](double cost, std::size_t i, std::size_t j, bool back) {
            if (cost < least) {
                least = cost;
                best = {i, j};
                and_back = back;
            }
        };
        for (std::size_t i = 0; i < nodes_; ++i) {
            for (std::size_t j = 0; j < nodes_; ++j) {
                const bool apart = part[i] != part[j];
                const double there = ways[i * nodes_ + j].cost;
                if (joints.excess(i) > 0 && joints.excess(j) < 0 &&
                    (apart || starts[part[i]] > 1)) {
                    weigh(there, i, j, false);
                }
                if (apart && joints.has_courses(i) && joints.has_courses(j)) {
                    weigh(there + ways[j * nodes_ + i].cost, i, j, true);
                }
            }
        }
        if (least == std::numeric_limits<double>::infinity()) {
            return false;
        }
        lay_way(ways, best.first, best.second);
        if (and_back) {
            lay_way(ways, best.second, best.first);
        }
        return true;
    }

    // Where nothing can be added: drops the course without which there are fewer fibres and that
    // bares least wall. False when there is none or no need.
    bool drop_loose() {
        Joints joints = this->joints();
        const int fibres = joints.fibres();
        std::size_t best = kNone;
        std::int64_t least = 0;
        for (std::size_t c = 0; fibres > fibres_ && c < laid_.size(); ++c) {
            const Member& member = members_[at(laid_[c].member)];
            joints.add(member, laid_[c].backward, -1);
            const bool helps = joints.fibres() < fibres;
            joints.add(member, laid_[c].backward, 1);
            if (!helps) {
                continue;
            }
            const std::int64_t bared = std::count_if(
                member.footprint.begin(), member.footprint.end(), [&](std::int32_t sample) {
                    return selection_.layers[at(sample)] <= options_.target(sample);
                });
            if (best == kNone || bared < least) {
                best = c;
                least = bared;
            }
        }
        if (best == kNone) {
            return false;
        }
        const std::int32_t member = laid_[best].member;
        for (const std::int32_t sample : members_[at(member)].footprint) {
            --selection_.layers[at(sample)];
        }
        selection_.chosen.erase(
            std::find(selection_.chosen.begin(), selection_.chosen.end(), member));
        laid_.erase(laid_.begin() + static_cast<std::ptrdiff_t>(best));
        return true;
    }

    std::span<const Member> members_;
    std::span<const char> allowed_;
    std::size_t rims_;
    std::size_t nodes_;
    const SelectOptions& options_;
    int fibres_;
    Selection& selection_;
    std::vector<LaidCourse> laid_;
};

}  // namespace

std::vector<LaidCourse> balance_courses(std::span<const Member> members,
                                        std::span<const char> allowed, std::size_t rims,
                                        const SelectOptions& options, int fibres,
                                        Selection& selection) {
    return Balancer(members, allowed, rims, options, fibres, selection).run();
}

}  // namespace meshwind
