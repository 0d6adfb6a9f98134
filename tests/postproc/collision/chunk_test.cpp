#include "postproc/collision/chunk.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

Vector3d random_point(test::Draw& draw, double size) {
    return {draw.between(-size, size), draw.between(-size, size), draw.between(-size, size)};
}

// Nearest weights that are not negative and add up to one.
Vector3d on_simplex(const Vector3d& weights, int count) {
    std::vector<double> sorted(weights.data(), weights.data() + count);
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    double sum = 0.0;
    double shift = 0.0;
    for (int k = 0; k < count; ++k) {
        sum += sorted[static_cast<std::size_t>(k)];
        const double candidate = (sum - 1.0) / (k + 1);
        if (sorted[static_cast<std::size_t>(k)] > candidate) {
            shift = candidate;
        }
    }
    Vector3d result = Vector3d::Zero();
    for (int k = 0; k < count; ++k) {
        result[k] = std::max(weights[k] - shift, 0.0);
    }
    return result;
}

// Least distance of two convex hulls by descent on the weights of their corners: knows nothing of
// sides and faces.
double searched_distance(const Chunk& a, const Chunk& b) {
    Eigen::Matrix3d p;
    Eigen::Matrix3d q;
    for (Eigen::Index i = 0; i < 3; ++i) {
        p.col(i) = a.corner[static_cast<std::size_t>(i)];
        q.col(i) = b.corner[static_cast<std::size_t>(i)];
    }
    const double step = 1.0 / (p.squaredNorm() + q.squaredNorm());
    Vector3d x = on_simplex(Vector3d::Zero(), a.corners);
    Vector3d y = on_simplex(Vector3d::Zero(), b.corners);
    Vector3d ahead_x = x;
    Vector3d ahead_y = y;
    double least = 1e300;
    for (int i = 1; i <= 4000; ++i) {
        const Vector3d gap = p * ahead_x - q * ahead_y;
        const Vector3d next_x = on_simplex(ahead_x - step * (p.transpose() * gap), a.corners);
        const Vector3d next_y = on_simplex(ahead_y + step * (q.transpose() * gap), b.corners);
        const double momentum = (i - 1.0) / (i + 2.0);
        ahead_x = next_x + momentum * (next_x - x);
        ahead_y = next_y + momentum * (next_y - y);
        x = next_x;
        y = next_y;
        least = std::min(least, (p * x - q * y).norm());
    }
    return least;
}

Chunk random_chunk(test::Draw& draw, int corners) {
    Chunk chunk;
    chunk.corners = corners;
    chunk.radius_mm = draw.between(0.1, 2.0);
    for (Vector3d& corner : chunk.corner) {
        corner = random_point(draw, 10.0);
    }
    return chunk;
}

TEST(ChunkDistance, AgreesWithASearch) {
    test::Draw draw(1);
    for (const auto& [a, b] : {std::pair{2, 2}, {2, 3}, {3, 2}, {3, 3}}) {
        for (int i = 0; i < 60; ++i) {
            const Chunk first = random_chunk(draw, a);
            const Chunk second = random_chunk(draw, b);
            const double found =
                chunk_distance_mm(first, second) + first.radius_mm + second.radius_mm;
            const double searched = searched_distance(first, second);
            EXPECT_LE(found, searched + 1e-9);
            EXPECT_NEAR(found, searched, 2e-3) << a << b;
        }
    }
}

TEST(ChunkDistance, ClosedForms) {
    const Vector3d o = Vector3d::Zero();
    const Vector3d x = Vector3d::UnitX();
    const Vector3d y = Vector3d::UnitY();
    const Vector3d z = Vector3d::UnitZ();
    EXPECT_DOUBLE_EQ(segment_distance_mm(-x, x, z - y, z + y), 1.0);         // skew
    EXPECT_DOUBLE_EQ(segment_distance_mm(o, x, 3.0 * y, 3.0 * y + x), 3.0);  // parallel
    EXPECT_DOUBLE_EQ(segment_distance_mm(o, x, 4.0 * x, 9.0 * x), 3.0);      // in line
    EXPECT_DOUBLE_EQ(segment_distance_mm(o, o, 3.0 * x, 3.0 * x + 4.0 * y), 3.0);
    EXPECT_DOUBLE_EQ(segment_distance_mm(o, o, 3.0 * x + 4.0 * y, 3.0 * x + 4.0 * y), 5.0);
    EXPECT_DOUBLE_EQ(segment_distance_mm(-x, x, -y, y), 0.0);
    const std::array<Vector3d, 3> t{o, 2.0 * x, 2.0 * y};
    EXPECT_DOUBLE_EQ(triangle_distance_mm(0.5 * x + 0.5 * y - 7.0 * z, t), 7.0);
    EXPECT_DOUBLE_EQ(triangle_distance_mm(2.0 * x + 2.0 * y, t), std::sqrt(2.0));
    const Chunk face{t, 3, 0.0};
    const Chunk needle{{0.2 * x + 0.2 * y + z, 0.2 * x + 0.2 * y - z, o}, 2, 0.25};
    EXPECT_DOUBLE_EQ(chunk_distance_mm(face, needle), -0.25);
    EXPECT_DOUBLE_EQ(chunk_distance_mm(needle, face), -0.25);
}

TEST(CapsuleMesh, HoldsTheCapsuleAndSticksOutByNoMoreThanSaid) {
    test::Draw draw(2);
    for (const double radius : {0.5, 3.0, 60.0, 400.0}) {
        for (const double outside : {0.1, 2.0}) {
            for (const bool ball : {true, false}) {
                Capsule capsule;
                capsule.from_mm = random_point(draw, 100.0);
                capsule.to_mm = ball ? capsule.from_mm : random_point(draw, 100.0);
                capsule.radius_mm = radius;
                const TriangleSoup mesh = capsule_mesh(capsule, outside);
                const Chunk axis{{capsule.from_mm, capsule.to_mm, capsule.to_mm}, 2, 0.0};
                double nearest = 1e300;
                double furthest = 0.0;
                double volume = 0.0;
                for (const Chunk& face : chunks_of(mesh)) {
                    nearest = std::min(nearest, chunk_distance_mm(axis, face));
                    for (const Vector3d& corner : face.corner) {
                        furthest = std::max(
                            furthest,
                            segment_distance_mm(corner, corner, axis.corner[0], axis.corner[1]));
                    }
                    const auto& c = face.corner;
                    volume += (c[0] - capsule.from_mm)
                                  .dot((c[1] - capsule.from_mm).cross(c[2] - capsule.from_mm)) /
                              6.0;
                }
                EXPECT_GE(nearest, radius * (1.0 - 1e-12));
                EXPECT_LE(furthest, radius + outside + 1e-9);
                // Closed and turned outward: the divergence theorem gives what lies between.
                const auto filled = [&](double r) {
                    const double length = (capsule.to_mm - capsule.from_mm).norm();
                    return kPi * r * r * (length + 4.0 / 3.0 * r);
                };
                EXPECT_GT(volume, filled(radius));
                EXPECT_LT(volume, filled(radius + outside));
            }
        }
    }
}

}  // namespace
}  // namespace meshwind
