#include "mesh/even/slivers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/interrupt.h"
#include "mesh/even/work_mesh.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Edge = WorkMesh::Edge;
using Face = WorkMesh::Face;
using Halfedge = WorkMesh::Halfedge;
using Vertex = WorkMesh::Vertex;

// A triangle of 1 : 6 has a quality of 0.28.
constexpr double kNarrow = 0.3;

// Facets turn by no more than 15 degrees: what is left of the surface is what vertices tell.
constexpr double kTurnCosine = 0.966;

constexpr int kRounds = 6;
constexpr double kNoLimit_mm = 1e12;

std::array<Vector3d, 3> corners_of(const WorkMesh& work, Face face) {
    std::array<Vector3d, 3> p;
    std::size_t i = 0;
    for (const Vertex v : work.mesh.fv_range(face)) {
        p[i++] = work.at(v);
    }
    return p;
}

double quality_of(const WorkMesh& work, Face face) {
    const auto [a, b, c] = corners_of(work, face);
    return shape_quality(a, b, c);
}

double quality_of(const TriangleSoup& soup, std::size_t face) {
    const auto& [a, b, c] = soup.faces[face];
    return shape_quality(soup.points_mm[static_cast<std::size_t>(a)],
                         soup.points_mm[static_cast<std::size_t>(b)],
                         soup.points_mm[static_cast<std::size_t>(c)]);
}

bool is_narrow(const WorkMesh& work, Edge edge) {
    for (const unsigned side : {0U, 1U}) {
        const Face face = work.mesh.face_handle(work.mesh.halfedge_handle(edge, side));
        if (work.is_wall(face) && quality_of(work, face) < kNarrow) {
            return true;
        }
    }
    return false;
}

bool collapse_short(WorkMesh& work, double short_mm, double off_mm) {
    bool any = false;
    for (const Edge edge : work.mesh.edges()) {
        if (work.mesh.status(edge).deleted() || work.length(edge) >= short_mm ||
            !is_narrow(work, edge)) {
            continue;
        }
        for (const unsigned side : {0U, 1U}) {
            const Halfedge half = work.mesh.halfedge_handle(edge, side);
            if (work.may_collapse(half, kTurnCosine, kNoLimit_mm) &&
                work.collapse_leaves_mm(half) <= off_mm) {
                work.collapse(half);
                any = true;
                break;
            }
        }
    }
    if (any) {
        work.mesh.garbage_collection();
    }
    return any;
}

bool turn_long(WorkMesh& work) {
    bool any = false;
    for (const Edge edge : work.mesh.edges()) {
        if (work.mesh.is_boundary(edge) || work.is_line(edge) || !is_narrow(work, edge)) {
            continue;
        }
        const auto [before, after] = work.angles(edge);
        if (after < before && work.may_flip(edge, kTurnCosine)) {
            work.flip(edge);
            any = true;
        }
    }
    return any;
}

}  // namespace

double shape_quality(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    const double area = 0.5 * (b - a).cross(c - a).norm();
    return sides > 0.0 ? 4.0 * std::sqrt(3.0) * area / sides : 0.0;
}

double least_quality(const TriangleSoup& soup) {
    double least = 1.0;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        least = std::min(least, quality_of(soup, f));
    }
    return least;
}

double least_quality(const LabelledMesh& part, const std::vector<char>& kept) {
    double least = 1.0;
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (kept[static_cast<std::size_t>(part.region[f])] != 0) {
            least = std::min(least, quality_of(part.soup, f));
        }
    }
    return least;
}

double share_below(const LabelledMesh& part, const std::vector<char>& kept, double quality) {
    double below = 0.0;
    double all = 0.0;
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (kept[static_cast<std::size_t>(part.region[f])] != 0) {
            const double area = area_mm2(part.soup.points_mm, part.soup.faces[f]);
            below += quality_of(part.soup, f) < quality ? area : 0.0;
            all += area;
        }
    }
    return all > 0.0 ? below / all : 0.0;
}

LabelledMesh without_slivers(const LabelledMesh& part, const std::vector<char>& kept,
                             double short_mm, double off_mm) {
    WorkMesh work(part, kept);
    for (int round = 0; round < kRounds; ++round) {
        check_interrupt();
        const bool collapsed = collapse_short(work, short_mm, off_mm);
        if (!turn_long(work) && !collapsed) {
            break;
        }
    }
    return work.part();
}

}  // namespace meshwind
