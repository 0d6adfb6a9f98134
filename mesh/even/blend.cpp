#include "mesh/even/blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/interrupt.h"
#include "mesh/edge_table.h"
#include "mesh/even/even_mesh.h"
#include "mesh/even/fair.h"
#include "mesh/even/rolling_ball.h"
#include "mesh/even/slivers.h"
#include "mesh/even/wall_surface.h"
#include "mesh/even/winding_mesh.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Edges where the ball cannot touch, as a share of its radius: four to a fillet of 90 degrees
// before it is bent.
constexpr double kEdge = 0.3;

// Shortest edges, as a share of the part's size: fillets are narrower than what parts have else.
constexpr double kMinEdge = 0.01;

// Share of the wall in uneven triangles that a blended wall may have.
constexpr double kMaxNarrow = 5e-3;

// Faces of the part that are wall, in their order: the faces of its frozen wall.
std::vector<std::int32_t> wall_faces(const LabelledMesh& part, const std::vector<char>& kept) {
    std::vector<std::int32_t> faces;
    for (std::size_t f = 0; f < part.region.size(); ++f) {
        if (kept[at(part.region[f])] != 0) {
            faces.push_back(static_cast<std::int32_t>(f));
        }
    }
    return faces;
}

EvenMeshOptions options_for(const LabelledMesh& part, const std::vector<char>& kept) {
    const double size = size_mm(part, kept);
    EvenMeshOptions options = even_options(size);
    options.least_mm = kMinEdge * size;
    return options;
}

// Creases beside the faces go, and regions that no crease parts any more become one.
void join_over(LabelledMesh& part, const std::vector<char>& kept,
               const std::vector<char>& blended) {
    const auto neighbours = face_neighbours(part.soup.faces);
    std::vector<std::int32_t> same(kept.size());
    std::iota(same.begin(), same.end(), 0);
    const auto first_of = [&](std::int32_t region) {
        while (same[at(region)] != region) {
            region = same[at(region)];
        }
        return region;
    };
    for (std::size_t f = 0; f < part.region.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = neighbours[f][e];
            if (g < 0 || kept[at(part.region[f])] == 0 || kept[at(part.region[at(g)])] == 0) {
                continue;
            }
            if (blended[f] != 0 || blended[at(g)] != 0) {
                part.feature[f][e] = 0;
            }
            if (part.feature[f][e] == 0) {
                const std::int32_t one = first_of(part.region[f]);
                const std::int32_t other = first_of(part.region[at(g)]);
                same[at(std::max(one, other))] = std::min(one, other);
            }
        }
    }
    for (std::int32_t& region : part.region) {
        region = first_of(region);
    }
}

double volume_mm3(const TriangleSoup& soup) {
    double volume = 0.0;
    for (const auto& [a, b, c] : soup.faces) {
        volume +=
            soup.points_mm[at(a)].dot(soup.points_mm[at(b)].cross(soup.points_mm[at(c)])) / 6.0;
    }
    return volume;
}

// The wall alone, with the number of each of its points in the part.
struct WallSoup {
    TriangleSoup soup;
    std::vector<std::int32_t> point;
};

WallSoup wall_soup(const LabelledMesh& part, const std::vector<std::int32_t>& faces) {
    WallSoup wall;
    std::vector<std::int32_t> number(part.soup.points_mm.size(), -1);
    for (const std::int32_t f : faces) {
        std::array<std::int32_t, 3> face = part.soup.faces[at(f)];
        for (std::int32_t& v : face) {
            std::int32_t& n = number[at(v)];
            if (n < 0) {
                n = static_cast<std::int32_t>(wall.point.size());
                wall.point.push_back(v);
                wall.soup.points_mm.push_back(part.soup.points_mm[at(v)]);
            }
            v = n;
        }
        wall.soup.faces.push_back(face);
    }
    return wall;
}

