#include "winding/revolution/pattern_constraints.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

constexpr double kTurn_rad = 2.0 * kPi;

// The tube of andrianov_2022_machine_path: radius 40, 45 degrees, band 3.5 mm, 1729.042 degrees a
// circuit (docs/winding.md), two rims.
CircuitToClose tube() {
    return {.turn_rad = rad_from_deg(1729.042),
            .dwelling_ends = 2,
            .band_mm = 3.5,
            .mm_per_rad = 40.0 * std::cos(rad_from_deg(45.0))};
}

// Which band lies beside the first one, by laying them out: the number of the circuit, and on which
// side.
std::pair<std::int64_t, bool> neighbour(const Pattern& p) {
    for (std::int64_t i = 1; i < p.circuits; ++i) {
        const double at = std::remainder(static_cast<double>(i) * p.turn_rad, kTurn_rad);
        if (std::abs(at) < 1.5 * kTurn_rad / static_cast<double>(p.circuits)) {
            return {i, at > 0.0};
        }
    }
    return {0, true};
}

TEST(PatternConstraints, EveryWishIsKeptByWhatIsLaid) {
    int found = 0;
    for (const int starts : {1, 2, 3, 5, 7, 11, 16}) {
        for (const BandOrder order : {BandOrder::Leading, BandOrder::Lagging}) {
            for (const double dwell_deg : {0.0, 15.0, 200.0}) {
                const PatternConstraints wish{.circuits = 53,
                                              .starts = starts,
                                              .order = order,
                                              .least_dwell_rad = rad_from_deg(dwell_deg)};
                const FoundPattern f = find_wished_pattern(tube(), wish);
                ASSERT_TRUE(f.pattern.has_value()) << f.failure;
                const Pattern& p = *f.pattern;
                EXPECT_EQ(p.circuits, 53);
                const auto [circuit, ahead] = neighbour(p);
                EXPECT_EQ(circuit, starts);
                EXPECT_EQ(ahead, order == BandOrder::Leading);
                EXPECT_GE(0.5 * p.dwell_rad, rad_from_deg(dwell_deg) - 1e-12);
                EXPECT_NEAR(p.turn_rad - p.dwell_rad, tube().turn_rad, 1e-9);
                // The wanted dwell is not passed by more than a turn.
                EXPECT_LT(p.dwell_rad, rad_from_deg(2.0 * dwell_deg) + kTurn_rad);
                ++found;
            }
        }
    }
    EXPECT_EQ(found, 42);
}

TEST(PatternConstraints, WithoutWishesItIsTheBestPatternThatCloses) {
    const FoundPattern found = find_wished_pattern(tube(), {});
    ASSERT_TRUE(found.pattern.has_value());
    EXPECT_EQ(found.pattern->circuits, 51);
    EXPECT_EQ(found.pattern->turns, 245);
    // 51 bands of 3.5 mm on 2 pi 40 cos(45).
    EXPECT_NEAR(found.pattern->overlap, 51.0 * 3.5 / (kTurn_rad * tube().mm_per_rad) - 1.0, 1e-12);
}

TEST(PatternConstraints, BandsAreAsFarApartAsAskedFor) {
    const double around_mm = kTurn_rad * tube().mm_per_rad;
    for (const double offset_mm : {2.0, 3.0, 3.5, 5.0, 9.0}) {
        const FoundPattern found = find_wished_pattern(tube(), {.band_offset_mm = offset_mm});
        ASSERT_TRUE(found.pattern.has_value()) << offset_mm;
        const auto circuits = static_cast<double>(found.pattern->circuits);
        EXPECT_LE(around_mm / circuits, offset_mm);
        EXPECT_GT(around_mm / (circuits - 1.0), 0.95 * offset_mm);
        // The overlap is that of the tow: of wide offsets a gap.
        EXPECT_NEAR(found.pattern->overlap, circuits * 3.5 / around_mm - 1.0, 1e-12);
        EXPECT_EQ(found.pattern->overlap<0.0, offset_mm> 3.6) << offset_mm;
    }
}

TEST(PatternConstraints, DwellAndOverlapKeepTheirLimits) {
    PatternConstraints wish{
        .starts = 8, .most_overlap = 0.06, .most_dwell_rad = rad_from_deg(110.0)};
    const FoundPattern narrow = find_wished_pattern(tube(), wish);
    ASSERT_TRUE(narrow.pattern.has_value()) << narrow.failure;
    EXPECT_LE(narrow.pattern->dwell_rad, rad_from_deg(220.0));
    EXPECT_LE(narrow.pattern->overlap, 0.06);
    EXPECT_EQ(neighbour(*narrow.pattern).first, 8);
    // With less dwell 8 starts take more overlap, and that is told.
    wish.most_dwell_rad = rad_from_deg(40.0);
    const FoundPattern none = find_wished_pattern(tube(), wish);
    EXPECT_FALSE(none.pattern.has_value());
    EXPECT_TRUE(test::tells(none.failure, "55 circuits, 8 starts")) << none.failure;
    wish.most_overlap = 0.1;
    EXPECT_EQ(find_wished_pattern(tube(), wish).pattern->circuits, 55);
    CircuitToClose one_rim = tube();
    one_rim.dwelling_ends = 1;
    const FoundPattern one = find_wished_pattern(
        one_rim, {.least_dwell_rad = rad_from_deg(40.0), .most_dwell_rad = rad_from_deg(60.0)});
    ASSERT_TRUE(one.pattern.has_value()) << one.failure;
    EXPECT_GE(one.pattern->dwell_rad, rad_from_deg(40.0) - 1e-12);
    EXPECT_LE(one.pattern->dwell_rad, rad_from_deg(60.0) + 1e-12);
}

