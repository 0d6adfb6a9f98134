#include "mesh/mandrel/cad_part.h"

#include <utility>

#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/mandrel/part_wall.h"
#include "mesh/mandrel/remarks.h"

namespace meshwind {
namespace {

[[noreturn]] void fail_face(const CadMesh* cad, const std::string& word, const std::string& name) {
    std::string words = "has no face " + word;
    if (cad == nullptr) {
        words += ", only CAD files have faces; keep_regions is for others";
    } else {
        words += ", its faces are 1 to " + std::to_string(cad->faces.size()) +
                 ", with the kinds and colours that meshwind inspect lists";
    }
    throw InputError("mesh.no_such_face", name, words);
}

// Per face of the part whether one of the words means it. Each has to mean one.
std::vector<char> named_faces(const CadMesh* cad, const std::vector<std::string>& words,
                              const std::string& name) {
    std::vector<char> named(cad != nullptr ? cad->faces.size() : 0, 0);
    for (const std::string& word : words) {
        bool any = false;
        for (std::size_t i = 0; i < named.size(); ++i) {
            if (is_named(cad->faces[i], i + 1, word)) {
                named[i] = 1;
                any = true;
            }
        }
        if (!any) {
            fail_face(cad, word, name);
        }
    }
    return named;
}

std::vector<CadFace> moved(std::vector<CadFace> faces, const Eigen::Isometry3d& motion) {
    for (CadFace& face : faces) {
        face.axis_point_mm = motion * face.axis_point_mm;
        face.axis_direction = motion.linear() * face.axis_direction;
    }
    return faces;
}

}  // namespace

void keep_named_faces(const CadMesh* cad, const TriangleSoup& whole,
                      const std::vector<std::string>& words, const std::string& name,
                      Segmentation& segmentation) {
    if (words.empty()) {
        return;
    }
    const std::vector<char> wanted = named_faces(cad, words, name);
    const ExactCorners known = exact_corners(*cad, whole);
    Region kept;
    kept.id = static_cast<std::int32_t>(segmentation.regions.size());
    kept.kind = RegionKind::OuterWall;
    kept.visible_fraction = 1.0;
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
        if (known.face[f] >= 0 && wanted[static_cast<std::size_t>(known.face[f])] != 0) {
            segmentation.region[f] = kept.id;
        }
    }
    for (Region& region : segmentation.regions) {
        region.kept = false;
    }
    kept.kept = true;
    segmentation.regions.push_back(kept);
    count_regions(whole, segmentation.regions.size(), segmentation);
}

std::optional<ExactWall> exact_wall(const CadMesh* cad, const TriangleSoup& whole,
                                    const Segmentation& segmentation, LabelledMesh& wall) {
    if (cad == nullptr) {
        return std::nullopt;
    }
    ExactCorners corners = exact_corners(*cad, wall.soup);
    std::vector<std::int32_t> face_region = regions_of_faces(*cad, whole, segmentation.region);
    mark_bend_borders(*cad, corners, wall);
    return ExactWall{*cad, std::move(corners), std::move(face_region)};
}

void take_cad_faces(ExactWall&& exact, const Eigen::Isometry3d& motion, Mandrel& mandrel) {
    mandrel.cad_face = std::move(exact.corners.face);
    mandrel.cad_faces = moved(exact.cad.faces, motion);
    for (std::size_t i = 0; i < exact.face_region.size(); ++i) {
        mandrel.cad_faces[i].region = exact.face_region[i];
    }
}

void add_cad_remarks(const CadMesh& cad, Mandrel& mandrel) {
    constexpr double kNoteworthy_mm = 1e-3;
    if (cad.sewn_edges > 0) {
        add_remark(mandrel,
                   std::to_string(cad.sewn_edges) +
                       " edges of the CAD part's faces were apart and are sewn",
                   {});
    }
    if (cad.open_edges > 0) {
        add_remark(mandrel,
                   "the CAD part is open: " + std::to_string(cad.open_edges) +
                       " of its edges are of one face only",
                   {});
    }
    if (cad.off_face_mm > kNoteworthy_mm) {
        add_remark(mandrel,
                   "edges of the CAD part are up to " + fixed(cad.off_face_mm, 3) +
                       " mm off its faces: paths there are no better",
                   {});
    }
}

}  // namespace meshwind
