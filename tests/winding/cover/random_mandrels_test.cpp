// Plans for mandrels drawn at random, each judged again from scratch: against the ideal surface
// that the mesh was made of, by nothing but the positions of the fibre.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/text/text_number.h"
#include "tests/support/fixtures.h"
#include "winding/cover/cover.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kExtension_mm = 100.0;
constexpr double kWidth_mm = 10.0;
constexpr double kFriction = 0.3;
constexpr double kBridge_mm = 0.5;
constexpr double kHead_mm = 10.0;
constexpr double kClearance_mm = 5.0;

// Fibre on a mesh with edges h on radii r is off the ideal surface by some h^2 / (8 r), 0.1 mm.
constexpr double kOffSurface_mm = 0.1;

// An error e of positions is one of 16 e / w^2 of curvatures over a window w of one and a half
// bands; fitted patches are good to some 0.01 mm.
constexpr double kWindow_mm = 1.5 * kWidth_mm;
constexpr double kCurvatureError_per_mm = 16.0 * 0.01 / (kWindow_mm * kWindow_mm);

struct Shape {
    std::string kind;
    MakeValues values;
    double edge_mm = 4.0;
};

Shape random_tee(test::Draw& draw) {
    const double run = draw.between(28.0, 45.0);
    const double branch = draw.between(0.6, 0.95) * run;
    const double blend = draw.between(10.0, 18.0);
    return {"tee",
            {{"run-radius", run},
             {"branch-radius", branch},
             {"blend-radius", blend},
             {"run-length", 2.0 * (branch + blend) + draw.between(60.0, 120.0)},
             {"branch-length", run + blend + draw.between(30.0, 60.0)}},
            3.5};
}

// A tee whose branch leans, a Y.
Shape random_lateral(test::Draw& draw) {
    const double run = draw.between(28.0, 40.0);
    const double branch = draw.between(0.6, 0.85) * run;
    const double blend = draw.between(9.0, 12.0);
    return {"tee",
            {{"run-radius", run},
             {"branch-radius", branch},
             {"blend-radius", blend},
             {"lean", draw.between(0.2, 0.6)},
             {"run-length", 4.0 * (branch + blend) + draw.between(60.0, 120.0)},
             {"branch-length", 2.0 * (run + blend) + draw.between(30.0, 60.0)}},
            3.5};
}

Shape random_frame(test::Draw& draw) {
    const double pipe = draw.between(15.0, 25.0);
    return {"frame",
            {{"pipe-radius", pipe},
             {"bend-radius", draw.between(4.0, 8.0) * pipe},
             {"angle", draw.between(0.2, 1.0)},
             {"leg1", draw.between(60.0, 150.0)},
             {"leg2", draw.between(60.0, 150.0)}},
            3.5};
}

Shape random_cone(test::Draw& draw) {
    const double wide = draw.between(30.0, 50.0);
    return {"cone",
            {{"radius1", wide},
             {"radius2", draw.between(0.6, 0.9) * wide},
             {"length", draw.between(120.0, 200.0)}},
            4.0};
}

// The ideal surface in the mandrel's frame.
class Ideal {
public:
    Ideal(const Shape& shape, const Mandrel& mandrel)
        : shape_(shape), to_mandrel_(mandrel.file_to_mandrel) {}

    [[nodiscard]] ShapeFoot foot(const Vector3d& place_mm) const {
        ShapeFoot foot = mandrel_foot(shape_.kind, shape_.values, to_mandrel_.inverse() * place_mm);
        foot.point_mm = to_mandrel_ * foot.point_mm;
        foot.normal = to_mandrel_.linear() * foot.normal;
        return foot;
    }

private:
    const Shape& shape_;
    Eigen::Affine3d to_mandrel_;
};

// The place at an arc length, on the cubic between two stations: its stations are up to an edge
// apart, and halfway along their chord it would be 0.1 mm inside.
Vector3d place_at(const SurfacePath& path, double s_mm) {
    const auto after = std::lower_bound(path.begin() + 1, path.end() - 1, s_mm,
                                        [](const PathPoint& p, double s) { return p.s_mm < s; });
    const auto before = after - 1;
    const double length = std::max(1e-9, after->s_mm - before->s_mm);
    const double t = (s_mm - before->s_mm) / length;
    const double r = 1.0 - t;
    return r * r * (1.0 + 2.0 * t) * before->position_mm +
           t * t * (1.0 + 2.0 * r) * after->position_mm +
           length * r * t * (r * before->tangent - t * after->tangent);
}

struct Found {
    double off_surface_mm = 0.0;
    double beyond_friction_per_mm = 0.0;  ///< |kg| - friction kn
    double chord_over_wall_mm = 0.0;
};