// Circuits and starts that words tell, in their order.
std::vector<std::pair<int, int>> patterns_told(const std::string& words) {
    static const std::regex kPattern("([0-9]+) circuits, ([0-9]+) starts");
    std::vector<std::pair<int, int>> told;
    for (std::sregex_iterator at(words.begin(), words.end(), kPattern), end; at != end; ++at) {
        told.emplace_back(std::stoi((*at)[1]), std::stoi((*at)[2]));
    }
    return told;
}

TEST(PatternConstraints, TellsTheNearestWhereNoneFulfilsIt) {
    // 54 and 6 have factors in common: after 6 circuits no band can lie beside the first of 54.
    const FoundPattern common = find_wished_pattern(tube(), {.circuits = 54, .starts = 6});
    EXPECT_FALSE(common.pattern.has_value());
    const auto told = patterns_told(common.failure);
    ASSERT_EQ(told.size(), 5U) << common.failure;
    // 5 and 7 have none with 54.
    EXPECT_TRUE(told[0] == std::pair(54, 5) || told[0] == std::pair(54, 7)) << common.failure;

    const FoundPattern gaps = find_wished_pattern(tube(), {.circuits = 30});
    EXPECT_FALSE(gaps.pattern.has_value());
    // As many as close the wall.
    ASSERT_FALSE(patterns_told(gaps.failure).empty()) << gaps.failure;
    EXPECT_EQ(patterns_told(gaps.failure).front().first, 51) << gaps.failure;

    const FoundPattern crowded = find_wished_pattern(tube(), {.circuits = 80, .most_overlap = 0.1});
    EXPECT_FALSE(crowded.pattern.has_value());
    EXPECT_FALSE(patterns_told(crowded.failure).empty()) << crowded.failure;
    EXPECT_TRUE(find_wished_pattern(tube(), {.circuits = 80}).pattern.has_value());

    CircuitToClose vessel = tube();
    vessel.dwelling_ends = 0;
    vessel.most_change_rad = rad_from_deg(8.0);
    const FoundPattern dwell = find_wished_pattern(vessel, {.least_dwell_rad = 0.1});
    EXPECT_FALSE(dwell.pattern.has_value());
    EXPECT_NE(dwell.failure, "");
}

TEST(PatternConstraints, TheLatticeIsThatOfTheLeastDwell) {
    for (const int circuits : {1, 2, 3, 6, 9, 12}) {
        const FoundPattern found = find_wished_lattice(tube(), {.circuits = circuits}, {});
        ASSERT_TRUE(found.pattern.has_value()) << found.failure;
        const Pattern expected =
            lattice(tube().turn_rad, circuits, tube().band_mm / tube().mm_per_rad);
        EXPECT_EQ(found.pattern->turns, expected.turns);
        EXPECT_NEAR(found.pattern->dwell_rad, expected.dwell_rad, 1e-12);
        EXPECT_NEAR(found.pattern->overlap, expected.overlap, 1e-12);
    }
    // The paper's grid closes after 29 turns with 5.479 degrees at either end.
    const FoundPattern printed = find_wished_lattice(tube(), {.circuits = 6}, {});
    EXPECT_EQ(printed.pattern->turns, 29);
    EXPECT_NEAR(deg_from_rad(0.5 * printed.pattern->dwell_rad), 5.479, 5e-4);
}

TEST(PatternConstraints, SeriesFillALatticeAsPrinted) {
    const LatticeConstraints wish{.circuits = 6, .series = 0};
    const FoundPattern found = find_wished_lattice(tube(), wish, {});
    ASSERT_TRUE(found.pattern.has_value()) << found.failure;
    const LaidLattice laid = laid_lattice(*found.pattern, tube(), wish, {});
    EXPECT_EQ(laid.series, 9);
    EXPECT_TRUE(laid.filled);
    const std::vector<double> starts = circuit_starts_rad(*found.pattern, laid);
    ASSERT_EQ(starts.size(), 54U);
    // All around, evenly, each place once.
    std::vector<double> places;
    for (const double start : starts) {
        places.push_back(std::fmod(start, kTurn_rad));
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_NEAR(places[i], kTurn_rad * static_cast<double>(i) / 54.0, 1e-12);
    }
}

