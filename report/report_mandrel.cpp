#include "report/report_mandrel.h"

#include "core/units.h"
#include "report/report_checks.h"

namespace meshwind {
namespace {

using nlohmann::json;

json json_of(const Eigen::Vector3d& v) {
    // Adding zero turns -0 into 0.
    return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};
}

json matrix_of(const Eigen::Affine3d& transform) {
    json rows = json::array();
    const Eigen::Matrix4d& m = transform.matrix();
    for (int i = 0; i < 4; ++i) {
        rows.push_back({m(i, 0) + 0.0, m(i, 1) + 0.0, m(i, 2) + 0.0, m(i, 3) + 0.0});
    }
    return rows;
}

json repairs_of(const RepairReport& r) {
    return {{"welded_points", r.welded_points},
            {"degenerate_faces_removed", r.degenerate_faces_removed},
            {"duplicate_faces_removed", r.duplicate_faces_removed},
            {"faces_flipped", r.faces_flipped},
            {"edges_stitched", r.edges_stitched},
            {"non_manifold_vertices_split", r.non_manifold_vertices_split},
            {"self_intersecting_faces", r.self_intersecting_faces},
            {"components", r.components}};
}

json cad_faces_of(const std::vector<CadFace>& faces) {
    json rows = json::array();
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const CadFace& face = faces[i];
        json& row = rows.emplace_back(
            json{{"number", i + 1}, {"kind", face.kind}, {"area_mm2", face.area_mm2}});
        row["region"] = face.region >= 0 ? json(face.region) : json(nullptr);
        if (!face.colour.empty()) {
            row["colour"] = face.colour;
        }
        if (face.radius_mm > 0.0) {
            row["radius_mm"] = face.radius_mm;
        }
        if (!face.axis_direction.isZero()) {
            row["axis"] = {{"point_mm", json_of(face.axis_point_mm)},
                           {"direction", json_of(face.axis_direction)}};
        }
    }
    return rows;
}

}  // namespace

json mandrel_report(const Mandrel& mandrel) {
    json rims = json::array();
    for (const Rim& rim : mandrel.rims) {
        rims.push_back({{"id", rim.id},
                        {"centre", json_of(rim.centre_mm)},
                        {"axis", json_of(rim.axis)},
                        {"radius", rim.radius_mm},
                        {"circularity_mm", rim.circularity_mm},
                        {"cut_off_mm", rim.cut_off_mm},
                        {"points", rim.vertices.size()}});
    }
    json regions = json::array();
    double area = 0.0;
    for (const Region& region : mandrel.regions) {
        regions.push_back({{"id", region.id},
                           {"kind", name_of(region.kind)},
                           {"kept", region.kept},
                           {"triangles", region.triangles},
                           {"area_mm2", region.area_mm2},
                           {"visible_fraction", region.visible_fraction}});
        area += region.kept ? region.area_mm2 : 0.0;
    }
    const FitReport& fit = mandrel.surface.fit;
    json report{{"file", mandrel.file},
                {"unit_mm", mandrel.unit_mm},
                {"unit_rule", mandrel.unit_rule},
                {"triangles", mandrel.surface.face.size()},
                {"file_triangles", mandrel.winding_mesh.file_triangles},
                {"file_to_mandrel", matrix_of(mandrel.file_to_mandrel)},
                {"axis", {{"rule", mandrel.axis.rule}, {"residual_mm", mandrel.axis.residual_mm}}},
                {"rims", rims},
                {"area_mm2", area},
                {"regions", regions},
                {"repairs", repairs_of(mandrel.repairs)},
                {"winding_mesh",
                 {{"own", mandrel.winding_mesh.own},
                  {"swept", mandrel.winding_mesh.swept},
                  {"least_quality", report_number(mandrel.winding_mesh.least_quality)},
                  {"ruled_shapes", mandrel.winding_mesh.ruled_shapes},
                  {"deviation_mm", report_number(mandrel.winding_mesh.deviation_mm)},
                  {"details", mandrel.winding_mesh.details},
                  {"details_mm2", report_number(mandrel.winding_mesh.details_mm2)},
                  {"details_mm", report_number(mandrel.winding_mesh.details_mm)},
                  {"blend_mm", report_number(mandrel.winding_mesh.blend_mm)},
                  {"blended_mm2", report_number(mandrel.winding_mesh.blended_mm2)},
                  {"filled_mm3", report_number(mandrel.winding_mesh.filled_mm3)}}},
                {"smooth_fit",
                 {{"quartic", fit.quartic},
                  {"cubic", fit.cubic},
                  {"quadratic", fit.quadratic},
                  {"reduced", fit.reduced},
                  {"averaged", fit.averaged}}},
                {"remarks", mandrel.remarks}};
    if (!mandrel.cad_faces.empty()) {
        report["smooth_fit"]["exact"] = fit.exact;
        report["cad_faces"] = cad_faces_of(mandrel.cad_faces);
    }
    return report;
}

