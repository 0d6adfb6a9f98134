// Starts and directions on vertices, edges and rims, needles, limits: decided, never looped on.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/index.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/reference.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Square grid in the plane z = 0, unit cells, all diagonals one way.
Surface grid(int cells) {
    TriangleSoup soup;
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) {
            soup.points_mm.emplace_back(i, j, 0.0);
        }
    }
    for (std::int32_t j = 0; j < cells; ++j) {
        for (std::int32_t i = 0; i < cells; ++i) {
            const std::int32_t a = j * (cells + 1) + i;
            const std::int32_t b = a + cells + 1;
            soup.faces.push_back({a, a + 1, b});
            soup.faces.push_back({a + 1, b + 1, b});
        }
    }
    return test::frozen(soup);
}

// A path through a vertex passes it 1e-9 of an edge to one side; over 20 cells that is 2e-8 mm.
constexpr double kVertexDrift_mm = 1e-7;

class TraceDegenerate : public test::BothTracers {
protected:
    static void expect_line(const Surface& surface, const SurfacePoint& start,
                            const Vector3d& direction, double length_mm) {
        const TraceOptions options{.max_length_mm = length_mm};
        const TraceResult traced = trace(surface, start, direction, {}, options);
        expect_sound(surface, traced, options);
        EXPECT_EQ(traced.stop, TraceStop::Length);
        const Vector3d end = position_mm(surface, start) + length_mm * direction.normalized();
        EXPECT_LT((traced.path.back().position_mm - end).norm(), kVertexDrift_mm)
            << "from " << position_mm(surface, start).transpose() << " along "
            << direction.transpose();
    }
};

INSTANTIATE_TEST_SUITE_P(, TraceDegenerate,
                         testing::Values(TraceMethod::Walk, TraceMethod::Patches),
                         test::method_name);

// Every face around the vertex names the same start; directions along mesh lines included.
TEST_P(TraceDegenerate, StartsOnAVertexInAnyDirection) {
    const Surface surface = grid(20);
    constexpr std::int32_t kVertex = 10 * 21 + 10;
    int faces = 0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            if (surface.face[f][c] != kVertex) {
                continue;
            }
            ++faces;
            SurfacePoint start{static_cast<std::int32_t>(f), Vector3d::Zero()};
            start.bary[static_cast<std::int32_t>(c)] = 1.0;
            for (int i = 0; i < 48; ++i) {
                const double angle = 2.0 * kPi * i / 48.0;  // the mesh lines are among these
                expect_line(surface, start, {std::cos(angle), std::sin(angle), 0.0}, 7.3);
            }
        }
    }
    EXPECT_EQ(faces, 6);
}

TEST_P(TraceDegenerate, StartsOnAnEdgeInAnyDirection) {
    const Surface surface = grid(20);
    for (const std::int32_t face : {420, 421}) {
        for (int c = 0; c < 3; ++c) {
            for (const double share : {0.5, 1e-3, 1e-9, 1e-12, 1e-300}) {
                SurfacePoint start{face, Vector3d::Zero()};
                start.bary[c] = share;
                start.bary[(c + 1) % 3] = 1.0 - share;
                for (int i = 0; i < 48; ++i) {
                    const double angle = 2.0 * kPi * i / 48.0;
                    expect_line(surface, start, {std::cos(angle), std::sin(angle), 0.0}, 6.9);
                }
            }
        }
    }
}

// Along rows, columns and diagonals through vertices from rim to rim.
TEST_P(TraceDegenerate, PassesVerticesAlongMeshLines) {
    const Surface surface = grid(20);
    const SurfacePoint corner = test::point_in(2 * (10 * 20 + 10), 1.0, 0.0, 0.0);  // at (10, 10)
    for (const Vector3d& d :
         {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(-1, 0, 0), Vector3d(0, -1, 0),
          Vector3d(1, 1, 0), Vector3d(-1, 1, 0), Vector3d(1, -1, 0), Vector3d(-1, -1, 0)}) {
        const TraceResult traced = trace(surface, corner, d);
        expect_sound(surface, traced);
        EXPECT_EQ(traced.stop, TraceStop::Rim);
        EXPECT_NEAR(traced.path.back().s_mm, 10.0 * d.norm(), kVertexDrift_mm);
        expect_line(surface, corner, d, 9.0);
    }
}

