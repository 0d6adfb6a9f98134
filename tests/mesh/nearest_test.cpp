#include "mesh/nearest.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> random_points(std::mt19937_64& random, int count, double side_mm) {
    std::uniform_real_distribution<double> side(-side_mm, side_mm);
    std::vector<Vector3d> points;
    for (int i = 0; i < count; ++i) {
        const double x = side(random);
        const double y = side(random);
        points.emplace_back(x, y, side(random));
    }
    return points;
}

std::vector<std::int32_t> within_by_force(const std::vector<Vector3d>& points,
                                          const Vector3d& query, double radius_mm) {
    std::vector<std::int32_t> found;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if ((points[i] - query).norm() <= radius_mm) {
            found.push_back(static_cast<std::int32_t>(i));
        }
    }
    return found;
}

std::int32_t nearest_by_force(const std::vector<Vector3d>& points, const Vector3d& query) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        if ((points[i] - query).squaredNorm() < (points[best] - query).squaredNorm()) {
            best = i;
        }
    }
    return static_cast<std::int32_t>(best);
}

TEST(NearestPoints, AgreesWithBruteForce) {
    std::mt19937_64 random(11);
    const std::vector<Vector3d> points = random_points(random, 3000, 100.0);
    const NearestPoints tree(points);
    for (const Vector3d& query : random_points(random, 300, 130.0)) {
        EXPECT_EQ(tree.nearest(query), nearest_by_force(points, query));
        for (const double radius : {0.0, 5.0, 40.0}) {
            EXPECT_EQ(tree.within(query, radius), within_by_force(points, query, radius));
        }
    }
}

// On a lattice many points are equally near, and the sphere's points are exactly on it.
TEST(NearestPoints, TakesTheLowestOfEqualsAndTheRimOfTheSphere) {
    std::vector<Vector3d> points;
    for (int i = 0; i < 1000; ++i) {
        points.emplace_back(i % 10, i / 10 % 10, i / 100);
    }
    const NearestPoints tree(points);
    for (const Vector3d& query :
         {Vector3d(4.5, 4.5, 4.5), Vector3d(3, 3.5, 7), Vector3d(2, 2, 2)}) {
        EXPECT_EQ(tree.nearest(query), nearest_by_force(points, query));
        EXPECT_EQ(tree.within(query, 3.0), within_by_force(points, query, 3.0));
    }
    EXPECT_EQ(tree.within({4, 4, 4}, 1.0).size(), 7U);
    EXPECT_EQ(tree.within({4, 4, 4}, 0.0).size(), 1U);
}

// Differences below single precision count.
TEST(NearestPoints, IsExactBelowSinglePrecision) {
    const NearestPoints tree(std::vector<Vector3d>{{1.0 + 1e-9, 0, 0}, {1, 0, 0}, {0, -1, 0}});
    EXPECT_EQ(tree.nearest(Vector3d::Zero()), 1);
    EXPECT_EQ(tree.within(Vector3d::Zero(), 1.0), (std::vector<std::int32_t>{1, 2}));
}

TEST(NearestPoints, HandlesCopiesOfOnePoint) {
    const NearestPoints tree(std::vector<Vector3d>(50, Vector3d(1, 2, 3)));
    EXPECT_EQ(tree.nearest({5, 5, 5}), 0);
    EXPECT_EQ(tree.within({1, 2, 3}, 0.0).size(), 50U);
}

TEST(NearestPoints, AnswersWithoutPoints) {
    const NearestPoints tree(std::vector<Vector3d>{});
    EXPECT_EQ(tree.nearest(Vector3d::Zero()), -1);
    EXPECT_TRUE(tree.within(Vector3d::Zero(), 1.0).empty());
}

}  // namespace
}  // namespace meshwind
