#include "study/study_mandrel.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/random.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/brep/read_cad.h"
#include "mesh/edge_table.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/segment/feature_edges.h"
#include "mesh/segment/rims.h"
#include "mesh/shapes/coarsen.h"
#include "mesh/smooth/freeze.h"
#include "mesh/smooth/refine.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kCylinderLengthMm = 400.0;

// Edges of the triangles from which starts are drawn, in radii: their nearest surface points are
// spread as evenly as the points themselves.
constexpr double kSampleShare = 0.2;

// Edge lengths within a tenth of the file's own mean stand for its mesh as given.
constexpr double kMinShare = 0.9;
constexpr double kMinCoarsening = 1.1;

// Edges that stand for a CAD part's exact faces, of the shortest that are looked at.
constexpr double kReferenceShare = 1.0 / 3.0;

StudyMandrel made_study(const std::string& kind, const MakeValues& values, double sample_edge_mm) {
    StudyMandrel study;
    study.name = kind;
    study.samples = make_mandrel(kind, values, {.edge_mm = sample_edge_mm});
    study.mesh = [kind, values](const StudyMeshOptions& options) {
        return frozen_surface(make_mandrel(
            kind, values,
            {.edge_mm = options.edge_mm, .irregular = options.irregular, .seed = options.seed}));
    };
    return study;
}

}  // namespace

StudyMandrel cylinder_study(double radius_mm) {
    const CylinderShape shape{radius_mm, kCylinderLengthMm};
    shape.validate();
    StudyMandrel study = made_study(
        "cylinder", {{"radius", radius_mm}, {"length", shape.length_mm}}, kSampleShare * radius_mm);
    study.name += '-';
    append_shortest(study.name, radius_mm);
    study.reference_words = "closed form";
    study.reference = cylinder_reference(radius_mm);
    return study;
}

StudyMandrel torus_study() {
    const TorusShape shape;
    StudyMandrel study = made_study("torus", {}, kSampleShare * shape.tube_radius_mm);
    study.reference_words = "differential equation of the exact surface";
    study.reference = torus_reference(shape);
    return study;
}

StudyMandrel ellipsoid_study() {
    const EllipsoidShape shape;
    StudyMandrel study = made_study("ellipsoid", {}, kSampleShare * shape.pole_radius_mm);
    study.reference_words = "differential equation of the exact surface";
    study.reference = ellipsoid_reference(shape);
    return study;
}

StudyMandrel tee_study() {
    const TeeShape shape;
    StudyMandrel study = made_study("tee", {}, kSampleShare * shape.branch_radius_mm);
    study.reference_words = "differential equation of the exact surface";
    study.reference = made_reference("tee", {});
    return study;
}

std::vector<StudyMandrel> known_studies(const std::string& name, std::span<const double> radii_mm) {
    std::vector<StudyMandrel> studies;
    if (name == "cylinder") {
        for (const double radius_mm : radii_mm) {
            studies.push_back(cylinder_study(radius_mm));
        }
    } else if (name == "torus") {
        studies.push_back(torus_study());
    } else if (name == "ellipsoid") {
        studies.push_back(ellipsoid_study());
    } else if (name == "tee") {
        studies.push_back(tee_study());
    }
    return studies;
}

StudyMandrel file_study(Mandrel mandrel) {
    StudyMandrel study;
    study.mandrel = std::make_unique<Mandrel>(std::move(mandrel));
    const Surface& given = study.mandrel->surface;
    study.refined = std::make_unique<Surface>(refined(given, 0.5 * given.mean_edge_mm).frozen());
    study.name = study.mandrel->file;
    study.reference_words =
        "patches on the mesh refined to edges of " + fixed(study.refined->mean_edge_mm, 2) + " mm";
    study.samples = {given.position_mm, given.face};
    study.reference = mesh_reference(*study.refined, {.method = TraceMethod::Patches});
    study.mesh = [&given, name = study.name](const StudyMeshOptions& options) {
        if (!(options.edge_mm >= kMinShare * given.mean_edge_mm)) {
            throw InputError("study.edge", name,
                             "its own edges are " + fixed(given.mean_edge_mm, 2) +
                                 " mm; a study of it takes no shorter ones");
        }
        TriangleSoup soup{given.position_mm, given.face};
        return frozen_surface(options.edge_mm < kMinCoarsening * given.mean_edge_mm
                                  ? soup
                                  : coarsened(soup, options.edge_mm));
    };
    return study;
}

