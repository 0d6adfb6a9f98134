#include "report/print_mandrel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

constexpr std::size_t kRegionsShown = 12;  // lettering alone makes hundreds; the rest is summed up

std::string padded(const std::string& text, std::size_t width) {
    return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string triple(const Eigen::Vector3d& v, int decimals) {
    return "(" + fixed(v.x(), decimals) + ", " + fixed(v.y(), decimals) + ", " +
           fixed(v.z(), decimals) + ")";
}

void print_size(std::ostream& out, const Mandrel& m) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : m.whole.points_mm) {
        box.extend(p);
    }
    const Eigen::Vector3d size = box.sizes();
    out << "file          " << m.file << ", " << m.winding_mesh.file_triangles << " triangles\n"
        << "unit          " << fixed(m.unit_mm, 3) << " mm (" << m.unit_rule << ")\n"
        << "size          " << fixed(size.x(), 3) << " x " << fixed(size.y(), 3) << " x "
        << fixed(size.z(), 3) << " mm in the mandrel frame\n"
        << "spindle axis  " << m.axis.rule << ", residual " << fixed(m.axis.residual_mm, 4)
        << " mm\n"
        << "file frame    mandrel origin at "
        << triple(m.file_to_mandrel.inverse().translation(), 4) << ", +Z along "
        << triple(m.file_to_mandrel.linear().row(2).transpose().normalized(), 4) << "\n";
}

void print_repairs(std::ostream& out, const RepairReport& r) {
    const std::array<std::pair<const char*, int>, 8> counts = {
        {{"points welded", r.welded_points},
         {"degenerate triangles removed", r.degenerate_faces_removed},
         {"duplicate triangles removed", r.duplicate_faces_removed},
         {"triangles turned over", r.faces_flipped},
         {"open edges stitched", r.edges_stitched},
         {"non-manifold vertices split", r.non_manifold_vertices_split},
         {"self-intersecting triangles (kept)", r.self_intersecting_faces},
         {"shells", r.components}}};
    out << "repairs\n";
    for (const auto& [what, count] : counts) {
        out << padded(std::to_string(count), 10) << "  " << what << "\n";
    }
}

void print_regions(std::ostream& out, const Mandrel& m) {
    out << "regions\n        id  kind        wound  triangles      area mm2  visible\n";
    const std::size_t shown = std::min(kRegionsShown, m.regions.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const Region& r = m.regions[i];
        std::string kind(name_of(r.kind));
        kind.resize(10, ' ');
        out << padded(std::to_string(r.id), 10) << "  " << kind << "  "
            << (r.kept ? "yes  " : "no   ") << padded(std::to_string(r.triangles), 11)
            << padded(fixed(r.area_mm2, 2), 14) << padded(fixed(100.0 * r.visible_fraction, 0), 7)
            << " %\n";
    }
    double area = 0.0;
    std::size_t wound = 0;
    for (std::size_t i = shown; i < m.regions.size(); ++i) {
        area += m.regions[i].area_mm2;
        wound += m.regions[i].kept ? 1 : 0;
    }
    if (shown < m.regions.size()) {
        out << "            and " << m.regions.size() - shown << " smaller ones, " << wound
            << " of them wound, together " << fixed(area, 2) << " mm2\n";
    }
}

void print_cad_faces(std::ostream& out, const Mandrel& m) {
    if (m.cad_faces.empty()) {
        return;
    }
    out << "faces         of the CAD part\n    number  kind         radius mm      area mm2  "
           "region  colour\n";
    std::vector<std::size_t> by_area(m.cad_faces.size());
    std::iota(by_area.begin(), by_area.end(), std::size_t{0});
    std::stable_sort(by_area.begin(), by_area.end(), [&](std::size_t a, std::size_t b) {
        return m.cad_faces[a].area_mm2 > m.cad_faces[b].area_mm2;
    });
    const std::size_t shown = std::min(kRegionsShown, by_area.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const CadFace& face = m.cad_faces[by_area[i]];
        std::string kind = face.kind;
        kind.resize(10, ' ');
        out << padded(std::to_string(by_area[i] + 1), 10) << "  " << kind
            << padded(face.radius_mm > 0.0 ? fixed(face.radius_mm, 3) : "", 12)
            << padded(fixed(face.area_mm2, 2), 14)
            << padded(face.region >= 0 ? std::to_string(face.region) : "gone", 8)
            << (face.colour.empty() ? "" : "  " + face.colour) << "\n";
    }
    if (shown < by_area.size()) {
        out << "            and " << by_area.size() - shown << " smaller ones\n";
    }
}

// Two digits are all that an estimate has.
std::string two_digits(double value) {
    constexpr double kLeast = 1e-9;
    if (!(value > kLeast)) {
        return "0";
    }
    return fixed(value, std::max(0, 1 - static_cast<int>(std::floor(std::log10(value)))));
}

