#include "winding/cover/balance_courses.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

constexpr std::int32_t kRims = 3;
constexpr std::int32_t kSamples = 60;

struct Library {
    std::vector<LibraryCourse> members;
    Selection selection;
};

// Random members; the first `chosen` of them are laid.
Library random_library(std::uint64_t seed, std::int32_t count, std::int32_t chosen) {
    test::Draw draw(seed);
    Library library;
    for (std::int32_t i = 0; i < count; ++i) {
        library.members.push_back(test::random_member(draw, kRims, kSamples));
    }
    library.selection.layers.assign(kSamples, 0);
    for (std::int32_t i = 0; i < chosen; ++i) {
        library.selection.chosen.push_back(i);
        for (const std::int32_t s : library.members[static_cast<std::size_t>(i)].footprint) {
            ++library.selection.layers[static_cast<std::size_t>(s)];
        }
    }
    return library;
}

// One course of each kind that there can be, so that everything can be mended.
void add_all_kinds(std::vector<LibraryCourse>& members) {
    for (std::int32_t from = 0; from < 2 * kRims; ++from) {
        for (std::int32_t to = 0; to < 2 * kRims; ++to) {
            LibraryCourse member;
            member.end[0] = {from / 2, 0.1 * from, 1.1, from % 2 == 0 ? 1 : -1};
            member.end[1] = {to / 2, 0.2 * to, 1.2, to % 2 == 0 ? 1 : -1};
            member.windable_forward = true;
            member.length_mm = 100.0 + from + to;
            members.push_back(member);
        }
    }
}

int loose_ends(const std::vector<LibraryCourse>& members, const std::vector<DirectedCourse>& laid) {
    std::vector<int> surplus(2 * kRims, 0);
    for (const DirectedCourse& c : laid) {
        const LibraryCourse& member = members[static_cast<std::size_t>(c.member)];
        ++surplus[arrival_node(end_of(member, c.backward))];
        --surplus[departure_node(start_of(member, c.backward))];
    }
    return std::accumulate(surplus.begin(), surplus.end(), 0,
                           [](int sum, int s) { return sum + std::abs(s); });
}

// Loose ends when every chosen course is wound forward, or backward where it cannot be.
int loose_ends_as_chosen(const Library& library) {
    std::vector<DirectedCourse> laid;
    for (const std::int32_t i : library.selection.chosen) {
        laid.push_back({i, !library.members[static_cast<std::size_t>(i)].windable_forward});
    }
    return loose_ends(library.members, laid);
}

void expect_consistent(const Library& before, const Library& after,
                       const std::vector<DirectedCourse>& laid) {
    std::vector<std::int32_t> laid_members;
    for (const DirectedCourse& c : laid) {
        const LibraryCourse& member = after.members[static_cast<std::size_t>(c.member)];
        EXPECT_TRUE(c.backward ? member.windable_backward : member.windable_forward);
        laid_members.push_back(c.member);
    }
    EXPECT_EQ(laid_members, after.selection.chosen);
    EXPECT_LE(loose_ends(after.members, laid), std::max(2, loose_ends_as_chosen(before)));
    std::vector<std::int32_t> layers(kSamples, 0);
    for (const std::int32_t i : laid_members) {
        for (const std::int32_t s : after.members[static_cast<std::size_t>(i)].footprint) {
            ++layers[static_cast<std::size_t>(s)];
        }
    }
    EXPECT_EQ(after.selection.layers, layers);
}

TEST(BalanceCourses, LeavesOneStartAndOneEndWhereTheLibraryAllows) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Library before = random_library(seed, 40, 12 + static_cast<std::int32_t>(seed % 9));
        Library after = before;
        add_all_kinds(after.members);
        const auto laid = balance_courses(after.members, std::vector<char>(after.members.size(), 1),
                                          kRims, {}, 1, after.selection);
        expect_consistent(before, after, laid);
        EXPECT_LE(loose_ends(after.members, laid), 2);
    }
}

TEST(BalanceCourses, AddsNoMoreThanSoManyFibresNeed) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Library before = random_library(seed, 40, 12 + static_cast<std::int32_t>(seed % 9));
        std::size_t last = std::numeric_limits<std::size_t>::max();
        for (int fibres = 1; fibres <= 4; ++fibres) {
            Library after = before;
            add_all_kinds(after.members);
            const auto laid =
                balance_courses(after.members, std::vector<char>(after.members.size(), 1), kRims,
                                {}, fibres, after.selection);
            expect_consistent(before, after, laid);
            EXPECT_LE(loose_ends(after.members, laid), 2 * fibres);
            EXPECT_LE(laid.size(), last) << fibres << " fibres";
            last = laid.size();
        }
    }
}

// Two courses, each back to where it began, on rims of their own: a way there and one back join
// them.
TEST(BalanceCourses, JoinsWhatIsClosedAndApart) {
    Library library;
    add_all_kinds(library.members);
    library.selection.layers.assign(kSamples, 0);
    for (std::size_t i = 0; i < library.members.size(); ++i) {
        const auto [from, to] = nodes_of(library.members[i], false);
        if (from == to && (from == 0 || from == 3)) {
            library.selection.chosen.push_back(static_cast<std::int32_t>(i));
        }
    }
    ASSERT_EQ(library.selection.chosen.size(), 2U);
    const std::vector<char> allowed(library.members.size(), 1);
    Selection two = library.selection;
    EXPECT_EQ(balance_courses(library.members, allowed, kRims, {}, 2, two).size(), 2U);
    const auto laid = balance_courses(library.members, allowed, kRims, {}, 1, library.selection);
    EXPECT_EQ(laid.size(), 4U);
    EXPECT_EQ(loose_ends(library.members, laid), 0);
}

TEST(BalanceCourses, NeverAddsWhatIsNotAllowed) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Library before = random_library(seed, 60, 15);
        Library after = before;
        std::vector<char> allowed(60, 0);
        std::fill(allowed.begin(), allowed.begin() + 15, char{1});
        auto laid = balance_courses(after.members, allowed, kRims, {}, 1, after.selection);
        expect_consistent(before, after, laid);
        for (const DirectedCourse& c : laid) {
            EXPECT_LT(c.member, 15);
        }
        after = before;
        laid =
            balance_courses(after.members, std::vector<char>(60, 0), kRims, {}, 1, after.selection);
        EXPECT_LE(laid.size(), before.selection.chosen.size()) << "nothing may be added";
    }
}

// Two reversible courses between the same rims, both listed from rim 0 to rim 1: one of them must
// be wound back.
TEST(BalanceCourses, WindsAPairThereAndBack) {
    Library library;
    for (int i = 0; i < 2; ++i) {
        LibraryCourse member;
        member.end[0] = {0, 0.3 * i, 1.1, i == 0 ? 1 : -1};
        member.end[1] = {1, 0.2 * i, 1.1, i == 0 ? 1 : -1};
        member.windable_forward = member.windable_backward = true;
        member.length_mm = 100.0;
        library.members.push_back(member);
        library.selection.chosen.push_back(i);
    }
    library.selection.layers.assign(kSamples, 0);
    const auto laid =
        balance_courses(library.members, std::vector<char>{1, 1}, kRims, {}, 1, library.selection);
    ASSERT_EQ(laid.size(), 2U);
    EXPECT_NE(laid[0].backward, laid[1].backward);
    EXPECT_EQ(loose_ends(library.members, laid), 0);
}

TEST(BalanceCourses, OfNothingIsNothing) {
    Selection selection;
    EXPECT_TRUE(balance_courses({}, {}, 2, {}, 1, selection).empty());
}

}  // namespace
}  // namespace meshwind
