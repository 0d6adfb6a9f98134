#include "winding/revolution/pattern.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kTurn_rad = 2.0 * kPi;

// Numbers that depend on the seed alone.
class Numbers {
public:
    explicit Numbers(std::uint64_t seed) : seed_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * random_unit(seed_, index_++);
    }

private:
    std::uint64_t seed_;
    std::uint64_t index_ = 0;
};

std::vector<PatternRequest> requests() {
    Numbers draw(20240611);
    std::vector<PatternRequest> all;
    for (int i = 0; i < 60; ++i) {
        PatternRequest request;
        request.circuit_rad = draw.between(0.0, 6.0 * kTurn_rad);
        request.band_rad = rad_from_deg(draw.between(4.0, 60.0));
        request.most_dwell_rad = i % 3 == 0 ? 0.0 : draw.between(0.0, kTurn_rad);
        request.most_change_rad = rad_from_deg(i % 2 == 0 ? 0.0 : draw.between(0.0, 3.0));
        request.layers = 1 + i % 5 / 4;
        request.least_overlap = i % 7 == 6 ? -0.3 : 0.0;
        request.most_overlap = 0.3;
        request.wanted_starts = i % 4;
        request.most_patterns = 1'000'000;
        all.push_back(request);
    }
    return all;
}

// Places of the bands on the circle, 0 to 1, laid one after the other.
std::vector<double> laid(double turn_rad, std::int64_t circuits) {
    std::vector<double> places;
    for (std::int64_t i = 0; i < circuits; ++i) {
        const double turns = static_cast<double>(i) * turn_rad / kTurn_rad;
        places.push_back(turns - std::floor(turns));
    }
    return places;
}

// Turns of up to 6 rad * 180 circuits leave 1e-13 of rounding.
constexpr double kPlace = 1e-11;

bool evenly_spaced(std::vector<double> places) {
    for (double& place : places) {
        place = place > 1.0 - kPlace ? 0.0 : place;
    }
    std::sort(places.begin(), places.end());
    const double step = 1.0 / static_cast<double>(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (std::abs(places[i] - static_cast<double>(i) * step) > kPlace) {
            return false;
        }
    }
    return true;
}

double circle_distance(double a, double b) {
    return std::remainder(a - b, 1.0);
}

TEST(FindPatterns, LaidBandsAreEvenlySpacedAndCloseInWholeTurns) {
    int found = 0;
    for (const PatternRequest& r : requests()) {
        for (const Pattern& p : find_patterns(r)) {
            ASSERT_TRUE(evenly_spaced(laid(p.turn_rad, p.circuits)));
            ASSERT_NEAR(p.turn_rad * static_cast<double>(p.circuits) / kTurn_rad,
                        static_cast<double>(p.turns), 1e-10);
            ASSERT_NEAR(p.turn_rad, r.circuit_rad + p.change_rad + p.dwell_rad, 1e-12);
            ASSERT_GE(p.dwell_rad, 0.0);
            ASSERT_LE(p.dwell_rad, r.most_dwell_rad);
            ASSERT_LE(std::abs(p.change_rad), r.most_change_rad + kSameTurn_rad + 1e-12);
            ++found;
        }
    }
    EXPECT_GT(found, 2000);
}

// Every number of turns is tried, and judged by the places of the bands alone.
TEST(FindPatterns, MissesNone) {
    int found = 0;
    for (const PatternRequest& r : requests()) {
        std::set<std::pair<std::int64_t, std::int64_t>> wanted;
        const double least = kTurn_rad * r.layers * (1.0 + r.least_overlap) / r.band_rad;
        const double most = kTurn_rad * r.layers * (1.0 + r.most_overlap) / r.band_rad;
        const auto first = static_cast<std::int64_t>(std::ceil(least));
        for (std::int64_t n = first; n == first || static_cast<double>(n) <= most; ++n) {
            for (std::int64_t k = 0; k <= 7 * n; ++k) {
                const double turn = kTurn_rad * static_cast<double>(k) / static_cast<double>(n);
                const double extra = turn - r.circuit_rad;
                if (extra >= -r.most_change_rad && extra <= r.most_change_rad + r.most_dwell_rad &&
                    evenly_spaced(laid(turn, n))) {
                    wanted.insert({n, k});
                }
            }
        }
        std::set<std::pair<std::int64_t, std::int64_t>> got;
        for (const Pattern& p : find_patterns(r)) {
            EXPECT_TRUE(got.insert({p.circuits, p.turns}).second) << "twice";
        }
        EXPECT_EQ(got, wanted);
        found += static_cast<int>(got.size());
    }
    EXPECT_GT(found, 2000);
}