TEST(PatternConstraints, RibsAreAsWideAsTheirSeries) {
    const LatticeConstraints wish{.circuits = 6, .series = 3, .plies = 2};
    const PatternConstraints apart{.band_offset_mm = 4.0};
    const FoundPattern found = find_wished_lattice(tube(), wish, apart);
    ASSERT_TRUE(found.pattern.has_value()) << found.failure;
    const LaidLattice laid = laid_lattice(*found.pattern, tube(), wish, apart);
    EXPECT_DOUBLE_EQ(laid.rib_mm, 3.5 + 2.0 * 4.0);
    EXPECT_NEAR(laid.rib_spacing_mm, kTurn_rad * tube().mm_per_rad / 6.0, 1e-12);
    const std::vector<double> starts = circuit_starts_rad(*found.pattern, laid);
    ASSERT_EQ(starts.size(), 36U);
    for (std::size_t i = 0; i < 18; ++i) {
        EXPECT_EQ(starts[i], starts[i + 18]);  // ply upon ply
        const double moved_mm = static_cast<double>(i / 6) * 4.0;
        EXPECT_NEAR(starts[i], starts[i % 6] + moved_mm / tube().mm_per_rad, 1e-12);
    }
    // Ribs are 29.6 mm apart: 9 series are 31.5 mm wide.
    EXPECT_TRUE(find_wished_lattice(tube(), {.circuits = 6, .series = 8}, {}).pattern.has_value());
    const FoundPattern wide = find_wished_lattice(tube(), {.circuits = 6, .series = 9}, {});
    EXPECT_FALSE(wide.pattern.has_value());
    EXPECT_NE(wide.failure, "");
}

TEST(PatternConstraints, ALatticeKeepsStartsAndOrder) {
    const FoundPattern found =
        find_wished_lattice(tube(), {.circuits = 11}, {.starts = 3, .order = BandOrder::Lagging});
    ASSERT_TRUE(found.pattern.has_value()) << found.failure;
    EXPECT_EQ(neighbour(*found.pattern), std::pair(std::int64_t{3}, false));
    const FoundPattern none = find_wished_lattice(tube(), {.circuits = 6}, {.starts = 2});
    EXPECT_FALSE(none.pattern.has_value());
    // Of 5 and 7 ribs 2 starts are to be had, of 6 only 1.
    EXPECT_TRUE(test::tells(none.failure, "5 circuits, 2 starts")) << none.failure;
    EXPECT_TRUE(test::tells(none.failure, "6 circuits, 1 starts")) << none.failure;
}

// Straight lines on the unrolled cylinder, every pair of passes.
TEST(Interlacing, CrossingsAreThoseOfTheLines) {
    int rows = 0;
    for (const std::int64_t circuits : {1, 2, 5, 6, 27}) {
        for (const double pass_rad : {0.7, 3.9, 14.0}) {
            for (const double upper_rad : {0.0, 0.4, 5.1}) {
                const FoundPattern found = find_wished_lattice(
                    {.turn_rad = 2.0 * pass_rad + upper_rad, .dwelling_ends = 1, .band_mm = 1e-3},
                    {.circuits = static_cast<int>(circuits)}, {});
                ASSERT_TRUE(found.pattern.has_value());
                const Pattern& p = *found.pattern;
                std::int64_t crossings = 0;
                for (std::int64_t up = 0; up < circuits; ++up) {
                    for (std::int64_t down = 0; down < circuits; ++down) {
                        // The way back less the way out, at the bottom; at the top 2 pass less.
                        const double bottom = static_cast<double>(down - up) * p.turn_rad +
                                              2.0 * pass_rad + upper_rad;
                        const double top = bottom - 2.0 * pass_rad;
                        constexpr double kEnds = 1e-7;
                        crossings +=
                            static_cast<std::int64_t>(std::floor((bottom - kEnds) / kTurn_rad)) -
                            static_cast<std::int64_t>(std::floor((top + kEnds) / kTurn_rad));
                    }
                }
                const Interlacing got = interlacing_of(p, pass_rad, upper_rad);
                EXPECT_EQ(got.crossings, crossings) << circuits << ' ' << pass_rad;
                EXPECT_EQ(got.crossings, got.crossing_rows * circuits);
                EXPECT_LE(got.diamonds_around, p.starts);
                rows += static_cast<int>(got.crossing_rows);
            }
        }
    }
    EXPECT_GT(rows, 100);
}

TEST(Interlacing, DiamondsAroundAreTheStarts) {
    for (const int starts : {1, 2, 5, 10, 16}) {
        const FoundPattern found = find_wished_pattern(tube(), {.circuits = 53, .starts = starts});
        ASSERT_TRUE(found.pattern.has_value());
        // Passes of over two turns have all rows there are.
        EXPECT_EQ(interlacing_of(*found.pattern, 14.0, 1.0).diamonds_around, starts);
    }
}

}  // namespace
}  // namespace meshwind
