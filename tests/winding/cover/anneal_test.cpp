#include "winding/cover/anneal.h"
#include "tests/support/course_scene.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "tests/support/fixtures.h"
#include "winding/cover/balance_courses.h"
#include "winding/laminate/coverage.h"
#include "winding/laminate/wound_angle.h"

namespace meshwind {
namespace {

struct Scene : test::CourseScene {
    explicit Scene(Mandrel loaded)
        : CourseScene(std::move(loaded), 0.3, 60.0),
          members(build_library(rules, candidates(400, 5, 0.0)).members),
          allowed(members.size(), 1) {}

    [[nodiscard]] std::vector<PlacedCourse> annealed(const AnnealOptions& options,
                                                     std::vector<PlacedCourse> courses = {}) const {
        const AnnealGround ground(rules, sample_surface(rules.mandrel.surface, kSpacing_mm, 3),
                                  samples, members);
        anneal(rules, ground, members, allowed, courses, options);
        return courses;
    }

    [[nodiscard]] PlacedCourse placed(std::size_t member) const {
        DraftCourse sketch;
        FootprintFinder::Scratch scratch = footprints.make_scratch();
        EXPECT_EQ(draw_sketch(rules, members[member].candidate, scratch, sketch),
                  CandidateFault::None);
        return {members[member], sketch.path, !members[member].windable_forward, false};
    }

    [[nodiscard]] Coverage coverage(const std::vector<PlacedCourse>& courses) const {
        std::vector<std::int32_t> layers(samples.size(), 0);
        for (const PlacedCourse& course : courses) {
            for (const std::int32_t sample : course.member.footprint) {
                ++layers[static_cast<std::size_t>(sample)];
            }
        }
        return measure_coverage(layers);
    }

