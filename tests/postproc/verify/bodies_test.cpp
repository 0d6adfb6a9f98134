// Head, free fibre and mandrel against bodies that are not on the eye's chain.
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "postproc/collision/chunk.h"
#include "postproc/collision/collision.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Steps = std::vector<std::size_t>;

const std::string kSource = MESHWIND_SOURCE_DIR;
const TriangleSoup kFarAway = test::box({9000.0, 9000.0, 9000.0}, {9001.0, 9001.0, 9001.0});

struct Scene {
    explicit Scene(const std::string& name)
        : machine(read_machine(kSource + "/machines/" + name + ".json")) {
        machine.bodies.clear();
        machine.eye.envelope.clear();
        joints.axis_count = machine.axis_count();
    }

    void add_row(const std::vector<std::pair<char, double>>& values) {
        std::vector<double> row(joints.axis_count, 0.0);
        for (const auto& [letter, value] : values) {
            row[*machine.joint_of(letter)] = value;
        }
        joints.joints.insert(joints.joints.end(), row.begin(), row.end());
        // The fibre of every eye point runs along z somewhere beside everything.
        const Isometry3d mandrel = base_from_mandrel(machine, row).inverse();
        const Vector3d eye = mandrel_from_eye(machine, row).translation();
        EyePoint point;
        point.eye_mm = eye;
        point.landing_mm = eye + mandrel.linear() * Vector3d(0.0, 0.0, 0.5);
        point.tangent = -mandrel.linear().col(2);
        point.binormal = mandrel.linear().col(0);
        path.push_back(point);
    }

    void add_head(char link, const Vector3d& from, const Vector3d& to, double radius_mm) {
        machine.eye.envelope.push_back({link, Capsule{from, to, radius_mm}});
    }
    void add_body(std::optional<char> link, const Vector3d& from, const Vector3d& to,
                  double radius_mm) {
        machine.bodies.push_back({link, Capsule{from, to, radius_mm}});
    }

    [[nodiscard]] CollisionReport check(const TriangleSoup& mandrel = kFarAway) const {
        std::vector<TriangleSoup> parts = bodies_on_mandrel(machine);
        parts.push_back(mandrel);
        const RayQuery obstacles(parts);
        return check_collisions(machine, head_envelope(machine), obstacles, path, joints, rule);
    }

    Machine machine;
    EyePath path;
    JointPath joints;
    CollisionRule rule;
};

TEST(Bodies, AreSortedByWhatCarriesThem) {
    Scene scene("robot_kr16");
    scene.add_body('F', {1768.0, 0.0, 640.0}, {1800.0, 0.0, 640.0}, 30.0);
    scene.add_body('C', {940.0, 0.0, 675.0}, {1600.0, 0.0, 675.0}, 80.0);
    scene.add_body({}, {0.0, 0.0, 0.0}, {0.0, 0.0, 100.0}, 50.0);
    const HeadEnvelope envelope = head_envelope(scene.machine);
    ASSERT_EQ(envelope.bodies.size(), 2u);
    EXPECT_EQ(envelope.bodies[0].link, 'C');
    EXPECT_EQ(envelope.bodies[1].link, kBaseLink);
    const std::vector<TriangleSoup> turning = bodies_on_mandrel(scene.machine);
    ASSERT_EQ(turning.size(), 1u);
    // In the flange frame, with z out of it: from 0 to 32 along z, and the ends of radius 30.
    double low = 1e9;
    double high = -1e9;
    for (const Vector3d& point : turning[0].points_mm) {
        low = std::min(low, point.z());
        high = std::max(high, point.z());
        EXPECT_LE(point.head<2>().norm(), 30.0 + kBodyMesh_mm);
    }
    EXPECT_NEAR(low, -30.0, kBodyMesh_mm);
    EXPECT_NEAR(high, 62.0, kBodyMesh_mm);
}