void print_accuracy(std::ostream& out, const PathAccuracy& accuracy) {
    out << "accuracy      ";
    if (accuracy.paths == 0) {
        out << "no estimate: no path is some edges long\n";
        return;
    }
    out << "paths drift by about " << two_digits(accuracy.walk_mm_per_m) << " mm per metre (walk), "
        << two_digits(accuracy.patches_mm_per_m) << " (patches), estimated on " << accuracy.paths
        << " geodesics of up to " << fixed(accuracy.length_mm, 0) << " mm\n";
}

// A line for each, the chosen one first.
void print_axes(std::ostream& out, const std::vector<AxisCandidate>& axes) {
    out << "axes              swing mm  rims on it  open deg  tilt deg    off mm\n";
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const AxisCandidate& axis = axes[i];
        std::string rule = axis.rule;
        rule.resize(12, ' ');
        out << (i == 0 ? "  * " : "    ") << rule << padded(fixed(axis.swing_mm, 2), 10)
            << padded(std::to_string(axis.rims), 12)
            << padded(fixed(deg_from_rad(axis.gap_rad), 0), 10)
            << padded(fixed(deg_from_rad(axis.angle_rad), 2), 10)
            << padded(fixed(axis.off_mm, 2), 10) << "  " << axis.why << "\n";
    }
}

std::string words_of(const MeridianPart& part, const Meridian& meridian) {
    std::string words(name_of(part.kind));
    words += " " + fixed(part.to_mm - part.from_mm, 2) + " mm R ";
    if (part.kind == MeridianPartKind::Cylinder) {
        return words + fixed(part.radius_mm, 2);
    }
    return words + fixed(meridian.at(part.from_mm).radius_mm, 2) + " to " +
           fixed(meridian.at(part.to_mm).radius_mm, 2);
}

void print_revolution(std::ostream& out, const RevolutionFinding& finding) {
    if (!finding.body) {
        out << "revolution    no body of revolution: " << finding.why_not << "\n";
        return;
    }
    constexpr std::size_t kPartsShown = 12;
    const std::vector<MeridianPart>& parts = finding.body->parts;
    out << "revolution    body of revolution: ";
    for (std::size_t i = 0; i < std::min(kPartsShown, parts.size()); ++i) {
        out << words_of(parts[i], finding.body->meridian) << ", ";
    }
    if (parts.size() > kPartsShown) {
        out << "and " << parts.size() - kPartsShown << " more parts, ";
    }
    out << "residual " << fixed(finding.body->residual_mm, 4) << " mm\n";
}

std::string words_of(const TubePart& part) {
    const std::string length = " " + fixed(part.to_mm - part.from_mm, 2) + " mm";
    const std::string turn = fixed(deg_from_rad(part.angle_rad), 2) + " deg";
    switch (part.kind) {
        case TubePartKind::Straight:
            return "straight" + length;
        case TubePartKind::Bend:
            return "bend " + turn + " R " + fixed(part.bend_radius_mm, 2);
        case TubePartKind::Curve:
            break;
    }
    return "curve" + length + " that turns by " + turn;
}

void print_tube(std::ostream& out, const TubeFinding& finding) {
    if (!finding.tube) {
        out << "tube          no tube: " << finding.why_not << "\n";
        return;
    }
    const Tube& tube = *finding.tube;
    out << "tube          radius " << fixed(tube.radius.front().radius_mm, 2);
    if (tube.radius.size() > 1) {
        out << " to " << fixed(tube.radius.back().radius_mm, 2);
    }
    out << ": ";
    for (const TubePart& part : tube.parts) {
        out << words_of(part) << ", ";
    }
    out << "residual " << fixed(tube.residual_mm, 4) << " mm\n";
}

}  // namespace

void print_mandrel(std::ostream& out, const Inspection& found) {
    const Mandrel& mandrel = found.mandrel;
    print_size(out, mandrel);
    print_repairs(out, mandrel.repairs);
    print_regions(out, mandrel);
    print_cad_faces(out, mandrel);
    out << "rims          " << mandrel.rims.size() << (mandrel.rims.empty() ? " (closed)\n" : "\n");
    for (const Rim& rim : mandrel.rims) {
        out << padded(std::to_string(rim.id), 10) << "  centre " << triple(rim.centre_mm, 3)
            << "  axis " << triple(rim.axis, 4) << "  radius " << fixed(rim.radius_mm, 3)
            << "  off circle " << fixed(rim.circularity_mm, 3) << "\n";
    }
    print_axes(out, found.axes);
    const FitReport& fit = mandrel.surface.fit;
    out << "surface       " << mandrel.surface.face.size() << " triangles, mean edge "
        << fixed(mandrel.surface.mean_edge_mm, 3) << " mm; smooth fit at " << fit.quartic
        << " corners quartic, " << fit.cubic << " cubic, " << fit.quadratic << " quadratic, "
        << fit.reduced << " reduced, " << fit.averaged << " averaged";
    out << (fit.exact > 0 ? "; exact at " + std::to_string(fit.exact) + "\n" : "\n");
    print_revolution(out, found.revolution);
    print_tube(out, found.tube);
    print_accuracy(out, found.accuracy);
    for (const std::string& remark : mandrel.remarks) {
        out << "remark        " << remark << "\n";
    }
}

}  // namespace meshwind
