#include "winding/laminate/coverage.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

TEST(MeasureCoverage, NinetyNineInAHundredHaveTheFirstPercentileAtLeast) {
    std::vector<std::int32_t> layers(1000, 3);
    std::fill(layers.begin(), layers.begin() + 10, 0);
    std::fill(layers.begin() + 10, layers.begin() + 40, 2);
    EXPECT_EQ(measure_coverage(layers).p1_layers, 2);
    layers[10] = 0;
    EXPECT_EQ(measure_coverage(layers).p1_layers, 0);
    // Of those in reach three in a hundred are thin, and none is bare.
    std::vector<char> reached(layers.size(), 1);
    std::fill(reached.begin(), reached.begin() + 11, 0);
    EXPECT_EQ(measure_coverage(layers, reached).p1_layers, 2);
    EXPECT_EQ(measure_coverage(layers, std::vector<char>(layers.size(), 0)).p1_layers, 0);
    EXPECT_EQ(measure_coverage(layers, reached).fraction, measure_coverage(layers).fraction);
}

Piece straight(PieceKind kind, double length_mm) {
    Piece piece;
    piece.kind = kind;
    piece.path.resize(2);
    piece.path.back().s_mm = length_mm;
    return piece;
}

TEST(FibreUse, CountsTurnsAndAllOverTheLayersAskedFor) {
    Plan plan;
    plan.pieces = {straight(PieceKind::Course, 300.0), straight(PieceKind::Transition, 150.0),
                   straight(PieceKind::Course, 50.0)};
    plan.fibre_length_mm = 500.0;
    const FibreUse use = fibre_use(plan, 10.0, 1000.0, 2.0);
    EXPECT_DOUBLE_EQ(use.factor, 2.5);
    EXPECT_DOUBLE_EQ(use.turn_share, 0.3);
    EXPECT_EQ(fibre_use(Plan(), 10.0, 1000.0, 2.0).factor, 0.0);
}

}  // namespace
}  // namespace meshwind
