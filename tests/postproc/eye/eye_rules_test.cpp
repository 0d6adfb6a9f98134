#include "postproc/eye/eye_rules.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "postproc/motion/choose_blocks.h"
#include "postproc/motion/joint_path.h"
#include "tests/support/fixtures.h"
#include "tests/support/synthetic_paths.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Landing points of a closed-form path as finished pieces; its free lengths are not looked at.
std::vector<Piece> pieces_of(const EyePath& path) {
    std::vector<Piece> pieces;
    double before_mm = 0.0;
    for (const EyePoint& point : path) {
        if (static_cast<std::size_t>(point.piece) >= pieces.size()) {
            pieces.emplace_back();
            before_mm = point.s_mm;
        }
        PathPoint station;
        station.position_mm = point.landing_mm;
        station.tangent = point.tangent;
        station.normal = point.tangent.cross(point.binormal).normalized();
        station.s_mm = point.s_mm - before_mm;
        pieces.back().path.push_back(station);
        pieces.back().slip.push_back(0.0);
        pieces.back().string.gap_mm.push_back(0.0);
        pieces.back().string.slope.push_back(0.0);
    }
    return pieces;
}

std::vector<Piece> helix(int stations) {
    return pieces_of(test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, stations));
}

FreeFibreRule range(double min_mm = 30.0, double max_mm = 600.0) {
    FreeFibreRule rule;
    rule.min_mm = min_mm;
    rule.max_mm = max_mm;
    return rule;
}

EyeLaw equal(double free_length_mm, std::vector<LengthPiece> lengths = {}) {
    EyeLaw law;
    law.rule = EyeRule::EqualFreeLength;
    law.free_length_mm = free_length_mm;
    law.lengths = std::move(lengths);
    return law;
}

EyeLaw by(EyeRule rule, double number) {
    EyeLaw law;
    law.rule = rule;
    law.radius_mm = number;
    law.plane_x_mm = number;
    law.plane_y_mm = number;
    return law;
}

void expect_eyes_on_the_fibre(const EyePath& path) {
    for (const EyePoint& point : path) {
        ASSERT_LT((point.eye_mm - point.landing_mm - point.free_length_mm * point.tangent).norm(),
                  1e-9);
    }
}

Machine six_axis() {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/six_axis.json");
}

TEST(EqualFreeLengthRule, IsTheSameEverywhereWhateverIsInTheWay) {
    const std::vector<Piece> pieces = helix(100);
    const PathPoint& station = pieces[0].path[50];
    const Vector3d post = station.position_mm + 150.0 * station.tangent;
    const Vector3d half(4.0, 4.0, 4.0);
    const TriangleSoup soup = test::box(post - half, post + half);
    const RayQuery obstacles({&soup, 1});
    const EyePathResult eyes = eye_path(pieces, equal(200.0), obstacles, range());
    EXPECT_TRUE(eyes.blocked.empty());
    EXPECT_EQ(eyes.shortest_mm, 200.0);
    EXPECT_EQ(eyes.longest_mm, 200.0);
    expect_eyes_on_the_fibre(eyes.path);
    // The rule that gives way does so here.
    FreeFibreRule rule = range();
    rule.preferred_mm = 200.0;
    EyeLaw adaptive;
    EXPECT_LT(eye_path(pieces, adaptive, obstacles, rule).shortest_mm, 200.0);
}

// The least length that is nowhere shorter than told and keeps the rates, from its definition:
// at each place the largest of what all other places ask for.
double least_length(const EyePath& path, std::size_t at, const std::vector<double>& told) {
    double least = told[at];
    for (std::size_t k = 0; k < path.size(); ++k) {
        const double ahead = path[k].s_mm - path[at].s_mm;
        const double asked =
            ahead > 0.0 ? told[k] - kLengtheningRate * ahead : told[k] + kShorteningRate * ahead;
        least = std::max(least, asked);
    }
    return least;
}

