#include "mesh/ray_query.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kSeed = 17;
constexpr int kQueries = 2000;
constexpr double kSide_mm = 100.0;
// Embree stores single precision: 6e-8 of 200 mm, and a few roundings of the intersection.
constexpr double kSingle_mm = 1e-3;

struct Triangle {
    Vector3d a, b, c;
};

Vector3d random_point(std::mt19937_64& random, double side_mm = kSide_mm) {
    std::uniform_real_distribution<double> side(-side_mm, side_mm);
    const double x = side(random);
    const double y = side(random);
    return {x, y, side(random)};
}

// Two soups of scattered triangles of some 60 mm.
std::vector<TriangleSoup> random_parts(std::mt19937_64& random) {
    std::vector<TriangleSoup> parts(2);
    for (TriangleSoup& soup : parts) {
        for (std::int32_t f = 0; f < 100; ++f) {
            const Vector3d centre = random_point(random);
            for (int i = 0; i < 3; ++i) {
                soup.points_mm.push_back(centre + random_point(random, 30.0));
            }
            soup.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
        }
    }
    return parts;
}

Triangle triangle_of(const TriangleSoup& soup, std::size_t f) {
    const auto& [a, b, c] = soup.faces[f];
    return {soup.points_mm[static_cast<std::size_t>(a)],
            soup.points_mm[static_cast<std::size_t>(b)],
            soup.points_mm[static_cast<std::size_t>(c)]};
}

std::vector<Triangle> triangles_of(const std::vector<TriangleSoup>& parts) {
    std::vector<Triangle> triangles;
    for (const TriangleSoup& soup : parts) {
        for (std::size_t f = 0; f < soup.faces.size(); ++f) {
            triangles.push_back(triangle_of(soup, f));
        }
    }
    return triangles;
}

// Where the line meets the triangle whose edges are moved outward by `slack` (share of the size).
std::optional<double> meet(const Vector3d& origin, const Vector3d& direction, const Triangle& t,
                           double slack) {
    Eigen::Matrix3d m;
    m << t.b - t.a, t.c - t.a, -direction;
    const Vector3d x = m.fullPivLu().solve(origin - t.a);
    const bool inside = x[0] >= -slack && x[1] >= -slack && x[0] + x[1] <= 1.0 + slack;
    return inside ? std::optional(x[2]) : std::nullopt;
}

double first_hit_by_force(const std::vector<Triangle>& triangles, const Vector3d& origin,
                          const Vector3d& direction, double max, double slack) {
    double first = max;
    for (const Triangle& t : triangles) {
        const auto hit = meet(origin, direction, t, slack);
        if (hit && *hit >= 0.0) {
            first = std::min(first, *hit);
        }
    }
    return first;
}

double to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
    const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (a + share * (b - a) - p).norm();
}

double to_triangle(const Vector3d& p, const Triangle& t) {
    const Vector3d n = (t.b - t.a).cross(t.c - t.a).normalized();
    const auto below = meet(p, n, t, 0.0);
    const double edges =
        std::min({to_segment(p, t.a, t.b), to_segment(p, t.b, t.c), to_segment(p, t.c, t.a)});
    return below ? std::min(std::abs(*below), edges) : edges;
}

// Least distance of two segments: inside both, or at one of the four ends.
double between_segments(const Vector3d& p, const Vector3d& q, const Vector3d& a,
                        const Vector3d& b) {
    double least = std::min(
        {to_segment(p, a, b), to_segment(q, a, b), to_segment(a, p, q), to_segment(b, p, q)});
    Eigen::Matrix<double, 3, 2> m;
    m << q - p, a - b;
    const Eigen::Vector2d x = (m.transpose() * m).inverse() * m.transpose() * (a - p);
    if (x.minCoeff() >= 0.0 && x.maxCoeff() <= 1.0) {
        least = std::min(least, (p + x[0] * (q - p) - a - x[1] * (b - a)).norm());
    }
    return least;
}

