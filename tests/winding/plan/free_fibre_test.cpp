#include "winding/plan/free_fibre.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// The search goes in steps of about a millimetre where it matters.
constexpr double kSearch_mm = 2.0;
constexpr double kExact_mm = 0.05;

// A ball of 15 mm in all around the eye, no arm.
FreeFibreRule ball_rule() {
    FreeFibreRule rule;
    rule.min_mm = 30.0;
    rule.preferred_mm = 200.0;
    rule.max_mm = 400.0;
    rule.head_radius_mm = 10.0;
    rule.clearance_mm = 5.0;
    return rule;
}

RayQuery query_of(const TriangleSoup& soup) {
    return RayQuery({&soup, 1});
}

std::vector<FreeFibreWindow> along_x(const RayQuery& obstacles, const FreeFibreRule& rule) {
    return free_fibre_windows(obstacles, Vector3d::Zero(), Vector3d::UnitY(), Vector3d::UnitX(),
                              rule);
}

TEST(FreeFibreWindows, WithNothingInTheWayIsEverythingUpToThePreferredLength) {
    const auto windows =
        along_x(query_of(test::box({0.0, 900.0, 0.0}, {1.0, 901.0, 1.0})), ball_rule());
    ASSERT_EQ(windows.size(), 1U);
    EXPECT_EQ(windows[0].low_mm, 30.0);
    EXPECT_EQ(windows[0].high_mm, 200.0);
}

TEST(FreeFibreWindows, EndsBeforeAWallAcrossTheFibre) {
    const auto windows =
        along_x(query_of(test::box({150.0, -90.0, -90.0}, {160.0, 90.0, 90.0})), ball_rule());
    ASSERT_EQ(windows.size(), 1U);
    EXPECT_EQ(windows[0].low_mm, 30.0);
    EXPECT_LE(windows[0].high_mm, 135.0 + kExact_mm);
    EXPECT_GE(windows[0].high_mm, 135.0 - kSearch_mm);
}

TEST(FreeFibreWindows, OfAWallTooNearIsNone) {
    EXPECT_TRUE(
        along_x(query_of(test::box({25.0, -9.0, -9.0}, {30.0, 9.0, 9.0})), ball_rule()).empty());
}

// Beside a post 8 mm away the ball of 15 mm does not pass; before and behind it does.
TEST(FreeFibreWindows, AreSeparateBeforeAndBehindAPost) {
    const double reach = std::sqrt(15.0 * 15.0 - 8.0 * 8.0);
    const auto windows =
        along_x(query_of(test::box({100.0, -30.0, -50.0}, {110.0, -8.0, 50.0})), ball_rule());
    ASSERT_EQ(windows.size(), 2U);
    EXPECT_LE(windows[0].high_mm, 100.0 - reach + kExact_mm);
    EXPECT_GE(windows[0].high_mm, 100.0 - reach - kSearch_mm);
    EXPECT_GE(windows[1].low_mm, 110.0 + reach - kExact_mm);
    EXPECT_LE(windows[1].low_mm, 110.0 + reach + kSearch_mm);
    EXPECT_EQ(windows[1].high_mm, 200.0);
}

TEST(FreeFibreWindows, GoBeyondThePreferredLengthOnlyWhereNothingElseIsPossible) {
    const double reach = std::sqrt(15.0 * 15.0 - 8.0 * 8.0);
    const auto windows =
        along_x(query_of(test::box({20.0, -30.0, -50.0}, {210.0, -8.0, 50.0})), ball_rule());
    ASSERT_EQ(windows.size(), 1U);
    EXPECT_GE(windows[0].low_mm, 210.0 + reach - kExact_mm);
    EXPECT_LE(windows[0].low_mm, 210.0 + reach + kSearch_mm);
    EXPECT_EQ(windows[0].high_mm, 400.0);
}

// On a cylinder the eye at L along a hoop is sqrt(R^2 + L^2) - R from the wall.
TEST(FreeFibreWindows, OnACylinderBeginWhereTheHeadClearsTheWall) {
    constexpr double kRadius = 50.0;
    const Mandrel mandrel = test::made_cylinder(kRadius, 400.0, 4.0);
    const RayQuery obstacles = test::obstacles_of(mandrel, 50.0);
    const double nearest = std::sqrt(65.0 * 65.0 - kRadius * kRadius);
    for (const double azimuth : {0.0, 1.0, 2.5, -2.0}) {
        const Vector3d normal(std::cos(azimuth), std::sin(azimuth), 0.0);
        const Vector3d hoop(-normal.y(), normal.x(), 0.0);
        const auto windows =
            free_fibre_windows(obstacles, kRadius * normal, normal, hoop, ball_rule());
        ASSERT_EQ(windows.size(), 1U) << azimuth;
        // Facets of 4 mm lie up to 0.04 mm inside: that is 0.06 mm of length.
        EXPECT_GE(windows[0].low_mm, nearest - 0.2);
        EXPECT_LE(windows[0].low_mm, nearest + kSearch_mm);
        EXPECT_EQ(windows[0].high_mm, 200.0);
    }
}