// The pattern number and the order are read off the laid bands.
TEST(FindPatterns, BandsComeBesideTheFirstAfterTheStartsSaid) {
    int leading = 0;
    int lagging = 0;
    for (const PatternRequest& r : requests()) {
        for (const Pattern& p : find_patterns(r)) {
            if (p.circuits < 3) {
                continue;  // both neighbours are the same band
            }
            const double step = 1.0 / static_cast<double>(p.circuits);
            const std::vector<double> places = laid(p.turn_rad, p.circuits);
            std::int64_t n = 1;
            while (std::abs(circle_distance(places[static_cast<std::size_t>(n)], 0.0)) >
                   1.5 * step) {
                ++n;
            }
            ASSERT_EQ(p.starts, n);
            const bool ahead = circle_distance(places[static_cast<std::size_t>(n)], 0.0) > 0.0;
            ASSERT_EQ(p.order == BandOrder::Leading, ahead);
            (ahead ? leading : lagging) += 1;
            ASSERT_EQ(std::gcd(p.starts, p.skip), 1);
            const double turns = static_cast<double>(n) * p.turn_rad / kTurn_rad;
            ASSERT_NEAR(turns, static_cast<double>(p.skip) + (ahead ? step : -step), 1e-10);
        }
    }
    EXPECT_GT(leading, 500);
    EXPECT_GT(lagging, 500);
}

// Layers are counted at places all around the circle, between which no band ends twice.
TEST(FindPatterns, LayersAndTheirSpreadAreThoseCounted) {
    constexpr int kPoints = 4001;
    for (const PatternRequest& r : requests()) {
        std::vector<Pattern> patterns = find_patterns(r);
        patterns.resize(std::min<std::size_t>(patterns.size(), 5));
        for (const Pattern& p : patterns) {
            const std::vector<double> places = laid(p.turn_rad, p.circuits);
            const double half = 0.5 * r.band_rad / kTurn_rad;
            double sum = 0.0;
            double squares = 0.0;
            std::int64_t least = std::numeric_limits<std::int64_t>::max();
            std::int64_t most = 0;
            for (int i = 0; i < kPoints; ++i) {
                std::int64_t layers = 0;
                for (const double place : places) {
                    // A band wider than the circle lies on itself.
                    const double off = std::abs(circle_distance((i + 0.5) / kPoints, place));
                    layers += off < half ? 1 : 0;
                    layers += 1.0 - off < half ? 1 : 0;
                }
                sum += static_cast<double>(layers);
                squares += static_cast<double>(layers * layers);
                least = std::min(least, layers);
                most = std::max(most, layers);
            }
            const double mean = sum / kPoints;
            const double spread = std::sqrt(std::max(0.0, squares / kPoints - mean * mean));
            // At each end of a band the count may be off by one point of the 4001.
            const double off = static_cast<double>(p.circuits) / kPoints;
            ASSERT_NEAR(mean, r.layers * (1.0 + p.overlap), off);
            ASSERT_NEAR(spread * spread, std::pow(p.ripple * r.layers * (1.0 + p.overlap), 2),
                        4.0 * off);
            ASSERT_GE(least, p.least_layers);
            ASSERT_LE(most, p.most_layers);
            ASSERT_LE(p.most_layers - p.least_layers, 1);
            if (r.least_overlap >= 0.0) {
                ASSERT_GE(p.least_layers, r.layers);
            }
        }
    }
}

// Where the bands of both directions cross, that of the later circuit is on top. Along a row of
// crossings around the mandrel the stretches where one direction is on top are half a diamond each.
TEST(FindPatterns, StartsAreTheDiamondsAround) {
    for (const PatternRequest& r : requests()) {
        std::vector<Pattern> patterns = find_patterns(r);
        patterns.resize(std::min<std::size_t>(patterns.size(), 20));
        for (const Pattern& p : patterns) {
            if (p.circuits < 3) {
                continue;
            }
            const std::vector<std::int64_t> circuit = circuits_around(p);
            const auto n = circuit.size();
            std::int64_t most = 0;
            for (std::size_t row = 1; row < n; ++row) {
                const auto forward_on_top = [&](std::size_t place) {
                    return circuit[place % n] > circuit[(place + n - row) % n];
                };
                std::int64_t diamonds = 0;
                for (std::size_t place = 0; place < n; ++place) {
                    diamonds += forward_on_top(place + 1) && !forward_on_top(place) ? 1 : 0;
                }
                most = std::max(most, diamonds);
            }
            ASSERT_EQ(most, p.starts);
        }
    }
}

