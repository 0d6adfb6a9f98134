#include "winding/cover/order_courses.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

const CourseTurns kTurns{{.friction = 0.25, .extension_mm = 150.0, .band_mm = 6.0}};

const LibraryCourse& member_of(const std::vector<LibraryCourse>& members, const DirectedCourse& c) {
    return members[static_cast<std::size_t>(c.member)];
}

std::size_t arrives(const std::vector<LibraryCourse>& members, const DirectedCourse& c) {
    return arrival_node(end_of(member_of(members, c), c.backward));
}

std::size_t departs(const std::vector<LibraryCourse>& members, const DirectedCourse& c) {
    return departure_node(start_of(member_of(members, c), c.backward));
}

// Fewest fibres for these directions: each connected part of the graph takes as many trails as it
// has departures in excess, and at least one.
int fewest_fibres(const std::vector<LibraryCourse>& members,
                  const std::vector<DirectedCourse>& laid, std::size_t nodes) {
    std::vector<std::size_t> part(nodes);
    std::iota(part.begin(), part.end(), std::size_t{0});
    std::vector<int> excess(nodes, 0);
    std::vector<char> used(nodes, 0);
    for (const DirectedCourse& c : laid) {
        const std::size_t from = departs(members, c);
        const std::size_t to = arrives(members, c);
        ++excess[from];
        --excess[to];
        used[from] = used[to] = 1;
        std::replace(part.begin(), part.end(), std::size_t{part[from]}, std::size_t{part[to]});
    }
    int fibres = 0;
    for (std::size_t p = 0; p < nodes; ++p) {
        int starts = 0;
        bool any = false;
        for (std::size_t n = 0; n < nodes; ++n) {
            if (part[n] == p && used[n] != 0) {
                any = true;
                starts += std::max(0, excess[n]);
            }
        }
        fibres += any ? std::max(1, starts) : 0;
    }
    return fibres;
}

int fibres_of(const std::vector<OrderedCourse>& order) {
    return static_cast<int>(std::count_if(order.begin(), order.end(),
                                          [](const OrderedCourse& c) { return c.cut_after; }));
}

void expect_one_trail_through_all(const std::vector<LibraryCourse>& members,
                                  const std::vector<DirectedCourse>& laid,
                                  const std::vector<OrderedCourse>& order) {
    ASSERT_EQ(order.size(), laid.size());
    std::vector<std::int32_t> wanted;
    std::vector<std::int32_t> found;
    for (const DirectedCourse& c : laid) {
        wanted.push_back(c.member);
    }
    for (const OrderedCourse& c : order) {
        found.push_back(c.course.member);
        const LibraryCourse& member = member_of(members, c.course);
        EXPECT_TRUE(c.course.backward ? member.windable_backward : member.windable_forward);
    }
    std::sort(wanted.begin(), wanted.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, wanted);
    EXPECT_TRUE(order.back().cut_after);
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
        if (!order[i].cut_after) {
            EXPECT_EQ(arrives(members, order[i].course), departs(members, order[i + 1].course));
            EXPECT_EQ(
                end_of(member_of(members, order[i].course), order[i].course.backward).rim,
                start_of(member_of(members, order[i + 1].course), order[i + 1].course.backward)
                    .rim);
        }
    }
}

// Courses laid either way that they can be wound, some of them twice.
std::vector<DirectedCourse> lay_all(test::Draw& draw, const std::vector<LibraryCourse>& members) {
    std::vector<DirectedCourse> laid;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(members.size()); ++i) {
        const LibraryCourse& member = members[static_cast<std::size_t>(i)];
        const bool backward = !member.windable_forward || (member.windable_backward && draw.coin());
        laid.insert(laid.end(), draw.coin(0.1) ? 2U : 1U, DirectedCourse{i, backward});
    }
    return laid;
}

TEST(OrderCourses, LaysEveryCourseOnceWithNoMoreCutsThanNeeded) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Draw draw(seed);
        const std::int32_t rims = 2 + draw.below(4);
        std::vector<LibraryCourse> members;
        const std::int32_t count = 1 + draw.below(24);
        for (std::int32_t i = 0; i < count; ++i) {
            members.push_back(test::random_member(draw, rims, 20));
        }
        const std::vector<DirectedCourse> laid = lay_all(draw, members);
        const auto order = order_courses(test::plain_rims(rims), members, laid, kTurns);
        expect_one_trail_through_all(members, laid, order);
        EXPECT_LE(fibres_of(order),
                  fewest_fibres(members, laid, 2 * static_cast<std::size_t>(rims)));
    }
}

