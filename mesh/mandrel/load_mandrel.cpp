#include "mesh/mandrel/load_mandrel.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/brep/exact_corners.h"
#include "mesh/brep/read_cad.h"
#include "mesh/edge_table.h"
#include "mesh/even/slivers.h"
#include "mesh/even/square_ends.h"
#include "mesh/even/wall_pieces.h"
#include "mesh/even/winding_mesh.h"
#include "mesh/io/import.h"
#include "mesh/mandrel/cad_part.h"
#include "mesh/mandrel/part_wall.h"
#include "mesh/mandrel/remarks.h"
#include "mesh/profile/profile_file.h"
#include "mesh/repair/repair.h"
#include "mesh/repair/weld.h"
#include "mesh/revolution/crease_rings.h"
#include "mesh/revolution/revolution.h"
#include "mesh/segment/rims.h"
#include "mesh/segment/segment.h"
#include "mesh/segment/spindle_axis.h"
#include "mesh/smooth/freeze.h"
#include "mesh/smooth/refine.h"

namespace meshwind {
namespace {

// Beyond these no part is real and single precision (Embree) would overflow or lose all digits.
constexpr double kLargestCoordinate = 1e9;  // file units
constexpr double kSmallestDiagonal = 1e-6;  // file units

constexpr double kSmallestInMm = 10.0;  // a part shorter than this many units is taken for metres

void check_options(const MandrelOptions& options, const std::string& name) {
    if (!std::isfinite(options.unit_mm) || options.unit_mm < 0.0) {
        throw InputError("mesh.bad_unit", name,
                         "the unit must be a length above 0 mm, give mm, cm, m or in");
    }
    if (options.axis &&
        (!options.axis->origin.allFinite() || !options.axis->direction.allFinite() ||
         options.axis->direction.norm() == 0.0)) {
        throw InputError("mesh.bad_axis", name,
                         "the spindle axis needs a finite origin and a direction other than 0");
    }
}

void check_triangles(const TriangleSoup& soup, const std::string& name) {
    const auto count = static_cast<std::int32_t>(soup.points_mm.size());
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        for (const std::int32_t v : soup.faces[f]) {
            if (v < 0 || v >= count) {
                throw InputError("mesh.bad_index", name,
                                 "triangle " + std::to_string(f + 1) + " names point " +
                                     std::to_string(v) + " of " + std::to_string(count) +
                                     ", export the part again");
            }
            if (!soup.points_mm[static_cast<std::size_t>(v)].allFinite()) {
                throw InputError("mesh.not_finite", name,
                                 "triangle " + std::to_string(f + 1) +
                                     " has a coordinate that is no finite number, export again");
            }
        }
    }
    const bool far_out = std::any_of(
        soup.points_mm.begin(), soup.points_mm.end(),
        [](const Eigen::Vector3d& p) { return p.cwiseAbs().maxCoeff() > kLargestCoordinate; });
    if (far_out || (!soup.faces.empty() && diagonal_mm(soup) < kSmallestDiagonal)) {
        throw InputError("mesh.size_out_of_range", name,
                         far_out ? "has coordinates beyond 1e9 units, the file is damaged: export "
                                   "it again"
                                 : "is smaller than 1e-6 units, export it in another unit");
    }
    if (soup.faces.empty()) {
        throw InputError("mesh.no_triangles", name,
                         "holds no triangle, export the part's surface as triangles");
    }
}

void decide_unit(Mandrel& mandrel, const MandrelOptions& options, double stated_mm) {
    if (options.unit_mm > 0.0) {
        mandrel.unit_mm = options.unit_mm;
        mandrel.unit_rule = "given";
        return;
    }
    if (stated_mm > 0.0) {
        mandrel.unit_mm = stated_mm;
        mandrel.unit_rule = "file";
        return;
    }
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : mandrel.whole.points_mm) {
        box.extend(p);
    }
    const Eigen::Vector3d size = box.sizes();
    const bool metres = size.maxCoeff() < kSmallestInMm;
    mandrel.unit_mm = metres ? 1000.0 : 1.0;
    mandrel.unit_rule = "assumed";
    if (metres) {
        mandrel.remarks.push_back("the file states no unit and measures " + fixed(size.x(), 2) +
                                  " x " + fixed(size.y(), 2) + " x " + fixed(size.z(), 2) +
                                  " units: taken for metres, pass --units mm if it is not");
    }
}