TEST(EqualFreeLengthRule, HoldsTheLongerLengthAllOverItsStretchAndChangesByTheRates) {
    const std::vector<Piece> pieces = helix(200);  // 995 mm
    const std::vector<LengthPiece> stretches{{{}, 300.0, 500.0, 250.0}, {{}, 700.0, 720.0, 150.0}};
    const EyePathResult eyes = strict_eye_path(pieces, equal(200.0, stretches), range());
    std::vector<double> told;
    for (const EyePoint& point : eyes.path) {
        const bool longer = point.s_mm >= 300.0 && point.s_mm <= 500.0;
        const bool shorter = point.s_mm >= 700.0 && point.s_mm <= 720.0;
        told.push_back(longer ? 250.0 : shorter ? 150.0 : 200.0);
        if (longer) {
            ASSERT_EQ(point.free_length_mm, 250.0) << point.s_mm;
        }
    }
    for (std::size_t i = 0; i < eyes.path.size(); ++i) {
        ASSERT_NEAR(eyes.path[i].free_length_mm, least_length(eyes.path, i, told), 1e-9) << i;
    }
    EXPECT_EQ(eyes.path.front().free_length_mm, 200.0);
    EXPECT_EQ(eyes.path.back().free_length_mm, 200.0);
    // 50 mm take 16.7 mm of fibre before and 62.5 mm after.
    EXPECT_EQ(eyes.path[56].free_length_mm, 200.0);  // s = 280
    EXPECT_NEAR(eyes.path[58].free_length_mm, 220.0, 1e-9);
    EXPECT_NEAR(eyes.path[110].free_length_mm, 210.0, 1e-9);  // s = 550
    EXPECT_EQ(eyes.path[113].free_length_mm, 200.0);
    // The stretch is too short for 50 mm less: down by 0.8 mm per mm from the station at 695 to
    // 715, and up by 3 mm per mm to that at 725.
    EXPECT_NEAR(eyes.shortest_mm, 184.0, 1e-9);
    EXPECT_TRUE(eyes.blocked.empty());
}

TEST(EqualFreeLengthRule, TakesTheLengthOfACourseAndTheLastThatNamesAPlace) {
    EyePath path = test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 300);
    for (std::size_t i = 0; i < path.size(); ++i) {
        path[i].piece = static_cast<std::int32_t>(i / 100);
    }
    const std::vector<LengthPiece> lengths{{1, 0.0, 0.0, 250.0}, {{}, 700.0, 800.0, 300.0}};
    const EyePathResult eyes = strict_eye_path(pieces_of(path), equal(200.0, lengths), range());
    EXPECT_EQ(eyes.path[100].free_length_mm, 250.0);
    EXPECT_EQ(eyes.path[199].free_length_mm, 250.0);
    EXPECT_EQ(eyes.path[150].free_length_mm, 300.0);
    EXPECT_EQ(eyes.path[90].free_length_mm, 200.0);
    EXPECT_EQ(eyes.path[220].free_length_mm, 200.0);
}

TEST(EqualFreeLengthRule, BlocksWhatTheMachineCannotWindWith) {
    const EyePathResult eyes =
        strict_eye_path(helix(100), equal(200.0, {{{}, 100.0, 110.0, 450.0}}), range(30.0, 400.0));
    ASSERT_FALSE(eyes.blocked.empty());
    for (const char* figure : {"405.00 mm", "30", "400 mm"}) {
        EXPECT_TRUE(test::tells(eyes.words, figure)) << eyes.words;
    }
    for (const std::size_t i : eyes.blocked) {
        EXPECT_GE(eyes.path[i].s_mm, 80.0);
        EXPECT_EQ(eyes.path[i].free_length_mm, 400.0);
    }
}

