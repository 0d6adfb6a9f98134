/// The cylinder of the tests of covers, and what holds of every plan.
#pragma once

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel.h"
#include "tests/support/fixtures.h"
#include "winding/plan/plan.h"

namespace meshwind::test {

/// Radius of the machine's table about the mandrel.
inline constexpr double kTable_mm = 60.0;

/// The rules of a plan do not depend on how long it is improved.
inline constexpr double kQuickEffort = 0.2;

inline const Mandrel& wound_cylinder() {
    static const Mandrel mandrel = made_cylinder(30.0, 160.0, 5.0);
    return mandrel;
}

/// Joints within 0.2 mm and 0.5 degrees: a course ends on a chord of the rim, the turn begins on
/// its circle. The sagitta is up to edge^2 / (8 R), here 0.1 mm.
inline void expect_continuous(const Plan& plan) {
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
        const Piece& piece = plan.pieces[i];
        ASSERT_GE(piece.path.size(), 2U);
        ASSERT_EQ(piece.path.size(), piece.slip.size());
        ASSERT_EQ(piece.path.size(), piece.string.gap_mm.size());
        ASSERT_EQ(piece.path.size(), piece.string.slope.size());
        if (piece.starts_fibre) {
            continue;
        }
        ASSERT_GT(i, 0U);
        const PathPoint& end = plan.pieces[i - 1].path.back();
        const PathPoint& start = piece.path.front();
        EXPECT_LT((start.position_mm - end.position_mm).norm(), 0.2) << "piece " << i;
        EXPECT_GT(start.tangent.dot(end.tangent), std::cos(rad_from_deg(0.5))) << "piece " << i;
        EXPECT_EQ(plan.pieces[i - 1].end_rim, piece.start_rim);
        EXPECT_NE(plan.pieces[i - 1].kind, piece.kind);
    }
}

}  // namespace meshwind::test
