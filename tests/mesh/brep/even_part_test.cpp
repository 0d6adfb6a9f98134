#include "mesh/brep/even_part.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "mesh/brep/exact_corners.h"
#include "mesh/even/slivers.h"
#include "mesh/smooth/freeze.h"
#include "mesh/smooth/patch.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 30.0;
constexpr double kHalfLength_mm = 40.0;

// A cylinder about Z, face 0, with half spheres on its ends, 1 below and 2 above: smooth, but for
// the curvature.
class Capsule : public ExactFaces {
public:
    std::optional<Vector3d> on_face(std::int32_t face, const Vector3d& p) override {
        return middle(face, p) + kRadius_mm * (p - middle(face, p)).normalized();
    }
    std::optional<Vector3d> on_border(std::int32_t face, std::int32_t other,
                                      const Vector3d& p) override {
        const double z = std::max(face, other) == 1 ? -kHalfLength_mm : kHalfLength_mm;
        const Vector3d out = Vector3d(p.x(), p.y(), 0.0).normalized();
        return Vector3d(kRadius_mm * out.x(), kRadius_mm * out.y(), z);
    }
    std::optional<Jet> jet(std::int32_t face, const Vector3d& p, double) override {
        Jet jet;
        jet.normal = (p - middle(face, p)).normalized();
        const Vector3d x = face == 0 ? Vector3d::UnitZ() : jet.normal.unitOrthogonal();
        const Vector3d y = jet.normal.cross(x);
        const double along = face == 0 ? 0.0 : 1.0 / kRadius_mm;
        jet.shape_operator_per_mm =
            along * x * x.transpose() + 1.0 / kRadius_mm * y * y.transpose();
        jet.height.frame << x, y, jet.normal;
        jet.height.coefficient[kJetX2] = -0.5 * along;
        jet.height.coefficient[kJetX2 + 2] = -0.5 / kRadius_mm;
        jet.terms = JetTerms::Quadratic;
        return jet;
    }

    static Vector3d middle(std::int32_t face, const Vector3d& p) {
        return {0.0, 0.0, face == 0 ? p.z() : face == 1 ? -kHalfLength_mm : kHalfLength_mm};
    }
};

struct Start {
    TriangleSoup soup;
    std::vector<std::int32_t> face;
};

// As CAD programs tessellate it: one row of facets along the cylinder.
Start start() {
    constexpr int kAround = 24;
    constexpr int kRows = 5;  // of a half sphere
    Start made;
    auto& points = made.soup.points_mm;
    const auto ring = [&](double z, double radius) {
        for (int i = 0; i < kAround; ++i) {
            const double angle = 2.0 * kPi * i / kAround;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
        }
    };
    points.emplace_back(0.0, 0.0, -kHalfLength_mm - kRadius_mm);
    std::vector<std::int32_t> face_below;  // of each ring
    for (int r = 1; r <= kRows; ++r) {
        const double angle = 0.5 * kPi * r / kRows;
        ring(-kHalfLength_mm - kRadius_mm * std::cos(angle), kRadius_mm * std::sin(angle));
        face_below.push_back(1);
    }
    for (int r = kRows; r >= 1; --r) {
        const double angle = 0.5 * kPi * r / kRows;
        ring(kHalfLength_mm + kRadius_mm * std::cos(angle), kRadius_mm * std::sin(angle));
        face_below.push_back(r == kRows ? 0 : 2);
    }
    points.emplace_back(0.0, 0.0, kHalfLength_mm + kRadius_mm);
    const auto top = static_cast<std::int32_t>(points.size()) - 1;
    const auto at = [&](std::int32_t r, std::int32_t i) { return 1 + r * kAround + i % kAround; };
    const auto add = [&](const std::array<std::int32_t, 3>& corners, std::int32_t face) {
        made.soup.faces.push_back(corners);
        made.face.push_back(face);
    };
    const auto rings = static_cast<std::int32_t>(face_below.size());
    for (std::int32_t i = 0; i < kAround; ++i) {
        add({0, at(0, i + 1), at(0, i)}, 1);
        for (std::int32_t r = 1; r < rings; ++r) {
            const std::int32_t face = face_below[static_cast<std::size_t>(r)];
            add({at(r - 1, i), at(r - 1, i + 1), at(r, i)}, face);
            add({at(r - 1, i + 1), at(r, i + 1), at(r, i)}, face);
        }
        add({at(rings - 1, i), at(rings - 1, i + 1), top}, 2);
    }
    return made;
}

