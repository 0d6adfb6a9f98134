#include "winding/cover/library.h"
#include "tests/support/course_scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

// As many candidates to either side as along geodesics.
constexpr double kSteered = 0.8;

struct Scene : test::CourseScene {
    explicit Scene(Mandrel loaded) : CourseScene(std::move(loaded), Tow{}.friction.holds()) {
        rules.free_fibre.min_mm = 40.0;
    }
};

const Scene& cylinder_scene() {
    static const Scene scene(test::made_cylinder(30.0, 160.0, 5.0));
    return scene;
}

const Scene& tee_scene() {
    static const Scene scene(test::small_tee(6.0));
    return scene;
}

void expect_ends_at_rims(const Scene& scene, const LibraryCourse& member, const SurfacePath& path) {
    for (std::size_t e = 0; e < 2; ++e) {
        const RimCrossing& end = member.end[e];
        ASSERT_GE(end.rim, 0);
        ASSERT_LT(end.rim, static_cast<std::int32_t>(scene.mandrel.rims.size()));
        const Rim& rim = scene.mandrel.rims[static_cast<std::size_t>(end.rim)];
        const PathPoint& last = e == 0 ? path.front() : path.back();
        const Eigen::Vector3d outward = e == 0 ? Eigen::Vector3d(-last.tangent) : last.tangent;
        const Eigen::Vector3d d = last.position_mm - rim.centre_mm;
        // On the patch over the rim's edge: lifted from the chord by up to 0.2 mm along normals
        // that lean against the rim's plane by a few mrad at most; the chord itself lies that far
        // inside.
        EXPECT_NEAR(d.dot(rim.axis), 0.0, 5e-3);
        EXPECT_NEAR(d.norm(), rim.radius_mm, 0.02);
        const RimCrossing again = crossing_at(rim, last.position_mm, outward);
        EXPECT_NEAR(std::remainder(again.azimuth_rad - end.azimuth_rad, 2.0 * kPi), 0.0, 1e-9);
        EXPECT_NEAR(again.angle_rad, end.angle_rad, 1e-9);
        EXPECT_EQ(again.sense, end.sense);
        EXPECT_TRUE(can_turn(rim, end, scene.rules.turns));
    }
}

// kg against kn as the path states them: it was never steered harder than the candidate says.
void expect_steered_within(const Candidate& candidate, const SurfacePath& path) {
    for (const PathPoint& p : path) {
        ASSERT_LE(std::abs(p.kg_per_mm),
                  std::abs(candidate.slip_ratio) * std::max(0.0, p.kn_per_mm) + 1e-12);
    }
}

// Independent of the library's own stations: every 15 mm there is a free length, each way stated.
void expect_windable(const Scene& scene, const SurfacePath& path) {
    const TautString string = taut_string(path);
    int blocked = 0;
    int tried = 0;
    double next = 3.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (path[i].s_mm < next) {
            continue;
        }
        next = path[i].s_mm + 15.0;
        const StringPoint fibre = string_point(path[i], string.gap_mm[i], string.slope[i]);
        ++tried;
        blocked += free_fibre_windows(scene.obstacles, fibre.position_mm, path[i].normal,
                                      fibre.tangent, scene.rules.free_fibre)
                           .empty()
                       ? 1
                       : 0;
    }
    // Between the stations that were judged a window may just close.
    EXPECT_LE(blocked, tried / 10);
}

void expect_members_keep_the_rules(const Scene& scene, int candidates, std::size_t least) {
    FootprintFinder::Scratch scratch = scene.footprints.make_scratch();
    std::size_t admitted = 0;
    for (const Candidate& candidate : scene.candidates(candidates, 11, kSteered)) {
        LibraryCourse member;
        if (judge(scene.rules, candidate, scratch, member) != CandidateFault::None) {
            continue;
        }
        ++admitted;
        const SurfacePath path = trace_both_ways(scene.rules, member.candidate);
        ASSERT_GE(path.size(), 2U);
        EXPECT_NEAR(path.back().s_mm, member.length_mm, 1e-9);
        expect_ends_at_rims(scene, member, path);
        expect_steered_within(member.candidate, path);
        const TautString string = taut_string(path);
        EXPECT_LE(string.worst_gap_mm, scene.rules.tow.bridging_tolerance_mm);
        EXPECT_LE(measure_slip(scene.mandrel.surface, path, string,
                               {.friction = scene.rules.tow.friction.holds(),
                                .method = TraceMethod::Patches})
                      .worst,
                  scene.rules.tow.friction.holds());
        EXPECT_EQ(scene.footprints.footprint(path, scratch), member.footprint);
        EXPECT_TRUE(member.windable_forward || member.windable_backward);
        if (member.windable_forward) {
            expect_windable(scene, path);
        }
        if (member.windable_backward) {
            expect_windable(scene, reversed(path));
        }
    }
    EXPECT_GE(admitted, least);
}

TEST(Judge, MembersOnACylinderKeepEveryRule) {
    expect_members_keep_the_rules(cylinder_scene(), 300, 20);
}

TEST(Judge, MembersOnATeeKeepEveryRule) {
    expect_members_keep_the_rules(tee_scene(), 600, 10);
}

