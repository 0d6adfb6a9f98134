#include "core/small_linear.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

Vector3d drawn(std::uint64_t seed) {
    return {random_unit(seed, 0) - 0.5, random_unit(seed, 1) - 0.5, random_unit(seed, 2) - 0.5};
}

// Axes that are turned about a drawn way, and values that are known.
TEST(PrincipalAxes, AreThoseThatAMatrixIsMadeOf) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(2.0 * kPi * random_unit(seed, 3), drawn(seed).normalized())
                .toRotationMatrix();
        const Vector3d values(-2.0, 0.5, 3.0);
        const PrincipalAxes<3> found =
            principal_axes(Eigen::Matrix3d(turn * values.asDiagonal() * turn.transpose()));
        EXPECT_LT((found.values - values).norm(), 1e-12);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(std::abs(found.vectors.col(i).dot(turn.col(i))), 1.0, 1e-12);
        }
    }
    Eigen::Matrix2d lower;
    lower << 1.0, 99.0, 2.0, 1.0;  // what stands above the diagonal is not read
    EXPECT_NEAR(principal_axes(lower).values[0], -1.0, 1e-14);
    EXPECT_NEAR(principal_axes(lower).values[1], 3.0, 1e-14);
}

// Their squares sum up to those of the entries, and a product of two orthogonal columns has their
// lengths.
TEST(SingularValues, AreLengthsOfOrthogonalColumns) {
    Eigen::MatrixXd matrix(4, 2);
    matrix << 1.0, 2.0, 1.0, -2.0, 1.0, 2.0, 1.0, -2.0;
    const Eigen::VectorXd values = singular_values(matrix);
    ASSERT_EQ(values.size(), 2);
    EXPECT_NEAR(values[0], 4.0, 1e-14);
    EXPECT_NEAR(values[1], 2.0, 1e-14);
}

TEST(ShortestTurn, TakesOneWayToTheOtherByTheAngleBetweenThem) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const Vector3d from = drawn(seed).normalized();
        const Vector3d to = drawn(seed + 1000).normalized();
        const Eigen::Quaterniond turn = shortest_turn(from, to);
        EXPECT_LT((turn * from - to).norm(), 1e-14);
        EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(), std::acos(from.dot(to)), 1e-7);
    }
    const Eigen::Quaterniond half = shortest_turn(Vector3d::UnitX(), -Vector3d::UnitX());
    EXPECT_LT((half * Vector3d::UnitX() + Vector3d::UnitX()).norm(), 1e-7);
}

}  // namespace
}  // namespace meshwind
