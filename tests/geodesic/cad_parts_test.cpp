// Meshes as CAD writes them: long facets in single precision, caps, borders, vertices of three
// facets, and files of others.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "mesh/io/export.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/reference.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 50.0;
constexpr double kLength_mm = 300.0;

class CadParts : public test::BothTracers {
protected:
    static Vector3d normal_at(const Surface& surface, const SurfacePoint& point) {
        return GetParam() == TraceMethod::Walk ? smooth_normal(surface, point)
                                               : on_patch(surface, point.face, point.bary).normal();
    }
};

INSTANTIATE_TEST_SUITE_P(, CadParts, testing::Values(TraceMethod::Walk, TraceMethod::Patches),
                         test::method_name);

// A cylinder with flat ends, walls of facets as long as the part, written as a binary STL in some
// other position.
std::filesystem::path capped_cylinder_file() {
    const TriangleSoup soup =
        test::revolve({{0, 0}, {kRadius_mm, 0}, {kRadius_mm, kLength_mm}, {0, kLength_mm}}, 48);
    const Eigen::Isometry3d away = Eigen::Translation3d(120, -340, 75) *
                                   Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized());
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("meshwind_cad_parts_") + test->name() + ".stl";
    std::replace(name.begin(), name.end(), '/', '_');
    const auto file = std::filesystem::temp_directory_path() / name;
    TriangleSoup used = test::moved(soup, away);
    write_mesh_file(used, file);
    return file;
}

// Coordinates of 500 mm in 24 bits are off by 3e-5 mm: across a facet of 6.5 mm that is 3e-4 deg of
// the normal.
TEST_P(CadParts, KeepTheHelixOnLongFacetsOfAnStl) {
    const auto file = capped_cylinder_file();
    const Mandrel mandrel = load_mandrel(file, {.mesh = MandrelOptions::Mesh::File});
    std::filesystem::remove(file);
    const Surface& surface = mandrel.surface;
    ASSERT_EQ(surface.face.size(), 96U);
    ASSERT_EQ(mandrel.rims.size(), 2U);
    double worst_rad = 0.0;
    for (const double alpha : {0.3, 0.9, 1.3}) {
        for (std::int32_t face = 0; face < 96; face += 7) {
            const SurfacePoint start = test::point_in(face, 0.5, 0.3, 0.2);
            const Vector3d n = normal_at(surface, start);
            const Vector3d direction =
                std::cos(alpha) * Vector3d::UnitZ() + std::sin(alpha) * Vector3d::UnitZ().cross(n);
            const TraceResult traced = trace(surface, start, direction);
            expect_sound(surface, traced);
            EXPECT_EQ(traced.stop, TraceStop::Rim);
            for (const PathPoint& point : traced.path) {
                worst_rad = std::max(worst_rad, std::abs(std::acos(point.tangent.z()) - alpha));
            }
        }
    }
    std::printf("long facets of an STL: winding angle off by %.1e deg\n", deg_from_rad(worst_rad));
    EXPECT_LT(deg_from_rad(worst_rad), 0.01);
}

// With its caps kept, paths run over the edge onto the cap, across it and down the other side: in
// the plane through the axis where they are axial.
TEST_P(CadParts, CrossTheCapsInOnePlane) {
    const auto file = capped_cylinder_file();
    MandrelOptions whole{.mesh = MandrelOptions::Mesh::File};
    for (const Region& region : load_mandrel(file).regions) {
        whole.keep_regions.push_back(region.id);
    }
    const Mandrel mandrel = load_mandrel(file, whole);
    std::filesystem::remove(file);
    const Surface& surface = mandrel.surface;
    ASSERT_EQ(surface.face.size(), 192U);
    ASSERT_TRUE(mandrel.rims.empty());
    double worst_mm = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const SurfacePoint start = test::point_in(static_cast<std::int32_t>(f), 0.4, 0.35, 0.25);
        const Vector3d n = normal_at(surface, start);
        const bool wall = std::abs(n.z()) < 0.5;
        const Vector3d p = position_mm(surface, start);
        const Vector3d direction = wall ? Vector3d::UnitZ() : Vector3d(p.x(), p.y(), 0.0);
        const TraceOptions options{.max_length_mm = 2.2 * (kLength_mm + 2.0 * kRadius_mm)};
        const TraceResult traced = trace(surface, start, direction, {}, options);
        expect_sound(surface, traced, options);
        EXPECT_EQ(traced.stop, TraceStop::Length);
        const Vector3d across =
            Vector3d::UnitZ().cross(traced.path.front().position_mm).normalized();
        for (const PathPoint& point : traced.path) {
            worst_mm = std::max(worst_mm, std::abs(across.dot(point.position_mm)));
        }
    }
    std::printf("over the caps: off by %.1e mm\n", worst_mm);
    EXPECT_LT(worst_mm, 0.02);
}