// What is in the air over a hollow is not free fibre: the rule keeps its length, the machine's
// shortest counts from the far end.
TEST(EqualFreeLengthRule, CountsTheMachinesRangeFromTheFarEndOfABridge) {
    std::vector<Piece> pieces = helix(40);
    for (const std::size_t i : {7U, 8U}) {
        pieces[0].string.gap_mm[i] = 0.4;
    }
    const EyePathResult eyes = strict_eye_path(pieces, equal(200.0), range(190.0, 400.0));
    EXPECT_EQ(eyes.blocked, (std::vector<std::size_t>{6}));  // 15 mm of bridge ahead
    ASSERT_EQ(eyes.ahead_mm.size(), eyes.path.size());
    EXPECT_NEAR(eyes.ahead_mm[6], 15.0, 0.5);
    EXPECT_EQ(eyes.ahead_mm[3], 0.0);
    EXPECT_EQ(eyes.longest_mm, 200.0);
}

TEST(CylinderRule, KeepsTheEyeOnItsCylinder) {
    const test::EllipsoidLine line;
    const std::vector<Piece> pieces = pieces_of(test::on_ellipsoid(line, 400));
    const EyePathResult eyes =
        strict_eye_path(pieces, by(EyeRule::Cylinder, 240.0), range(1.0, 1e4));
    EXPECT_TRUE(eyes.blocked.empty());
    expect_eyes_on_the_fibre(eyes.path);
    for (const EyePoint& point : eyes.path) {
        ASSERT_NEAR(point.eye_mm.head<2>().norm(), 240.0, 1e-9);
        ASSERT_GT(point.free_length_mm, 0.0);
    }
    EXPECT_LT(eyes.shortest_mm, eyes.longest_mm - 1.0);
}

TEST(CylinderRule, SaysWhereThereIsNoEye) {
    const std::vector<Piece> pieces = helix(10);
    const EyePathResult inside =
        strict_eye_path(pieces, by(EyeRule::Cylinder, 65.0), range(30.0, 400.0));
    EXPECT_EQ(inside.blocked.size(), 10U);
    for (const char* figure : {"70.00 mm", "65.00 mm"}) {
        EXPECT_TRUE(test::tells(inside.words, figure)) << inside.words;
    }
    EXPECT_EQ(inside.shortest_mm, 30.0);  // what the machine can, for want of better
    std::vector<Piece> axial = helix(10);
    axial[0].path[4].tangent = Vector3d::UnitZ();
    const EyePathResult along =
        strict_eye_path(axial, by(EyeRule::Cylinder, 200.0), range(30.0, 400.0));
    EXPECT_EQ(along.blocked, (std::vector<std::size_t>{4}));
    for (const char* figure : {"0.00000000", "200.00 mm"}) {
        EXPECT_TRUE(test::tells(along.words, figure)) << along.words;
    }
    EXPECT_TRUE(std::isfinite(along.path[4].eye_mm.norm()));
    const EyePathResult far =
        strict_eye_path(pieces, by(EyeRule::Cylinder, 500.0), range(30.0, 400.0));
    EXPECT_EQ(far.blocked.size(), 10U);  // sqrt(500^2 - 70^2) / sin 45 deg
    for (const char* figure : {"700.14 mm", "30", "400 mm"}) {
        EXPECT_TRUE(test::tells(far.words, figure)) << far.words;
    }
}

