#include "postproc/eye/eye_path.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 40.0;

// A 45 degree helix on a cylinder about Z, as a finished piece.
Piece helix(double length_mm) {
    Piece piece;
    const double c = std::sqrt(0.5);
    for (double s = 0.0; s <= length_mm + 1e-9; s += 4.0) {
        const double azimuth = s * c / kRadius_mm;
        PathPoint p;
        p.normal = {std::cos(azimuth), std::sin(azimuth), 0.0};
        p.position_mm = kRadius_mm * p.normal + c * s * Vector3d::UnitZ();
        p.tangent = c * (Vector3d::UnitZ().cross(p.normal) + Vector3d::UnitZ());
        p.s_mm = s;
        p.kn_per_mm = 0.5 / kRadius_mm;
        piece.path.push_back(p);
        piece.slip.push_back(0.0);
        piece.string.gap_mm.push_back(0.0);
        piece.string.slope.push_back(0.0);
    }
    return piece;
}

FreeFibreRule rule_of(double preferred_mm) {
    FreeFibreRule rule;
    rule.min_mm = 40.0;
    rule.preferred_mm = preferred_mm;
    rule.max_mm = 400.0;
    return rule;
}

RayQuery nothing_near() {
    const TriangleSoup far = test::box({9e3, 9e3, 9e3}, {9001.0, 9001.0, 9001.0});
    return RayQuery({&far, 1});
}

void expect_eye_on_the_free_fibre(const EyePath& path) {
    for (const EyePoint& p : path) {
        ASSERT_LT((p.eye_mm - (p.landing_mm + p.free_length_mm * p.tangent)).norm(), 1e-9);
        ASSERT_NEAR(p.tangent.norm(), 1.0, 1e-12);
        ASSERT_NEAR(p.binormal.norm(), 1.0, 1e-12);
        ASSERT_NEAR(p.binormal.dot(p.tangent), 0.0, 1e-12);
    }
}

void expect_rates(const EyePath& path) {
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double ds = path[i].s_mm - path[i - 1].s_mm;
        const double change = path[i].free_length_mm - path[i - 1].free_length_mm;
        ASSERT_LE(change, kLengtheningRate * ds + 1e-9) << i;
        ASSERT_GE(change, -kShorteningRate * ds - 1e-9) << i;
    }
}

TEST(AdaptiveFreeLength, KeepsThePreferredLengthWhereNothingIsInTheWay) {
    const std::vector<Piece> pieces{helix(100.0), helix(60.0)};
    const EyePathResult eyes = adaptive_free_length(pieces, nothing_near(), rule_of(200.0));
    ASSERT_EQ(eyes.path.size(), 26U + 16U);
    EXPECT_TRUE(eyes.blocked.empty());
    EXPECT_EQ(eyes.shortest_mm, 200.0);
    EXPECT_EQ(eyes.longest_mm, 200.0);
    expect_eye_on_the_free_fibre(eyes.path);
    EXPECT_EQ(eyes.path[26].piece, 1);
    EXPECT_EQ(eyes.path[26].point, 0);
    EXPECT_NEAR(eyes.path[26].s_mm, 100.0, 1e-12);
    EXPECT_NEAR(eyes.path.back().s_mm, 160.0, 1e-12);
    EXPECT_NEAR(eyes.path[5].binormal.dot(pieces[0].path[5].normal), 0.0, 1e-12);
}

// From the station before a bridge to the one after it the fibre is one straight line.
TEST(AdaptiveFreeLength, TakesStationsUnderABridgeOnTheStraightFibre) {
    std::vector<Piece> pieces{helix(20.0)};
    for (const std::size_t i : {2U, 3U}) {
        pieces[0].string.gap_mm[i] = 0.4;
    }
    const SurfacePath& wall = pieces[0].path;
    const EyePath path = adaptive_free_length(pieces, nothing_near(), rule_of(200.0)).path;
    const Vector3d chord = wall[4].position_mm - wall[1].position_mm;
    for (const std::size_t i : {2U, 3U}) {
        const Vector3d place = wall[1].position_mm + static_cast<double>(i - 1) / 3.0 * chord;
        EXPECT_LT((path[i].landing_mm - place).norm(), 1e-12);
        EXPECT_LT((path[i].tangent - chord.normalized()).norm(), 1e-12);
        EXPECT_NEAR(path[i].binormal.dot(wall[i].normal), 0.0, 1e-12);
    }
    for (const std::size_t i : {1U, 4U}) {
        EXPECT_EQ(path[i].landing_mm, wall[i].position_mm);
        EXPECT_EQ(path[i].tangent, wall[i].tangent);
    }
    expect_eye_on_the_free_fibre(path);
}

// The fibre that is in the air over a hollow is not the free one: that begins where it lands.
TEST(AdaptiveFreeLength, CountsFromTheFarEndOfABridge) {
    std::vector<Piece> pieces{helix(60.0)};
    for (const std::size_t i : {7U, 8U}) {
        pieces[0].string.gap_mm[i] = 0.4;
    }
    FreeFibreRule rule = rule_of(200.0);
    rule.min_mm = 200.0;
    const EyePathResult eyes = adaptive_free_length(pieces, nothing_near(), rule);
    EXPECT_TRUE(eyes.blocked.empty());
    const Vector3d& lands = pieces[0].path[9].position_mm;
    for (const std::size_t i : {6U, 7U, 8U}) {
        EXPECT_GE((eyes.path[i].eye_mm - lands).norm(), 200.0 - 0.01) << i;
    }
    EXPECT_NEAR(eyes.longest_mm, 200.0 + (lands - pieces[0].path[6].position_mm).norm(), 1e-9);
    expect_rates(eyes.path);
}