// What a course does on the ideal surface. Slip where the fibre presses on the wall for the whole
// window: at the ends of bridges it does so at one place only.
Found judge_again(const Ideal& ideal, const Piece& course) {
    Found found;
    const SurfacePath& path = course.path;
    for (const PathPoint& station : path) {
        found.off_surface_mm =
            std::max(found.off_surface_mm, std::abs(ideal.foot(station.position_mm).distance_mm));
    }
    const double half = 0.5 * kWindow_mm;
    const double length = path.back().s_mm;
    for (double s = half; s + half < length; s += 0.3 * kWidth_mm) {
        bool lies = true;
        for (std::size_t i = 0; i < path.size(); ++i) {
            lies = lies && (std::abs(path[i].s_mm - s) > 2.0 * kWindow_mm ||
                            course.string.gap_mm[i] <= 0.0);
        }
        const ShapeFoot before = ideal.foot(place_at(path, s - half));
        const ShapeFoot here = ideal.foot(place_at(path, s));
        const ShapeFoot after = ideal.foot(place_at(path, s + half));
        const Vector3d in = here.point_mm - before.point_mm;
        const Vector3d out = after.point_mm - here.point_mm;
        const Vector3d bend = 2.0 * (out.normalized() - in.normalized()) / (in.norm() + out.norm());
        const Vector3d along = (in + out).normalized();
        const double kn = -bend.dot(here.normal);
        const double kg = bend.dot(here.normal.cross(along));
        if (lies) {
            found.beyond_friction_per_mm = std::max(found.beyond_friction_per_mm,
                                                    std::abs(kg) - kFriction * std::max(0.0, kn));
        }
        // A taut fibre runs along the highest chords: none may be far over the wall.
        for (double reach = kWidth_mm; s + reach < length && reach < 40.0; reach += kWidth_mm) {
            const Vector3d middle = 0.5 * (here.point_mm + place_at(path, s + reach));
            const ShapeFoot under = ideal.foot(place_at(path, s + 0.5 * reach));
            found.chord_over_wall_mm =
                std::max(found.chord_over_wall_mm, (middle - under.point_mm).dot(under.normal));
        }
    }
    return found;
}

// A planner without a machine estimates clearances from a table, good to some tenths of a mm, at
// stations 2 mm apart.
constexpr double kRoom_mm = 0.5;

// At each station, but for those that the fibre passes over and those next to them, where it leaves
// the wall and meets it again, there is a length at which it runs free and the head has room.
bool has_room(const RayQuery& obstacles, const FreeFibreRule& rule, const Piece& course) {
    const auto lifted = [&](std::size_t i) {
        return course.string.gap_mm[i] > 0.0 || course.string.slope[i] > 0.0;
    };
    for (std::size_t i = 0; i < course.path.size(); ++i) {
        const PathPoint& station = course.path[i];
        bool room =
            lifted(i) || (i > 0 && lifted(i - 1)) || (i + 1 < course.path.size() && lifted(i + 1));
        const Vector3d start = station.position_mm + rule.stand_off_mm * station.normal +
                               rule.start_mm * station.tangent;
        for (double length = rule.min_mm; !room && length <= rule.max_mm; length += 1.0) {
            const Vector3d eye = station.position_mm + length * station.tangent;
            room = !obstacles.occluded(start, eye) &&
                   obstacles.closest(eye, 1e3).distance_mm >= kHead_mm + kClearance_mm - kRoom_mm;
        }
        if (!room) {
            return false;
        }
    }
    return true;
}

constexpr int kPlaces = 600;

// The share of places drawn on the mesh that lie under a course: within half a band of a station's
// line, on the same side of the wall.
double share_covered(const Surface& surface, const std::vector<const Piece*>& courses,
                     test::Draw& draw) {
    const auto face_count = static_cast<std::int32_t>(surface.face.size());
    double covered = 0.0;
    double all = 0.0;
    for (int k = 0; k < kPlaces; ++k) {
        const auto& v = surface.face[static_cast<std::size_t>(draw.below(face_count))];
        const auto corner = [&](std::size_t i) {
            return surface.position_mm[static_cast<std::size_t>(v[i])];
        };
        const double a = draw.between(0.0, 1.0);
        const double b = draw.between(0.0, 1.0 - a);
        const Vector3d place = a * corner(0) + b * corner(1) + (1.0 - a - b) * corner(2);
        const Vector3d across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        const bool under = std::any_of(courses.begin(), courses.end(), [&](const Piece* course) {
            const SurfacePath& path = course->path;
            for (std::size_t i = 1; i < path.size(); ++i) {
                const Vector3d way = path[i].position_mm - path[i - 1].position_mm;
                const double share = std::clamp(
                    (place - path[i - 1].position_mm).dot(way) / way.squaredNorm(), 0.0, 1.0);
                const Vector3d nearest = path[i - 1].position_mm + share * way;
                if ((place - nearest).norm() < 0.5 * kWidth_mm &&
                    path[i].normal.dot(across) > 0.0) {
                    return true;
                }
            }
            return false;
        });
        all += across.norm();
        covered += under ? across.norm() : 0.0;
    }
    return covered / all;
}