// In the machine, from the axes: the eye's plane, and a fibre square to it seen along the spindle.
void expect_plane(EyeRule rule, double plane_mm, const EyePath& landing) {
    const Machine machine = six_axis();
    const EyePathResult eyes =
        strict_eye_path(pieces_of(landing), by(rule, plane_mm), range(1.0, 1e4));
    ASSERT_TRUE(eyes.blocked.empty()) << eyes.words;
    expect_eyes_on_the_fibre(eyes.path);
    const EyePath fine =
        refine_path(machine, eyes.path, RedundancyPolicy::CentralAngle, BlockTolerance{});
    const JointPath joints = solve_joints(machine, fine, RedundancyPolicy::CentralAngle);
    const int across = rule == EyeRule::VerticalPlane ? 0 : 1;
    const double side = plane_mm > 0.0 ? 1.0 : -1.0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const Eigen::Isometry3d machine_from_mandrel = base_from_mandrel(machine, joints.row(i));
        const Vector3d eye = base_from_eye(machine, joints.row(i)).translation();
        const Vector3d tangent = machine_from_mandrel.linear() * fine[i].tangent;
        ASSERT_LT((machine_from_mandrel * fine[i].eye_mm - eye).norm(), 1e-9);
        // Between stations length and turn are even: off by their curvature.
        const bool station = i == 0 || fine[i].point != fine[i - 1].point;
        ASSERT_NEAR(eye[across], plane_mm, station ? 1e-9 : 0.05) << i;
        ASSERT_NEAR(tangent[1 - across], 0.0, station ? 1e-9 : 1e-3) << i;
        ASSERT_GT(side * tangent[across], 0.0);
    }
}

TEST(PlaneRules, KeepTheEyeInItsPlane) {
    const test::EllipsoidLine line;
    for (const double plane : {220.0, 300.0}) {
        expect_plane(EyeRule::VerticalPlane, plane, test::on_ellipsoid(line, 400));
        expect_plane(EyeRule::HorizontalPlane, plane, test::on_ellipsoid(line, 400));
        expect_plane(EyeRule::HorizontalPlane, -plane, test::on_ellipsoid(line, 400));
        expect_plane(EyeRule::VerticalPlane, plane, test::elliptic_helix(600));
    }
}

// On a cylinder the fibre's lever arm is the radius: the vertical plane x = D has the eye at the
// height -R and takes L = D / sin(beta).
TEST(PlaneRules, AgreeWithTheClosedFormOnACylinder) {
    const EyePathResult eyes =
        strict_eye_path(helix(50), by(EyeRule::VerticalPlane, 180.0), range(30.0, 400.0));
    const JointPath joints = solve_joints(six_axis(), eyes.path, RedundancyPolicy::CentralAngle);
    const Machine machine = six_axis();
    for (std::size_t i = 0; i < eyes.path.size(); ++i) {
        EXPECT_NEAR(eyes.path[i].free_length_mm, 180.0 * std::sqrt(2.0), 1e-9);
        EXPECT_NEAR(joints.row(i)[*machine.joint_of('X')], 180.0, 1e-9);
        EXPECT_NEAR(joints.row(i)[*machine.joint_of('Y')], -70.0, 1e-9);
    }
    const EyePathResult beyond =
        strict_eye_path(pieces_of(test::on_ellipsoid({.swing = 0.7}, 200)),
                        by(EyeRule::HorizontalPlane, 5.0), range(30.0, 400.0));
    EXPECT_FALSE(beyond.blocked.empty());
}

TEST(PlaneRules, SayWhereTheLandingPointIsBeyondThePlane) {
    std::vector<Piece> pieces = helix(10);
    // Fibre that leaves outward, as behind a dome: 0.6 of its direction across the spindle is
    // radial.
    for (PathPoint& station : pieces[0].path) {
        const Vector3d radial =
            Vector3d(station.position_mm.x(), station.position_mm.y(), 0.0) / 70.0;
        station.tangent = 0.6 * radial + 0.8 * Vector3d::UnitZ().cross(radial);
        station.normal = station.tangent.cross(Vector3d::UnitZ());
    }
    const EyePathResult eyes =
        strict_eye_path(pieces, by(EyeRule::VerticalPlane, 40.0), range(1.0, 400.0));
    EXPECT_EQ(eyes.blocked.size(), 10U);
    for (const char* figure : {"2.00 mm", "x = 40.00 mm"}) {
        EXPECT_TRUE(test::tells(eyes.words, figure)) << eyes.words;
    }
}

}  // namespace
}  // namespace meshwind
