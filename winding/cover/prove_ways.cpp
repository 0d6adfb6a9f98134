#include "winding/cover/prove_ways.h"

#include <algorithm>

#include "core/parallel.h"

namespace meshwind {
namespace {

// Of the courses between two nodes so many are proven to know whether the way is open, and where
// none of them holds, so many.
constexpr std::size_t kProvenForWay = 6;
constexpr std::size_t kProvenForScarceWay = 48;

// An open way is taken for one with courses in plenty where the library has so many.
constexpr std::size_t kAbound = 8;

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

// Which way a windable member is wound from the first node to the second.
bool leads_backward(const Member& member, const NodePair& nodes) {
    return !(member.windable_forward && nodes_of(member, false) == nodes);
}

}  // namespace

ProvenWays prove_ways(std::span<const Member> members, const Ways& ways,
                      const std::function<Rejection(PlacedCourse&)>& prove,
                      const std::function<void(double share)>& progress) {
    struct Trial {
        NodePair nodes;
        PlacedCourse course;
        std::int32_t member;
        Rejection rejection = Rejection::None;
    };
    ProvenWays proven;
    for (const std::size_t most : {kProvenForWay, kProvenForScarceWay}) {
        std::vector<Trial> trials;
        for (const auto& [nodes, way] : ways) {
            const std::size_t count = std::min(most, way.windable.size());
            for (std::size_t k = 0; !proven.known.contains(nodes) && k < count; ++k) {
                const std::int32_t i = way.windable[k * way.windable.size() / count];
                const Member& member = members[at(i)];
                trials.push_back({nodes, {member, {}, leads_backward(member, nodes)}, i});
            }
        }
        progress(most == kProvenForWay ? 0.0 : 0.5);
        parallel_for(trials.size(), 1, [&](std::size_t i, std::size_t) {
            trials[i].rejection = prove(trials[i].course);
        });
        for (const Trial& trial : trials) {
            if (trial.rejection != Rejection::None) {
                proven.refused.emplace_back(trial.member, trial.rejection);
            } else {
                proven.known[trial.nodes].proven.push_back({trial.member, trial.course.backward});
            }
        }
    }
    for (auto& [nodes, way] : proven.known) {
        way.abounds = ways.at(nodes).windable.size() >= kAbound;
    }
    return proven;
}

std::vector<LaidCourse> spare_links(std::span<const Member> members, const Ways& ways,
                                    const KnownWays& known, const FibreRoute& route,
                                    std::size_t stage) {
    const auto from = static_cast<int>(stage);
    const std::int32_t link = route.links[stage].member;
    std::vector<LaidCourse> proven;
    std::vector<LaidCourse> others;
    for (const auto& [nodes, way] : ways) {
        if (route.stage[nodes.first] != from || route.stage[nodes.second] != from + 1) {
            continue;
        }
        const auto held = known.find(nodes);
        for (const std::int32_t i : way.windable) {
            const bool holds =
                held != known.end() &&
                std::any_of(held->second.proven.begin(), held->second.proven.end(),
                            [&](const LaidCourse& course) { return course.member == i; });
            if (i != link) {
                (holds ? proven : others).push_back({i, leads_backward(members[at(i)], nodes)});
            }
        }
    }
    proven.insert(proven.end(), others.begin(), others.end());
    std::reverse(proven.begin(), proven.end());
    return proven;
}

}  // namespace meshwind