bool plan_and_judge_again(const Shape& shape, std::uint64_t seed) {
    std::string words = shape.kind;
    for (const auto& [name, value] : shape.values) {
        words += ' ' + name + ' ' + fixed(value, 2);
    }
    SCOPED_TRACE(words);
    const Mandrel mandrel = test::made(shape.kind, shape.values, shape.edge_mm);
    const RayQuery obstacles = test::obstacles_of(mandrel, kExtension_mm, 80.0);
    CoverOptions options;
    options.tow.width_mm = kWidth_mm;
    options.tow.friction = kFriction;
    options.tow.bridging_tolerance_mm = kBridge_mm;
    options.turns.rule.extension_mm = kExtension_mm;
    options.free_fibre.min_mm = 40.0;
    options.free_fibre.head_radius_mm = kHead_mm;
    options.free_fibre.clearance_mm = kClearance_mm;
    options.free_fibre.start_mm = 2.0 * mandrel.surface.mean_edge_mm;
    options.context.seed = seed;
    options.context.effort = 0.05;  // the rules do not depend on it
    options.candidates = 3000;
    options.rounds = 1;
    options.aimed_candidates = 1000;
    options.scarce_candidates = 1000;
    const Plan plan = plan_cover(mandrel, obstacles, options).plan;
    if (!plan.failure.empty()) {
        EXPECT_TRUE(plan.pieces.empty());
        std::printf("%s: %s\n", words.c_str(), plan.failure.c_str());
        return false;
    }
    const Ideal ideal(shape, mandrel);
    std::vector<const Piece*> courses;
    Found worst;
    for (const Piece& piece : plan.pieces) {
        if (piece.kind != PieceKind::Course) {
            continue;
        }
        courses.push_back(&piece);
        const Found found = judge_again(ideal, piece);
        EXPECT_LT(found.off_surface_mm, kOffSurface_mm);
        EXPECT_LT(found.beyond_friction_per_mm, kCurvatureError_per_mm);
        EXPECT_LT(found.chord_over_wall_mm, kBridge_mm + kOffSurface_mm);
        EXPECT_TRUE(has_room(obstacles, options.free_fibre, piece));
        worst.off_surface_mm = std::max(worst.off_surface_mm, found.off_surface_mm);
        worst.beyond_friction_per_mm =
            std::max(worst.beyond_friction_per_mm, found.beyond_friction_per_mm);
        worst.chord_over_wall_mm = std::max(worst.chord_over_wall_mm, found.chord_over_wall_mm);
    }
    EXPECT_EQ(plan.fibres, 1);
    EXPECT_EQ(static_cast<int>(courses.size()), plan.courses);
    test::Draw draw(seed);
    const double covered = share_covered(mandrel.surface, courses, draw);
    // Three standard deviations of so many places, and a band's edge that is known to 0.3 mm.
    const double fraction = plan.coverage.fraction;
    EXPECT_NEAR(covered, fraction, 3.0 * std::sqrt(fraction * (1.0 - fraction) / kPlaces) + 0.02);
    std::printf(
        "%s: %d courses, covered %.3f (again %.3f), off %.3f mm, beyond friction %.5f / mm, "
        "chord over wall %.3f mm\n",
        words.c_str(), plan.courses, fraction, covered, worst.off_surface_mm,
        worst.beyond_friction_per_mm, worst.chord_over_wall_mm);
    return true;
}

// \return how many of the mandrels could be planned
int plan_and_judge_again(Shape (*random_shape)(test::Draw&), int count) {
    int planned = 0;
    for (int k = 0; k < count; ++k) {
        const auto seed = static_cast<std::uint64_t>(k + 1);
        test::Draw draw(100 + seed);
        planned += plan_and_judge_again(random_shape(draw), seed) ? 1 : 0;
    }
    return planned;
}

TEST(RandomMandrels, TeesKeepEveryRule) {
    EXPECT_EQ(plan_and_judge_again(random_tee, 3), 3);
}

TEST(RandomMandrels, YsKeepEveryRule) {
    EXPECT_EQ(plan_and_judge_again(random_lateral, 2), 2);
}

TEST(RandomMandrels, FramesKeepEveryRule) {
    EXPECT_GE(plan_and_judge_again(random_frame, 3), 1);
}

TEST(RandomMandrels, ConesKeepEveryRule) {
    EXPECT_EQ(plan_and_judge_again(random_cone, 2), 2);
}

}  // namespace
}  // namespace meshwind