double segment_to_triangle(const Vector3d& p, const Vector3d& q, const Triangle& t) {
    const auto hit = meet(p, q - p, t, 0.0);
    if (hit && *hit >= 0.0 && *hit <= 1.0) {
        return 0.0;
    }
    return std::min({to_triangle(p, t), to_triangle(q, t), between_segments(p, q, t.a, t.b),
                     between_segments(p, q, t.b, t.c), between_segments(p, q, t.c, t.a)});
}

// A ray within `kSlack` of an edge may be decided either way in single precision; those are few.
TEST(RayQuery, FirstHitAgreesWithBruteForce) {
    constexpr double kSlack = 1e-5;
    std::mt19937_64 random(kSeed);
    const auto parts = random_parts(random);
    const auto triangles = triangles_of(parts);
    const RayQuery rays(parts);
    int hits = 0;
    int undecided = 0;
    for (int i = 0; i < kQueries; ++i) {
        const Vector3d origin = random_point(random);
        const Vector3d direction = random_point(random).normalized();
        const double max_mm = i % 2 == 0 ? 500.0 : 80.0;
        const double wide = first_hit_by_force(triangles, origin, direction, max_mm, kSlack);
        const double tight = first_hit_by_force(triangles, origin, direction, max_mm, -kSlack);
        if (wide != tight) {
            ++undecided;
            continue;
        }
        const double hit = rays.first_hit_mm(origin, direction, max_mm);
        // The grazing of a flat triangle stretches the error by 1 / sine: 100 covers the seed.
        EXPECT_NEAR(hit, wide, 100.0 * kSingle_mm) << "seed " << kSeed << " query " << i;
        hits += hit < max_mm ? 1 : 0;
    }
    EXPECT_GT(hits, kQueries / 8);
    EXPECT_LT(undecided, kQueries / 100);
}

TEST(RayQuery, OccludedAgreesWithBruteForce) {
    constexpr double kSlack = 1e-4;
    std::mt19937_64 random(kSeed + 1);
    const auto parts = random_parts(random);
    const auto triangles = triangles_of(parts);
    const RayQuery rays(parts);
    int occluded = 0;
    int undecided = 0;
    for (int i = 0; i < kQueries; ++i) {
        const Vector3d from = random_point(random);
        const Vector3d to = random_point(random);
        const bool wide =
            first_hit_by_force(triangles, from, to - from, 2.0, kSlack) <= 1.0 + kSlack;
        const bool tight =
            first_hit_by_force(triangles, from, to - from, 2.0, -kSlack) <= 1.0 - kSlack;
        if (wide != tight) {
            ++undecided;
            continue;
        }
        EXPECT_EQ(rays.occluded(from, to), wide) << "seed " << kSeed + 1 << " query " << i;
        occluded += wide ? 1 : 0;
    }
    EXPECT_GT(occluded, kQueries / 8);
    EXPECT_LT(undecided, kQueries / 100);
}

// Closest points are computed in double: only rounding is allowed.
TEST(RayQuery, ClosestAgreesWithBruteForce) {
    std::mt19937_64 random(kSeed + 2);
    const auto parts = random_parts(random);
    const auto triangles = triangles_of(parts);
    const RayQuery rays(parts);
    for (int i = 0; i < kQueries; ++i) {
        const Vector3d query = random_point(random, 1.5 * kSide_mm);
        const double radius_mm = i % 2 == 0 ? 1000.0 : 10.0;
        double least = radius_mm;
        for (const Triangle& t : triangles) {
            least = std::min(least, to_triangle(query, t));
        }
        const ClosestPoint found = rays.closest(query, radius_mm);
        // Embree prunes by single precision: a triangle that is nearer by less may be passed over.
        ASSERT_NEAR(found.distance_mm, least, 1e-4) << "seed " << kSeed + 2 << " query " << i;
        EXPECT_EQ(found.part < 0, found.distance_mm == radius_mm);
        if (found.part >= 0) {
            const Triangle t = triangle_of(parts[static_cast<std::size_t>(found.part)],
                                           static_cast<std::size_t>(found.face));
            const Vector3d p = found.bary[0] * t.a + found.bary[1] * t.b + found.bary[2] * t.c;
            EXPECT_NEAR(found.bary.sum(), 1.0, 1e-12);
            EXPECT_GE(found.bary.minCoeff(), 0.0);
            EXPECT_LT((p - found.position_mm).norm(), 1e-11);
            EXPECT_NEAR((found.position_mm - query).norm(), found.distance_mm, 1e-11);
            EXPECT_NEAR(to_triangle(query, t), found.distance_mm, 1e-9);
        }
    }
}

