#include "machines/drawn_starts.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kDraws = 1000;

Axis axis(AxisType type, double min, double max) {
    Axis made;
    made.type = type;
    made.min = min;
    made.max = max;
    return made;
}

// A spindle without ends, a carriage with ends, one with one end alone, and a head roll.
Machine machine() {
    Machine made;
    made.mandrel_chain = {axis(AxisType::Rotary, -kInfinity, kInfinity)};
    made.eye_chain = {axis(AxisType::Linear, -100.0, 300.0), axis(AxisType::Linear, 0.0, kInfinity),
                      axis(AxisType::Rotary, -kInfinity, 1.0)};
    return made;
}

struct Range {
    double low = kInfinity;
    double high = -kInfinity;
};

std::vector<Range> ranges(DrawnStarts& starts, const std::vector<double>& at_hand) {
    std::vector<Range> found(at_hand.size());
    for (int k = 0; k < kDraws; ++k) {
        const std::vector<double> start = starts.next(at_hand);
        EXPECT_EQ(start.size(), at_hand.size());
        for (std::size_t j = 0; j < start.size(); ++j) {
            found[j].low = std::min(found[j].low, start[j]);
            found[j].high = std::max(found[j].high, start[j]);
        }
    }
    return found;
}

TEST(DrawnStarts, FillTheTravelOrSoMuchBesideTheJointAtHand) {
    const Machine made = machine();
    DrawnStarts starts(made, {.endless_mm = 500.0});
    const std::vector<Range> found = ranges(starts, {7.0, 0.0, 200.0, 0.5});
    const std::vector<Range> wanted = {
        {7.0 - kPi, 7.0 + kPi}, {-100.0, 300.0}, {0.0, 700.0}, {0.5 - kPi, 1.0}};
    for (std::size_t j = 0; j < wanted.size(); ++j) {
        // That none of 1000 even draws comes within 2 % of an end has a chance of 2e-9.
        const double near = 0.02 * (wanted[j].high - wanted[j].low);
        EXPECT_GE(found[j].low, wanted[j].low);
        EXPECT_LT(found[j].low, wanted[j].low + near);
        EXPECT_LE(found[j].high, wanted[j].high);
        EXPECT_GT(found[j].high, wanted[j].high - near);
    }
}

TEST(DrawnStarts, KeepTheFirstJointsAndTheNumber) {
    const Machine made = machine();
    DrawnStarts starts(made, {.first = 1});
    for (int k = 0; k < kDraws; ++k) {
        const std::vector<double> start = starts.next(std::vector<double>{7.0, 10.0});
        ASSERT_EQ(start.size(), 2U);
        EXPECT_EQ(start[0], 7.0);
        EXPECT_NE(start[1], 10.0);
    }
}

TEST(DrawnStarts, AreTheSameAgain) {
    const Machine made = machine();
    const std::vector<double> at_hand(made.axis_count(), 0.0);
    DrawnStarts one(made);
    DrawnStarts two(made);
    const std::vector<double> first = one.next(at_hand);
    EXPECT_EQ(first, two.next(at_hand));
    EXPECT_NE(first, one.next(at_hand));
}

}  // namespace
}  // namespace meshwind
