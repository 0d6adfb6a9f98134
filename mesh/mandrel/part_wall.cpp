#include "mesh/mandrel/part_wall.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/edge_table.h"
#include "mesh/even/blend.h"
#include "mesh/even/slivers.h"
#include "mesh/even/winding_mesh.h"
#include "mesh/mandrel/swept_part.h"
#include "mesh/revolution/revolution.h"
#include "mesh/revolution/rolled_meridian.h"
#include "mesh/smooth/freeze.h"

namespace meshwind {
namespace {

std::optional<BodyOfRevolution> body_of(Wall wall) {
    const Eigen::Isometry3d& motion = wall.frame.mandrel_from_file;
    move(wall.kept.soup, motion);
    move(wall.rims.rims, motion);
    const Surface surface = freeze_surface(
        wall.kept.soup,
        {.feature = wall.kept.feature, .region = wall.kept.region, .rim = wall.rims.of_edge});
    return find_revolution(surface, wall.rims.rims).body;
}

// The wall in the rings that a meridian sweeps. The spindle stays. Whether they are not too many.
bool sweep(const Meridian& meridian, Mandrel& mandrel, Segmentation& segmentation, Wall& wall) {
    const std::vector<char> kept = kept_of(segmentation.regions);
    std::optional<LabelledMesh> swept =
        swept_part(view(mandrel.whole, segmentation), kept, meridian, wall.frame.mandrel_from_file);
    if (!swept) {
        return false;
    }
    take(*std::move(swept), mandrel, segmentation);
    wall.kept = wall_of(view(mandrel.whole, segmentation), kept);
    wall.rims = find_rims(wall.kept.soup);
    return true;
}

// The body of revolution that the wall is, near enough to be wound in its place.
std::optional<BodyOfRevolution> exact_body(const Segmentation& segmentation, const Wall& wall) {
    std::optional<BodyOfRevolution> body = body_of(wall);
    const double most_mm = kDeviationShare * size_mm(wall.kept, kept_of(segmentation.regions));
    return body && body->residual_mm <= most_mm ? std::move(body) : std::nullopt;
}

// A body of revolution stays one. Whether that can be.
bool blend_in_rings(Mandrel& mandrel, Segmentation& segmentation, Wall& wall, double radius_mm) {
    const std::optional<BodyOfRevolution> body = exact_body(segmentation, wall);
    if (!body) {
        return false;
    }
    const RolledMeridian rolled = rolled_meridian(body->meridian, radius_mm);
    if (!rolled.why_not.empty() ||
        (rolled.meridian && !sweep(*rolled.meridian, mandrel, segmentation, wall))) {
        return false;
    }
    mandrel.winding_mesh.blended_mm2 = rolled.area_mm2;
    mandrel.winding_mesh.filled_mm3 = rolled.volume_mm3;
    return true;
}

void blend_mesh(Mandrel& mandrel, Segmentation& segmentation, Wall& wall, double radius_mm,
                const std::string& name) {
    Blend made = blend_wall({mandrel.whole, segmentation.region, segmentation.feature},
                            kept_of(segmentation.regions), radius_mm);
    if (!made.why_not.empty()) {
        throw InputError("mesh.no_blend", name,
                         "cannot be blended by " + fixed(radius_mm, 2) + " mm: " + made.why_not);
    }
    mandrel.winding_mesh.blended_mm2 = made.area_mm2;
    mandrel.winding_mesh.filled_mm3 = made.volume_mm3;
    if (made.area_mm2 > 0.0) {
        take(std::move(made.part), mandrel, segmentation);
        wall.kept = wall_of(view(mandrel.whole, segmentation), kept_of(segmentation.regions));
        wall.rims = find_rims(wall.kept.soup);
    }
}

}  // namespace

LabelledView view(const TriangleSoup& whole, const Segmentation& segmentation) {
    return {whole, segmentation.region, segmentation.feature, segmentation.neighbours};
}

std::vector<char> kept_of(const std::vector<Region>& regions) {
    std::vector<char> kept;
    kept.reserve(regions.size());
    for (const Region& region : regions) {
        kept.push_back(static_cast<char>(region.kept));
    }
    return kept;
}

void count_regions(const TriangleSoup& whole, std::size_t count, Segmentation& segmentation) {
    for (std::size_t id = segmentation.regions.size(); id < count; ++id) {
        Region end;
        end.id = static_cast<std::int32_t>(id);
        end.kind = RegionKind::EndCap;
        end.visible_fraction = 1.0;
        segmentation.regions.push_back(end);
    }
    for (Region& region : segmentation.regions) {
        region.triangles = 0;
        region.area_mm2 = 0.0;
    }
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
        Region& region = segmentation.regions[static_cast<std::size_t>(segmentation.region[f])];
        ++region.triangles;
        region.area_mm2 += area_mm2(whole.points_mm, whole.faces[f]);
    }
}