// Between the radius and 1.01 of it both answers are right; nearer or farther there is one.
// The table only says where to begin to look.
TEST(RayQuery, ClosestIsTheSameWithATable) {
    std::mt19937_64 random(kSeed + 6);
    const auto parts = random_parts(random);
    const RayQuery plain(parts);
    const RayQuery tabulated(parts, 0.3 * kSide_mm);
    for (int i = 0; i < 20 * kQueries; ++i) {
        Vector3d query = random_point(random, 2.0 * kSide_mm);
        if (i % 3 == 0) {  // on a triangle, where there is least room
            query = plain.closest(query, 1e4).position_mm;
        }
        const double radius_mm = i % 2 == 0 ? 1000.0 : 10.0;
        const ClosestPoint with = tabulated.closest(query, radius_mm);
        const ClosestPoint without = plain.closest(query, radius_mm);
        ASSERT_EQ(with.part < 0, without.part < 0) << "query " << i;
        ASSERT_NEAR(with.distance_mm, without.distance_mm, 1e-4) << "query " << i;
    }
}

TEST(RayQuery, CapsuleClearIsConservativeByOnePercent) {
    std::mt19937_64 random(kSeed + 3);
    const auto parts = random_parts(random);
    const auto triangles = triangles_of(parts);
    const RayQuery rays(parts);
    std::uniform_real_distribution<double> radii(0.5, 10.0);
    int clear = 0;
    for (int i = 0; i < kQueries; ++i) {
        const Vector3d from = random_point(random);
        const Vector3d to = from + random_point(random, 40.0);
        const double radius_mm = radii(random);
        double least = 1e9;
        for (const Triangle& t : triangles) {
            least = std::min(least, segment_to_triangle(from, to, t));
        }
        const bool answer = rays.capsule_clear(from, to, radius_mm);
        if (least < radius_mm - kSingle_mm) {
            EXPECT_FALSE(answer) << "seed " << kSeed + 3 << " query " << i;
        } else if (least > 1.01 * radius_mm + kSingle_mm) {
            EXPECT_TRUE(answer) << "seed " << kSeed + 3 << " query " << i;
        }
        clear += answer ? 1 : 0;
    }
    EXPECT_GT(clear, kQueries / 10);
    EXPECT_LT(clear, kQueries - kQueries / 10);
}

// Equally near triangles: the lowest part and face, whatever the traversal order.
// A bent pipe and a plate that stands out to one side: far from a body of revolution.
std::vector<TriangleSoup> uneven_parts() {
    std::vector<TriangleSoup> parts(2);
    constexpr int kAround = 12;
    for (int ring = 0; ring < 10; ++ring) {
        const double z = 20.0 * ring - 90.0;
        for (int i = 0; i < kAround; ++i) {
            const double turn = 2.0 * std::numbers::pi * i / kAround;
            const double bend = 0.002 * z * z;
            parts[0].points_mm.emplace_back(bend + 15.0 * std::cos(turn), 15.0 * std::sin(turn), z);
        }
    }
    for (std::int32_t ring = 0; ring < 9; ++ring) {
        for (std::int32_t i = 0; i < kAround; ++i) {
            const std::int32_t a = ring * kAround + i;
            const std::int32_t b = ring * kAround + (i + 1) % kAround;
            parts[0].faces.push_back({a, b, a + kAround});
            parts[0].faces.push_back({b, b + kAround, a + kAround});
        }
    }
    parts[1].points_mm = {{0.0, 0.0, -10.0}, {0.0, 80.0, 0.0}, {0.0, 0.0, 30.0}};
    parts[1].faces = {{0, 1, 2}};
    return parts;
}

