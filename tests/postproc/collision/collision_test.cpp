#include "postproc/collision/collision.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

const std::string kSource = MESHWIND_SOURCE_DIR;

// Joints by letter; what is missing is zero.
struct Pose {
    double c = 0.0, z = 0.0, y = 0.0, x = 0.0, a = 0.0, b = 0.0;
};

// A head alone in front of obstacles: the fibre of every eye point is far away from all.
struct Scene {
    explicit Scene(std::initializer_list<Pose> poses)
        : machine(read_machine(kSource + "/machines/six_axis.json")) {
        joints.axis_count = machine.axis_count();
        for (const Pose& pose : poses) {
            std::vector<double> row(joints.axis_count, 0.0);
            const std::pair<char, double> values[] = {{'C', pose.c}, {'Z', pose.z}, {'Y', pose.y},
                                                      {'X', pose.x}, {'A', pose.a}, {'B', pose.b}};
            for (const auto& [letter, value] : values) {
                row[*machine.joint_of(letter)] = value;
            }
            joints.joints.insert(joints.joints.end(), row.begin(), row.end());
            EyePoint eye;
            eye.landing_mm = {5000.0, 5000.0, 0.0};
            eye.tangent = Vector3d::UnitZ();
            eye.binormal = Vector3d::UnitX();
            eye.eye_mm = {5000.0, 5000.0, 100.0};
            eye.free_length_mm = 100.0;
            path.push_back(eye);
        }
    }

    void add_capsule(char link, const Vector3d& from, const Vector3d& to, double radius_mm) {
        HeadEnvelope::Part part;
        part.link = link;
        part.capsule = {from, to, radius_mm};
        envelope.parts.push_back(part);
    }

    [[nodiscard]] CollisionReport check(const TriangleSoup& obstacle) const {
        const RayQuery obstacles({&obstacle, 1});
        return check_collisions(machine, envelope, obstacles, path, joints, rule);
    }

    Machine machine;
    HeadEnvelope envelope;
    EyePath path;
    JointPath joints;
    CollisionRule rule;
};

const TriangleSoup kThinWall = test::box({-50.0, -50.0, -0.05}, {300.0, 50.0, 0.05});

using Steps = std::vector<std::size_t>;

TEST(CheckCollisions, CatchesAHeadThatPassesAThinWallBetweenTwoBlocks) {
    Scene scene({{.z = -60.0, .x = 100.0}, {.z = 60.0, .x = 100.0}, {.z = 61.0, .x = 100.0}});
    scene.add_capsule('X', {0.0, 0.0, 0.0}, {50.0, 0.0, 0.0}, 4.0);
    const CollisionReport report = scene.check(kThinWall);
    EXPECT_EQ(report.head_hits, (Steps{1}));
    EXPECT_TRUE(report.fibre_hits.empty());
    // At the points themselves it is clear.
    EXPECT_NEAR(report.min_clearance_mm, 60.0 - 0.05 - 4.0, 2.0 * kSweepResolution_mm);
}

TEST(CheckCollisions, CountsTheClearanceAndNotMore) {
    for (const double spare : {-0.2, 0.2}) {
        const double z = 0.05 + 4.0 + 5.0 + spare;
        Scene scene({{.z = 40.0, .x = 100.0}, {.z = z, .x = 100.0}, {.z = 40.0, .x = 100.0}});
        scene.add_capsule('X', {0.0, 0.0, 0.0}, {50.0, 0.0, 0.0}, 4.0);
        const CollisionReport report = scene.check(kThinWall);
        EXPECT_EQ(report.head_hits, spare < 0.0 ? (Steps{1, 2}) : Steps{}) << spare;
        EXPECT_NEAR(report.min_clearance_mm, 5.0 + spare, 2.0 * kSweepResolution_mm);
        EXPECT_EQ(report.min_clearance_point, 1U);
    }
}

