// Changes and zeros whose places are known in closed form.
#include "core/roots.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace meshwind {
namespace {

constexpr double kRounding = std::numeric_limits<double>::epsilon();

// x^2 < 2 holds up to the root of 2. From [1, 2] on, n halvings leave 2^-n, in binary without
// rounding.
TEST(Halve, LeavesTheHalfInWhichTheConditionChanges) {
    const double root = std::sqrt(2.0);
    for (const int times : {0, 1, 10, 40}) {
        const Changeover found =
            halve({.holds = 1.0, .fails = 2.0}, times, [](double x) { return x * x < 2.0; });
        EXPECT_EQ(found.fails - found.holds, std::ldexp(1.0, -times));
        EXPECT_LE(found.holds, root);
        EXPECT_GE(found.fails, root);
        EXPECT_EQ(found.middle(), found.holds + std::ldexp(1.0, -times - 1));
    }
}

TEST(Halve, TakesEitherEndAsTheLower) {
    const auto below = [](double x) { return x < 0.3; };
    const auto above = [](double x) { return !(x < 0.3); };
    const Changeover up = halve({.holds = -1.0, .fails = 1.0}, 30, below);
    const Changeover down = halve({.holds = 1.0, .fails = -1.0}, 30, above);
    EXPECT_EQ(up.holds, down.fails);
    EXPECT_EQ(up.fails, down.holds);
    EXPECT_LT(up.holds, up.fails);
}

// Every middle is 0.5 (a + b) of the ends then, to the last bit: 1/3 on the way from 0 to 1.
TEST(Halve, AsksAtTheMiddlesInTurn) {
    std::vector<double> asked;
    const Changeover found = halve({.holds = 0.0, .fails = 1.0}, 5, [&](double x) {
        asked.push_back(x);
        return x < 1.0 / 3.0;
    });
    EXPECT_EQ(asked, (std::vector<double>{0.5, 0.25, 0.375, 0.3125, 0.34375}));
    EXPECT_EQ(found.holds, 0.3125);
    EXPECT_EQ(found.fails, 0.34375);
}

// Between 0.1 and 0.4 are 2^53 or so numbers, fewer than 2^60.
TEST(Halve, EndsWhereNoNumberIsLeftBetween) {
    int asked = 0;
    const Changeover found = halve({.holds = 0.1, .fails = 0.4}, 1000, [&](double x) {
        ++asked;
        return x * x < 0.1;
    });
    EXPECT_EQ(std::nextafter(found.holds, 1.0), found.fails);
    EXPECT_LT(found.holds * found.holds, 0.1);
    EXPECT_GE(found.fails * found.fails, 0.1);
    EXPECT_LT(asked, 60);
}

TEST(Halve, TakesTheEndsAtTheirWord) {
    const auto always = [](double) { return true; };
    const auto never = [](double) { return false; };
    const Changeover all = halve({.holds = 0.0, .fails = 1.0}, 8, always);
    EXPECT_EQ(all.holds, 1.0 - std::ldexp(1.0, -8));
    EXPECT_EQ(all.fails, 1.0);
    const Changeover none = halve({.holds = 0.0, .fails = 1.0}, 8, never);
    EXPECT_EQ(none.holds, 0.0);
    EXPECT_EQ(none.fails, std::ldexp(1.0, -8));
}

// All halvings by the loop that Boost's is to be as good as, to the last bit.
TEST(Halve, IsTheLoopOfAllHalvings) {
    constexpr int kTimes = 60;
    constexpr std::uint64_t kSeed = 1;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const double from = 200.0 * random_unit(kSeed, 3 * i) - 100.0;
        const double to = 200.0 * random_unit(kSeed, 3 * i + 1) - 100.0;
        const double change = from + random_unit(kSeed, 3 * i + 2) * (to - from);
        const auto holds = [&](double x) { return from < to ? x < change : x > change; };
        double good = from;
        double bad = to;
        for (int k = 0; k < kTimes; ++k) {
            const double middle = 0.5 * (good + bad);
            (holds(middle) ? good : bad) = middle;
        }
        const Changeover found = halve({.holds = from, .fails = to}, kTimes, holds);
        ASSERT_EQ(found.holds, good) << i;
        ASSERT_EQ(found.fails, bad) << i;
    }
}