void move(std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& motion) {
    for (Eigen::Vector3d& p : points) {
        p = motion * p;
    }
}

void move(TriangleSoup& soup, const Eigen::Isometry3d& motion) {
    move(soup.points_mm, motion);
}

void move(std::vector<Rim>& rims, const Eigen::Isometry3d& motion) {
    for (Rim& rim : rims) {
        rim.centre_mm = motion * rim.centre_mm;
        rim.axis = motion.linear() * rim.axis;
    }
}

Wall find_wall(const TriangleSoup& whole, const Segmentation& segmentation,
               const std::optional<MandrelOptions::Axis>& axis_mm) {
    Wall wall;
    wall.kept = wall_of(view(whole, segmentation), kept_of(segmentation.regions));
    wall.rims = find_rims(wall.kept.soup);
    wall.frame = find_spindle(wall.kept.soup, wall.rims.rims, axis_mm);
    return wall;
}

void take(LabelledMesh&& part, Mandrel& mandrel, Segmentation& segmentation) {
    mandrel.whole = std::move(part.soup);
    segmentation.region = std::move(part.region);
    segmentation.feature = std::move(part.feature);
    segmentation.neighbours = face_neighbours(mandrel.whole.faces);
}

bool make_rings(Mandrel& mandrel, Segmentation& segmentation, Wall& wall) {
    WindingMeshReport& report = mandrel.winding_mesh;
    if (report.least_quality >= kUnevenQuality) {
        return false;
    }
    const std::optional<BodyOfRevolution> body = exact_body(segmentation, wall);
    if (!body || !sweep(body->meridian, mandrel, segmentation, wall)) {
        return false;
    }
    report.own = report.swept = true;
    report.triangles = wall.kept.soup.faces.size();
    report.deviation_mm = body->residual_mm;
    return true;
}

void make_even(Mandrel& mandrel, Segmentation& segmentation, Wall& wall,
               const std::optional<MandrelOptions::Axis>& axis_mm,
               const std::optional<double>& details_mm) {
    const std::vector<char> kept = kept_of(segmentation.regions);
    WindingMesh made =
        winding_mesh({mandrel.whole, segmentation.region, segmentation.feature}, kept, details_mm);
    made.report.file_triangles = mandrel.winding_mesh.file_triangles;
    mandrel.winding_mesh = made.report;
    mandrel.details = std::move(made.removed);
    if (made.report.own) {
        take(std::move(made.part), mandrel, segmentation);
        wall = find_wall(mandrel.whole, segmentation, axis_mm);
    }
}

void blend(Mandrel& mandrel, Segmentation& segmentation, Wall& wall, double radius_mm,
           const std::string& name) {
    mandrel.winding_mesh.blend_mm = radius_mm;
    if (!blend_in_rings(mandrel, segmentation, wall, radius_mm)) {
        blend_mesh(mandrel, segmentation, wall, radius_mm, name);
    }
    count_regions(mandrel.whole, segmentation.regions.size(), segmentation);
}

}  // namespace meshwind