// Inside the square or along its rim the trace goes on; out of it, it ends where it stands.
TEST_P(TraceDegenerate, StartsAtARim) {
    const Surface surface = grid(20);
    const SurfacePoint start = test::point_in(20, 0.5, 0.5, 0.0);  // (10.5, 0) on the lower rim
    for (int i = 0; i < 48; ++i) {
        const double angle = 2.0 * kPi * i / 48.0;
        const Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
        const TraceOptions options{.max_length_mm = 5.0};
        const TraceResult traced = trace(surface, start, direction, {}, options);
        expect_sound(surface, traced, options);
        if (direction.y() > 1e-9) {
            EXPECT_EQ(traced.stop, TraceStop::Length);
        } else if (direction.y() < -1e-9) {
            EXPECT_EQ(traced.stop, TraceStop::Rim);
            EXPECT_EQ(traced.path.back().s_mm, 0.0);
        }
    }
    for (int c = 0; c < 3; ++c) {  // the corner of the square: two rim edges at one vertex
        SurfacePoint corner{0, Vector3d::Zero()};
        corner.bary[c] = 1.0;
        for (int i = 0; i < 48; ++i) {
            const double angle = 2.0 * kPi * i / 48.0;
            const TraceOptions options{.max_length_mm = 5.0};
            expect_sound(
                surface,
                trace(surface, corner, {std::cos(angle), std::sin(angle), 0.0}, {}, options),
                options);
        }
    }
}

Surface icosahedron() {
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    TriangleSoup soup;
    for (const double s : {-1.0, 1.0}) {
        for (const double t : {-g, g}) {
            soup.points_mm.insert(soup.points_mm.end(), {{0, s, t}, {s, t, 0}, {t, 0, s}});
        }
    }
    for (std::int32_t a = 0; a < 12; ++a) {
        for (std::int32_t b = 0; b < 12; ++b) {
            for (std::int32_t c = 0; c < 12; ++c) {
                const auto& p = soup.points_mm;
                const auto apart = [&](std::int32_t i, std::int32_t j) {
                    return std::abs((p[at(i)] - p[at(j)]).norm() - 2.0) < 1e-9;
                };
                if (a < b && a < c && apart(a, b) && apart(b, c) && apart(c, a) &&
                    (p[at(b)] - p[at(a)]).cross(p[at(c)] - p[at(a)]).dot(p[at(a)]) > 0.0) {
                    soup.faces.push_back({a, b, c});
                }
            }
        }
    }
    return test::frozen(soup);
}

// Twenty faces, thirty creases (42 deg), twelve vertices: along each edge and across each vertex.
TEST_P(TraceDegenerate, EndsOnAnIcosahedron) {
    const Surface surface = icosahedron();
    ASSERT_EQ(surface.face.size(), 20U);
    const TraceOptions options{.max_length_mm = 50.0};
    for (std::int32_t f = 0; f < 20; ++f) {
        for (std::int32_t c = 0; c < 3; ++c) {
            SurfacePoint corner{f, Vector3d::Zero()};
            corner.bary[c] = 1.0;
            const auto& v = surface.face[at(f)];
            const Vector3d& p = surface.position_mm[at(v[at(c)])];
            const Vector3d& q = surface.position_mm[at(v[at((c + 1) % 3)])];
            const Vector3d& r = surface.position_mm[at(v[at((c + 2) % 3)])];
            for (const Vector3d& d : {Vector3d(q - p), Vector3d(p - q), Vector3d(r - p),
                                      Vector3d(q + r - 2.0 * p), Vector3d(2.0 * p - q - r)}) {
                const TraceResult traced = trace(surface, corner, d, {}, options);
                expect_sound(surface, traced, options);
                EXPECT_EQ(traced.stop, TraceStop::Length);
            }
        }
    }
}

// A plane strip of needles 100 mm long and 1e-4 mm wide, aspect 1e6: crossed, followed, and
// slanted.
TEST_P(TraceDegenerate, WalksOverNeedles) {
    constexpr int kNeedles = 2000;
    constexpr double kStep_mm = 1e-4;
    TriangleSoup soup;
    for (int i = 0; i <= kNeedles; ++i) {
        soup.points_mm.emplace_back(0.0, kStep_mm * i, 0.0);
        soup.points_mm.emplace_back(100.0, kStep_mm * i, 0.0);
    }
    for (std::int32_t i = 0; i < 2 * kNeedles; i += 2) {
        soup.faces.push_back({i, i + 1, i + 2});
        soup.faces.push_back({i + 1, i + 3, i + 2});
    }
    const Surface surface = test::frozen(soup);
    const SurfacePoint start = test::point_in(kNeedles, 0.3, 0.5, 0.2);
    const Vector3d from = position_mm(surface, start);
    for (const double angle :
         {0.0, 1e-7, 1e-6, 1e-3, 0.5, 0.5 * kPi, 2.0, kPi, -1e-6, -0.5 * kPi}) {
        const Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
        const TraceResult traced = trace(surface, start, direction);
        expect_sound(surface, traced);
        EXPECT_EQ(traced.stop, TraceStop::Rim) << angle;
        // Rounding of 100 mm over a height of 1e-4 mm tilts a needle's rates by 1e-10 at most; each
        // of up to 2000 crossings may add its share of a vertex clearance, 1e-7 mm.
        const Vector3d end = from + traced.path.back().s_mm * direction;
        EXPECT_LT((traced.path.back().position_mm - end).norm(), 1e-6) << angle;
    }
}