CadMesh capsule(double edge_mm) {
    Capsule exact;
    const Start from = start();
    CadMesh mesh = even_part(from.soup, from.face, exact, edge_mm);
    mesh.faces = {{"cylinder", kRadius_mm, 0.0, 0, "", -1, Vector3d(0, 0, 7), Vector3d::UnitZ()},
                  {"sphere"},
                  {"sphere"}};
    return mesh;
}

TEST(EvenPart, VerticesLieOnTheFacesAndBordersOnTheirEdges) {
    const CadMesh mesh = capsule(0.0);
    std::vector<std::set<std::int32_t>> faces(mesh.soup.points_mm.size());
    for (std::size_t f = 0; f < mesh.soup.faces.size(); ++f) {
        for (const std::int32_t v : mesh.soup.faces[f]) {
            faces[static_cast<std::size_t>(v)].insert(mesh.face[f]);
        }
    }
    constexpr double kRounding_mm = 1e-12;
    int on_borders = 0;
    for (std::size_t v = 0; v < faces.size(); ++v) {
        const Vector3d& p = mesh.soup.points_mm[v];
        for (const std::int32_t face : faces[v]) {
            EXPECT_NEAR((p - Capsule::middle(face, p)).norm(), kRadius_mm, kRounding_mm);
        }
        if (faces[v].size() > 1) {
            EXPECT_NEAR(std::abs(p.z()), kHalfLength_mm, kRounding_mm);
            ++on_borders;
        }
    }
    EXPECT_GT(on_borders, 40);
}

TEST(EvenPart, FacetsFromEndToEndBecomeEvenTriangles) {
    const Start from = start();
    // Of facets from end to end: as thin as these show what is made of slivers.
    EXPECT_LT(least_quality(from.soup), 0.5 * least_quality(capsule(0.0).soup));
    EXPECT_GT(least_quality(capsule(0.0).soup), 0.4);
}

TEST(EvenPart, HalfTheEdgeTakesFourTimesTheTriangles) {
    const auto count = [](double edge_mm) {
        return static_cast<double>(capsule(edge_mm).soup.faces.size());
    };
    EXPECT_NEAR(count(1.5) / count(3.0), 4.0, 0.4);
}

// A capsule whose ends claim to be bent as strongly as a lip of a few micrometres.
class SharpCapsule : public Capsule {
public:
    std::optional<Jet> jet(std::int32_t face, const Vector3d& p, double reach_mm) override {
        constexpr double kSharper = 1e4;
        std::optional<Jet> jet = Capsule::jet(face, p, reach_mm);
        jet->shape_operator_per_mm *= face == 0 ? 1.0 : kSharper;
        return jet;
    }
};

TEST(EvenPart, RoundingsFarSmallerThanThePartTakeNoMillionsOfTriangles) {
    SharpCapsule exact;
    const Start from = start();
    const CadMesh mesh = even_part(from.soup, from.face, exact, 0.0);
    EXPECT_GT(mesh.soup.faces.size(), 10000U);
    EXPECT_LT(mesh.soup.faces.size(), 100000U);
    EXPECT_GT(least_quality(mesh.soup), 0.4);
}

TEST(ExactCorners, BordersWhereTheCurvatureJumpsPartTheFits) {
    const CadMesh mesh = capsule(0.0);
    const ExactCorners known = exact_corners(mesh, mesh.soup);
    EXPECT_EQ(known.face, mesh.face);
    LabelledMesh wall{mesh.soup, std::vector<std::int32_t>(mesh.face.size(), 0),
                      std::vector<std::array<std::uint8_t, 3>>(mesh.face.size(), {0, 0, 0})};
    mark_bend_borders(mesh, known, wall);
    const std::vector<std::array<std::int32_t, 3>> no_rims(mesh.face.size(), {-1, -1, -1});
    Surface surface =
        freeze_surface(wall.soup, {.feature = wall.feature, .region = wall.region, .rim = no_rims});
    // As it lies in the mandrel frame.
    const Eigen::Isometry3d motion(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
    set_exact(mesh, known, motion, surface);
    EXPECT_EQ(surface.fit.exact, static_cast<int>(surface.normal.size()));
    constexpr double kRounding_per_mm = 1e-14;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (const std::int32_t corner : surface.corner[f]) {
            const Eigen::Matrix3d& s =
                surface.shape_operator_per_mm[static_cast<std::size_t>(corner)];
            EXPECT_NEAR(s.trace(), (mesh.face[f] == 0 ? 1.0 : 2.0) / kRadius_mm, kRounding_per_mm);
        }
    }
}

