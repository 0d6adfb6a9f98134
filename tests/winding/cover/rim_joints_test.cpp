#include "winding/cover/rim_joints.h"

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"
#include "winding/cover/balance_courses.h"

namespace meshwind {
namespace {

// A course from one rim to another, in the sense in which it may go round.
LibraryCourse between(std::int32_t from, std::int32_t to) {
    LibraryCourse member;
    member.end[0].rim = from;
    member.end[1].rim = to;
    member.end[0].sense = -1;
    member.end[1].sense = 1;
    return member;
}

TEST(RimJoints, AgreeWithTheCoursesOneByOne) {
    constexpr std::int32_t kRims = 4;
    test::Draw draw(8);
    RimJoints joints(2 * kRims);
    std::vector<int> excess(2 * kRims, 0);
    for (int i = 0; i < 60; ++i) {
        const LibraryCourse member = test::random_member(draw, kRims, 10);
        const bool backward = draw.coin();
        joints.add(member, backward, 1);
        ++excess[arrival_node(end_of(member, backward))];
        --excess[departure_node(start_of(member, backward))];
    }
    for (std::size_t node = 0; node < excess.size(); ++node) {
        EXPECT_EQ(joints.excess(node), excess[node]);
    }
}

TEST(RimJoints, CountsTheFibres) {
    RimJoints joints(6);
    EXPECT_EQ(joints.fibres(), 0);
    const LibraryCourse low = between(0, 0);
    const LibraryCourse high = between(1, 1);
    joints.add(low, false, 1);
    EXPECT_EQ(joints.fibres(), 1);
    joints.add(high, false, 1);
    EXPECT_EQ(joints.fibres(), 2) << "they are apart";
    const LibraryCourse link = between(0, 1);
    joints.add(link, false, 1);
    EXPECT_EQ(joints.fibres(), 1);
    joints.add(link, false, 1);
    EXPECT_EQ(joints.fibres(), 2) << "two begin in one place, and end in one";
    joints.add(link, false, -2);
    EXPECT_EQ(joints.fibres(), 2);
    EXPECT_FALSE(joints.has_courses(4));
}

}  // namespace
}  // namespace meshwind
