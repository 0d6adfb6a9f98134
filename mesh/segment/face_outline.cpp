#include "mesh/segment/face_outline.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Turns about the edge's end through the faces inside.
template <typename Inside>
HalfEdge next_on_border(const MeasuredFaces& part, HalfEdge edge, const Inside& inside) {
    auto [f, e] = edge;
    e = (e + 1) % 3;
    for (std::int32_t g = part.neighbours[at(f)][e]; inside(g); g = part.neighbours[at(f)][e]) {
        const std::int32_t turned = part.soup.faces[at(f)][e];
        const auto& corners = part.soup.faces[at(g)];
        e = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), turned) -
                                     corners.begin());
        f = g;
    }
    return {f, e};
}

// Boundary loops of the marked faces, each turning left about them. Empty where the part is
// open there.
std::vector<std::vector<HalfEdge>> loops_of(const MeasuredFaces& part,
                                            const std::vector<std::int32_t>& faces,
                                            const FaceMarks& marks, int mark) {
    const auto inside = [&](std::int32_t f) { return marks.of_face[at(f)] == mark; };
    std::vector<HalfEdge> border;
    for (const std::int32_t f : faces) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = part.neighbours[at(f)][e];
            if (g < 0) {
                return {};
            }
            if (!inside(g)) {
                border.emplace_back(f, e);
            }
        }
    }
    std::sort(border.begin(), border.end());
    std::vector<char> used(border.size(), 0);
    std::vector<std::vector<HalfEdge>> loops;
    for (std::size_t i = 0; i < border.size(); ++i) {
        if (used[i] != 0) {
            continue;
        }
        std::vector<HalfEdge> loop;
        HalfEdge edge = border[i];
        for (std::size_t place = i; used[place] == 0;) {
            used[place] = 1;
            loop.push_back(edge);
            edge = next_on_border(part, edge, inside);
            place = static_cast<std::size_t>(std::lower_bound(border.begin(), border.end(), edge) -
                                             border.begin());
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

// The loop that encloses the largest area, and that area. Loops turn left about the normal.
FaceOutline outline_of(const MeasuredFaces& part, const std::vector<std::vector<HalfEdge>>& loops,
                       const Vector3d& normal) {
    FaceOutline outline;
    for (const auto& loop : loops) {
        const Vector3d& origin = part.corner(loop.front().first, loop.front().second);
        double area = 0.0;
        for (const auto& [f, e] : loop) {
            area += 0.5 *
                    normal.dot((part.corner(f, e) - origin).cross(part.corner(f, e + 1) - origin));
        }
        if (area > outline.enclosed_mm2) {
            outline = {loop, area};
        }
    }
    return outline;
}

}  // namespace

FaceOutline marked_outline(const MeasuredFaces& part, const std::vector<std::int32_t>& faces,
                           const Vector3d& normal, FaceMarks& marks) {
    const int mark = marks.fresh();
    for (const std::int32_t f : faces) {
        marks.of_face[at(f)] = mark;
    }
    return outline_of(part, loops_of(part, faces, marks, mark), normal);
}

}  // namespace meshwind