// The cylinder of the capsule as a surface of its own, in a frame that is turned.
TEST(ExactCorners, PatchesOfACylinderAreThatCylinder) {
    const CadMesh mesh = capsule(0.0);
    const ExactCorners known = exact_corners(mesh, mesh.soup);
    const std::vector<std::array<std::uint8_t, 3>> no_features(mesh.face.size(), {0, 0, 0});
    const std::vector<std::array<std::int32_t, 3>> no_rims(mesh.face.size(), {-1, -1, -1});
    const std::vector<std::int32_t> region(mesh.face.size(), 0);
    const Eigen::Isometry3d motion(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
    TriangleSoup soup = mesh.soup;
    for (Vector3d& p : soup.points_mm) {
        p = motion * p;
    }
    Surface surface =
        freeze_surface(soup, {.feature = no_features, .region = region, .rim = no_rims});
    set_exact(mesh, known, motion, surface);
    constexpr double kRounding_mm = 1e-12;
    constexpr double kStep = 1e-4;  // of a side: differences are off by its square, and by rounding
    int seen = 0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        ASSERT_EQ(surface.cylinder_of[f] >= 0, mesh.face[f] == 0);
        if (mesh.face[f] != 0) {
            continue;
        }
        ++seen;
        const Patch patch(surface, static_cast<std::int32_t>(f));
        const Eigen::Vector2d uv(0.3, 0.25);
        const PatchPlace place = patch.at(uv);
        const Vector3d own = motion.inverse() * place.position_mm;
        EXPECT_NEAR(std::hypot(own.x(), own.y()), kRadius_mm, kRounding_mm);
        const PatchPlace ahead = patch.at(uv + Eigen::Vector2d(kStep, 0.0));
        const PatchPlace aside = patch.at(uv + Eigen::Vector2d(0.0, kStep));
        const auto near = [](const Vector3d& found, const Vector3d& wanted) {
            EXPECT_LT((found - wanted).norm(), 1e-3);
        };
        near((ahead.position_mm - place.position_mm) / kStep, place.along_u);
        near((aside.position_mm - place.position_mm) / kStep, place.along_v);
        near((ahead.along_u - place.along_u) / kStep, place.second_uu);
        near((aside.along_u - place.along_u) / kStep, place.second_uv);
        near((aside.along_v - place.along_v) / kStep, place.second_vv);
    }
    EXPECT_GT(seen, 100);
}

TEST(ExactCorners, TrianglesThatAreNotThePartsAreNotKnown) {
    const CadMesh mesh = capsule(0.0);
    TriangleSoup other = mesh.soup;
    std::reverse(other.faces.begin(), other.faces.end());  // another order
    const auto moved = static_cast<std::size_t>(other.faces[0][0]);
    other.points_mm[moved].x() += 1e-9;
    const ExactCorners known = exact_corners(mesh, other);
    for (std::size_t f = 0; f < other.faces.size(); ++f) {
        const auto& corners = other.faces[f];
        const bool changed = std::count(corners.begin(), corners.end(), other.faces[0][0]) > 0;
        EXPECT_EQ(known.face[f], changed ? -1 : mesh.face[mesh.face.size() - 1 - f]);
    }
}

TEST(CadMesh, BytesGiveTheSameMesh) {
    CadMesh mesh = capsule(0.0);
    mesh.faces = {{"cylinder", 30.0, 1.5, 0, "#ff0033", -1, {1, 2, 3}, {0, 0, 1}}, {"other"}};
    mesh.unit_mm = 25.4;
    mesh.sewn_edges = 3;
    const std::string bytes = bytes_of(mesh);
    const CadMesh again = cad_mesh_of(bytes, "part.step");
    EXPECT_EQ(bytes_of(again), bytes);
    EXPECT_EQ(again.soup.points_mm, mesh.soup.points_mm);
    EXPECT_EQ(again.faces[0].kind, "cylinder");
    EXPECT_EQ(again.unit_mm, 25.4);
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{10}, std::size_t{25}, bytes.size() / 2, bytes.size() - 1}) {
        EXPECT_THROW((void)cad_mesh_of(std::string_view(bytes).substr(0, size), "part.step"),
                     InputError);
    }
    EXPECT_THROW((void)cad_mesh_of(bytes + "x", "part.step"), InputError);
}

}  // namespace
}  // namespace meshwind