// The head runs along Z past a post on the base: between its ends it is nearest, at 40 mm in X.
TEST(Bodies, HeadKeepsTheClearanceFromAPostBetweenTwoBlocks) {
    for (const double spare : {-0.2, 0.2}) {
        Scene scene("six_axis");
        scene.add_row({{'Z', -80.0}, {'X', 100.0}, {'C', 1.0}});
        scene.add_row({{'Z', 70.0}, {'X', 100.0}, {'C', 1.1}});
        scene.add_row({{'Z', 71.0}, {'X', 100.0}, {'C', 1.1}});
        scene.add_head('X', {0.0, 0.0, 0.0}, {50.0, 0.0, 0.0}, 4.0);
        const double post_x = 100.0 - 4.0 - 5.0 - 10.0 - spare;
        scene.add_body({}, {post_x, -300.0, 0.0}, {post_x, 300.0, 0.0}, 10.0);
        const CollisionReport report = scene.check();
        EXPECT_EQ(report.head_hits, spare < 0.0 ? (Steps{1}) : Steps{}) << spare;
        EXPECT_TRUE(report.fibre_hits.empty());
        EXPECT_TRUE(report.body_hits.empty());
        // At the points themselves: the diagonal way, less both radii.
        EXPECT_NEAR(report.clearance_mm[1], std::hypot(100.0 - post_x, 70.0) - 14.0, 1e-9);
        EXPECT_NEAR(report.clearance_mm[0], std::hypot(100.0 - post_x, 80.0) - 14.0, 1e-9);
    }
}

// The head's swing carries its far end through a post, both ends of the step clear.
TEST(Bodies, FollowTheSwingingHead) {
    for (const double length : {220.0, 180.0}) {
        Scene scene("six_axis");
        scene.add_row({{'X', 100.0}, {'B', rad_from_deg(-20.0)}});
        scene.add_row({{'X', 100.0}, {'B', rad_from_deg(20.0)}});
        scene.add_head('B', {0.0, 0.0, 0.0}, {length, 0.0, 0.0}, 4.0);
        scene.add_body({}, {300.0, -50.0, 0.0}, {300.0, 50.0, 0.0}, 3.0);
        EXPECT_EQ(scene.check().head_hits, length > 200.0 ? (Steps{1}) : Steps{});
    }
}

// A jaw on the spindle is an obstacle that turns: it meets the head where its angle is the head's.
TEST(Bodies, AJawOnTheSpindleTurnsWithIt) {
    Scene scene("six_axis");
    scene.add_row({{'C', rad_from_deg(-60.0)}, {'X', 100.0}});
    scene.add_row({{'C', rad_from_deg(60.0)}, {'X', 100.0}});
    scene.add_row({{'C', rad_from_deg(300.0)}, {'X', 100.0}});
    scene.add_row({{'C', rad_from_deg(301.0)}, {'X', 100.0}});
    scene.add_head('X', {0.0, 0.0, 0.0}, {50.0, 0.0, 0.0}, 4.0);
    scene.add_body('C', {80.0, 0.0, -5.0}, {80.0, 0.0, 5.0}, 12.0);
    const CollisionReport report = scene.check();
    EXPECT_EQ(report.head_hits, (Steps{1}));
    // Chord between 80 at 60 degrees and 100 at 0, less the radii; the jaw's mesh is a little
    // wider.
    const double chord = std::sqrt(80.0 * 80.0 + 100.0 * 100.0 - 80.0 * 100.0);
    for (const std::size_t point : {0U, 1U, 2U}) {
        EXPECT_NEAR(report.clearance_mm[point], chord - 16.0,
                    kBodyMesh_mm + 2.0 * kSweepResolution_mm);
        EXPECT_LE(report.clearance_mm[point], chord - 16.0 + 2.0 * kSweepResolution_mm);
    }
    // The same jaw on a machine whose mandrel sits 50 mm further along: nothing changes for it.
    scene.machine.mount = MandrelMount{.origin_mm = {0.0, 0.0, 50.0}};
    EXPECT_EQ(scene.check().head_hits, (Steps{1}));
}

// The fibre sweeps across a post while it is clear of it at both points.
TEST(Bodies, FreeFibreMustNotTouch) {
    for (const double radius : {9.9, 10.1}) {
        Scene scene("six_axis");
        scene.add_row({{'X', 200.0}, {'Y', 100.0}});
        scene.add_row({{'X', 200.0}, {'Y', -100.0}});
        scene.add_row({{'X', 200.0}, {'Y', -101.0}});
        for (std::size_t i = 0; i < 3; ++i) {
            scene.path[i].landing_mm = scene.path[i].eye_mm - Vector3d(150.0, 0.0, 0.0);
        }
        // Along z, ending 10 mm above the plane in which the fibre moves.
        scene.add_body({}, {120.0, 0.0, 10.0}, {120.0, 0.0, 80.0}, radius);
        const CollisionReport report = scene.check();
        EXPECT_EQ(report.fibre_hits, radius > 10.0 ? (Steps{1}) : Steps{}) << radius;
        EXPECT_TRUE(report.head_hits.empty());
    }
}