void keep_named_regions(Segmentation& segmentation, const std::vector<std::int32_t>& ids,
                        const std::string& name) {
    if (ids.empty()) {
        return;
    }
    const std::set<std::int32_t> wanted(ids.begin(), ids.end());
    const auto count = static_cast<std::int32_t>(segmentation.regions.size());
    if (*wanted.begin() < 0 || *wanted.rbegin() >= count) {
        const std::int32_t bad = *wanted.begin() < 0 ? *wanted.begin() : *wanted.rbegin();
        throw InputError("mesh.no_such_region", name,
                         "has no region " + std::to_string(bad) + ", its regions are 0 to " +
                             std::to_string(count - 1) + " (see meshwind inspect)");
    }
    for (Region& region : segmentation.regions) {
        region.kept = wanted.count(region.id) != 0;
    }
}

std::string words_of(const Region& region) {
    const std::string why = region.kind == RegionKind::EndCap
                                ? std::string("a flat end")
                                : "taken for a bore, " + percent(region.visible_fraction, 0) +
                                      " of it sees the outside";
    return std::to_string(region.id) + " (" + std::string(name_of(region.kind)) + ", " +
           fixed(region.area_mm2, 1) + " mm2, " + why + ")";
}

// Nothing that follows means anything without a surface to wind.
void check_wall(const std::vector<Region>& regions, const std::string& name) {
    constexpr std::size_t kNamed = 5;  // the largest; inspect has no more to say of the others
    if (std::any_of(regions.begin(), regions.end(), [](const Region& r) { return r.kept; })) {
        return;
    }
    std::string words;
    for (std::size_t i = 0; i < std::min(kNamed, regions.size()); ++i) {
        words += (i > 0 ? ", " : " ") + words_of(regions[i]);
    }
    if (regions.size() > kNamed) {
        words += " and " + std::to_string(regions.size() - kNamed) + " smaller ones";
    }
    throw InputError("mesh.no_wall", name,
                     "none of its regions is an outer wall:" + words +
                         "; if one is to be wound, name it in the job, \"mandrel\": "
                         "{\"keep_regions\": [0]}, else export the part's outside");
}

// Largest first, in the frame of the whole.
std::vector<AngularEnd> angular_ends_of(const TriangleSoup& whole, const Segmentation& s) {
    std::vector<AngularEnd> ends;
    for (const std::int32_t id : s.angular_ends) {
        AngularEnd& end = ends.emplace_back(AngularEnd{.region = id});
        for (std::size_t f = 0; f < whole.faces.size(); ++f) {
            if (s.region[f] == id) {
                const auto& [a, b, c] = whole.faces[f];
                const Eigen::Vector3d& p = whole.points_mm[static_cast<std::size_t>(a)];
                const Eigen::Vector3d& q = whole.points_mm[static_cast<std::size_t>(b)];
                const Eigen::Vector3d& r = whole.points_mm[static_cast<std::size_t>(c)];
                const double area_mm2 = 0.5 * (q - p).cross(r - p).norm();
                end.area_mm2 += area_mm2;
                end.middle_mm += area_mm2 / 3.0 * (p + q + r);
            }
        }
        end.middle_mm /= end.area_mm2;
    }
    std::stable_sort(ends.begin(), ends.end(), [](const AngularEnd& a, const AngularEnd& b) {
        return a.area_mm2 > b.area_mm2;
    });
    return ends;
}

// Takes off what is no part of the ends' legs.
std::vector<EndCut> cut_ends(Mandrel& mandrel, Segmentation& segmentation,
                             const std::optional<double>& depth_mm, const std::string& name) {
    std::optional<SquareEnds> square =
        square_ends(view(mandrel.whole, segmentation), kept_of(segmentation.regions), depth_mm);
    if (!square) {
        return {};
    }
    take(std::move(square->part), mandrel, segmentation);
    count_regions(mandrel.whole, square->kept.size(), segmentation);
    if (std::none_of(segmentation.regions.begin(), segmentation.regions.end(),
                     [](const Region& r) { return r.kept && r.triangles > 0; })) {
        throw InputError("mesh.no_wall", name,
                         "nothing is left of its wall when so much is cut off its ends; give "
                         "less as \"cut_ends\" in the job");
    }
    return std::move(square->cuts);
}

