#include "core/text_number.h"

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