TEST(RayQuery, WhatIsKnownToBeBeyondIs) {
    const std::vector<TriangleSoup> parts = uneven_parts();
    const RayQuery bare(parts);  // without a table: by the reach from the axis alone
    const RayQuery tabled(parts, 30.0);
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> far(0.0, 60.0);
    int known_bare = 0;
    int known_tabled = 0;
    for (int i = 0; i < kQueries; ++i) {
        const Vector3d place = random_point(random, 130.0);
        const double distance = far(random);
        const bool is_so = bare.closest(place, 1000.0).distance_mm >= distance - kSingle_mm;
        EXPECT_TRUE(is_so || !bare.is_beyond(place, distance)) << place.transpose();
        EXPECT_TRUE(is_so || !tabled.is_beyond(place, distance)) << place.transpose();
        known_bare += bare.is_beyond(place, distance) ? 1 : 0;
        known_tabled += tabled.is_beyond(place, distance) ? 1 : 0;
    }
    EXPECT_GT(known_bare, kQueries / 4);
    EXPECT_GE(known_tabled, known_bare);
}

// On a pipe about the Z axis the bound is the distance itself, but for a bin at its ends.
TEST(RayQuery, BeyondIsExactAroundABodyOfRevolution) {
    std::vector<TriangleSoup> parts = uneven_parts();
    parts.pop_back();
    for (Vector3d& point : parts[0].points_mm) {
        point.x() -= 0.002 * point.z() * point.z();
    }
    const RayQuery query(parts);
    const Vector3d place(40.0, 0.0, 10.0);  // at a corner of the rings
    EXPECT_TRUE(query.is_beyond(place, 25.0 - 1e-6));
    EXPECT_FALSE(query.is_beyond(place, 25.0 + 1e-6));
    EXPECT_TRUE(query.is_beyond({0.0, 0.0, 120.0}, 29.0));
    EXPECT_FALSE(query.is_beyond({0.0, 0.0, 120.0}, 31.0));
}

TEST(RayQuery, RoomIsWhereTheEstimateSaysSo) {
    constexpr double kReach_mm = 30.0;
    const RayQuery query(uneven_parts(), kReach_mm);
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> needs(0.0, 40.0);
    int known = 0;
    for (int i = 0; i < kQueries; ++i) {
        const Vector3d place = random_point(random, 160.0);
        const double need = needs(random);
        const double from = query.room_from_mm(place.z(), need);
        if (std::hypot(place.x(), place.y()) <= from) {
            continue;
        }
        ++known;
        EXPECT_LT(need, kReach_mm);
        EXPECT_GE(query.distance_estimate_mm(place), need) << place.transpose();
    }
    EXPECT_GT(known, kQueries / 4);
    EXPECT_EQ(RayQuery(uneven_parts()).room_from_mm(0.0, 1.0),
              std::numeric_limits<double>::infinity());
}