TEST_P(TraceDegenerate, StopsAtTheFaceLimit) {
    const Surface surface =
        test::frozen(make_mandrel("torus", {}, {.edge_mm = 10.0, .irregular = true}));
    for (const int limit : {1, 2, 17}) {
        const TraceResult traced =
            trace(surface, test::point_in(3, 0.2, 0.3, 0.5), {1, 2, 3}, {}, {.max_faces = limit});
        EXPECT_EQ(traced.stop, TraceStop::FaceLimit);
        EXPECT_LE(traced.path.size(), static_cast<std::size_t>(limit) + 1U);
    }
}

// Cut exactly, inside the first facet as after many.
TEST_P(TraceDegenerate, CutsExactlyAtTheLength) {
    const Surface surface =
        test::frozen(make_mandrel("torus", {}, {.edge_mm = 10.0, .irregular = true}));
    for (const double length : {1e-300, 1e-9, 1e-4, 0.1, 33.3, 777.7}) {
        const TraceOptions options{.max_length_mm = length};
        const TraceResult traced =
            trace(surface, test::point_in(3, 0.2, 0.3, 0.5), {1, 2, 3}, {0.1, 0.0}, options);
        expect_sound(surface, traced, options);
        EXPECT_EQ(traced.stop, TraceStop::Length);
        EXPECT_EQ(traced.path.back().s_mm, length);
    }
}

// The direction is projected: its share along the normal and its length change nothing but
// rounding.
TEST_P(TraceDegenerate, ProjectsTheDirection) {
    const Surface surface =
        test::frozen(make_mandrel("torus", {}, {.edge_mm = 10.0, .irregular = true}));
    const SurfacePoint start = test::point_in(3, 0.2, 0.3, 0.5);
    const Vector3d n = GetParam() == TraceMethod::Walk
                           ? smooth_normal(surface, start)
                           : on_patch(surface, start.face, start.bary).normal();
    const Vector3d t = n.unitOrthogonal();
    const TraceOptions options{.max_length_mm = 100.0};
    const Vector3d end = trace(surface, start, t, {}, options).path.back().position_mm;
    for (const Vector3d& d : {Vector3d(1e6 * t), Vector3d(1e-6 * t), Vector3d(t + 3.0 * n)}) {
        const Vector3d other = trace(surface, start, d, {}, options).path.back().position_mm;
        EXPECT_LT((other - end).norm(), 1e-10);
    }
}

// Signed zeros in the start and the direction are plain zeros.
TEST_P(TraceDegenerate, TakesNegativeZeros) {
    const Surface surface = grid(20);
    const SurfacePoint plus = test::point_in(420, 0.5, 0.5, 0.0);
    const SurfacePoint minus = test::point_in(420, 0.5, 0.5, -0.0);
    const TraceOptions options{.max_length_mm = 5.0};
    const TraceResult a = trace(surface, plus, {1.0, 0.0, 0.0}, {}, options);
    const TraceResult b = trace(surface, minus, {1.0, -0.0, -0.0}, {-0.0, -0.0}, options);
    ASSERT_EQ(a.path.size(), b.path.size());
    EXPECT_EQ(a.path.back().position_mm, b.path.back().position_mm);
}

TEST_P(TraceDegenerate, RandomStartsOnATeeAlwaysEnd) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Surface surface = test::frozen(
            make_mandrel("tee", {}, {.edge_mm = 10.0, .irregular = true, .seed = seed}));
        std::mt19937_64 random(seed);
        int rims = 0;
        for (int i = 0; i < 300; ++i) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << " start " << i);
            test::Start start = test::random_start(surface, random);
            if (i % 3 == 1) {  // on an edge
                start.at.bary[0] = 0.0;
                start.at.bary /= start.at.bary.sum();
            } else if (i % 3 == 2) {  // on a vertex
                start.at.bary = Vector3d::UnitY();
            }
            const double slip = i % 2 == 0 ? 0.0 : 0.2;
            const TraceOptions options{.max_length_mm = 2000.0};
            const TraceResult traced =
                trace(surface, start.at, start.direction, {slip, 0.0}, options);
            expect_sound(surface, traced, options);
            EXPECT_NE(traced.stop, TraceStop::FaceLimit);
            rims += traced.stop == TraceStop::Rim ? 1 : 0;
        }
        EXPECT_GT(rims, 100);  // a tee of 400 mm has ends nearly everywhere ahead
    }
}

}  // namespace
}  // namespace meshwind