    std::vector<LibraryCourse> members;
    std::vector<char> allowed;
};

const Scene& cylinder() {
    static const Scene scene(test::made_cylinder(30.0, 160.0, 5.0));
    return scene;
}

const Scene& tee() {
    static const Scene scene(test::small_tee(4.0));
    return scene;
}

// Slowly enough for the courses to find their order.
AnnealOptions slowly() {
    return {.proposals = 40'000, .hot = 0.5, .cold = 0.005};
}

// Two layers everywhere, of helices of both hands, have no unevenness at all: what is left is where
// bands do not quite meet. Courses laid by chance would have 1 / sqrt(2), 0.71, and leave 13 %
// bare.
TEST(Anneal, LaysACylinderTwiceOver) {
    const Coverage coverage = cylinder().coverage(cylinder().annealed(slowly()));
    EXPECT_GT(coverage.fraction, 0.995);
    EXPECT_NEAR(coverage.mean_layers, 2.0, 0.15);
    EXPECT_LT(coverage.cv, 0.4);
}

TEST(Anneal, ComesNearAWantedWindingAngle) {
    const double wish = rad_from_deg(60.0);
    const auto share_off = [&](const std::vector<PlacedCourse>& courses) {
        double off = 0.0;
        double length = 0.0;
        for (const PlacedCourse& course : courses) {
            const AngleKept kept = angle_kept(cylinder().mandrel.surface, course.path, wish);
            off += kept.off_mm;
            length += kept.measured_mm;
        }
        return off / length;
    };
    Scene scene(test::made_cylinder(30.0, 160.0, 5.0));
    scene.rules.angle_rad = wish;
    const double wanted = share_off(scene.annealed(slowly()));
    const double any = share_off(cylinder().annealed(slowly()));
    EXPECT_LT(wanted, 0.2);
    EXPECT_GT(any, 2.0 * wanted);
}

TEST(Anneal, HonoursTheTargetAsMultiplicity) {
    AnnealOptions options = slowly();
    options.select.target_layers = 2;
    const auto courses = cylinder().annealed(options);
    std::vector<int> layers(cylinder().samples.size(), 0);
    for (const PlacedCourse& course : courses) {
        for (const std::int32_t sample : course.member.footprint) {
            ++layers[static_cast<std::size_t>(sample)];
        }
    }
    const auto twice = std::count_if(layers.begin(), layers.end(), [](int l) { return l >= 2; });
    EXPECT_GT(static_cast<double>(twice), 0.98 * static_cast<double>(layers.size()));
    EXPECT_LT(cylinder().coverage(courses).mean_layers, 3.6);
}

// Ends that lead nowhere.
int loose_ends(const std::vector<PlacedCourse>& courses, std::size_t rims) {
    std::vector<int> excess(2 * rims, 0);
    for (const PlacedCourse& course : courses) {
        ++excess[arrival_node(end_of(course.member, course.backward))];
        --excess[departure_node(start_of(course.member, course.backward))];
    }
    int loose = 0;
    for (const int e : excess) {
        loose += std::abs(e);
    }
    return loose;
}

// Every course is again what its candidate gives: ends, length, footprint.
TEST(Anneal, LeavesCoursesThatKeepTheRules) {
    const Scene& scene = tee();
    const auto courses = scene.annealed({.proposals = 12'000});
    ASSERT_GT(courses.size(), 5U);
    FootprintFinder::Scratch scratch = scene.footprints.make_scratch();
    for (const PlacedCourse& course : courses) {
        DraftCourse sketch;
        ASSERT_EQ(draw_sketch(scene.rules, course.member.candidate, scratch, sketch),
                  CandidateFault::None);
        EXPECT_EQ(sketch.course.footprint, course.member.footprint);
        EXPECT_EQ(sketch.course.length_mm, course.member.length_mm);
        EXPECT_LE(std::abs(course.member.candidate.slip_ratio), scene.rules.tow.friction.holds());
        EXPECT_LE(
            std::abs(course.member.candidate.slip_ratio + course.member.candidate.more_behind),
            scene.rules.tow.friction.holds());
        const SurfacePath way = course.backward ? reversed(course.path) : course.path;
        EXPECT_TRUE(is_windable(scene.rules, way, taut_string(way), kSketchStep_mm));
    }
}

// What is left open is closed afterwards (balance_courses.h); mostly that is nothing but the
// fibre's ends.
TEST(Anneal, MostlyLeavesOneFibre) {
    const Scene& scene = tee();
    std::vector<int> loose;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        loose.push_back(loose_ends(scene.annealed({.seed = seed, .proposals = 12'000}),
                                   scene.mandrel.rims.size()));
    }
    std::sort(loose.begin(), loose.end());
    EXPECT_LE(loose[loose.size() / 2], 2);
}

TEST(Anneal, TakesOnlyWhatIsVerifiedAndGoesOnlyAllowedWays) {
    const Scene& scene = tee();
    AnnealOptions options{.proposals = 3'000};
    options.verify = [](PlacedCourse& course) { return course.member.length_mm > 150.0; };
    options.way = [](const NodePair& nodes) { return nodes.first % 2 == 0; };
    const auto courses = scene.annealed(options);
    ASSERT_FALSE(courses.empty());
    for (const PlacedCourse& course : courses) {
        EXPECT_GT(course.member.length_mm, 150.0);
        EXPECT_EQ(departure_node(start_of(course.member, course.backward)) % 2, 0U);
    }
}

TEST(Anneal, KeepsFixedCourses) {
    const Scene& scene = tee();
    ASSERT_FALSE(scene.members.empty());
    PlacedCourse fixed = scene.placed(0);
    fixed.link = 0;
    const auto courses = scene.annealed({.proposals = 3'000}, {fixed});
    EXPECT_TRUE(std::any_of(courses.begin(), courses.end(), [&](const PlacedCourse& course) {
        return course.link == 0 && course.member.length_mm == fixed.member.length_mm;
    }));
}

TEST(Anneal, IsTheSameForAnyNumberOfThreads) {
    set_thread_count(1);
    const auto one = tee().annealed({.proposals = 3'000});
    set_thread_count(2);
    const auto two = tee().annealed({.proposals = 3'000});
    set_thread_count(0);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].member.length_mm, two[i].member.length_mm);
        EXPECT_EQ(one[i].member.footprint, two[i].member.footprint);
        EXPECT_EQ(one[i].backward, two[i].backward);
    }
}

}  // namespace
}  // namespace meshwind
