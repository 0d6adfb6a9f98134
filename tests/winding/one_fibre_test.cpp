#include "winding/one_fibre.h"

#include <gtest/gtest.h>

#include "tests/winding/fixtures.h"

namespace meshwind {
namespace {

using Nodes = std::pair<std::size_t, std::size_t>;

// A member that leads from one node to another, covering given samples, windable forward.
Member leading(std::size_t from, std::size_t to, std::vector<std::int32_t> samples) {
    Member member;
    member.end[0].rim = static_cast<std::int32_t>(from / 2);
    member.end[0].sense = from % 2 == 0 ? 1 : -1;  // departures count the other sense
    member.end[1].rim = static_cast<std::int32_t>(to / 2);
    member.end[1].sense = to % 2 == 1 ? 1 : -1;
    member.windable_forward = true;
    member.footprint = std::move(samples);
    return member;
}

// Nodes 0 and 3 go round; so do 1 and 2; 4 leads only to itself. From 0 a link leads to 4, from 2
// one to 0.
struct Scene {
    std::vector<Member> members{leading(0, 3, {0, 1, 2}), leading(3, 0, {2, 3}), leading(1, 2, {4}),
                                leading(2, 1, {5}),       leading(4, 4, {6, 7}), leading(0, 4, {8}),
                                leading(2, 0, {9})};
    std::map<Nodes, KnownWay> ways{{{0, 3}, {true, {{0, false}}}}, {{3, 0}, {true, {{1, false}}}},
                                   {{1, 2}, {true, {{2, false}}}}, {{2, 1}, {true, {{3, false}}}},
                                   {{4, 4}, {true, {{4, false}}}}, {{0, 4}, {false, {{5, false}}}},
                                   {{2, 0}, {false, {{6, false}}}}};
};

TEST(BestRoute, GoesThroughAllThatLinksLeadTo) {
    const Scene scene;
    const FibreRoute route = best_route(scene.members, scene.ways, 6, 10);
    EXPECT_EQ(route.stage, (std::vector<int>{1, 0, 0, 1, 2, -1}));
    ASSERT_EQ(route.links.size(), 2U);
    EXPECT_EQ(route.links[0].member, 6);
    EXPECT_EQ(route.links[1].member, 5);
    EXPECT_TRUE(route.holds({0, 3}));
    EXPECT_FALSE(route.holds({0, 4}));
    EXPECT_FALSE(route.holds({5, 5}));
}

TEST(BestRoute, TakesTheStagesThatCoverMostWhereNoLinkHolds) {
    Scene scene;
    scene.ways.erase({0, 4});
    scene.ways.erase({2, 0});
    const FibreRoute route = best_route(scene.members, scene.ways, 6, 10);
    EXPECT_EQ(route.stage, (std::vector<int>{0, -1, -1, 0, -1, -1}));
    EXPECT_TRUE(route.links.empty());
}

TEST(BestRoute, MakesDoWithFewCoursesWhereNoneAbound) {
    Scene scene;
    for (auto& [nodes, way] : scene.ways) {
        way.abounds = false;
    }
    const FibreRoute route = best_route(scene.members, scene.ways, 6, 10);
    EXPECT_EQ(route.stage, (std::vector<int>{1, 0, 0, 1, 2, -1}));
}

TEST(BestRoute, IsEmptyWhereNothingHolds) {
    const FibreRoute route = best_route({}, {}, 4, 10);
    EXPECT_EQ(route.stage, std::vector<int>(4, -1));
}

}  // namespace
}  // namespace meshwind