// A one-way course from one node to another, and a closed round that only touches one of the two:
// one fibre lays both.
void expect_joined(std::int32_t touched_rim, double steep_rad = 1.1) {
    const auto member = [steep_rad](std::int32_t from, int from_sense, std::int32_t to,
                                    int to_sense) {
        LibraryCourse m;
        m.end[0] = {from, 0.3, steep_rad, from_sense};
        m.end[1] = {to, 0.9, 1.2, to_sense};
        m.windable_forward = true;
        m.length_mm = 100.0;
        return m;
    };
    // Leaves rim 0, arrives at rim 1 counter-clockwise; the round leaves and arrives at one node.
    const std::vector<LibraryCourse> members{member(0, -1, 1, 1),
                                             member(touched_rim, -1, touched_rim, 1)};
    // The round is listed first and is its own nearest successor.
    const std::vector<DirectedCourse> laid{{1, false}, {0, false}};
    const auto order = order_courses(test::plain_rims(2), members, laid, kTurns);
    expect_one_trail_through_all(members, laid, order);
    EXPECT_EQ(fibres_of(order), 1);
}

TEST(OrderCourses, JoinsARoundAtTheEndOfAnOpenFibre) {
    expect_joined(1);
}

TEST(OrderCourses, JoinsARoundAtTheStartOfAnOpenFibre) {
    expect_joined(0);
}

// The turn of steep ends takes more fibre than a whole round of the rim.
TEST(OrderCourses, OpensNoFibreAtATurnThatTakesMuch) {
    expect_joined(1, 0.7);
    expect_joined(0, 0.7);
}

// Ends are steep or shallow, at places drawn at random. Both halves of a turn are hoop at one
// height, so that a shallow end beside a steep one takes two rounds more: more than any dwell.
TEST(OrderCourses, TurnsEndsThatAreAlike) {
    constexpr double kSteep_rad = 0.8;
    constexpr double kShallow_rad = 1.3;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Draw draw(seed);
        std::vector<LibraryCourse> members(4);
        std::vector<DirectedCourse> laid;
        for (std::int32_t i = 0; i < 4; ++i) {
            LibraryCourse& member = members[static_cast<std::size_t>(i)];
            const auto end = [&](bool steep, int sense) {
                return RimCrossing{0, draw.between(0.0, 6.0), steep ? kSteep_rad : kShallow_rad,
                                   sense};
            };
            member.end = {end(i < 2, -1), end(i % 2 == 0, 1)};
            member.windable_forward = true;
            laid.push_back({i, false});
        }
        const auto order = order_courses(test::plain_rims(1), members, laid, kTurns);
        ASSERT_EQ(order.size(), 4U);
        for (std::size_t i = 0; i + 1 < order.size(); ++i) {
            EXPECT_EQ(end_of(member_of(members, order[i].course), false).angle_rad,
                      start_of(member_of(members, order[i + 1].course), false).angle_rad);
        }
    }
}

// Three rounds from one node back to it, of which each may follow one other.
TEST(OrderCourses, TakesNoClosedTurnWhereThereIsAnotherWay) {
    std::vector<LibraryCourse> members(3);
    std::vector<DirectedCourse> laid;
    for (std::int32_t i = 0; i < 3; ++i) {
        LibraryCourse& member = members[static_cast<std::size_t>(i)];
        member.end[0] = {0, 0.5 + i, 1.1, -1};
        member.end[1] = {0, 0.6 + i, 1.1, 1};
        member.windable_forward = true;
        laid.push_back({i, false});
    }
    const ClosedTurns one_way{{laid[0], laid[1]}, {laid[1], laid[2]}, {laid[2], laid[0]}};
    const ClosedTurns other_way{{laid[1], laid[0]}, {laid[2], laid[1]}, {laid[0], laid[2]}};
    for (const ClosedTurns& closed : {one_way, other_way}) {
        const auto order = order_courses(test::plain_rims(1), members, laid, kTurns, closed);
        ASSERT_EQ(order.size(), 3U);
        EXPECT_EQ(fibres_of(order), 1);
        EXPECT_EQ(closed.count({order[0].course, order[1].course}), 0U);
        EXPECT_EQ(closed.count({order[1].course, order[2].course}), 0U);
    }
}

TEST(OrderCourses, OfOneCourseIsThatCourse) {
    test::Draw draw(1);
    const std::vector<LibraryCourse> members{test::random_member(draw, 2, 20)};
    const auto order = order_courses(test::plain_rims(2), members,
                                     std::vector<DirectedCourse>{{0, false}}, kTurns);
    ASSERT_EQ(order.size(), 1U);
    EXPECT_TRUE(order[0].cut_after);
    EXPECT_TRUE(order_courses(test::plain_rims(2), members, {}, kTurns).empty());
}

}  // namespace
}  // namespace meshwind
