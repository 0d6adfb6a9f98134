// Linear programmes whose solution is known by hand.
#include "core/linear_programme.h"

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace meshwind {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;

// 2 x + y >= 4 and x + 3 y >= 6 cost 3 and 2: both hold with equality at x = 1.2, y = 1.6. Its
// prices solve 2 p + q = 3 and p + 3 q = 2.
TEST(LinearProgramme, FindsCornerAndPrices) {
    const std::array<LinearProgramme::Row, 2> rows{{{4.0, kNoEnd}, {6.0, kNoEnd}}};
    LinearProgramme programme(rows);
    programme.add_column(3.0, kNoEnd, std::array{RowEntry{0, 2.0}, RowEntry{1, 1.0}});
    programme.add_column(2.0, kNoEnd, std::array{RowEntry{0, 1.0}, RowEntry{1, 3.0}});
    const LinearProgramme::Solution solution = programme.solve();
    ASSERT_TRUE(solution.optimal);
    EXPECT_NEAR(solution.x[0], 1.2, kRounding);
    EXPECT_NEAR(solution.x[1], 1.6, kRounding);
    EXPECT_NEAR(solution.cost, 6.8, kRounding);
    EXPECT_NEAR(solution.price[0], 1.4, kRounding);
    EXPECT_NEAR(solution.price[1], 0.2, kRounding);
    EXPECT_LE(solution.worst_breach, kRounding);
}

// A column that does the work of both for less is found once it is there.
TEST(LinearProgramme, GoesOnFromWhereItWasWithMoreColumns) {
    const std::array<LinearProgramme::Row, 2> rows{{{4.0, kNoEnd}, {6.0, kNoEnd}}};
    LinearProgramme programme(rows);
    programme.add_column(3.0, kNoEnd, std::array{RowEntry{0, 2.0}});
    programme.add_column(2.0, kNoEnd, std::array{RowEntry{1, 3.0}});
    EXPECT_NEAR(programme.solve().cost, 10.0, kRounding);
    EXPECT_EQ(programme.add_column(1.0, 3.0, std::array{RowEntry{0, 1.0}, RowEntry{1, 1.0}}), 2);
    const LinearProgramme::Solution solution = programme.solve();
    // Three of it, its most; then 1 of 4 lacks at 3 for 2, and 3 of 6 at 2 for 3.
    EXPECT_NEAR(solution.cost, 3.0 + 1.5 + 2.0, kRounding);
    EXPECT_NEAR(solution.x[2], 3.0, kRounding);
    EXPECT_LE(solution.worst_breach, kRounding);
}

TEST(LinearProgramme, SaysWhatCannotBe) {
    const std::array<LinearProgramme::Row, 2> rows{{{4.0, kNoEnd}, {-kNoEnd, 1.0}}};
    LinearProgramme programme(rows);
    programme.add_column(1.0, kNoEnd, std::array{RowEntry{0, 1.0}, RowEntry{1, 1.0}});
    EXPECT_FALSE(programme.solve().optimal);
}

// Equal covers have many bases at one corner. Stopped after a few steps the programme goes on with
// bounds that are told apart, and ends as good as at the optimum or says that it did not.
TEST(LinearProgramme, GoesOnWhereItIsStopped) {
    constexpr int kRows = 40;
    const std::vector<LinearProgramme::Row> rows(kRows, {4.0, kNoEnd});
    const auto programme = [&] {
        auto made = std::make_unique<LinearProgramme>(rows);
        for (int c = 0; c < kRows; ++c) {
            std::vector<RowEntry> column;
            for (int r = 0; r < kRows; ++r) {
                if ((r - c + kRows) % kRows < 7) {
                    column.push_back({r, 1.0});
                }
            }
            made->add_column(1.0, kNoEnd, column);
        }
        return made;
    };
    const double least = programme()->solve().cost;
    EXPECT_NEAR(least, 4.0 * kRows / 7.0, kRounding);
    const LinearProgramme::Solution few = programme()->solve(1);
    EXPECT_FALSE(few.optimal);
    int ended = 0;
    for (const int steps : {10, 30, 60, 90}) {
        const LinearProgramme::Solution solution = programme()->solve(steps);
        EXPECT_LE(solution.feasible ? solution.worst_breach : 0.0, 4e-4 + kRounding) << steps;
        if (solution.optimal) {
            ++ended;
            EXPECT_NEAR(solution.cost, least, 1e-4 * least) << steps;
        }
    }
    EXPECT_GT(ended, 0);
}

// Where prices are feasible, b . p is no more than any feasible cost; at the optimum both meet.
TEST(LinearProgramme, PricesProveTheCostOfRandomCovers) {
    constexpr std::uint64_t kSeed = 11;
    for (std::uint64_t trial = 0; trial < 20; ++trial) {
        std::vector<LinearProgramme::Row> rows;
        for (std::uint64_t r = 0; r < 30; ++r) {
            rows.push_back({1.0 + random_unit(kSeed, 1000 * trial + r), kNoEnd});
        }
        LinearProgramme programme(rows);
        std::vector<std::vector<RowEntry>> columns;
        std::vector<double> cost;
        for (std::uint64_t c = 0; c < 80; ++c) {
            std::vector<RowEntry>& column = columns.emplace_back();
            for (int r = 0; r < 30; ++r) {
                const std::uint64_t draw = (trial * 80 + c) * 100 + static_cast<std::uint64_t>(r);
                if (random_unit(kSeed + 1, draw) < 0.2 || c == static_cast<std::uint64_t>(r)) {
                    column.push_back({r, 1.0});
                }
            }
            cost.push_back(1.0 + random_unit(kSeed + 2, trial * 80 + c));
            programme.add_column(cost.back(), kNoEnd, column);
        }
        const LinearProgramme::Solution solution = programme.solve();
        ASSERT_TRUE(solution.optimal);
        EXPECT_LE(solution.worst_breach, 1e-7);
        double value = 0.0;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            EXPECT_GE(solution.price[r], -1e-7);
            value += rows[r].least * solution.price[r];
        }
        EXPECT_NEAR(value, solution.cost, 1e-6);
        for (std::size_t c = 0; c < columns.size(); ++c) {
            double worth = 0.0;
            for (const RowEntry& entry : columns[c]) {
                worth += solution.price[static_cast<std::size_t>(entry.row)];
            }
            EXPECT_LE(worth, cost[c] + 1e-6);
        }
    }
}

}  // namespace
}  // namespace meshwind
