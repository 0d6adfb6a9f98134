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
constexpr double kMostNarrow = 1e-3;

// More corners than this where no surface can be fitted, and the mesh has failed. Of the file's own
// vertices even more: their triangles may still be long.
constexpr double kMostAveraged = 0.1;
constexpr double kMostAveragedInFile = 0.5;

// Lettering stands out by 1 mm at most, mm, whatever the part's size, and the wall under it is
// known to a quarter of that; on small parts it stands out by less than a share of their size.
constexpr double kLetterHeight_mm = 1.25;
constexpr double kDetailHeight = 0.05;

// Ball that does not fill the strokes of letters, as a share of the part's size.
constexpr double kDetailBall = 0.1;

// What is lower than this share of the part's size is left to the even mesh, which need not come
// nearer to the file's vertices.
constexpr double kDetailLeast = kDeviationShare / 2.0;

// Why a frozen wall is none, or empty.
std::string no_surface(const Surface& wall, double most_averaged) {
    const auto corners = static_cast<double>(wall.normal.size());
    return wall.fit.averaged <= most_averaged * corners
               ? std::string()
               : "its vertices stand for no smooth surface at " +
                     percent(wall.fit.averaged / corners, 0) + " of the corners";
}

// Largest distance of a vertex of the file's wall from the smooth surface of the own mesh, but for
// those on details that were taken off.
double deviation_mm(const LabelledMesh& file, const Surface& surface, const std::vector<char>& kept,
                    const TriangleSoup& removed, double near_mm) {
    const WallProjection wall(surface);
    const RayQuery gone{std::span(&removed, 1)};
    std::vector<std::int32_t> region_of_vertex(file.soup.points_mm.size(), -1);
    for (std::size_t f = 0; f < file.soup.faces.size(); ++f) {
        if (kept[static_cast<std::size_t>(file.region[f])] != 0) {
            for (const std::int32_t v : file.soup.faces[f]) {
                region_of_vertex[static_cast<std::size_t>(v)] = file.region[f];
            }
        }
    }
    std::vector<double> off(region_of_vertex.size(), 0.0);
    constexpr std::size_t kChunk = 256;
    parallel_for(off.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const Eigen::Vector3d& p = file.soup.points_mm[v];
            if (region_of_vertex[v] >= 0 && wall.has(region_of_vertex[v]) &&
                gone.closest(p, near_mm).part < 0) {
                off[v] = (wall.nearest(p, region_of_vertex[v]).position_mm - p).norm();
            }
        }
    });
    return *std::max_element(off.begin(), off.end());
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
    const LabelledMesh& told = details.part;
    const EvenMeshOptions options = even_options(size);
    Surface wall = frozen_wall(told, kept);
    report.why_not = no_surface(wall, kMostAveragedInFile);
    if (!report.why_not.empty()) {
        return result;
    }
    const double wanted = wanted_triangles(wall, options);
    if (!(wanted <= kMostEvenTriangles)) {
        report.why_not = "even triangles would be too many, " + fixed(wanted, 0);
        return result;
    }
    LabelledMesh own = even_mesh(told, kept, std::move(wall), options);
    const Surface surface = frozen_wall(own, kept);
    report.triangles = surface.face.size();
    report.deviation_mm = deviation_mm(part, surface, kept, details.removed, least_detail_mm);
    const double most_mm = kDeviationShare * size;
    const double narrow = share_below(own, kept, kUnevenQuality);
    if (!(report.deviation_mm <= most_mm)) {
        report.why_not = "even triangles would be up to " + fixed(report.deviation_mm, 3) +
                         " mm off its vertices, more than " + fixed(most_mm, 3) + " mm";
    } else if (narrow > kMostNarrow) {
        report.why_not = "its narrow triangles cannot be taken out: " + percent(narrow, 1) +
                         " of the wall would still lie in such";
    } else {
        report.why_not = no_surface(surface, kMostAveraged);
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