// A tube of metres: the cells of its table are some 40 mm long. Within one from the wall they would
// tell up to half of that too much.
TEST(RayQuery, AroundALargePartTellsTheDistanceAtTheWall) {
    constexpr double kRadius_mm = 1000.0;
    constexpr double kHalf_mm = 1500.0;
    constexpr double kReach_mm = 60.0;
    constexpr std::int32_t kAround = 96;
    TriangleSoup tube;
    for (std::int32_t i = 0; i < kAround; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kAround;
        for (const double z : {-kHalf_mm, kHalf_mm}) {
            tube.points_mm.emplace_back(kRadius_mm * std::cos(angle), kRadius_mm * std::sin(angle),
                                        z);
        }
        const std::int32_t next = (i + 1) % kAround;
        tube.faces.push_back({2 * i, 2 * next, 2 * i + 1});
        tube.faces.push_back({2 * next, 2 * next + 1, 2 * i + 1});
    }
    const RayQuery query({&tube, 1}, kReach_mm);
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> angles(0.0, 2.0 * std::numbers::pi);
    std::uniform_real_distribution<double> shares(0.0, 1.0);
    int room = 0;
    for (int i = 0; i < kQueries; ++i) {
        const double angle = angles(random);
        const double radius_mm = kRadius_mm + 3.0 * kReach_mm * shares(random);
        const Vector3d place(radius_mm * std::cos(angle), radius_mm * std::sin(angle),
                             kHalf_mm * (shares(random) - 0.5));
        // A facet is 2 pi / 96 wide: R (1 - cos(pi / 96)) = 0.54 mm deep. Further out the table
        // tells a distance to a wall that is curved by 1e-3 / mm: 40^2 / 8 of that.
        const double clear_mm = radius_mm - kRadius_mm;
        EXPECT_LE(query.distance_estimate_mm(place), clear_mm + 0.54 + 0.2);
        const double need_mm = 0.5 * kReach_mm * shares(random);
        if (radius_mm > query.room_from_mm(place.z(), need_mm)) {
            EXPECT_GE(query.distance_estimate_mm(place), need_mm);
            ++room;
        }
    }
    EXPECT_GT(room, 0);
}

TEST(RayQuery, ClosestTakesTheLowestOfEquals) {
    TriangleSoup fan;
    fan.points_mm = {{0, 0, 0}};
    for (std::int32_t i = 0; i < 24; ++i) {
        fan.points_mm.emplace_back(10.0 * std::cos(0.26 * i), 10.0 * std::sin(0.26 * i), 0.0);
    }
    for (std::int32_t i = 1; i < 24; ++i) {
        fan.faces.push_back({0, i, i + 1});
    }
    const RayQuery rays(std::vector<TriangleSoup>{fan, fan});
    const ClosestPoint found = rays.closest({0, 0, 5}, 100.0);
    EXPECT_EQ(found.part, 0);
    EXPECT_EQ(found.face, 0);
    EXPECT_DOUBLE_EQ(found.distance_mm, 5.0);
}

TEST(RayQuery, AnswersWithoutTriangles) {
    for (const std::size_t count : {0U, 1U}) {
        const RayQuery rays(std::vector<TriangleSoup>{count, TriangleSoup{}});
        EXPECT_EQ(rays.first_hit_mm({0, 0, 0}, {0, 0, 1}, 7.0), 7.0);
        EXPECT_FALSE(rays.occluded({0, 0, 0}, {0, 0, 9}));
        EXPECT_EQ(rays.closest({0, 0, 0}, 3.0).part, -1);
        EXPECT_EQ(rays.closest({0, 0, 0}, 3.0).distance_mm, 3.0);
        EXPECT_TRUE(rays.capsule_clear({0, 0, 0}, {0, 0, 9}, 1.0));
    }
}

long address_space_mb() {
    constexpr long kPage_kb = 4;
    constexpr long kKbPerMb = 1024;
    long pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * kPage_kb / kKbPerMb;
}

// Faces of a CAD part have a query each, and its reader works within bounds: with a device of its
// own each took half a MB of address space.
TEST(RayQuery, AThousandAtOnceTakeLittleAddressSpace) {
    TriangleSoup soup;
    soup.points_mm = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    soup.faces = {{0, 1, 2}};
    std::vector<RayQuery> queries;
    queries.emplace_back(std::span(&soup, 1));
    const long before_mb = address_space_mb();
    for (int i = 0; i < 1000; ++i) {
        queries.emplace_back(std::span(&soup, 1));
    }
    EXPECT_LT(address_space_mb() - before_mb, 300);  // 140; with their own 600
}

}  // namespace
}  // namespace meshwind
