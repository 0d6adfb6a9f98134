#include "winding/cover/arrange_courses.h"
#include "tests/support/course_scene.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "geodesic/trace.h"
#include "tests/support/fixtures.h"
#include "winding/cover/order_courses.h"
#include "winding/laminate/course_character.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

const CourseTurns kTurns{{.friction = 0.25, .extension_mm = 150.0, .band_mm = 6.0}};
constexpr double kThreeRounds_rad = 6.0 * kPi;  // per lateness of 1 over the whole plan

struct Scene {
    std::vector<Rim> rims;
    std::vector<LibraryCourse> members;
    std::vector<OrderedCourse> order;
    std::vector<double> lateness;
};

Scene random_scene(std::uint64_t seed) {
    test::Draw draw(seed);
    Scene scene;
    const std::int32_t rims = 2 + draw.below(2);
    scene.rims = test::plain_rims(rims);
    std::vector<DirectedCourse> laid;
    for (std::int32_t i = 0; i < 4 + draw.below(26); ++i) {
        scene.members.push_back(test::random_member(draw, rims, 20));
        laid.push_back({i, !scene.members.back().windable_forward});
    }
    scene.order = order_courses(scene.rims, scene.members, laid, kTurns);
    for (std::size_t i = 0; i < scene.order.size(); ++i) {
        scene.lateness.push_back(draw.between(-1.0, 1.0));
    }
    return scene;
}

const LibraryCourse& member_of(const Scene& scene, const OrderedCourse& course) {
    return scene.members[static_cast<std::size_t>(course.course.member)];
}

// Lateness of a member, whatever its place.
double lateness_of(const Scene& scene, std::int32_t member) {
    for (std::size_t i = 0; i < scene.order.size(); ++i) {
        if (scene.order[i].course.member == member) {
            return scene.lateness[i];
        }
    }
    return 0.0;
}

// What arranging makes larger: of each fibre, lateness by place, less the fibre in turns.
double worth(const Scene& scene, const std::vector<OrderedCourse>& order) {
    double worth = 0.0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (!order[i].cut_after) {
            const RimCrossing& from = end_of(member_of(scene, order[i]), order[i].course.backward);
            const RimCrossing& to =
                start_of(member_of(scene, order[i + 1]), order[i + 1].course.backward);
            EXPECT_EQ(arrival_node(from), departure_node(to));
            const Rim& rim = scene.rims[static_cast<std::size_t>(from.rim)];
            worth -= turn_mm(rim, from, to, kTurns) / rim.radius_mm;
            continue;
        }
        const auto courses = static_cast<double>(i + 1 - begin);
        for (std::size_t k = begin; k <= i; ++k) {
            worth += kThreeRounds_rad * lateness_of(scene, order[k].course.member) *
                     static_cast<double>(k - begin) / courses;
        }
        begin = i + 1;
    }
    return worth;
}

std::vector<std::int32_t> sorted_members(const std::vector<OrderedCourse>& order) {
    std::vector<std::int32_t> members;
    for (const OrderedCourse& course : order) {
        members.push_back(course.course.member);
    }
    std::sort(members.begin(), members.end());
    return members;
}

// The best that one more exchange of neighbouring stretches of a fibre would gain.
double best_exchange(const Scene& scene, const std::vector<OrderedCourse>& order) {
    const auto node = [&](std::size_t i) {
        const OrderedCourse& course = order[i];
        return departure_node(start_of(member_of(scene, course), course.course.backward));
    };
    const double now = worth(scene, order);
    double best = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t k = i + 2; k < order.size() && !order[k - 1].cut_after; ++k) {
            for (std::size_t j = i + 1; j < k && !order[i].cut_after; ++j) {
                if (node(i) == node(j) && node(j) == node(k)) {
                    std::vector<OrderedCourse> other = order;
                    const auto step = [&](std::size_t x) {
                        return other.begin() + static_cast<std::ptrdiff_t>(x);
                    };
                    std::rotate(step(i), step(j), step(k));
                    best = std::max(best, worth(scene, other) - now);
                }
            }
        }
    }
    return best;
}

