#include "mesh/mandrel/remarks.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/text/text_number.h"
#include "mesh/mandrel/round_rims.h"
#include "mesh/segment/rims.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Nearer places than this share of the part's diagonal are one.
constexpr double kApartShare = 0.15;
// Of a remark; more of them say no more.
constexpr std::size_t kMaxPlaces = 8;

std::vector<Vector3d> middles_of_faces(const TriangleSoup& soup) {
    std::vector<Vector3d> middles;
    middles.reserve(soup.faces.size());
    for (const auto& face : soup.faces) {
        middles.push_back(middle_mm(soup.points_mm, face));
    }
    return middles;
}

Vector3d farthest_off(const Mandrel& mandrel, const Rim& rim) {
    Vector3d worst = rim.centre_mm;
    double most = -1.0;
    for (const std::int32_t v : rim.vertices) {
        const Vector3d& p = mandrel.surface.position_mm[static_cast<std::size_t>(v)];
        const double off = off_circle_mm(rim, p);
        if (off > most) {
            most = off;
            worst = p;
        }
    }
    return worst;
}

void add_file_remarks(Mandrel& mandrel) {
    const RepairReport& r = mandrel.repairs;
    if (r.components > 1) {
        add_remark(mandrel,
                   "the file holds " + std::to_string(r.components) +
                       " separate shells; all are kept as obstacles",
                   {});
    }
    if (r.self_intersecting_faces > 0) {
        std::vector<Vector3d> places_mm = r.crossings;
        for (Vector3d& place : places_mm) {
            place = mandrel.file_to_mandrel * place;
        }
        add_remark(mandrel,
                   std::to_string(r.self_intersecting_faces) +
                       " triangles cross others; paths near them may be wrong, mend the "
                       "part in the modeller",
                   places_mm);
    }
}

void add_rim_remarks(Mandrel& mandrel) {
    constexpr double kRoundShare = 0.02;  // of its radius: a rim further off is worth a word
    for (const Rim& rim : mandrel.rims) {
        const std::array places_mm{farthest_off(mandrel, rim)};
        if (!is_round(rim)) {
            add_remark(mandrel, off_circle_words(mandrel, rim) + "; the main job refuses it",
                       places_mm);
        } else if (rim.circularity_mm > kRoundShare * rim.radius_mm) {
            add_remark(mandrel,
                       "rim " + std::to_string(rim.id) + " is no circle: up to " +
                           fixed(rim.circularity_mm, 2) + " mm off radius " +
                           fixed(rim.radius_mm, 2) + " mm",
                       places_mm);
        }
    }
    if (!mandrel.angular_ends.empty()) {
        const std::array places_mm{mandrel.angular_ends.front().middle_mm};
        add_remark(mandrel, angular_end_words(mandrel) + "; the main job refuses it", places_mm);
    }
    for (const Rim& rim : mandrel.rims) {
        if (rim.cut_off_mm > 0.0) {
            const std::array places_mm{
                mandrel.surface.position_mm[static_cast<std::size_t>(rim.vertices.front())]};
            add_remark(
                mandrel,
                "rim " + std::to_string(rim.id) + " is cut " + fixed(rim.cut_off_mm, 2) +
                    " mm before the part's end, where its leg of radius " +
                    fixed(rim.radius_mm, 2) +
                    " mm ends; \"mandrel\": {\"cut_ends\": 0} in the job keeps what is beyond",
                places_mm);
        }
    }
}

void add_mesh_remarks(Mandrel& mandrel) {
    const WindingMeshReport& mesh = mandrel.winding_mesh;
    if (mesh.details > 0) {
        add_remark(mandrel,
                   "lettering and the like is not wound: " + std::to_string(mesh.details) +
                       " places, " + fixed(mesh.details_mm2, 0) + " mm2, that stand up to " +
                       fixed(mesh.details_mm, 2) +
                       " mm out of the wall or in it; \"mandrel\": {\"remove_details\": 0} in the "
                       "job keeps them",
                   middles_of_faces(mandrel.details));
    }
    if (mesh.blend_mm > 0.0) {
        add_remark(mandrel,
                   mesh.blended_mm2 > 0.0
                       ? "the wall is blended by " + fixed(mesh.blend_mm, 2) +
                             " mm: " + fixed(mesh.blended_mm2, 0) +
                             " mm2 of it stand over the file's, with " +
                             fixed(mesh.filled_mm3 / 1000.0, 2) + " cm3 to fill in"
                       : "a ball of " + fixed(mesh.blend_mm, 2) +
                             " mm touches all of the wall: nothing is blended",
                   {});
    }
    if (mesh.own) {
        add_remark(
            mandrel,
            "the file's triangles are uneven: what is wound has " + std::to_string(mesh.triangles) +
                (mesh.swept ? " in rings about the spindle" : " even ones") +
                ", from which no vertex of the file is more than " + fixed(mesh.deviation_mm, 3) +
                " mm off; \"mandrel\": {\"mesh\": \"file\"} in the job winds the file's",
            {});
    } else if (!mesh.why_not.empty()) {
        add_remark(mandrel,
                   "the file's triangles are uneven and are wound as they are: " + mesh.why_not,
                   {});
    }
}

}  // namespace

void add_remark(Mandrel& mandrel, std::string words, std::span<const Vector3d> places_mm) {
    const double near_mm = kApartShare * diagonal_mm(mandrel.whole);
    const std::vector<Vector3d> middles = middles_of_groups(places_mm, near_mm);
    for (std::size_t i = 0; i < std::min(kMaxPlaces, middles.size()); ++i) {
        mandrel.places.push_back({mandrel.remarks.size(), middles[i]});
    }
    mandrel.remarks.push_back(std::move(words));
}

void add_remarks(Mandrel& mandrel, std::span<const Vector3d> holes_mm,
                 std::span<const Vector3d> crumbs_mm) {
    add_file_remarks(mandrel);
    if (!holes_mm.empty()) {
        add_remark(mandrel,
                   std::to_string(holes_mm.size()) +
                       " small holes in the wall are not rims: courses end at them",
                   holes_mm);
    }
    if (!crumbs_mm.empty()) {
        add_remark(mandrel,
                   std::to_string(crumbs_mm.size()) +
                       " small pieces of the wall hang together with nothing of it and "
                       "are not wound; keep_regions names what is",
                   crumbs_mm);
    }
    add_rim_remarks(mandrel);
    add_mesh_remarks(mandrel);
    if (mandrel.axis.rule == "principal") {
        add_remark(mandrel,
                   "no coaxial rims and no axis of revolution: the spindle is a principal axis of "
                   "inertia, give another with \"axis\"",
                   {});
    }
}

std::vector<Vector3d> middles_of_groups(std::span<const Vector3d> points_mm, double near_mm) {
    std::vector<std::vector<Vector3d>> groups;
    for (const Vector3d& point : points_mm) {
        const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) {
            return (g.front() - point).norm() < near_mm;
        });
        (group == groups.end() ? groups.emplace_back() : *group).push_back(point);
    }
    std::stable_sort(groups.begin(), groups.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
    std::vector<Vector3d> middles;
    for (const std::vector<Vector3d>& group : groups) {
        Vector3d mean = Vector3d::Zero();
        for (const Vector3d& point : group) {
            mean += point / static_cast<double>(group.size());
        }
        middles.push_back(
            *std::min_element(group.begin(), group.end(), [&](const auto& a, const auto& b) {
                return (a - mean).squaredNorm() < (b - mean).squaredNorm();
            }));
    }
    return middles;
}

}  // namespace meshwind
