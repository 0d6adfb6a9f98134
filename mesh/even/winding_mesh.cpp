#include "mesh/even/winding_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/text/text_number.h"
#include "mesh/even/details.h"
#include "mesh/even/even_mesh.h"
#include "mesh/even/long_facets.h"
#include "mesh/even/shape_creases.h"
#include "mesh/even/slivers.h"
#include "mesh/even/wall_shapes.h"
#include "mesh/even/wall_surface.h"
#include "mesh/ray_query.h"

namespace meshwind {
namespace {

// Short edges of narrow triangles, by the part's size.
constexpr double kShortEdge = 0.02;

// What vertices that are left out may be off the triangles that stay.
constexpr double kLeftOut = 1e-4;

// Long facets are halved down to this share of that radius: 8 edges a quarter of such a pipe.
constexpr double kFacetEdge = 0.1;

// Share of the wall's area in narrow triangles that may be left: between creases that nearly meet.
constexpr double kMaxNarrow = 1e-3;

// More corners than this where no surface can be fitted, and the mesh has failed. Of the file's own
// vertices even more: their triangles may still be long.
constexpr double kMaxAveraged = 0.1;
constexpr double kMaxAveragedInFile = 0.5;

// Lettering stands out by 1 mm at most, mm, whatever the part's size, and the wall under it is
// known to a quarter of that; on small parts it stands out by less than a share of their size.
constexpr double kLetterHeight_mm = 1.25;
constexpr double kDetailHeight = 0.05;

// Ball that does not fill the strokes of letters, as a share of the part's size.
constexpr double kDetailBall = 0.1;

// What is lower than this share of the part's size is left to the even mesh, which need not come
// nearer to the file's vertices.
constexpr double kDetailLeast = kDeviationShare / 2.0;

// Where the own mesh is too far off the file's vertices, its edges are made shorter by this, so
// often at most.
constexpr double kShorter = 0.5;
constexpr double kShortenFrom = 0.5;  // of what they may be off
constexpr int kRounds = 3;

// Why a frozen wall is none, or empty.
std::string no_surface(const Surface& wall, double most_averaged) {
    const auto corners = static_cast<double>(wall.normal.size());
    return wall.fit.averaged <= most_averaged * corners
               ? std::string()
               : "its vertices stand for no smooth surface at " +
                     percent(wall.fit.averaged / corners, 0) + " of the corners";
}

double mean_edge_mm(const Surface& surface, std::int32_t face) {
    double sum = 0.0;
    const auto& v = surface.face[static_cast<std::size_t>(face)];
    for (std::size_t e = 0; e < 3; ++e) {
        sum += (surface.position_mm[static_cast<std::size_t>(v[(e + 1) % 3])] -
                surface.position_mm[static_cast<std::size_t>(v[e])])
                   .norm();
    }
    return sum / 3.0;
}

// A vertex of the file's wall, and how far it is off the smooth surface of the own mesh.
struct OffVertex {
    Eigen::Vector3d at_mm;
    std::int32_t region = -1;
    double off_mm = 0.0;
    double edge_mm = 0.0;  // of the own mesh there, mean
};

bool is_nearer(const OffVertex& a, const OffVertex& b) {
    return a.off_mm < b.off_mm;
}

// All of them but those on details that were taken off.
std::vector<OffVertex> off_vertices(const LabelledMesh& file, const Surface& surface,
                                    const std::vector<char>& kept, const TriangleSoup& removed,
                                    double near_mm) {
    const WallProjection wall(surface);
    const RayQuery gone{std::span(&removed, 1)};
    std::vector<OffVertex> off(file.soup.points_mm.size());
    for (std::size_t f = 0; f < file.soup.faces.size(); ++f) {
        if (kept[static_cast<std::size_t>(file.region[f])] != 0) {
            for (const std::int32_t v : file.soup.faces[f]) {
                off[static_cast<std::size_t>(v)].region = file.region[f];
            }
        }
    }
    constexpr std::size_t kChunk = 256;
    parallel_for(off.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            OffVertex& vertex = off[v];
            vertex.at_mm = file.soup.points_mm[v];
            if (vertex.region >= 0 && wall.has(vertex.region) &&
                gone.closest(vertex.at_mm, near_mm).part < 0) {
                const WallProjection::Foot foot = wall.nearest(vertex.at_mm, vertex.region);
                vertex.off_mm = (foot.position_mm - vertex.at_mm).norm();
                vertex.edge_mm = mean_edge_mm(surface, foot.face);
            }
        }
    });
    return off;
}