TEST(FreeFibreWindows, KeepTheArmClearToo) {
    FreeFibreRule rule = ball_rule();
    rule.min_mm = 60.0;
    // Outward of the eye, at x = 300 .. 320 for an eye near x = 100, stands a wall.
    rule.arm = {{100.0, 150.0, 10.0}};
    const auto windows =
        along_x(query_of(test::box({300.0, -90.0, -90.0}, {301.0, 90.0, 90.0})), rule);
    ASSERT_EQ(windows.size(), 1U);
    EXPECT_LE(windows[0].high_mm, 300.0 - 15.0 - 150.0 + 0.2);
    EXPECT_GE(windows[0].high_mm, 300.0 - 15.0 - 150.0 - 12.0);
}

using Windows = std::vector<std::vector<FreeFibreWindow>>;

// Every length of a station can go on to some length of the next, and the wish clamped into the
// ranges keeps the rates as well.
void expect_rates(const std::vector<double>& s, const FreeLengths& lengths, double wish) {
    constexpr double kRounding = 1e-9;
    for (std::size_t i = 0; i < s.size(); ++i) {
        ASSERT_LE(lengths.low_mm[i], lengths.high_mm[i]);
        if (i == 0) {
            continue;
        }
        const double ds = s[i] - s[i - 1];
        const double shorter = kShorteningRate * ds + kRounding;
        const double longer = kLengtheningRate * ds + kRounding;
        ASSERT_GE(lengths.low_mm[i - 1] + longer, lengths.low_mm[i]) << i;
        ASSERT_LE(lengths.high_mm[i - 1] - shorter, lengths.high_mm[i]) << i;
        const double change = std::clamp(wish, lengths.low_mm[i], lengths.high_mm[i]) -
                              std::clamp(wish, lengths.low_mm[i - 1], lengths.high_mm[i - 1]);
        ASSERT_LE(change, longer) << i;
        ASSERT_GE(change, -shorter) << i;
    }
}

// True when each range lies in one of the station's windows.
bool within_windows(const FreeLengths& lengths, const Windows& windows) {
    for (std::size_t i = 0; i < windows.size(); ++i) {
        if (std::none_of(windows[i].begin(), windows[i].end(), [&](const FreeFibreWindow& w) {
                return w.low_mm <= lengths.low_mm[i] + 1e-9 &&
                       lengths.high_mm[i] <= w.high_mm + 1e-9;
            })) {
            return false;
        }
    }
    return true;
}

TEST(ChooseFreeLengths, TakesThePreferredLengthWhereItCan) {
    std::vector<double> s;
    Windows windows;
    for (int i = 0; i < 20; ++i) {
        s.push_back(5.0 * i);
        windows.push_back({{60.0, 250.0}});
    }
    const FreeLengths lengths = choose_free_lengths(s, windows, 200.0);
    EXPECT_TRUE(lengths.blocked.empty());
    EXPECT_TRUE(within_windows(lengths, windows));
    for (std::size_t i = 0; i < s.size(); ++i) {
        EXPECT_LE(lengths.low_mm[i], 200.0);
        EXPECT_GE(lengths.high_mm[i], 200.0);
    }
}

TEST(ChooseFreeLengths, ShortensInTimeForANarrowPlace) {
    std::vector<double> s;
    Windows windows;
    for (int i = 0; i <= 100; ++i) {
        s.push_back(4.0 * i);
        windows.push_back({{60.0, i >= 60 && i <= 70 ? 90.0 : 250.0}});
    }
    const FreeLengths lengths = choose_free_lengths(s, windows, 200.0);
    EXPECT_TRUE(lengths.blocked.empty());
    expect_rates(s, lengths, 200.0);
    // From 200 down to 90 at the greatest rate takes 110 / kShorteningRate of fibre.
    for (int i = 0; i < 60; ++i) {
        const double highest = 90.0 + kShorteningRate * 4.0 * (60 - i);
        EXPECT_NEAR(lengths.high_mm[static_cast<std::size_t>(i)], std::min(250.0, highest), 1e-9);
    }
    EXPECT_GE(lengths.high_mm.back(), 200.0);
}