// A sketch is a first opinion: nearly all that it admits the patches admit too, nearly where the
// sketch has it, and hardly anything else.
void expect_sketches_like_courses(const Scene& scene, int candidates) {
    const auto tried = scene.candidates(candidates, 12, kSteered);
    const LibraryPart library = build_library(scene.rules, tried);
    ASSERT_EQ(library.outcome.size(), tried.size());
    FootprintFinder::Scratch scratch = scene.footprints.make_scratch();
    std::size_t next = 0;
    int agreed = 0;
    int differed = 0;
    int both = 0;
    int apart = 0;
    for (std::size_t i = 0; i < tried.size(); ++i) {
        LibraryCourse exact;
        const bool holds = judge(scene.rules, tried[i], scratch, exact) == CandidateFault::None;
        const bool sketched = library.outcome[i] == CandidateFault::None;
        (holds == sketched ? agreed : differed) += holds || sketched ? 1 : 0;
        if (!sketched) {
            continue;
        }
        const LibraryCourse& sketch = library.members[next++];
        if (holds) {
            EXPECT_EQ(sketch.end[0].rim, exact.end[0].rim);
            EXPECT_EQ(sketch.end[1].rim, exact.end[1].rim);
            ++both;
            apart += std::abs(sketch.length_mm / exact.length_mm - 1.0) > 0.03 ? 1 : 0;
        }
    }
    EXPECT_EQ(next, library.members.size());
    // Both follow the same steering, the walk to second order only: a course that passes a saddle
    // several times may come out elsewhere.
    EXPECT_LE(apart, both / 20) << both;
    EXPECT_GT(agreed, 10);
    EXPECT_LT(differed, agreed / 4) << agreed;
}

TEST(BuildLibrary, SketchesOnACylinderAreLikeTheCourses) {
    expect_sketches_like_courses(cylinder_scene(), 400);
}

TEST(BuildLibrary, SketchesOnATeeAreLikeTheCourses) {
    expect_sketches_like_courses(Scene(test::small_tee(3.0)), 600);
}

// The steering of the part behind the seed is its own.
TEST(TraceBothWays, SteersAheadAndBehindTheSeed) {
    const Scene& scene = cylinder_scene();
    for (Candidate candidate : scene.candidates(20, 14, kSteered)) {
        candidate.slip_ratio = 0.1;
        candidate.more_behind = -0.25;
        const SurfacePath path = trace_both_ways(scene.rules, candidate);
        const Eigen::Vector3d seed = position_mm(scene.mandrel.surface, candidate.seed);
        bool behind = true;
        for (const PathPoint& p : path) {
            if ((p.position_mm - seed).norm() < 0.5) {
                behind = false;
                continue;
            }
            ASSERT_NEAR(p.kg_per_mm, (behind ? -0.15 : 0.1) * p.kn_per_mm, 1e-9);
        }
        EXPECT_FALSE(behind);
    }
}

TEST(BuildLibrary, IsTheSameForAnyNumberOfThreads) {
    const Scene& scene = tee_scene();
    const auto candidates = scene.candidates(200, 13, kSteered);
    set_thread_count(1);
    const LibraryPart one = build_library(scene.rules, candidates);
    set_thread_count(2);
    const LibraryPart two = build_library(scene.rules, candidates);
    set_thread_count(0);
    EXPECT_EQ(one.outcome, two.outcome);
    ASSERT_EQ(one.members.size(), two.members.size());
    for (std::size_t i = 0; i < one.members.size(); ++i) {
        EXPECT_EQ(one.members[i].length_mm, two.members[i].length_mm);
        EXPECT_EQ(one.members[i].footprint, two.members[i].footprint);
    }
}

TEST(Judge, LeavesTheMemberAsItWasOnRefusal) {
    const Scene& scene = cylinder_scene();
    // Exactly axial: it cannot be turned by friction.
    const Eigen::Vector3d n = smooth_normal(scene.mandrel.surface, scene.samples.at[0]);
    const Eigen::Vector3d x = n.unitOrthogonal();
    const double axial =
        std::atan2(Eigen::Vector3d::UnitZ().dot(n.cross(x)), Eigen::Vector3d::UnitZ().dot(x));
    LibraryCourse member;
    member.length_mm = 42.0;
    FootprintFinder::Scratch scratch = scene.footprints.make_scratch();
    EXPECT_EQ(judge(scene.rules, {scene.samples.at[0], axial, 0.0}, scratch, member),
              CandidateFault::NotTurnable);
    EXPECT_EQ(member.length_mm, 42.0);
    // Exactly hoop: it meets no rim.
    EXPECT_EQ(judge(scene.rules, {scene.samples.at[0], axial + 0.5 * kPi, 0.0}, scratch, member),
              CandidateFault::NoRim);
}

TEST(RefusalNames, AreDistinctWords) {
    std::set<std::string> names;
    for (std::size_t r = 0; r < kCandidateFaults; ++r) {
        names.insert(name_of(static_cast<CandidateFault>(r)));
    }
    EXPECT_EQ(names.size(), kCandidateFaults);
    EXPECT_EQ(names.count(""), 0U);
}

}  // namespace
}  // namespace meshwind