// The spindle carries a small post past the standing head, which is met in the middle of the step.
TEST(CheckCollisions, FollowsTheTurningMandrel) {
    const TriangleSoup post = test::box({-101.0, -1.0, -1.0}, {-99.0, 1.0, 1.0});
    Scene scene({{.c = rad_from_deg(120.0), .x = 100.0}, {.c = rad_from_deg(240.0), .x = 100.0}});
    scene.add_capsule('X', {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 4.0);
    EXPECT_EQ(scene.check(post).head_hits, (Steps{1}));
    Scene other({{.c = rad_from_deg(-120.0), .x = 100.0}, {.c = rad_from_deg(120.0), .x = 100.0}});
    other.add_capsule('X', {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 4.0);
    EXPECT_TRUE(other.check(post).head_hits.empty());
}

// A long part on the wrist swings its far end through a post while both ends of the step are clear.
TEST(CheckCollisions, FollowsTheSwingingWrist) {
    const TriangleSoup post = test::box({299.0, -1.0, -1.0}, {301.0, 1.0, 1.0});
    Scene scene({{.x = 100.0, .b = rad_from_deg(-20.0)}, {.x = 100.0, .b = rad_from_deg(20.0)}});
    scene.add_capsule('B', {0.0, 0.0, 0.0}, {220.0, 0.0, 0.0}, 4.0);
    EXPECT_EQ(scene.check(post).head_hits, (Steps{1}));
    Scene shorter({{.x = 100.0, .b = rad_from_deg(-20.0)}, {.x = 100.0, .b = rad_from_deg(20.0)}});
    shorter.add_capsule('B', {0.0, 0.0, 0.0}, {180.0, 0.0, 0.0}, 4.0);
    EXPECT_TRUE(shorter.check(post).head_hits.empty());
}

TEST(CheckCollisions, SweepsTrianglesAsWell) {
    Scene scene({{.z = -60.0, .x = 100.0}, {.z = 60.0, .x = 100.0}});
    HeadEnvelope::Part part;
    part.link = 'X';
    part.triangles = test::box({0.0, -5.0, -5.0}, {20.0, 5.0, 5.0});
    scene.envelope.parts.push_back(part);
    const CollisionReport report = scene.check(kThinWall);
    EXPECT_EQ(report.head_hits, (Steps{1}));
    EXPECT_NEAR(report.min_clearance_mm, 60.0 - 0.05 - 5.0, 2.0 * kSweepResolution_mm);
}

// Facets of 3 mm lie up to edge^2 / (6 R) = 0.03 mm inside the sphere of 50 mm.
TEST(CheckCollisions, ClearanceFromASphereIsTheClosedForm) {
    const TriangleSoup sphere = make_mandrel(
        "ellipsoid", {{"equator-radius", 50.0}, {"pole-radius", 50.0}}, {.edge_mm = 3.0});
    test::Draw draw(5);
    for (int k = 0; k < 30; ++k) {
        const Pose pose{.c = draw.between(-9.0, 9.0),
                        .z = draw.between(-60.0, 60.0),
                        .y = draw.between(-40.0, 40.0),
                        .x = draw.between(80.0, 120.0)};
        Scene scene({pose});
        scene.add_capsule('X', Vector3d::Zero(), Vector3d::Zero(), 6.0);
        const double expected =
            std::sqrt(pose.x * pose.x + pose.y * pose.y + pose.z * pose.z) - 50.0 - 6.0;
        EXPECT_NEAR(scene.check(sphere).min_clearance_mm, std::min(expected, kClearanceCap_mm),
                    0.06);
    }
}

// Of a head that wanders about a ball, through it here and there: what is pruned changes nothing.
TEST(CheckCollisions, TheLeastAloneIsTheLeastOfAll) {
    const TriangleSoup sphere = make_mandrel(
        "ellipsoid", {{"equator-radius", 50.0}, {"pole-radius", 50.0}}, {.edge_mm = 6.0});
    test::Draw draw(7);
    for (const double nearest_mm : {45.0, 60.0}) {
        Scene scene({});
        for (int k = 0; k < 400; ++k) {
            const Scene pose({{.c = draw.between(-0.5, 0.5),
                               .z = draw.between(-80.0, 80.0),
                               .y = draw.between(-40.0, 40.0),
                               .x = draw.between(nearest_mm, 120.0)}});
            scene.joints.joints.insert(scene.joints.joints.end(), pose.joints.joints.begin(),
                                       pose.joints.joints.end());
            scene.path.push_back(pose.path.front());
        }
        scene.add_capsule('X', Vector3d::Zero(), {60.0, 0.0, 0.0}, 6.0);
        scene.add_capsule('B', {8.0, 0.0, 0.0}, {130.0, 0.0, 0.0}, 4.0);
        scene.rule.report_within_mm = 25.0;
        const CollisionReport all = scene.check(sphere);
        EXPECT_EQ(all.head_hits.empty(), nearest_mm > 50.0);
        scene.rule.least_only = true;
        for (const int threads : {1, 2}) {
            set_thread_count(threads);
            const CollisionReport least = scene.check(sphere);
            EXPECT_EQ(least.head_hits, all.head_hits);
            EXPECT_EQ(least.min_clearance_mm, all.min_clearance_mm);
            EXPECT_EQ(least.min_clearance_point, all.min_clearance_point);
        }
        set_thread_count(0);
    }
}

TEST(CheckCollisions, SeesTheFreeFibreMeetAWall) {
    Scene scene({{}, {}, {}});
    const auto place = [&](std::size_t i, double height) {
        scene.path[i].landing_mm = {100.0, height, -50.0};
        scene.path[i].eye_mm = {100.0, height, 50.0};
    };
    place(0, 80.0);
    place(1, 60.0);
    place(2, -60.0);  // across the wall, with both ends of the step beside it
    EXPECT_EQ(scene.check(kThinWall).fibre_hits, (Steps{2}));
}

TEST(CheckCollisions, WithoutObstaclesNearCapsTheClearance) {
    Scene scene({{.x = 1400.0}, {.x = 1410.0}});
    scene.add_capsule('X', {0.0, 0.0, 0.0}, {50.0, 0.0, 0.0}, 4.0);
    const CollisionReport report = scene.check(kThinWall);
    EXPECT_EQ(report.min_clearance_mm, kClearanceCap_mm);
    EXPECT_TRUE(report.head_hits.empty());
}

}  // namespace
}  // namespace meshwind