void note(const std::vector<EndCut>& cuts, std::vector<Rim>& rims) {
    for (const EndCut& cut : cuts) {
        const auto off = [&](const Rim& rim) { return (rim.centre_mm - cut.centre_mm).norm(); };
        const auto nearest = std::min_element(
            rims.begin(), rims.end(), [&](const Rim& a, const Rim& b) { return off(a) < off(b); });
        if (nearest != rims.end()) {
            nearest->cut_off_mm = cut.depth_mm;
        }
    }
}

// Crumbs that hang together with nothing of the wall are none of it. Returns where they are.
std::vector<Eigen::Vector3d> leave_crumbs(std::vector<WallPiece>& pieces,
                                          std::vector<Region>& regions) {
    constexpr double kCrumbShare = 0.01;  // of the largest piece
    std::vector<Eigen::Vector3d> crumbs_mm;
    while (pieces.back().area_mm2 < kCrumbShare * pieces.front().area_mm2) {
        crumbs_mm.push_back(pieces.back().middle_mm);
        for (const std::int32_t id : pieces.back().regions) {
            regions[static_cast<std::size_t>(id)].kept = false;
        }
        pieces.pop_back();
    }
    return crumbs_mm;
}

// The file's triangles welded and repaired, in its unit.
Mandrel repaired_part(TriangleSoup&& file_units, const std::string& name) {
    Mandrel mandrel;
    mandrel.file = std::filesystem::path(name).filename().string();
    mandrel.whole = std::move(file_units);
    check_interrupt();
    const WeldReport welded = weld(mandrel.whole);
    mandrel.repairs.welded_points = welded.welded_points;
    mandrel.repairs.edges_stitched = welded.edges_stitched;
    check_interrupt();
    repair(mandrel.whole, name, mandrel.repairs);
    check_interrupt();
    return mandrel;
}

// The regions of the part, and which of them are wound.
Segmentation segment_part(const TriangleSoup& whole, const CadMesh* cad,
                          const MandrelOptions& options, const std::string& name) {
    Segmentation segmentation = segment(whole);
    keep_named_regions(segmentation, options.keep_regions, name);
    keep_named_faces(cad, whole, options.keep_faces, name, segmentation);
    check_wall(segmentation.regions, name);
    return segmentation;
}

// Ends squared, triangles laid out anew, hollows filled up as the options say; still in the file's
// frame, in mm.
Wall wound_wall(const MandrelOptions& options, const std::string& name, Mandrel& mandrel,
                Segmentation& segmentation) {
    std::optional<MandrelOptions::Axis> given = options.axis;
    if (given) {
        given->origin *= mandrel.unit_mm;
    }
    const std::vector<EndCut> cuts = cut_ends(mandrel, segmentation, options.cut_ends_mm, name);
    Wall wall = find_wall(mandrel.whole, segmentation, given);
    check_interrupt();
    mandrel.winding_mesh.least_quality = least_quality(wall.kept.soup);
    if (options.mesh == MandrelOptions::Mesh::Even && !make_rings(mandrel, segmentation, wall)) {
        make_even(mandrel, segmentation, wall, given, options.remove_details_mm);
    }
    if (options.blend_mm > 0.0) {
        check_interrupt();
        blend(mandrel, segmentation, wall, options.blend_mm, name);
    }
    note(cuts, wall.rims.rims);
    return wall;
}

// \param wall its triangles in the mandrel's frame
Surface frozen(const Wall& wall, const std::optional<ExactWall>& exact) {
    Surface surface = freeze_surface(
        wall.kept.soup,
        {.feature = wall.kept.feature, .region = wall.kept.region, .rim = wall.rims.of_edge});
    if (exact) {
        set_exact(exact->cad, exact->corners, wall.frame.mandrel_from_file, surface);
    }
    return surface;
}

// Surface, regions and rims in the mandrel's frame.
void freeze_wall(const std::optional<ExactWall>& exact, Mandrel& mandrel,
                 Segmentation&& segmentation, Wall& wall) {
    const Eigen::Isometry3d& motion = wall.frame.mandrel_from_file;
    move(mandrel.whole, motion);
    move(mandrel.details, motion);
    move(wall.kept.soup, motion);
    check_interrupt();
    mandrel.surface = frozen(wall, exact);
    check_interrupt();
    mandrel.whole_region = std::move(segmentation.region);
    mandrel.regions = std::move(segmentation.regions);
    mandrel.rims = wall.rims.rims;
    move(mandrel.rims, motion);
    const RevolutionFinding found = find_revolution(mandrel.surface, mandrel.rims);
    if (found.body && mark_crease_rings(*found.body, wall.kept.soup, wall.kept.feature)) {
        mandrel.surface = frozen(wall, exact);
    }
}