// A torus where every third facet has a vertex of its own in its middle.
TEST_P(CadParts, PassVerticesOfThreeFacets) {
    const test::ExactTorus torus;
    TriangleSoup soup = make_mandrel("torus", {}, {.edge_mm = 5.0, .irregular = true});
    const std::size_t count = soup.faces.size();
    for (std::size_t f = 0; f < count; f += 3) {
        const auto [a, b, c] = soup.faces[f];
        const auto middle = static_cast<std::int32_t>(soup.points_mm.size());
        const auto p = [&](std::int32_t i) { return soup.points_mm[static_cast<std::size_t>(i)]; };
        soup.points_mm.push_back(torus.foot((p(a) + p(b) + p(c)) / 3.0));
        soup.faces[f] = {a, b, middle};
        soup.faces.push_back({b, c, middle});
        soup.faces.push_back({c, a, middle});
    }
    const Surface surface = test::frozen(soup);
    std::mt19937_64 random(4);
    double squares = 0.0;
    constexpr int kPaths = 40;
    for (int i = 0; i < kPaths; ++i) {
        test::Start start = test::random_start(surface, random);
        if (i % 2 == 0) {  // on such a vertex
            start.at = test::point_in(static_cast<std::int32_t>(count) + 10 * i, 0.0, 0.0, 1.0);
        }
        const Vector3d on = GetParam() == TraceMethod::Walk
                                ? position_mm(surface, start.at)
                                : on_patch(surface, start.at.face, start.at.bary).position_mm;
        const Vector3d p = torus.foot(on);
        const Vector3d n = torus.normal(p);
        const Vector3d t = (start.direction - n * n.dot(start.direction)).normalized();
        const TraceOptions options{.max_length_mm = 300.0};
        const TraceResult traced = trace(surface, start.at, t, {}, options);
        expect_sound(surface, traced, options);
        EXPECT_EQ(traced.stop, TraceStop::Length);
        squares += (traced.path.back().position_mm - test::follow(torus, {p, t}, 300.0).position_mm)
                       .squaredNorm();
    }
    const double rms_mm = std::sqrt(squares / kPaths);
    std::printf("vertices of three facets: rms %.2e mm\n", rms_mm);
    EXPECT_LT(rms_mm, GetParam() == TraceMethod::Walk ? 0.3 : 2e-3);
}

// Hoops inside the outermost row of facets, where the fits see one side only: they stay at their
// height, and end at the rim only where they start within its error.
TEST_P(CadParts, RunAlongBorders) {
    const Surface surface =
        test::frozen(make_mandrel("cylinder", {{"radius", kRadius_mm}, {"length", 200.0}},
                                  {.edge_mm = 5.0, .irregular = true}));
    double worst_mm = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (int e = 0; e < 3; ++e) {
            if (surface.neighbour[f][static_cast<std::size_t>(e)] != kNoFace) {
                continue;
            }
            SurfacePoint start{static_cast<std::int32_t>(f), Vector3d::Constant(0.3)};
            start.bary[(e + 2) % 3] = 0.4;  // of the way in from the rim
            const Vector3d n = normal_at(surface, start);
            const TraceOptions options{.max_length_mm = 2.0 * kPi * kRadius_mm};
            const TraceResult traced =
                trace(surface, start, Vector3d::UnitZ().cross(n), {}, options);
            expect_sound(surface, traced, options);
            EXPECT_EQ(traced.stop, TraceStop::Length);
            for (const PathPoint& point : traced.path) {
                worst_mm = std::max(worst_mm, std::abs(point.position_mm.z() -
                                                       traced.path.front().position_mm.z()));
            }
        }
    }
    std::printf("along borders: off by %.2e mm\n", worst_mm);
    EXPECT_LT(worst_mm, GetParam() == TraceMethod::Walk ? 0.4 : 0.1);
}

// Threads, slivers, seams, blends of a few facets: every trace ends and is sound, vertices as
// starts included.
TEST_P(CadParts, AlwaysEndOnFilesAsTheyCome) {
    const std::filesystem::path data = std::filesystem::path(MESHWIND_SOURCE_DIR) / "data/meshes";
    for (const char* file :
         {"tee_tetra_large_t.stl", "wye_4way_tetra.stl", "vessel_capsule_seam_degenerate.obj"}) {
        const Mandrel mandrel = load_mandrel(data / file);
        std::mt19937_64 random(7);
        int ended = 0;
        for (int i = 0; i < 300; ++i) {
            SCOPED_TRACE(testing::Message() << file << ", start " << i);
            test::Start start = test::random_start(mandrel.surface, random);
            if (i % 3 == 1) {
                start.at.bary[0] = 0.0;
                start.at.bary /= start.at.bary.sum();
            } else if (i % 3 == 2) {
                start.at.bary = Vector3d::UnitY();
            }
            const TraceOptions options{.max_length_mm = 1000.0, .max_faces = 100'000};
            const double slip = i % 2 == 0 ? 0.0 : 0.2;
            const TraceResult traced =
                trace(mandrel.surface, start.at, start.direction, {slip, 0.0}, options);
            expect_sound(mandrel.surface, traced, options);
            if (testing::Test::HasFatalFailure()) {
                return;
            }
            ended += traced.stop == TraceStop::FaceLimit ? 0 : 1;
        }
        EXPECT_EQ(ended, 300) << file;
    }
}

}  // namespace
}  // namespace meshwind
