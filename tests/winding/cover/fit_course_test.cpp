#include "winding/cover/fit_course.h"
#include "tests/support/course_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

struct Scene : test::CourseScene {
    explicit Scene(Mandrel loaded)
        : CourseScene(std::move(loaded), 0.3),
          strips(mandrel.surface, samples, kStripBands * kBand_mm) {}

    // A course as the walk follows it; none where it meets no rims or bridges.
    [[nodiscard]] std::optional<PlacedCourse> placed(const Candidate& candidate) const {
        DraftCourse sketch;
        FootprintFinder::Scratch scratch = footprints.make_scratch();
        if (draw_sketch(rules, candidate, scratch, sketch) != CandidateFault::None) {
            return std::nullopt;
        }
        return PlacedCourse{sketch.course, sketch.path, false, false};
    }

    [[nodiscard]] std::optional<PlacedCourse> moved_by(const PlacedCourse& course,
                                                       const CourseMove& move) const {
        return placed(moved(rules, course, seed_station(course), move));
    }

    FootprintFinder strips;
};

const Scene& cylinder() {
    static const Scene scene(test::made_cylinder(30.0, 160.0, 5.0));
    return scene;
}

const Scene& tee() {
    static const Scene scene(test::small_tee(3.0));
    return scene;
}

std::set<std::int32_t> samples_of(const PlacedCourse& course) {
    return {course.member.footprint.begin(), course.member.footprint.end()};
}

// +1 for what is inside `wanted`, -1 for the rest.
double score(const PlacedCourse& course, const std::set<std::int32_t>& wanted) {
    double sum = 0.0;
    for (const std::int32_t sample : samples_of(course)) {
        sum += wanted.contains(sample) ? 1.0 : -1.0;
    }
    return sum;
}

// How far the places of a path are from the nearest stations of another, at most.
double farthest_mm(const SurfacePath& path, const SurfacePath& from) {
    double farthest = 0.0;
    for (const PathPoint& point : path) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const PathPoint& other : from) {
            nearest = std::min(nearest, (point.position_mm - other.position_mm).norm());
        }
        farthest = std::max(farthest, nearest);
    }
    return farthest;
}

Fit fit_to(const Scene& scene, const PlacedCourse& course, const std::set<std::int32_t>& wanted) {
    FootprintFinder::Scratch scratch = scene.strips.make_scratch();
    const Strip strip = scene.strips.strip(course.path, scratch);
    std::vector<float> saving;
    for (const std::int32_t sample : strip.sample) {
        saving.push_back(wanted.contains(sample) ? 1.0F : -1.0F);
    }
    return fit_course(scene.rules, course, strip, saving);
}

// Where a course has been moved away from what it is to cover, the fit moves it back. The answer is
// the move itself, traced anew: nothing in it comes from the fit's linear theory.
void expect_finds_the_way_back(const Scene& scene) {
    test::Draw draw(3);
    std::vector<double> left_over;  // shares of what was lost
    int worse = 0;
    int broken = 0;  // promises
    for (const Candidate& candidate : scene.candidates(400, 7, 0.4)) {
        const auto course = scene.placed(candidate);
        if (!course || course->member.length_mm > 600.0) {
            continue;  // of long ones the places far from the seed move by more than a fit may
        }
        const auto away =
            scene.moved_by(*course, {draw.between(-1.0, 1.0), draw.between(-0.01, 0.01),
                                     draw.between(-0.02, 0.02), draw.between(-0.02, 0.02)});
        if (!away ||
            farthest_mm(course->path, away->path) > kFitBands * test::CourseScene::kBand_mm) {
            continue;  // a fit may not move it so far
        }
        const std::set<std::int32_t> wanted = samples_of(*course);
        const auto most = static_cast<double>(wanted.size());
        const double before = score(*away, wanted);
        const Fit fit = fit_to(scene, *away, wanted);
        const auto back = scene.moved_by(*away, fit.move);
        if (!back || most - before < 0.05 * most) {
            continue;
        }
        const double after = score(*back, wanted);
        left_over.push_back((most - after) / (most - before));
        worse += after <= before ? 1 : 0;
        // The band's edge is a slope to the fit.
        broken += std::abs(fit.saved - after) > 0.1 * most ? 1 : 0;
    }
    const auto found = static_cast<int>(left_over.size());
    ASSERT_GT(found, 20);
    // Where a saddle parts neighbours quickly first order does not reach far.
    EXPECT_LE(worse, found / 20);
    EXPECT_LE(broken, found / 20);
    const double mean = std::accumulate(left_over.begin(), left_over.end(), 0.0) / found;
    EXPECT_LT(mean, 0.35);
}

TEST(FitCourse, FindsTheWayBackOnACylinder) {
    expect_finds_the_way_back(cylinder());
}