TEST(AdaptiveFreeLength, KeepsWithinTheMachinesRange) {
    const std::vector<Piece> pieces{helix(20.0)};
    EXPECT_EQ(adaptive_free_length(pieces, nothing_near(), rule_of(10.0)).longest_mm, 40.0);
    EXPECT_EQ(adaptive_free_length(pieces, nothing_near(), rule_of(900.0)).shortest_mm, 400.0);
}

// A post beside the eye's way at the preferred length: the length gives way in time and comes back.
TEST(AdaptiveFreeLength, LeavesThePreferredLengthByTheRatesAndComesBack) {
    const std::vector<Piece> pieces{helix(700.0)};
    const PathPoint& station = pieces[0].path[90];
    const Vector3d post = station.position_mm + 200.0 * station.tangent + 12.0 * station.normal;
    const Vector3d half(4.0, 4.0, 4.0);
    const TriangleSoup soup = test::box(post - half, post + half);
    const RayQuery obstacles({&soup, 1});
    const EyePathResult eyes = adaptive_free_length(pieces, obstacles, rule_of(200.0));
    EXPECT_TRUE(eyes.blocked.empty());
    expect_eye_on_the_free_fibre(eyes.path);
    expect_rates(eyes.path);
    EXPECT_EQ(eyes.path.front().free_length_mm, 200.0);
    EXPECT_EQ(eyes.path.back().free_length_mm, 200.0);
    EXPECT_NE(eyes.path[90].free_length_mm, 200.0);
    EXPECT_EQ(eyes.longest_mm, 200.0);
    for (const EyePoint& p : eyes.path) {
        ASSERT_GE((p.eye_mm - post).cwiseAbs().maxCoeff(), 4.0 + 15.0 / std::sqrt(3.0) - 0.05);
    }
}

TEST(AdaptiveFreeLength, KeepsMoreClearanceOnThePiecesThatAskForIt) {
    const std::vector<Piece> pieces{helix(300.0), helix(300.0)};
    const Vector3d half(4.0, 4.0, 4.0);
    const PathPoint& station = pieces[0].path[40];  // the second piece lies over the first
    const Vector3d post = station.position_mm + 200.0 * station.tangent + 12.0 * station.normal;
    const TriangleSoup soup = test::box(post - half, post + half);
    const RayQuery obstacles({&soup, 1});
    const std::vector<double> more{0.0, 5.0};
    const EyePath path = adaptive_free_length(pieces, obstacles, rule_of(200.0), more).path;
    const auto least = [&](std::int32_t piece) {
        double distance = 1e9;
        for (const EyePoint& p : path) {
            if (p.piece == piece) {
                distance = std::min(distance, obstacles.closest(p.eye_mm, 1e3).distance_mm);
            }
        }
        return distance;
    };
    EXPECT_GE(least(0), 15.0 - 0.05);  // head and clearance
    EXPECT_LT(least(0), 20.0);
    EXPECT_GE(least(1), 20.0 - 0.05);
}

// Along a post of 190 mm only fibre that reaches past it keeps the head clear, and that grows by no
// more than 3 mm per mm: it is long before the post, where the wish would do.
TEST(AdaptiveFreeLength, IsLongBeforeTheStretchThatTakesLongFibre) {
    Piece straight;
    for (double x = -150.0; x <= 50.0; x += 4.0) {
        PathPoint p;
        p.normal = Vector3d::UnitY();
        p.position_mm = x * Vector3d::UnitX();
        p.tangent = Vector3d::UnitX();
        p.s_mm = x + 150.0;
        straight.path.push_back(p);
        straight.slip.push_back(0.0);
        straight.string.gap_mm.push_back(0.0);
        straight.string.slope.push_back(0.0);
    }
    const TriangleSoup post = test::box({20.0, -30.0, -50.0}, {210.0, -8.0, 50.0});
    const RayQuery obstacles({&post, 1});
    const EyePathResult eyes =
        adaptive_free_length({&straight, 1}, obstacles, rule_of(200.0), {}, LengthSearch::All);
    EXPECT_TRUE(eyes.blocked.empty());
    expect_rates(eyes.path);
    for (const EyePoint& p : eyes.path) {
        // Head and clearance: 15 mm.
        ASSERT_GE(obstacles.closest(p.eye_mm, 1e3).distance_mm, 15.0 - 0.05);
    }
    EXPECT_GT(eyes.path.front().eye_mm.x(), 210.0);
}

TEST(AdaptiveFreeLength, NamesThePointsWhereNoLengthIsPossible) {
    const std::vector<Piece> pieces{helix(100.0)};
    const PathPoint& station = pieces[0].path[10];
    const Vector3d wall = station.position_mm + 30.0 * station.tangent;
    const Vector3d half(2.0, 2.0, 2.0);
    const TriangleSoup soup = test::box(wall - half, wall + half);
    const RayQuery obstacles({&soup, 1});
    const EyePathResult eyes = adaptive_free_length(pieces, obstacles, rule_of(200.0));
    EXPECT_NE(std::find(eyes.blocked.begin(), eyes.blocked.end(), 10U), eyes.blocked.end());
    EXPECT_EQ(std::find(eyes.blocked.begin(), eyes.blocked.end(), 0U), eyes.blocked.end());
    ASSERT_EQ(eyes.path.size(), pieces[0].path.size());
}

}  // namespace
}  // namespace meshwind