// Shorter edges around vertices that the own mesh is too far off.
void shorten_edges(const std::vector<OffVertex>& off, double most_off_mm, const Surface& wall,
                   EvenMeshOptions& options) {
    const WallProjection file(wall);
    options.most_mm.resize(wall.position_mm.size(), options.longest_mm);
    for (const OffVertex& vertex : off) {
        if (vertex.off_mm > most_off_mm) {
            const WallProjection::Foot foot = file.nearest(vertex.at_mm, vertex.region);
            for (const std::int32_t v : wall.face[static_cast<std::size_t>(foot.face)]) {
                double& most = options.most_mm[static_cast<std::size_t>(v)];
                most = std::min(most, kShorter * vertex.edge_mm);
            }
        }
    }
}

// Even triangles over what is left of the part, near the file's vertices where they can be had;
// their count and what they are off go to the report, and why there are none.
LabelledMesh even_triangles(const LabelledMesh& file, const Details& left,
                            const std::vector<char>& kept, WindingMeshReport& report) {
    const Surface wall = frozen_wall(left.part, kept);
    report.why_not = no_surface(wall, kMaxAveragedInFile);
    if (!report.why_not.empty()) {
        return {};
    }
    const double size = size_mm(file, kept);
    EvenMeshOptions options = even_options(size);
    const double most_mm = kDeviationShare * size;
    LabelledMesh own;
    std::vector<OffVertex> off;
    for (int round = 0; round < kRounds; ++round) {
        check_interrupt();
        if (round > 0) {
            shorten_edges(off, kShortenFrom * most_mm, wall, options);
        }
        const double wanted = wanted_triangles(wall, options);
        if (!(wanted <= kMaxEvenTriangles)) {
            report.why_not = "even triangles would be too many, " + fixed(wanted, 0);
            break;
        }
        own = even_mesh(left.part, kept, wall, options);
        const Surface surface = frozen_wall(own, kept);
        off = off_vertices(file, surface, kept, left.removed, kDetailLeast * size);
        report.triangles = surface.face.size();
        report.deviation_mm = std::max_element(off.begin(), off.end(), is_nearer)->off_mm;
        if (report.deviation_mm <= most_mm) {
            report.why_not = no_surface(surface, kMaxAveraged);
            break;
        }
        report.why_not = "even triangles would be up to " + fixed(report.deviation_mm, 3) +
                         " mm off its vertices, more than " + fixed(most_mm, 3) + " mm";
    }
    return own;
}

}  // namespace

WindingMesh winding_mesh(const LabelledMesh& part, const std::vector<char>& kept,
                         const std::optional<double>& details_mm) {
    WindingMesh result;
    WindingMeshReport& report = result.report;
    report.least_quality = least_quality(part, kept);
    result.part = part;
    if (report.least_quality >= kUnevenQuality && !(details_mm && *details_mm > 0.0)) {
        return result;
    }
    const double size = size_mm(part, kept);
    const double height_mm =
        details_mm ? *details_mm : std::min(kLetterHeight_mm, kDetailHeight * size);
    const auto clean = [&](const LabelledMesh& mesh) {
        check_interrupt();
        return without_slivers(mesh, kept, kShortEdge * size, kLeftOut * size);
    };
    // On the file's own triangles: without slivers fewer are left that tell a shape.
    const WallShapes exact = find_wall_shapes(part, kept);
    LabelledMesh labelled = part;
    labelled.shape = exact.of_face;
    mark_shape_creases(exact, kept, labelled);
    const LongFacets halved =
        halve_long_facets(clean(labelled), kept, kFacetEdge * size, exact.shapes);
    report.ruled_shapes = halved.shapes;
    const double least_detail_mm = kDetailLeast * size;
    Details details =
        without_details(clean(halved.part), kept, kDetailBall * size, least_detail_mm, height_mm);
    details.part.shape.clear();  // triangles turn over the edge between two shapes
    LabelledMesh own = even_triangles(part, details, kept, report);
    if (report.why_not.empty()) {
        const double narrow = share_below(own, kept, kUnevenQuality);
        if (narrow > kMaxNarrow) {
            report.why_not = "its narrow triangles cannot be taken out: " + percent(narrow, 1) +
                             " of the wall would still lie in such";
        }
    }
    report.own = report.why_not.empty();
    if (report.own) {
        result.part = std::move(own);
        result.removed = std::move(details.removed);
        report.details = details.count;
        report.details_mm2 = details.area_mm2;
        report.details_mm = details.most_mm;
    }
    return result;
}

}  // namespace meshwind