// Points whose faces are all blended, and which are not where the wall ends.
std::vector<char> free_points(const TriangleSoup& wall, const std::vector<char>& blended) {
    std::vector<char> free(wall.points_mm.size(), 1);
    const auto neighbours = face_neighbours(wall.faces);
    for (std::size_t f = 0; f < wall.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (blended[f] == 0) {
                free[at(wall.faces[f][e])] = 0;
            }
            if (neighbours[f][e] < 0) {
                free[at(wall.faces[f][e])] = 0;
                free[at(wall.faces[f][(e + 1) % 3])] = 0;
            }
        }
    }
    return free;
}

// Even triangles, short ones near where the ball cannot touch.
LabelledMesh fine_near(const LabelledMesh& part, const std::vector<char>& kept, Surface&& wall,
                       const std::vector<char>& out, double radius_mm) {
    EvenMeshOptions options = options_for(part, kept);
    options.most_mm.assign(wall.position_mm.size(), options.longest_mm);
    for (std::size_t f = 0; f < out.size(); ++f) {
        for (const std::int32_t v : wall.face[f]) {
            if (out[f] != 0) {
                options.most_mm[at(v)] = std::min(options.longest_mm, kEdge * radius_mm);
            }
        }
    }
    return even_mesh(part, kept, std::move(wall), options);
}

}  // namespace

std::vector<char> out_of_reach(const Surface& wall, double radius_mm) {
    return out_of_reach({wall.position_mm, wall.face}, radius_mm, WallSide::Outside);
}

double out_of_reach_mm2(const Surface& wall, double radius_mm) {
    const std::vector<char> out = out_of_reach(wall, radius_mm);
    double area = 0.0;
    for (std::size_t f = 0; f < out.size(); ++f) {
        area += out[f] != 0 ? area_mm2(wall.position_mm, wall.face[f]) : 0.0;
    }
    return area;
}

Blend blend_wall(const LabelledMesh& part, const std::vector<char>& kept, double radius_mm) {
    Blend result;
    result.part = part;
    Surface wall = frozen_wall(part, kept);
    const std::vector<char> out = out_of_reach(wall, radius_mm);
    if (std::find(out.begin(), out.end(), 1) == out.end()) {
        return result;
    }
    check_interrupt();
    LabelledMesh fine = fine_near(part, kept, std::move(wall), out, radius_mm);
    check_interrupt();
    const std::vector<std::int32_t> faces = wall_faces(fine, kept);
    const std::vector<char> blended = out_of_reach(frozen_wall(fine, kept), radius_mm);
    WallSoup filled = wall_soup(fine, faces);
    const double before = volume_mm3(filled.soup);
    if (!fair(filled.soup, free_points(filled.soup, blended))) {
        result.why_not = "no smooth surface fills it";
        return result;
    }
    result.volume_mm3 = volume_mm3(filled.soup) - before;
    std::vector<char> blended_of_part(fine.soup.faces.size(), 0);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        blended_of_part[at(faces[i])] = blended[i];
        if (blended[i] != 0) {
            result.area_mm2 += area_mm2(filled.soup.points_mm, filled.soup.faces[i]);
        }
    }
    for (std::size_t v = 0; v < filled.point.size(); ++v) {
        fine.soup.points_mm[at(filled.point[v])] = filled.soup.points_mm[v];
    }
    join_over(fine, kept, blended_of_part);
    check_interrupt();
    Surface smooth = frozen_wall(fine, kept);
    const EvenMeshOptions options = options_for(fine, kept);
    if (wanted_triangles(smooth, options) > kMaxEvenTriangles) {
        result.why_not = "it would take too many triangles; blend by a larger radius";
        return result;
    }
    LabelledMesh even = even_mesh(fine, kept, std::move(smooth), options);
    const double narrow = share_below(even, kept, kUnevenQuality);
    if (narrow > kMaxNarrow) {
        result.why_not = "its triangles do not come out even";
        return result;
    }
    result.part = std::move(even);
    return result;
}

}  // namespace meshwind
