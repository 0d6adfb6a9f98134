#include "mesh/even/winding_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/text/text_number.h"
#include "mesh/even/even_mesh.h"
#include "mesh/even/long_facets.h"
#include "mesh/even/slivers.h"
#include "mesh/even/wall_surface.h"

namespace meshwind {
namespace {

// Lengths go by the radius of the ball with the wall's area: on a pipe four times as long as wide
// that is 1.4 times its own.
constexpr double kLongestEdge = 0.15;
constexpr double kLeastEdge = 0.02;
constexpr double kShortEdge = 0.02;

// What vertices that are left out may be off the triangles that stay.
constexpr double kLeftOut = 1e-4;

// Long facets are halved down to this share of that radius: 8 edges a quarter of such a pipe.
constexpr double kFacetEdge = 0.1;

// Share of the wall's area in narrow triangles that may be left: between creases that nearly meet.
constexpr double kMostNarrow = 1e-3;

// More corners than this where no surface can be fitted, and the mesh has failed.
constexpr double kMostAveraged = 0.1;

double wall_area_mm2(const LabelledMesh& part, const std::vector<char>& kept) {
    double area = 0.0;
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (kept[static_cast<std::size_t>(part.region[f])] != 0) {
            area += area_mm2(part.soup.points_mm, part.soup.faces[f]);
        }
    }
    return area;
}

// Largest distance of a vertex of the file's wall from the smooth surface of the own mesh.
double deviation_mm(const LabelledMesh& file, const Surface& surface,
                    const std::vector<char>& kept) {
    const WallProjection wall(surface);
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
            if (region_of_vertex[v] >= 0) {
                const Eigen::Vector3d& p = file.soup.points_mm[v];
                off[v] = (wall.nearest(p, region_of_vertex[v]).position_mm - p).norm();
            }
        }
    });
    return *std::max_element(off.begin(), off.end());
}

}  // namespace

WindingMesh winding_mesh(const LabelledMesh& part, const std::vector<char>& kept) {
    WindingMesh result;
    result.report.least_quality = least_quality(part, kept);
    if (result.report.least_quality >= kUnevenQuality) {
        result.part = part;
        return result;
    }
    const double size_mm = std::sqrt(wall_area_mm2(part, kept) / (4.0 * std::numbers::pi));
    const auto clean = [&](const LabelledMesh& mesh) {
        check_interrupt();
        return without_slivers(mesh, kept, kShortEdge * size_mm, kLeftOut * size_mm);
    };
    const LongFacets halved = halve_long_facets(clean(part), kept, kFacetEdge * size_mm);
    EvenMeshOptions options;
    options.least_mm = kLeastEdge * size_mm;
    options.longest_mm = kLongestEdge * size_mm;
    LabelledMesh own = even_mesh(clean(halved.part), kept, options);
    const Surface surface = frozen_wall(own, kept);
    result.report.ruled_shapes = halved.shapes;
    result.report.triangles = surface.face.size();
    result.report.deviation_mm = deviation_mm(part, surface, kept);
    const double most_mm = kDeviationShare * size_mm;
    const double narrow = share_below(own, kept, kUnevenQuality);
    const auto corners = static_cast<double>(surface.normal.size());
    if (!(result.report.deviation_mm <= most_mm)) {
        result.report.why_not = "even triangles would be up to " +
                                fixed(result.report.deviation_mm, 3) +
                                " mm off its vertices, more than " + fixed(most_mm, 3) + " mm";
    } else if (narrow > kMostNarrow) {
        result.report.why_not = "its narrow triangles cannot be taken out: " + percent(narrow, 1) +
                                " of the wall would still lie in such";
    } else if (surface.fit.averaged > kMostAveraged * corners) {
        result.report.why_not = "its vertices stand for no smooth surface at " +
                                percent(surface.fit.averaged / corners, 0) + " of the corners";
    }
    result.report.own = result.report.why_not.empty();
    if (result.report.own) {
        result.part = std::move(own);
    } else {
        result.part = part;
    }
    return result;
}

}  // namespace meshwind
