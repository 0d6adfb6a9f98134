#include "winding/cover/select.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Indices = std::vector<std::int32_t>;

// A member that covers the samples first .. last.
Member covering(std::int32_t first, std::int32_t last, double length_mm = 100.0) {
    Member member;
    member.length_mm = length_mm;
    for (std::int32_t i = first; i <= last; ++i) {
        member.footprint.push_back(i);
    }
    return member;
}

Indices chosen(const std::vector<Member>& members, const std::vector<char>& allowed,
               std::size_t samples, const SelectOptions& options = {}) {
    Indices sorted = select_courses(members, allowed, samples, options).chosen;
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

TEST(SelectCourses, FindsTheCoverWithoutOverlap) {
    const std::vector<Member> members{covering(3, 6), covering(0, 4), covering(2, 7),
                                      covering(5, 9)};
    EXPECT_EQ(chosen(members, {1, 1, 1, 1}, 10), (Indices{1, 3}));
}

// The widest is taken first; then both ends need a course of their own, which cover the rest too.
TEST(SelectCourses, DropsWhatHasBecomeSuperfluous) {
    const std::vector<Member> members{covering(1, 8), covering(0, 4), covering(5, 9)};
    const Selection selection = select_courses(members, std::vector<char>{1, 1, 1}, 10, {});
    EXPECT_EQ(selection.chosen.size(), 2U);
    EXPECT_EQ(selection.layers, std::vector<std::int32_t>(10, 1));
}

// A place that asks for nothing more is waste from the first layer on.
TEST(SelectCourses, AsksOfEachSampleWhatItLacks) {
    const std::vector<Member> members{covering(0, 4), covering(5, 9), covering(0, 9, 150.0)};
    std::vector<std::int32_t> targets(10, 0);
    std::fill_n(targets.begin(), 5, 1);
    const std::vector<char> all{1, 1, 1};
    EXPECT_EQ(chosen(members, all, 10, {.targets = targets}), (Indices{0}));
    targets.assign(10, 1);
    EXPECT_EQ(chosen(members, all, 10, {.targets = targets}), (Indices{2}));
}

TEST(FillThinPlaces, TakesWhatBringsMostPlacesToTheirTarget) {
    const std::vector<Member> members{covering(0, 1), covering(0, 4), covering(3, 9)};
    const std::vector<char> all{1, 1, 1};
    const std::vector<char> reached(10, 1);
    const std::vector<std::int32_t> targets(10, 2);
    // Samples 0 to 3 lack a layer, 4 lacks two, and the others none.
    const std::vector<std::int32_t> layers{1, 1, 1, 1, 0, 2, 2, 2, 2, 2};
    const auto filled = [&](double most_short, const std::vector<char>& allowed) {
        return fill_thin_places(members, allowed, reached, layers, {.targets = targets},
                                most_short);
    };
    // The second brings four of them there, and sample 4 with the third.
    EXPECT_EQ(filled(0.1, all), (Indices{1}));
    EXPECT_EQ(filled(0.0, all), (Indices{1, 2}));
    EXPECT_EQ(filled(0.0, {1, 0, 0}), (Indices{0}));
    EXPECT_EQ(filled(0.5, all), Indices{});
}

TEST(FillThinPlaces, LeavesWhatIsOutOfReach) {
    const std::vector<Member> members{covering(0, 4)};
    std::vector<char> reached(5, 0);
    const std::vector<char> allowed{1};
    EXPECT_EQ(fill_thin_places(members, allowed, reached, std::vector<std::int32_t>(5, 0), {}, 0.0),
              Indices{});
    reached[2] = 1;
    EXPECT_EQ(fill_thin_places(members, allowed, reached, std::vector<std::int32_t>(5, 0), {}, 0.0),
              Indices{0});
}

TEST(SelectCourses, GivesTiesToTheLowerIndex) {
    const std::vector<Member> members{covering(0, 4), covering(0, 4), covering(5, 9),
                                      covering(5, 9)};
    EXPECT_EQ(chosen(members, {1, 1, 1, 1}, 10), (Indices{0, 2}));
}

TEST(SelectCourses, PrefersTheShorterOfTwo) {
    const std::vector<Member> members{covering(0, 4, 200.0), covering(0, 4, 100.0)};
    EXPECT_EQ(chosen(members, {1, 1}, 5), (Indices{1}));
}

TEST(SelectCourses, KeepsToWhatIsAllowed) {
    const std::vector<Member> members{covering(0, 9), covering(0, 4), covering(5, 9)};
    EXPECT_EQ(chosen(members, {0, 1, 1}, 10), (Indices{1, 2}));
    EXPECT_TRUE(chosen(members, {0, 0, 0}, 10).empty());
    EXPECT_TRUE(chosen({}, {}, 10).empty());
}

// From nothing the two halves are chosen; the thirds that are kept need only the last one.
TEST(SelectCourses, GoesOnFromWhatIsKept) {
    const std::vector<Member> members{covering(0, 5), covering(6, 11), covering(0, 3),
                                      covering(4, 7), covering(8, 11)};
    EXPECT_EQ(chosen(members, {1, 1, 1, 1, 1}, 12), (Indices{0, 1}));
    const Selection selection =
        select_courses(members, std::vector<char>(5, 1), 12, {}, Indices{2, 3});
    EXPECT_EQ(selection.chosen, (Indices{2, 3, 4}));
    EXPECT_EQ(selection.layers, std::vector<std::int32_t>(12, 1));
}

TEST(SelectCourses, CoversAsOftenAsAsked) {
    const std::vector<Member> members{covering(0, 9), covering(0, 4), covering(5, 9),
                                      covering(0, 9)};
    const Selection selection =
        select_courses(members, std::vector<char>(4, 1), 10, {.target_layers = 2});
    EXPECT_GE(*std::min_element(selection.layers.begin(), selection.layers.end()), 2);
}

TEST(SelectCourses, CountsTheLayersOfWhatItChose) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        test::Draw draw(seed);
        std::vector<Member> members;
        for (int i = 0; i < 60; ++i) {
            members.push_back(test::random_member(draw, 2, 80));
        }
        const Selection selection =
            select_courses(members, std::vector<char>(members.size(), 1), 80, {});
        std::vector<std::int32_t> layers(80, 0);
        std::vector<char> reached(80, 0);
        for (const std::int32_t i : selection.chosen) {
            for (const std::int32_t s : members[static_cast<std::size_t>(i)].footprint) {
                ++layers[static_cast<std::size_t>(s)];
            }
        }
        for (const Member& member : members) {
            for (const std::int32_t s : member.footprint) {
                reached[static_cast<std::size_t>(s)] = 1;
            }
        }
        EXPECT_EQ(selection.layers, layers) << "seed " << seed;
        // With five samples a course, no loss is below the share that may be left.
        for (std::size_t s = 0; s < reached.size(); ++s) {
            EXPECT_EQ(layers[s] > 0, reached[s] != 0) << "seed " << seed << " sample " << s;
        }
    }
}

}  // namespace
}  // namespace meshwind