void set_frame(const SpindleFrame& frame, Mandrel& mandrel) {
    mandrel.axis = frame.axis;
    mandrel.file_to_mandrel = frame.mandrel_from_file * Eigen::Scaling(mandrel.unit_mm);
    for (WallPiece& piece : mandrel.pieces) {
        piece.middle_mm = frame.mandrel_from_file * piece.middle_mm;
    }
    for (AngularEnd& end : mandrel.angular_ends) {
        end.middle_mm = frame.mandrel_from_file * end.middle_mm;
    }
}

// \param cad that the triangles are of, or nullptr
Mandrel build(TriangleSoup&& file_units, double stated_mm, const std::string& name,
              const MandrelOptions& options, const CadMesh* cad = nullptr) {
    check_options(options, name);
    check_triangles(file_units, name);
    Mandrel mandrel = repaired_part(std::move(file_units), name);
    decide_unit(mandrel, options, stated_mm);
    for (Eigen::Vector3d& p : mandrel.whole.points_mm) {
        p *= mandrel.unit_mm;
    }
    mandrel.winding_mesh.file_triangles = mandrel.whole.faces.size();

    Segmentation segmentation = segment_part(mandrel.whole, cad, options, name);
    mandrel.pieces = wall_pieces(view(mandrel.whole, segmentation), kept_of(segmentation.regions));
    std::vector<Eigen::Vector3d> crumbs_mm;
    if (options.keep_regions.empty() && options.keep_faces.empty()) {
        crumbs_mm = leave_crumbs(mandrel.pieces, segmentation.regions);
        mandrel.angular_ends = angular_ends_of(mandrel.whole, segmentation);
    }
    check_interrupt();

    Wall wall = wound_wall(options, name, mandrel, segmentation);
    std::optional<ExactWall> exact = exact_wall(cad, mandrel.whole, segmentation, wall.kept);
    freeze_wall(exact, mandrel, std::move(segmentation), wall);
    if (exact) {
        take_cad_faces(std::move(*exact), wall.frame.mandrel_from_file, mandrel);
    }
    set_frame(wall.frame, mandrel);

    move(wall.rims.holes_mm, wall.frame.mandrel_from_file);
    move(crumbs_mm, wall.frame.mandrel_from_file);
    add_remarks(mandrel, wall.rims.holes_mm, crumbs_mm);
    if (cad != nullptr) {
        add_cad_remarks(*cad, mandrel);
    }
    return mandrel;
}

}  // namespace

TriangleSoup refined_wall(const Mandrel& mandrel, double edge_mm) {
    TriangleSoup soup = refined(mandrel.surface, edge_mm).soup;
    const Eigen::Affine3d mandrel_to_file = mandrel.file_to_mandrel.inverse();
    for (Eigen::Vector3d& p : soup.points_mm) {
        p = mandrel_to_file * p;
    }
    return soup;
}

Mandrel load_mandrel(const std::filesystem::path& file, const MandrelOptions& options) {
    if (is_profile(file)) {
        const ProfileFile profile = read_profile(file);
        MandrelOptions about_axis = options;
        if (!about_axis.axis) {
            about_axis.axis = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
        }
        return build(swept_profile(profile, file.string()), profile.stated_unit_mm, file.string(),
                     about_axis);
    }
    if (is_cad(file)) {
        CadMesh cad = read_cad(file, options.solid, options.edge_mm);
        if (options.unit_mm > 0.0 && options.unit_mm != cad.unit_mm) {
            throw InputError("mesh.bad_unit", file.string(),
                             "states its unit itself, " + fixed(cad.unit_mm, 3) +
                                 " mm; leave --units and the job's \"units\" out");
        }
        TriangleSoup file_units = cad.soup;
        for (std::size_t v = 0; v < file_units.points_mm.size(); ++v) {
            file_units.points_mm[v] /= cad.unit_mm;
            cad.soup.points_mm[v] = file_units.points_mm[v] * cad.unit_mm;  // to the same bits
        }
        return build(std::move(file_units), cad.unit_mm, file.string(), options, &cad);
    }
    TriangleSoup soup = read_triangles(file);
    return build(std::move(soup), stated_unit_mm(file), file.string(), options);
}

Mandrel build_mandrel(const TriangleSoup& file_units, const std::string& name,
                      const MandrelOptions& options) {
    return build(TriangleSoup(file_units), 0.0, name, options);
}

}  // namespace meshwind