TEST(Arrange, KeepsTheFibresAndLeavesNothingToGain) {
    double gained = 0.0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = random_scene(seed);
        std::vector<OrderedCourse> order = scene.order;
        arrange(scene.rims, scene.members, kTurns, scene.lateness, order);
        ASSERT_EQ(order.size(), scene.order.size());
        for (std::size_t i = 0, begin = 0; i < order.size(); ++i) {
            ASSERT_EQ(order[i].cut_after, scene.order[i].cut_after);
            if (order[i].cut_after) {
                const auto stretch = [&](const std::vector<OrderedCourse>& all) {
                    const auto first = all.begin() + static_cast<std::ptrdiff_t>(begin);
                    return sorted_members(
                        {first, all.begin() + static_cast<std::ptrdiff_t>(i + 1)});
                };
                EXPECT_EQ(stretch(order), stretch(scene.order));
                begin = i + 1;
            }
        }
        const double more = worth(scene, order) - worth(scene, scene.order);
        EXPECT_GT(more, -1e-6);
        EXPECT_LT(best_exchange(scene, order), 1e-6);
        gained += more;
    }
    EXPECT_GT(gained, 0.0);
}

// Rounds from one node back to it may come in any order: where they are alike but for their
// lateness they are sorted by it.
TEST(Arrange, SortsRoundsByLateness) {
    Scene scene;
    scene.rims = test::plain_rims(1);
    scene.lateness = {0.9, -0.5, 0.3, 0.0, -0.9};
    for (std::int32_t i = 0; i < 5; ++i) {
        LibraryCourse member;
        member.end[0] = {0, 0.5, 1.1, -1};
        member.end[1] = {0, 0.5, 1.1, 1};
        member.windable_forward = true;
        member.length_mm = 100.0;
        scene.members.push_back(member);
        scene.order.push_back({{i, false}, i == 4});
    }
    std::vector<OrderedCourse> order = scene.order;
    arrange(scene.rims, scene.members, kTurns, scene.lateness, order);
    std::vector<std::int32_t> found;
    for (const OrderedCourse& course : order) {
        found.push_back(course.course.member);
    }
    EXPECT_EQ(found, (std::vector<std::int32_t>{4, 1, 3, 2, 0}));
}

TEST(CharacterOf, IsHoopAcrossAPipeAndJunctionInABlend) {
    const Mandrel cylinder = test::made_cylinder(30.0, 160.0, 4.0);
    const auto helix = [&](double deg) {
        const Surface& surface = cylinder.surface;
        const SurfacePoint start{static_cast<std::int32_t>(surface.face.size() / 2),
                                 Vector3d::Constant(1.0 / 3.0)};
        const Vector3d around = Vector3d::UnitZ().cross(smooth_normal(surface, start)).normalized();
        const double angle = rad_from_deg(deg);
        return character_of(
            surface,
            trace(surface, start, std::cos(angle) * Vector3d::UnitZ() + std::sin(angle) * around,
                  {}, {.max_length_mm = 60.0})
                .path);
    };
    EXPECT_NEAR(helix(80.0).hoop_mm, 60.0, 1e-6);
    EXPECT_NEAR(helix(60.0).hoop_mm, 0.0, 1e-6);
    for (const double deg : {10.0, 45.0, 60.0, 80.0}) {
        const CourseCharacter character = helix(deg);
        EXPECT_NEAR(character.length_mm, 60.0, 1e-6);
        EXPECT_NEAR(character.junction_mm, 0.0, 1e-6);
        EXPECT_NEAR(character.lateness(), std::pow(std::sin(rad_from_deg(deg)), 2), 0.01) << deg;
    }
    const test::CourseScene tee(test::small_tee(3.5), 0.25);
    double junction = 0.0;
    for (const Candidate& candidate : tee.candidates(30, 5, 0.0)) {
        const CourseCharacter character = character_of(
            tee.mandrel.surface, trace_both_ways(tee.rules, candidate, TraceMethod::Walk));
        EXPECT_LE(character.junction_mm + character.hoop_mm, character.length_mm + 1e-9);
        EXPECT_GE(character.lateness(), -1.0);
        junction += character.junction_mm;
    }
    EXPECT_GT(junction, 0.0);
}

}  // namespace
}  // namespace meshwind
