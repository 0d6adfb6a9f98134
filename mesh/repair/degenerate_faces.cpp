#include "mesh/repair/degenerate_faces.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "mesh/repair/open_mesh.h"

namespace meshwind {
namespace {

using Halfedge = OpenMesh::SmartHalfedgeHandle;

// Rounds over the shrinking list of degenerate faces; chains of caps on one line need a few.
constexpr int kRounds = 32;

struct Shape {
    Halfedge longest;
    Halfedge shortest;
    double shortest_mm = 0.0;
    double height_mm = 0.0;
};

Shape shape_of(const OpenTriMesh& mesh, OpenMesh::FaceHandle face) {
    Shape shape;
    double longest_mm = -1.0;
    for (const Halfedge h : mesh.fh_range(face)) {
        const double length = mesh.calc_edge_length(h);
        if (length > longest_mm) {
            longest_mm = length;
            shape.longest = h;
        }
        if (!shape.shortest.is_valid() || length < shape.shortest_mm) {
            shape.shortest_mm = length;
            shape.shortest = h;
        }
    }
    const auto origin = mesh.point(shape.longest.from());
    const auto along = mesh.point(shape.longest.to()) - origin;
    const auto up = mesh.point(shape.longest.next().to()) - origin;
    shape.height_mm = longest_mm > 0.0 ? along.cross(up).norm() / longest_mm : 0.0;
    return shape;
}

bool collapse_shortest(OpenTriMesh& mesh, const Shape& shape) {
    for (const Halfedge h : {shape.shortest, shape.shortest.opp()}) {
        const bool cuts_border = h.from().is_boundary() && !h.edge().is_boundary();
        if (!cuts_border && mesh.is_collapse_ok(h)) {
            mesh.collapse(h);
            return true;
        }
    }
    return false;
}

// A cap's longest edge lies along its two others: the neighbour takes the middle point over.
bool mend_cap(OpenTriMesh& mesh, const Shape& shape, OpenMesh::FaceHandle face) {
    if (shape.longest.edge().is_boundary()) {
        mesh.delete_face(face, false);
        return true;
    }
    if (!mesh.is_flip_ok(shape.longest.edge())) {
        return false;
    }
    mesh.flip(shape.longest.edge());
    return true;
}

}  // namespace

int remove_degenerate_faces(TriangleSoup& soup, double height_mm) {
    OpenTriMesh mesh = open_mesh_of(soup);
    std::vector<OpenMesh::FaceHandle> suspects(mesh.faces_begin(), mesh.faces_end());
    const auto degenerate = static_cast<int>(std::count_if(
        suspects.begin(), suspects.end(),
        [&](OpenMesh::FaceHandle face) { return shape_of(mesh, face).height_mm <= height_mm; }));
    bool changed = false;
    for (int round = 0; round < kRounds && !suspects.empty(); ++round) {
        std::vector<OpenMesh::FaceHandle> next;
        for (const OpenMesh::FaceHandle face : suspects) {
            if (mesh.status(face).deleted()) {
                continue;
            }
            const Shape shape = shape_of(mesh, face);
            if (shape.height_mm > height_mm) {
                continue;
            }
            next.push_back(face);
            const auto across = shape.longest.opp().face();
            if (across.is_valid()) {
                next.push_back(across);
            }
            changed = (shape.shortest_mm <= height_mm ? collapse_shortest(mesh, shape)
                                                      : mend_cap(mesh, shape, face)) ||
                      changed;
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        suspects = std::move(next);
    }
    for (const OpenMesh::FaceHandle face : suspects) {
        if (!mesh.status(face).deleted() && shape_of(mesh, face).height_mm <= height_mm) {
            mesh.delete_face(face, false);
            changed = true;
        }
    }
    if (!changed) {
        return 0;
    }
    soup = soup_of(mesh);
    return degenerate;
}

}  // namespace meshwind
