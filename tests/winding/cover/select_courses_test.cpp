#include "winding/cover/select_courses.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Indices = std::vector<std::int32_t>;

// A member that covers the samples first .. last.
LibraryCourse covering(std::int32_t first, std::int32_t last, double length_mm = 100.0) {
    LibraryCourse member;
    member.length_mm = length_mm;
    for (std::int32_t i = first; i <= last; ++i) {
        member.footprint.push_back(i);
    }
    return member;
}

TEST(FillThinPlaces, TakesWhatBringsMostPlacesToTheirTarget) {
    const std::vector<LibraryCourse> members{covering(0, 1), covering(0, 4), covering(3, 9)};
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

TEST(LackingShare, CountsPlacesInReachAlone) {
    const std::vector<std::int32_t> layers{0, 1, 2, 3, 0};
    const std::vector<std::int32_t> targets{1, 2, 2, 2, -1};
    EXPECT_EQ(lacking_share(layers, std::vector<char>(5, 1), {.targets = targets}), 0.4);
    EXPECT_EQ(lacking_share(layers, std::vector<char>{0, 1, 1, 1, 1}, {.targets = targets}), 0.25);
    EXPECT_EQ(lacking_share(layers, std::vector<char>(5, 0), {.targets = targets}), 0.0);
}

TEST(FillThinPlaces, LeavesWhatIsOutOfReach) {
    const std::vector<LibraryCourse> members{covering(0, 4)};
    std::vector<char> reached(5, 0);
    const std::vector<char> allowed{1};
    EXPECT_EQ(fill_thin_places(members, allowed, reached, std::vector<std::int32_t>(5, 0), {}, 0.0),
              Indices{});
    reached[2] = 1;
    EXPECT_EQ(fill_thin_places(members, allowed, reached, std::vector<std::int32_t>(5, 0), {}, 0.0),
              Indices{0});
}

}  // namespace
}  // namespace meshwind
