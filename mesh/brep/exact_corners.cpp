#include "mesh/brep/exact_corners.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "core/index.h"
#include "mesh/edge_table.h"
#include "mesh/smooth/freeze.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Where both sides of a border turn along an edge by the same but for this angle, they are as good
// as one surface: a fit across is off by a hundredth of a millimetre on edges of 50 mm.
constexpr double kSameBend_rad = 1e-3;

// Equal bits: the vertices have been copied, not computed again.
struct PlaceHash {
    std::size_t operator()(const Vector3d& p) const {
        std::uint64_t hash = 0;
        for (const double x : p) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ULL;
            hash ^= hash >> 29U;
        }
        return hash;
    }
};

struct CornersHash {
    std::size_t operator()(const std::array<std::int32_t, 3>& v) const {
        std::uint64_t hash = 0;
        for (const std::int32_t i : v) {
            hash = (hash ^ static_cast<std::uint32_t>(i)) * 0x9e3779b97f4a7c15ULL;
            hash ^= hash >> 29U;
        }
        return hash;
    }
};

std::array<std::int32_t, 3> sorted(std::array<std::int32_t, 3> v) {
    std::sort(v.begin(), v.end());
    return v;
}

Jet moved(Jet jet, const Eigen::Isometry3d& motion) {
    const Eigen::Matrix3d turn = motion.linear();
    jet.height.frame = turn * jet.height.frame;
    jet.normal = turn * jet.normal;
    jet.shape_operator_per_mm = turn * jet.shape_operator_per_mm * turn.transpose();
    return jet;
}

}  // namespace

ExactCorners exact_corners(const CadMesh& part, const TriangleSoup& wall) {
    std::unordered_map<Vector3d, std::int32_t, PlaceHash> vertex_at;
    for (std::size_t v = 0; v < part.soup.points_mm.size(); ++v) {
        vertex_at.try_emplace(part.soup.points_mm[v], static_cast<std::int32_t>(v));
    }
    std::unordered_map<std::array<std::int32_t, 3>, std::size_t, CornersHash> triangle_of;
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        triangle_of.try_emplace(sorted(part.soup.faces[f]), f);
    }
    ExactCorners known;
    for (const auto& corners : wall.faces) {
        std::array<std::int32_t, 3> v{};
        for (std::size_t c = 0; c < 3; ++c) {
            const auto found = vertex_at.find(wall.points_mm[at(corners[c])]);
            v[c] = found == vertex_at.end() ? -1 : found->second;
        }
        const auto found = triangle_of.find(sorted(v));
        known.face.push_back(-1);
        known.jet.push_back({-1, -1, -1});
        if (found == triangle_of.end()) {
            continue;
        }
        const auto& there = part.soup.faces[found->second];
        known.face.back() = part.face[found->second];
        for (std::size_t c = 0; c < 3; ++c) {
            const auto k = static_cast<std::size_t>(std::find(there.begin(), there.end(), v[c]) -
                                                    there.begin());
            known.jet.back()[c] = part.jet[found->second][k];
        }
    }
    return known;
}

void mark_bend_borders(const CadMesh& part, const ExactCorners& known, LabelledMesh& wall) {
    const auto neighbours = face_neighbours(wall.soup.faces);
    for (std::size_t f = 0; f < wall.soup.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t next = neighbours[f][e];
            if (next == kNoFace || known.face[f] < 0 || known.face[at(next)] < 0 ||
                known.face[f] == known.face[at(next)]) {
                continue;
            }
            const auto& here = wall.soup.faces[f];
            const auto& there = wall.soup.faces[at(next)];
            const double edge_mm =
                (wall.soup.points_mm[at(here[e])] - wall.soup.points_mm[at(here[(e + 1) % 3])])
                    .norm();
            for (const std::size_t c : {e, (e + 1) % 3}) {
                const auto k = static_cast<std::size_t>(
                    std::find(there.begin(), there.end(), here[c]) - there.begin());
                const std::int32_t a = known.jet[f][c];
                const std::int32_t b = known.jet[at(next)][k];
                if (a >= 0 && b >= 0 &&
                    (part.jets[at(a)].shape_operator_per_mm -
                     part.jets[at(b)].shape_operator_per_mm)
                                .norm() *
                            edge_mm >
                        kSameBend_rad) {
                    wall.feature[f][e] = 1;
                }
            }
        }
    }
}

std::vector<std::int32_t> regions_of_faces(const CadMesh& part, const TriangleSoup& whole,
                                           std::span<const std::int32_t> region) {
    const ExactCorners known = exact_corners(part, whole);
    std::vector<std::map<std::int32_t, double>> area(part.faces.size());  // by region
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
        if (known.face[f] >= 0) {
            area[at(known.face[f])][region[f]] += area_mm2(whole.points_mm, whole.faces[f]);
        }
    }
    std::vector<std::int32_t> most;
    for (const auto& of_face : area) {
        const auto largest =
            std::max_element(of_face.begin(), of_face.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        most.push_back(largest == of_face.end() ? -1 : largest->first);
    }
    return most;
}

namespace {

// How far a vertex may be off a cylinder that its face is taken for: what such faces are apart at
// their borders. Files have 1e-7 mm.
constexpr double kOnCylinder_mm = 1e-6;

void set_cylinders(const CadMesh& part, const ExactCorners& known, const Eigen::Isometry3d& motion,
                   Surface& surface) {
    std::vector<std::int32_t> number(part.faces.size(), -1);
    for (std::size_t i = 0; i < part.faces.size(); ++i) {
        const CadFace& face = part.faces[i];
        if (face.kind == "cylinder") {
            number[i] = static_cast<std::int32_t>(surface.cylinder.size());
            surface.cylinder.push_back({motion * face.axis_point_mm,
                                        motion.linear() * face.axis_direction, face.radius_mm});
        }
    }
    surface.cylinder_of.assign(surface.face.size(), -1);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const std::int32_t found = known.face[f] < 0 ? -1 : number[at(known.face[f])];
        if (found < 0) {
            continue;
        }
        const KnownCylinder& cylinder = surface.cylinder[at(found)];
        const bool on =
            std::all_of(surface.face[f].begin(), surface.face[f].end(), [&](std::int32_t vertex) {
                const Eigen::Vector3d arm =
                    (surface.position_mm[at(vertex)] - cylinder.point_mm).cross(cylinder.direction);
                return std::abs(arm.norm() - cylinder.radius_mm) < kOnCylinder_mm;
            });
        surface.cylinder_of[f] = on ? found : -1;
    }
}

}  // namespace

void set_exact(const CadMesh& part, const ExactCorners& known, const Eigen::Isometry3d& motion,
               Surface& surface) {
    std::vector<char> done(surface.normal.size(), 0);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t corner = at(surface.corner[f][c]);
            if (known.jet[f][c] >= 0 && std::exchange(done[corner], 1) == 0) {
                set_jet(surface, corner, moved(part.jets[at(known.jet[f][c])], motion));
                surface.exact[corner] = 1;
                ++surface.fit.exact;
            }
        }
    }
    set_cylinders(part, known, motion, surface);
}

}  // namespace meshwind
