#include "core/text/text_number.h"

#include <cmath>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

TEST(Fixed, RoundsToTheDigitsAsked) {
    EXPECT_EQ(fixed(1.2345, 3), "1.234");  // 1.2345 is just below the tie in binary
    EXPECT_EQ(fixed(-0.5, 2), "-0.50");
    EXPECT_EQ(fixed(361230.0004, 3), "361230.000");
}

TEST(Fixed, NeverPrintsANegativeZero) {
    EXPECT_EQ(fixed(-0.0, 3), "0.000");
    EXPECT_EQ(fixed(-0.0004, 3), "0.000");
    EXPECT_EQ(fixed(-0.0, 0), "0");
    EXPECT_EQ(fixed(-0.0006, 3), "-0.001");
}

TEST(FixedApart, HasTheDigitsThatShowWhichIsLarger) {
    const FixedPair near = fixed_apart(167.0009, 166.6667, 0);
    EXPECT_EQ(near.value, "167.0");
    EXPECT_EQ(near.limit, "166.7");
    const FixedPair far = fixed_apart(1000.4, 600.0, 0);
    EXPECT_EQ(far.value, "1000");
    EXPECT_EQ(far.limit, "600");
    for (const double limit : {1.0, -0.3, 1e9, 1e-12, 0.0}) {
        for (const int decimals : {0, 1, 4}) {
            const double above = std::nextafter(limit, 1e300);
            const FixedPair least = fixed_apart(above, limit, decimals);
            EXPECT_NE(least.value, least.limit);
            const FixedPair same = fixed_apart(limit, limit, decimals);
            EXPECT_EQ(same.value, same.limit);
        }
    }
}

TEST(AppendShortest, ReadsBackAsTheSameDouble) {
    for (const double value : {0.1, 1.0 / 3.0, -2.5e-17, 1e22}) {
        std::string text;
        append_shortest(text, value);
        EXPECT_EQ(std::stod(text), value);
    }
    std::string text;
    append_shortest(text, -0.0);
    EXPECT_EQ(text, "0");
}

}  // namespace
}  // namespace meshwind