json revolution_report(const RevolutionFinding& finding) {
    if (!finding.body) {
        return {{"why_not", finding.why_not}};
    }
    json ends = json::array();
    for (const MeridianEnd& end : finding.body->end) {
        ends.push_back({{"kind", end.kind == MeridianEnd::Kind::Rim ? "rim" : "pole"}});
        if (end.kind == MeridianEnd::Kind::Rim) {
            ends.back()["rim"] = end.rim;
        }
    }
    json parts = json::array();
    for (const MeridianPart& part : finding.body->parts) {
        parts.push_back({{"kind", name_of(part.kind)},
                         {"from_mm", part.from_mm},
                         {"to_mm", part.to_mm},
                         {"mean_radius_mm", part.radius_mm}});
        if (part.kind == MeridianPartKind::Cone) {
            parts.back()["slope_deg"] = deg_from_rad(part.slope_rad);
        }
    }
    return {{"residual_mm", finding.body->residual_mm},
            {"length_mm", finding.body->meridian.length_mm()},
            {"ends", ends},
            {"parts", parts}};
}

json tube_report(const TubeFinding& finding) {
    if (!finding.tube) {
        return {{"why_not", finding.why_not}};
    }
    const Tube& tube = *finding.tube;
    json parts = json::array();
    for (const TubePart& part : tube.parts) {
        parts.push_back(
            {{"kind", name_of(part.kind)}, {"from_mm", part.from_mm}, {"to_mm", part.to_mm}});
        if (part.kind != TubePartKind::Straight) {
            parts.back()["angle_deg"] = deg_from_rad(part.angle_rad);
        }
        if (part.kind == TubePartKind::Bend) {
            parts.back()["bend_radius_mm"] = part.bend_radius_mm;
        }
    }
    json radius = json::array();
    for (const TubeRadius& node : tube.radius) {
        radius.push_back({{"at_mm", node.arc_mm}, {"radius_mm", node.radius_mm}});
    }
    return {{"residual_mm", tube.residual_mm},
            {"length_mm", tube.line.length_mm()},
            {"rims", tube.rim},
            {"lean_deg", {deg_from_rad(tube.lean_rad[0]), deg_from_rad(tube.lean_rad[1])}},
            {"radius", radius},
            {"parts", parts}};
}

json accuracy_report(const PathAccuracy& accuracy) {
    if (accuracy.paths == 0) {
        return nullptr;
    }
    return {{"paths", accuracy.paths},
            {"length_mm", accuracy.length_mm},
            {"walk_mm_per_m", accuracy.walk_mm_per_m},
            {"patches_mm_per_m", accuracy.patches_mm_per_m}};
}

json axes_report(const std::vector<AxisCandidate>& axes) {
    json rows = json::array();
    for (const AxisCandidate& axis : axes) {
        rows.push_back({{"rule", axis.rule},
                        {"through", json_of(axis.through_mm)},
                        {"direction", json_of(axis.direction)},
                        {"residual_mm", axis.residual_mm},
                        {"swing_mm", axis.swing_mm},
                        {"rims", axis.rims},
                        {"gap_deg", deg_from_rad(axis.gap_rad)},
                        {"angle_deg", deg_from_rad(axis.angle_rad)},
                        {"off_mm", axis.off_mm},
                        {"why", axis.why}});
    }
    return rows;
}

json places_report(const std::vector<RemarkPlace>& places) {
    json rows = json::array();
    for (const RemarkPlace& place : places) {
        rows.push_back({{"remark", place.remark}, {"at", json_of(place.at_mm)}});
    }
    return rows;
}

}  // namespace meshwind