TEST(ChooseFreeLengths, NamesAStationWithoutWindow) {
    const std::vector<double> s{0.0, 5.0, 10.0};
    const Windows windows{{{60.0, 250.0}}, {}, {{60.0, 250.0}}};
    EXPECT_EQ(choose_free_lengths(s, windows, 200.0).blocked, (std::vector<std::size_t>{1}));
}

TEST(ChooseFreeLengths, NamesAChangeThatIsTooFast) {
    const std::vector<double> s{0.0, 5.0};
    EXPECT_FALSE(
        choose_free_lengths(s, Windows{{{60.0, 60.0}}, {{300.0, 300.0}}}, 200.0).blocked.empty());
    EXPECT_FALSE(
        choose_free_lengths(s, Windows{{{300.0, 300.0}}, {{60.0, 60.0}}}, 200.0).blocked.empty());
    EXPECT_TRUE(
        choose_free_lengths(s, Windows{{{60.0, 60.0}}, {{70.0, 70.0}}}, 200.0).blocked.empty());
    EXPECT_TRUE(
        choose_free_lengths(s, Windows{{{64.0, 64.0}}, {{60.0, 60.0}}}, 200.0).blocked.empty());
}

// A wander that keeps the rates runs through windows of random width, with others beside it.
TEST(ChooseFreeLengths, FindsAWayThroughRandomWindows) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Draw draw(seed);
        std::vector<double> s;
        Windows windows;
        double at = 0.0;
        double length = 150.0;
        for (int i = 0; i < 60; ++i) {
            const double ds = draw.between(1.0, 8.0);
            at += ds;
            length = std::clamp(length + draw.between(-kShorteningRate, kLengtheningRate) * ds,
                                60.0, 400.0);
            s.push_back(at);
            windows.push_back({{std::max(60.0, length - draw.between(0.0, 20.0)),
                                std::min(400.0, length + draw.between(0.0, 20.0))}});
        }
        const FreeLengths lengths = choose_free_lengths(s, windows, 200.0);
        ASSERT_TRUE(lengths.blocked.empty());
        EXPECT_TRUE(within_windows(lengths, windows));
        expect_rates(s, lengths, 200.0);
        // Windows that lead nowhere, far off, change nothing.
        for (std::size_t i = 0; i < windows.size(); i += 3) {
            windows[i].push_back({1000.0, 1010.0});
        }
        const FreeLengths again = choose_free_lengths(s, windows, 200.0);
        EXPECT_EQ(again.low_mm, lengths.low_mm);
        EXPECT_EQ(again.high_mm, lengths.high_mm);
        EXPECT_TRUE(again.blocked.empty());
    }
}

// Two ways that no length leads between: each can be run through, and only where the second begins
// is blocked.
TEST(ChooseFreeLengths, GoesOnBehindAPlaceThatBlocks) {
    std::vector<double> s;
    Windows windows;
    for (int i = 0; i <= 100; ++i) {
        s.push_back(4.0 * i);
        const bool narrow = i == 80;
        windows.push_back(i < 30
                              ? Windows::value_type{{60.0, 90.0}}
                              : Windows::value_type{{20.0, 30.0}, {180.0, narrow ? 190.0 : 400.0}});
    }
    const FreeLengths lengths = choose_free_lengths(s, windows, 300.0);
    EXPECT_EQ(lengths.blocked, (std::vector<std::size_t>{30}));
    EXPECT_TRUE(within_windows(lengths, windows));
    const auto stretch = [&](std::size_t from, std::size_t to) {
        const auto part = [&](const std::vector<double>& all) {
            return std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(from),
                                       all.begin() + static_cast<std::ptrdiff_t>(to));
        };
        expect_rates(part(s), {part(lengths.low_mm), part(lengths.high_mm), {}}, 300.0);
    };
    stretch(0, 30);
    stretch(30, s.size());
    EXPECT_GE(lengths.high_mm[30], 300.0);
    EXPECT_EQ(lengths.high_mm[80], 190.0);
    EXPECT_GE(lengths.high_mm.back(), 300.0 - 1e-9);
}

TEST(ChooseFreeLengths, OfNothingIsNothing) {
    const FreeLengths lengths = choose_free_lengths({}, {}, 200.0);
    EXPECT_TRUE(lengths.low_mm.empty());
    EXPECT_TRUE(lengths.blocked.empty());
}

}  // namespace
}  // namespace meshwind