TEST(FitCourse, FindsTheWayBackOnATee) {
    expect_finds_the_way_back(tee());
}

TEST(FitCourse, MovesNoPlaceTooFar) {
    const Scene& scene = cylinder();
    int tried = 0;
    for (const Candidate& candidate : scene.candidates(60, 9, 0.0)) {
        const auto course = scene.placed(candidate);
        if (!course) {
            continue;
        }
        // All that lies to the left is wanted: it would go on for ever.
        FootprintFinder::Scratch scratch = scene.strips.make_scratch();
        const Strip strip = scene.strips.strip(course->path, scratch);
        std::vector<float> saving;
        for (const float left : strip.left_mm) {
            saving.push_back(left > 0.0F ? 1.0F : -1.0F);
        }
        const Fit fit = fit_course(scene.rules, *course, strip, saving);
        const auto moved = scene.moved_by(*course, fit.move);
        if (!moved) {
            continue;
        }
        ++tried;
        EXPECT_GT(fit.move.left_mm, 0.0);
        for (const PathPoint& point : course->path) {
            if (std::min(point.s_mm, course->member.length_mm - point.s_mm) < 40.0) {
                continue;  // it meets the rim earlier or later
            }
            double nearest = std::numeric_limits<double>::infinity();
            for (const PathPoint& other : moved->path) {
                nearest = std::min(nearest, (other.position_mm - point.position_mm).norm());
            }
            // Stations are up to an edge apart.
            EXPECT_LT(nearest, kFitBands * test::CourseScene::kBand_mm + 3.0);
        }
    }
    EXPECT_GT(tried, 10);
}

TEST(FitCourse, StaysWhereNothingIsToBeSaved) {
    const Scene& scene = cylinder();
    const auto course = scene.placed({scene.samples.at.front(), 0.5, 0.0});
    ASSERT_TRUE(course);
    FootprintFinder::Scratch scratch = scene.strips.make_scratch();
    const Strip strip = scene.strips.strip(course->path, scratch);
    const std::vector<float> saving(strip.sample.size(), 0.0F);
    const Fit fit = fit_course(scene.rules, *course, strip, saving);
    EXPECT_EQ(fit.saved, 0.0);
    EXPECT_EQ(fit.move.left_mm, 0.0);
    EXPECT_EQ(fit.move.turn_rad, 0.0);
}

// Sketches end where pins take hold of them, and a fit moves no end from there to first order.
TEST(FitCourse, KeepsEndsAtPins) {
    Scene scene(test::made_cylinder(30.0, 160.0, 5.0));
    std::string failure;
    scene.rules.turns.pins = stand_pins(
        scene.mandrel.rims, {}, {.width_mm = Scene::kBand_mm, .thickness_mm = 0.25}, 40.0, failure);
    ASSERT_EQ(failure, "");
    int fitted = 0;
    for (std::size_t i = 0; i < 40; ++i) {
        const SurfacePoint& seed = scene.samples.at[i * scene.samples.size() / 40];
        const auto course = scene.placed({seed, 0.3 + 0.02 * static_cast<double>(i), 0.0});
        const auto wanted = scene.placed({seed, 0.3 + 0.02 * static_cast<double>(i), 0.2});
        if (!course || !wanted) {
            continue;
        }
        EXPECT_TRUE(ends_at_pins(scene.rules, course->member, 0.2));
        const Fit fit = fit_to(scene, *course, samples_of(*wanted));
        if (std::abs(fit.move.steering) + std::abs(fit.move.behind) < 1e-3) {
            continue;
        }
        ++fitted;
        CourseMove tenth = fit.move;
        for (double* part : {&tenth.left_mm, &tenth.turn_rad, &tenth.steering, &tenth.behind}) {
            *part *= 0.1;
        }
        const auto off_at = [&](const CourseMove& move, std::size_t e) {
            const Candidate to = moved(scene.rules, *course, seed_station(*course), move);
            const SurfacePath path = trace_both_ways(scene.rules, to, TraceMethod::Walk);
            const Rim& rim =
                scene.mandrel.rims[static_cast<std::size_t>(course->member.end[e].rim)];
            const PathPoint& last = e == 0 ? path.front() : path.back();
            const Eigen::Vector3d outward = e == 0 ? Eigen::Vector3d(-last.tangent) : last.tangent;
            return off_pins_mm(rim, crossing_at(rim, last.position_mm, outward), scene.rules.turns);
        };
        for (const std::size_t e : {std::size_t{0}, std::size_t{1}}) {
            EXPECT_NEAR(off_at(tenth, e), off_at({}, e), 0.1);  // of moves by up to 0.4 mm
        }
    }
    EXPECT_GE(fitted, 5);
}

}  // namespace
}  // namespace meshwind