TEST(CircuitsAround, IsTheOrderOfTheLaidBands) {
    for (const PatternRequest& r : requests()) {
        for (const Pattern& p : find_patterns(r)) {
            const std::vector<double> places = laid(p.turn_rad, p.circuits);
            const std::vector<std::int64_t> circuit = circuits_around(p);
            for (std::size_t i = 0; i < circuit.size(); ++i) {
                const double place = static_cast<double>(i) / static_cast<double>(p.circuits);
                const double laid_at = places[static_cast<std::size_t>(circuit[i])];
                ASSERT_NEAR(circle_distance(laid_at, place), 0.0, kPlace);
            }
        }
    }
}

TEST(FindPatterns, RanksByOverlapThenDwellThenStarts) {
    PatternRequest r{.circuit_rad = rad_from_deg(1729.04),
                     .band_rad = rad_from_deg(7.09),
                     .most_dwell_rad = rad_from_deg(60.0)};
    // 360 / 7.09 = 50.8: 51 circuits overlap by 0.4 %, 52 by 2.4 %, 55 by 8.3 %.
    std::vector<Pattern> patterns = find_patterns(r);
    ASSERT_FALSE(patterns.empty());
    EXPECT_EQ(patterns.front().circuits, 51);
    EXPECT_NEAR(patterns.front().overlap, 51.0 * 7.09 / 360.0 - 1.0, 1e-12);
    // The first whole number of turns from 51 * 1729.04 / 360 = 244.95 on.
    EXPECT_EQ(patterns.front().turns, 245);
    EXPECT_NEAR(deg_from_rad(patterns.front().dwell_rad), 245.0 * 360.0 / 51.0 - 1729.04, 1e-9);
    for (std::size_t i = 1; i < patterns.size(); ++i) {
        EXPECT_LE(std::floor(100.0 * patterns[i - 1].overlap),
                  std::floor(100.0 * patterns[i].overlap));
    }
    // A wish decides among dwells within 5 degrees, not among overlaps.
    r.wanted_starts = 16;
    const std::vector<Pattern> wished = find_patterns(r);
    EXPECT_EQ(wished.front().circuits, 51);
    EXPECT_LT(wished.front().dwell_rad, rad_from_deg(5.0));
    for (const Pattern& p : wished) {
        if (p.circuits == 51 && p.dwell_rad < rad_from_deg(5.0)) {
            EXPECT_LE(std::abs(wished.front().starts - 16), std::abs(p.starts - 16));
        }
    }
}

TEST(FindPatterns, PutsPatternsWithoutGapFirst) {
    // 51 bands of a fiftieth overlap by as much as 49 leave bare.
    const std::vector<Pattern> patterns = find_patterns({.circuit_rad = 1.0,
                                                         .band_rad = kTurn_rad / 50.0,
                                                         .most_dwell_rad = kTurn_rad,
                                                         .least_overlap = -0.02,
                                                         .most_overlap = 0.02});
    std::vector<std::int64_t> circuits;
    for (const Pattern& p : patterns) {
        if (circuits.empty() || circuits.back() != p.circuits) {
            circuits.push_back(p.circuits);
        }
    }
    EXPECT_EQ(circuits, (std::vector<std::int64_t>{50, 51, 49}));
}

TEST(FindPatterns, KeepsTheBestWhereOnlySomeAreWanted) {
    PatternRequest r{.circuit_rad = 9.0, .band_rad = 0.02, .most_dwell_rad = kTurn_rad};
    r.most_patterns = 1'000'000;
    const std::vector<Pattern> all = find_patterns(r);
    ASSERT_GT(all.size(), 5000U);
    r.most_patterns = 7;
    const std::vector<Pattern> best = find_patterns(r);
    ASSERT_EQ(best.size(), 7U);
    for (std::size_t i = 0; i < best.size(); ++i) {
        EXPECT_EQ(best[i].circuits, all[i].circuits);
        EXPECT_EQ(best[i].turns, all[i].turns);
    }
}