TEST(Halve, GivesTheSamePlaceTwiceBack) {
    const Changeover found = halve({.holds = 0.7, .fails = 0.7}, 5, [](double) {
        ADD_FAILURE() << "there is no middle to ask at";
        return true;
    });
    EXPECT_EQ(found.holds, 0.7);
    EXPECT_EQ(found.fails, 0.7);
}

double of_cosine(double x) {
    return std::cos(x) - x;
}

// cos(x) = x at 0.7390851332151607 (OEIS A003957).
TEST(ZeroBetween, FindsWhereTheCosineIsItsAngle) {
    constexpr double kZero = 0.7390851332151607;
    const ZeroBracket found = zero_between({0.0, 1.0, of_cosine(0.0), of_cosine(1.0)}, of_cosine);
    EXPECT_LE(found.low, found.high);
    EXPECT_NEAR(found.middle(), kZero, 4.0 * kRounding);
}

// Over by no more than 2^(1 - bits) of what is nearer to 0: of 2, with the zero of x^3 - 8.
TEST(ZeroBetween, IsNarrowerThanAskedFor) {
    const auto cube = [](double x) { return x * x * x - 8.0; };
    for (const int bits : {8, 20, 40}) {
        const ZeroBracket found =
            zero_between({1.0, 5.0, cube(1.0), cube(5.0)}, cube, {.bits = bits});
        EXPECT_LE(found.low, 2.0);
        EXPECT_GE(found.high, 2.0);
        EXPECT_LE(found.high - found.low, std::ldexp(found.low, 1 - bits));
    }
}

TEST(ZeroBetween, AsksAsOftenAsItMay) {
    int asked = 0;
    const auto step = [&](double x) {
        ++asked;
        return x < 0.3 ? -1.0 : 1e9;
    };
    const ZeroBracket found = zero_between({0.0, 1.0, -1.0, 1e9}, step, {.most_evaluations = 7});
    EXPECT_LE(asked, 7);
    EXPECT_LT(found.low, 0.3);
    EXPECT_GE(found.high, 0.3);
    EXPECT_GT(found.high - found.low, 1e-12);
}

TEST(ZeroBetween, TakesAnEndWhoseValueIsZero) {
    const auto line = [](double x) { return x - 2.0; };
    const ZeroBracket low = zero_between({2.0, 3.0, 0.0, 1.0}, line);
    EXPECT_EQ(low.low, 2.0);
    EXPECT_EQ(low.high, 2.0);
    const ZeroBracket high = zero_between({1.0, 2.0, -1.0, 0.0}, line);
    EXPECT_EQ(high.low, 2.0);
    EXPECT_EQ(high.high, 2.0);
}

// A rising line's zero is met by the first secant; a bent one within rounding of a few more. The
// last call is at the zero.
TEST(SecantRoot, LeavesTheLastCallAtTheZero) {
    double last = 0.0;
    const auto line = [&](double x) {
        last = x;
        return 2.0 * x - 3.0;
    };
    EXPECT_TRUE(secant_root(line, 0.1, 10.0, 1e-12));
    EXPECT_NEAR(last, 1.5, 1e-12);
    const auto exponential = [&](double x) {
        last = x;
        return std::exp(x) - 0.25;
    };
    EXPECT_TRUE(secant_root(exponential, 0.1, 10.0, 1e-14));
    EXPECT_NEAR(last, std::log(0.25), 1e-13);  // the slope there is 1 / 4
}

TEST(SecantRoot, GoesNoFartherThanAllowed) {
    double farthest = 0.0;
    const auto line = [&](double x) {
        farthest = std::max(farthest, std::abs(x));
        return 2.0 * x - 3.0;
    };
    EXPECT_FALSE(secant_root(line, 0.1, 1.0, 1e-12));
    EXPECT_EQ(farthest, 1.0);
}

TEST(SecantRoot, StartsDownwardsFromAnExcess) {
    std::vector<double> asked;
    EXPECT_TRUE(secant_root(
        [&](double x) {
            asked.push_back(x);
            return x + 1.0;
        },
        0.25, 10.0, 1e-12));
    ASSERT_GE(asked.size(), 2U);
    EXPECT_EQ(asked[0], 0.0);
    EXPECT_EQ(asked[1], -0.25);
}

}  // namespace
}  // namespace meshwind
