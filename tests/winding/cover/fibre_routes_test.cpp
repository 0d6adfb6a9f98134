#include "winding/cover/fibre_routes.h"

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Nodes = std::pair<std::size_t, std::size_t>;

// A member that leads from one node to another, covering given samples, windable forward.
LibraryCourse leading(std::size_t from, std::size_t to, std::vector<std::int32_t> samples) {
    LibraryCourse member;
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
    std::vector<LibraryCourse> members{
        leading(0, 3, {0, 1, 2}), leading(3, 0, {2, 3}), leading(1, 2, {4}), leading(2, 1, {5}),
        leading(4, 4, {6, 7}),    leading(0, 4, {8}),    leading(2, 0, {9})};
    std::map<Nodes, KnownWay> ways{{{0, 3}, {true, {{0, false}}}}, {{3, 0}, {true, {{1, false}}}},
                                   {{1, 2}, {true, {{2, false}}}}, {{2, 1}, {true, {{3, false}}}},
                                   {{4, 4}, {true, {{4, false}}}}, {{0, 4}, {false, {{5, false}}}},
                                   {{2, 0}, {false, {{6, false}}}}};
};

Scene without_links() {
    Scene scene;
    scene.ways.erase({0, 4});
    scene.ways.erase({2, 0});
    return scene;
}

std::vector<FibreRoute> routes(const Scene& scene, std::size_t most) {
    return best_routes(scene.members, scene.ways, 6, 10, most);
}

TEST(BestRoutes, GoThroughAllThatLinksLeadTo) {
    const std::vector<FibreRoute> found = routes(Scene(), 3);
    ASSERT_EQ(found.size(), 1U) << "a second fibre reaches nothing more";
    const FibreRoute& route = found.front();
    EXPECT_EQ(route.stage, (std::vector<int>{1, 0, 0, 1, 2, -1}));
    ASSERT_EQ(route.links.size(), 2U);
    EXPECT_EQ(route.links[0].member, 6);
    EXPECT_EQ(route.links[1].member, 5);
    EXPECT_EQ(route.reach, 1.0);
    EXPECT_TRUE(route.holds({0, 3}));
    EXPECT_FALSE(route.holds({0, 4}));
    EXPECT_FALSE(route.holds({5, 5}));
    EXPECT_TRUE(route.leads({0, 3}));
    EXPECT_TRUE(route.leads({1, 4})) << "from an earlier stage to a later one";
    EXPECT_FALSE(route.leads({4, 0}));
    EXPECT_FALSE(route.leads({5, 5}));
}

TEST(BestRoutes, TakeTheStagesThatCoverMostWhereNoLinkHolds) {
    const std::vector<FibreRoute> found = routes(without_links(), 1);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].stage, (std::vector<int>{0, -1, -1, 0, -1, -1}));
    EXPECT_TRUE(found[0].links.empty());
}

TEST(BestRoutes, GiveWhatIsApartAFibreOfItsOwn) {
    const std::vector<FibreRoute> found = routes(without_links(), 5);
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].stage, (std::vector<int>{0, -1, -1, 0, -1, -1}));
    EXPECT_EQ(found[0].reach, 0.4);
    EXPECT_EQ(found[1].stage, (std::vector<int>{-1, 0, 0, -1, -1, -1}));
    EXPECT_EQ(found[1].reach, 0.6);
    EXPECT_EQ(found[2].stage, (std::vector<int>{-1, -1, -1, -1, 0, -1}));
    EXPECT_EQ(found[2].reach, 0.8);
}

// Where a branch is entered and not left again each fibre enters it once, by a course that the
// others have not laid.
TEST(BestRoutes, EnterABranchOncePerFibre) {
    Scene scene;
    scene.members.push_back(leading(0, 4, {6}));
    scene.members.push_back(leading(3, 4, {9}));
    scene.ways.erase({2, 0});
    scene.ways[{0, 4}].proven = {{7, false}, {5, false}};
    scene.ways[{3, 4}] = {false, {{8, false}}};
    const std::vector<FibreRoute> found = routes(scene, 2);
    ASSERT_EQ(found.size(), 2U);
    ASSERT_EQ(found[0].links.size(), 1U);
    ASSERT_EQ(found[1].links.size() + (found[1].stage[1] == 0 ? 1U : 0U), 1U);
    EXPECT_NE(found[0].links[0].member, 7) << "covers nothing new";
}

TEST(BestRoutes, MakeDoWithFewCoursesWhereNoneAbound) {
    Scene scene;
    for (auto& [nodes, way] : scene.ways) {
        way.abounds = false;
    }
    EXPECT_EQ(routes(scene, 1).at(0).stage, (std::vector<int>{1, 0, 0, 1, 2, -1}));
}

TEST(BestRoutes, AreNoneWhereNothingHolds) {
    EXPECT_TRUE(best_routes({}, {}, 4, 10, 3).empty());
}

// Courses of 10, 20 and 30 mm; a cut behind the first and the second.
TEST(LongestFibres, KeepTheirOrder) {
    std::vector<LibraryCourse> members(3);
    for (std::size_t i = 0; i < members.size(); ++i) {
        members[i].length_mm = 10.0 * static_cast<double>(i + 1);
    }
    const std::vector<OrderedCourse> order{
        {{1, false}, true}, {{0, false}, true}, {{2, true}, true}};
    const auto kept = [&](std::size_t most) {
        std::vector<std::int32_t> found;
        for (const OrderedCourse& course : longest_fibres(members, order, most)) {
            found.push_back(course.course.member);
        }
        return found;
    };
    EXPECT_EQ(kept(1), (std::vector<std::int32_t>{2}));
    EXPECT_EQ(kept(2), (std::vector<std::int32_t>{1, 2}));
    EXPECT_EQ(kept(7), (std::vector<std::int32_t>{1, 0, 2}));
    EXPECT_TRUE(longest_fibres(members, {}, 1).empty());
}

}  // namespace
}  // namespace meshwind