TEST(FindPatterns, TurnsThatCloseAlreadyNeedNoDwell) {
    for (const double off_rad : {-1e-12, 0.0, 1e-12}) {
        const std::vector<Pattern> patterns =
            find_patterns({.circuit_rad = 5.0 / 12.0 * kTurn_rad + off_rad,
                           .band_rad = kTurn_rad / 12.0 + off_rad});
        ASSERT_EQ(patterns.size(), 1U);
        EXPECT_EQ(patterns[0].circuits, 12);
        EXPECT_EQ(patterns[0].turns, 5);
        EXPECT_EQ(patterns[0].starts, 5);  // 5 * 5 = 2 * 12 + 1
        EXPECT_EQ(patterns[0].skip, 2);
        EXPECT_EQ(patterns[0].order, BandOrder::Leading);
        EXPECT_EQ(patterns[0].least_layers, 1);
        EXPECT_NEAR(patterns[0].dwell_rad, 0.0, 1e-11);
    }
    EXPECT_TRUE(find_patterns({.circuit_rad = 0.5 * kTurn_rad, .band_rad = 1.0}).empty());
}

TEST(FindPatterns, OneBandAroundTheWholeMandrel) {
    const std::vector<Pattern> patterns =
        find_patterns({.circuit_rad = 7.0, .band_rad = 7.0, .most_dwell_rad = kTurn_rad});
    ASSERT_EQ(patterns.size(), 1U);
    EXPECT_EQ(patterns[0].circuits, 1);
    EXPECT_EQ(patterns[0].turns, 2);
    EXPECT_EQ(patterns[0].starts, 1);
    EXPECT_EQ(patterns[0].skip, 1);
}

std::string code_of(const PatternRequest& request) {
    try {
        (void)find_patterns(request);
    } catch (const InputError& error) {
        return error.code();
    }
    return "none";
}

TEST(FindPatterns, RefusesWhatIsOutOfRange) {
    const PatternRequest good{.circuit_rad = 7.0, .band_rad = 0.1, .most_dwell_rad = 1.0};
    EXPECT_EQ(code_of(good), "none");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -1.0}) {
        for (double PatternRequest::*field :
             {&PatternRequest::circuit_rad, &PatternRequest::band_rad,
              &PatternRequest::most_dwell_rad, &PatternRequest::least_dwell_rad,
              &PatternRequest::most_change_rad, &PatternRequest::least_overlap,
              &PatternRequest::most_overlap}) {
            PatternRequest request = good;
            request.*field = bad;
            EXPECT_EQ(code_of(request), "pattern.out_of_range") << bad;
        }
    }
    for (int PatternRequest::*field : {&PatternRequest::layers, &PatternRequest::most_patterns}) {
        PatternRequest request = good;
        request.*field = 0;
        EXPECT_EQ(code_of(request), "pattern.out_of_range");
    }
    PatternRequest request = good;
    request.wanted_starts = -1;
    EXPECT_EQ(code_of(request), "pattern.out_of_range");
    for (const std::int64_t bad : {-1, 10'001}) {
        request = good;
        request.circuits = bad;
        EXPECT_EQ(code_of(request), "pattern.out_of_range");
    }
    request = good;
    request.starts = -1;
    EXPECT_EQ(code_of(request), "pattern.out_of_range");
    request = good;
    request.least_dwell_rad = 1.5;  // above the most
    EXPECT_EQ(code_of(request), "pattern.out_of_range");
    request = good;
    request.circuit_rad = 1e7;
    EXPECT_EQ(code_of(request), "pattern.out_of_range");
    request = good;
    request.band_rad = 1e-5;
    EXPECT_EQ(code_of(request), "pattern.band_too_narrow");
}

// All smaller turns are tried by laying them.
TEST(Lattice, IsThatOfTheLeastDwell) {
    Numbers draw(3);
    for (int i = 0; i < 300; ++i) {
        const int n = 1 + i % 40;
        const double circuit = draw.between(0.0, 30.0);
        const Pattern p = lattice(circuit, n, 0.02);
        ASSERT_EQ(p.circuits, n);
        ASSERT_TRUE(evenly_spaced(laid(p.turn_rad, n)));
        ASSERT_NEAR(p.turn_rad, circuit + p.dwell_rad, 1e-12);
        ASSERT_GE(p.dwell_rad, 0.0);
        for (std::int64_t k = p.turns - 1; k >= 0; --k) {
            const double turn = kTurn_rad * static_cast<double>(k) / n;
            if (turn < circuit) {
                break;
            }
            ASSERT_FALSE(evenly_spaced(laid(turn, n)));
        }
        ASSERT_NEAR(p.overlap, n * 0.02 / kTurn_rad - 1.0, 1e-12);
    }
}