// A cam on the mandrel passes a post on the base with 1 mm to spare, or not.
TEST(Bodies, TheMandrelMustNotTouchThem) {
    for (const double gap : {-1.0, 1.0}) {
        Scene scene("six_axis");
        scene.add_row({{'X', 1000.0}, {'C', 0.0}});
        scene.add_row({{'X', 1000.0}, {'C', kPi}});
        scene.add_row({{'X', 1000.0}, {'C', 1.1 * kPi}});
        const TriangleSoup cam = test::box({90.0, -1.0, -1.0}, {100.0, 1.0, 1.0});
        const double reach = std::hypot(100.0, 1.0);
        scene.add_body({}, {0.0, reach + 20.0 + gap, -30.0}, {0.0, reach + 20.0 + gap, 30.0}, 20.0);
        EXPECT_EQ(scene.check(cam).body_hits, gap < 0.0 ? (Steps{1}) : Steps{});
    }
}

// An arm swings a mandrel about at random; between its ends each step is looked at in 400 places.
TEST(Bodies, SweepsOfAnArmMissNothing) {
    test::Draw draw(9);
    const TriangleSoup mandrel = test::box({-40.0, -40.0, 0.0}, {40.0, 40.0, 300.0});
    int hits = 0;
    int clear = 0;
    for (int run = 0; run < 150; ++run) {
        Scene scene("robot_kr16");
        std::vector<double> a;
        std::vector<double> b;
        for (std::size_t j = 0; j < 6; ++j) {
            const Axis& axis = scene.machine.axis(j);
            a.push_back(draw.between(axis.min, axis.max));
            b.push_back(a.back() + draw.between(-0.5, 0.5));
        }
        for (const auto* const row : {&a, &b}) {
            scene.add_row({});
            std::copy(row->begin(), row->end(), scene.joints.joints.end() - 6);
        }
        const auto at = [&](double share) {
            std::vector<double> q(6);
            for (std::size_t j = 0; j < 6; ++j) {
                q[j] = a[j] + share * (b[j] - a[j]);
            }
            return base_from_mandrel(scene.machine, q);
        };
        // Somewhere about the place where the mandrel's end passes in the middle of the step.
        const Vector3d place = at(0.5) * Vector3d(0.0, 0.0, 300.0);
        const Vector3d off(draw.between(-150.0, 150.0), draw.between(-150.0, 150.0),
                           draw.between(-150.0, 150.0));
        scene.add_body({}, place + off, place + 2.0 * off, 15.0);
        const Chunk body = chunk_of(std::get<Capsule>(scene.machine.bodies[0].shape));
        double least = 1e9;
        for (int k = 0; k <= 400; ++k) {
            const Isometry3d pose = at(k / 400.0);
            for (const Chunk& face : chunks_of(mandrel)) {
                least = std::min(least, chunk_distance_mm(face.moved(pose), body));
            }
        }
        // Beyond a sweep's resolution the verdict is that of the samples.
        const bool hit = !scene.check(mandrel).body_hits.empty();
        if (least < 0.0) {
            EXPECT_TRUE(hit) << least;
        } else if (least > 3.0) {
            EXPECT_FALSE(hit) << least;
        }
        ++(hit ? hits : clear);
    }
    EXPECT_GT(hits, 20);
    EXPECT_GT(clear, 20);
}

// The eye of a robot that carries the mandrel stands still: so does its fibre's end.
TEST(Bodies, FibreOfAStillEye) {
    Scene scene("robot_kr16");
    const std::vector<std::pair<char, double>> pose{
        {'A', 2.2}, {'B', -1.2}, {'C', 1.4}, {'E', 0.4}};
    scene.add_row(pose);
    scene.add_row(pose);
    const Vector3d eye = scene.machine.eye.position_mm;
    const std::vector<double> q(scene.joints.row(0).begin(), scene.joints.row(0).end());
    for (EyePoint& point : scene.path) {
        point.landing_mm =
            base_from_mandrel(scene.machine, q).inverse() * (eye + Vector3d(0, 90, 0));
    }
    scene.add_body({}, eye + Vector3d(25.0, 45.0, 0.0), eye + Vector3d(40.0, 45.0, 0.0), 24.0);
    EXPECT_TRUE(scene.check().fibre_hits.empty());
    scene.add_body({}, eye + Vector3d(25.0, 45.0, 0.0), eye + Vector3d(40.0, 45.0, 0.0), 26.0);
    EXPECT_EQ(scene.check().fibre_hits, (Steps{0, 1}));
}

}  // namespace
}  // namespace meshwind