StudyMandrel cad_study(const std::filesystem::path& file, double shortest_mm) {
    const double fine_mm = kReferenceShare * shortest_mm;
    StudyMandrel study;
    study.mandrel = std::make_unique<Mandrel>(load_mandrel(file, {.edge_mm = fine_mm}));
    const Surface& fine = study.mandrel->surface;
    study.name = study.mandrel->file;
    study.reference_words = "the exact faces, by edges of " + fixed(fine.mean_edge_mm, 2) + " mm";
    study.samples = {fine.position_mm, fine.face};
    study.reference = mesh_reference(fine, {.method = TraceMethod::Patches});
    // Every mesh in one frame: that of the finest.
    const Eigen::Affine3d file_from_mandrel = study.mandrel->file_to_mandrel.inverse();
    const MandrelOptions::Axis axis{file_from_mandrel.translation(),
                                    file_from_mandrel.linear().col(2)};
    study.mesh = [file, axis](const StudyMeshOptions& options) {
        return load_mandrel(file, {.axis = axis, .edge_mm = options.edge_mm}).surface;
    };
    return study;
}

StudyMandrel study_of_file(const std::filesystem::path& file, double unit_mm, double shortest_mm) {
    return is_cad(file) ? cad_study(file, shortest_mm)
                        : file_study(load_mandrel(file, {.unit_mm = unit_mm}));
}

Surface frozen_surface(const TriangleSoup& soup) {
    const auto neighbours = face_neighbours(soup.faces);
    const auto feature = feature_edges(soup, steady_normals(soup, neighbours), neighbours);
    const Rims rims = find_rims(soup);
    const std::vector<std::int32_t> region(soup.faces.size(), 0);
    return freeze_surface(soup, {.feature = feature, .region = region, .rim = rims.of_edge});
}

std::vector<CurveState> random_starts(const StudyMandrel& mandrel, int count, std::uint64_t seed) {
    const TriangleSoup& soup = mandrel.samples;
    std::vector<double> total_mm2(soup.faces.size());
    double sum = 0.0;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        sum += area_mm2(soup.points_mm, soup.faces[f]);
        total_mm2[f] = sum;
    }
    std::vector<CurveState> starts;
    std::uint64_t draw = 0;
    for (int i = 0; i < count; ++i) {
        const double wanted = sum * random_unit(seed, draw++);
        const auto above = std::upper_bound(total_mm2.begin(), total_mm2.end() - 1, wanted);
        const auto& face = soup.faces[static_cast<std::size_t>(above - total_mm2.begin())];
        double u = random_unit(seed, draw++);
        double v = random_unit(seed, draw++);
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const Vector3d near_mm = (1.0 - u - v) * soup.points_mm[static_cast<std::size_t>(face[0])] +
                                 u * soup.points_mm[static_cast<std::size_t>(face[1])] +
                                 v * soup.points_mm[static_cast<std::size_t>(face[2])];
        const double angle = 2.0 * kPi * random_unit(seed, draw++);
        const SurfaceFoot foot = mandrel.reference->foot(near_mm);
        const Vector3d ahead = foot.normal.unitOrthogonal();
        starts.push_back(
            {foot.point_mm, std::cos(angle) * ahead + std::sin(angle) * foot.normal.cross(ahead)});
    }
    return starts;
}

}  // namespace meshwind