// Lattice after lattice, each further by a band: no gap is left, and one series fewer leaves some.
TEST(FillLattice, LeavesNoGap) {
    Numbers draw(4);
    for (int i = 0; i < 100; ++i) {
        const int n = 1 + i % 13;
        const double band = draw.between(0.01, 0.9);
        const Pattern p = lattice(draw.between(0.0, 30.0), n, band);
        const Series s = fill_lattice(p, band);
        const auto count = static_cast<double>(s.count);
        ASSERT_GE(count * band, p.step_rad);
        ASSERT_LT((count - 1.0) * band, p.step_rad);
        ASSERT_EQ(s.circuits, s.count * n);
        ASSERT_NEAR(s.overlap, (count * band - p.step_rad) / p.step_rad, 1e-12);
        ASSERT_NEAR(s.even_rad * count * n, kTurn_rad, 1e-12);
        ASSERT_NEAR(s.total_rad, count * (n * p.turn_rad + s.offset_rad), 1e-9);
    }
}

TEST(ClosureInSteps, RoundedSumsCloseExactly) {
    for (const PatternRequest& r : requests()) {
        std::vector<Pattern> patterns = find_patterns(r);
        patterns.resize(std::min<std::size_t>(patterns.size(), 10));
        for (const Pattern& p : patterns) {
            const StepClosure closure = closure_in_steps(p, {360'000, 1});
            ASSERT_EQ(closure.increments.size(), static_cast<std::size_t>(p.circuits));
            ASSERT_EQ(std::accumulate(closure.increments.begin(), closure.increments.end(),
                                      std::int64_t{0}),
                      p.turns * 360'000);
            ASSERT_EQ(closure.closure_rad, 0.0);
            const double step_rad = kTurn_rad / 360'000.0;
            std::int64_t sum = 0;
            double worst = 0.0;
            for (std::size_t i = 0; i < closure.increments.size(); ++i) {
                sum += closure.increments[i];
                worst = std::max(worst, std::abs(static_cast<double>(sum) * step_rad -
                                                 static_cast<double>(i + 1) * p.turn_rad));
            }
            ASSERT_NEAR(closure.worst_rad, worst, 1e-11);
            ASSERT_LE(closure.worst_rad, 0.5 * step_rad * (1.0 + 1e-12));
            const double single = std::round(p.turn_rad / step_rad) * step_rad;
            ASSERT_NEAR(
                closure.separate_rad,
                static_cast<double>(p.circuits) * single - kTurn_rad * static_cast<double>(p.turns),
                1e-9);
        }
    }
}

// By hand: 5 turns in 7 circuits are 257142.857 steps each, alone rounded to 257143.
TEST(ClosureInSteps, ExampleByHand) {
    const Pattern p = lattice(5.0 / 7.0 * kTurn_rad, 7, 0.1);
    EXPECT_EQ(p.turns, 5);
    const StepClosure closure = closure_in_steps(p, {});
    EXPECT_EQ(closure.increments,
              (std::vector<std::int64_t>{257143, 257143, 257143, 257142, 257143, 257143, 257143}));
    const double step_rad = kTurn_rad / 360'000.0;
    EXPECT_NEAR(closure.separate_rad, step_rad, 1e-15);  // 7 * 257143 = 1800001
    EXPECT_NEAR(closure.worst_rad, 3.0 / 7.0 * step_rad, 1e-15);
}

// A step of 7 thousandths does not divide the turn: 1 800 000 / 7 = 257142.857, off by 1.
TEST(ClosureInSteps, SaysWhatStepsThatDoNotDivideTheTurnLeave) {
    const Pattern p = lattice(5.0 / 7.0 * kTurn_rad, 7, 0.1);
    const StepClosure closure = closure_in_steps(p, {360'000, 7});
    EXPECT_NEAR(closure.closure_rad, kTurn_rad / 360'000.0, 1e-15);
}

// Sums of 1e9 turns in 1e-9 degrees stay exact.
TEST(ClosureInSteps, LargestSumsAreExact) {
    Pattern p;
    p.circuits = 9973;
    p.turns = 999'999'937;
    const StepClosure closure = closure_in_steps(p, {360'000'000'000, 1'000});
    EXPECT_EQ(std::accumulate(closure.increments.begin(), closure.increments.end(), std::int64_t{}),
              p.turns * 360'000'000);
    EXPECT_EQ(closure.closure_rad, 0.0);
    EXPECT_THROW((void)closure_in_steps(p, {0, 1}), InputError);
    EXPECT_THROW((void)closure_in_steps(p, {10, 11}), InputError);
}

}  // namespace
}  // namespace meshwind
