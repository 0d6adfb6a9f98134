#include "mesh/smooth/refine.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/text/text_number.h"
#include "mesh/edge_table.h"
#include "mesh/smooth/freeze.h"
#include "mesh/smooth/smooth_shape.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Index = std::int32_t;

constexpr std::uint8_t kInside = 3;
constexpr Index kWhole = -1;
constexpr std::size_t kPlaceChunk = 1024;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

// A triangle within a face of the given surface.
struct Piece {
    std::array<Index, 3> vertex;
    std::array<Vector2d, 3> uv;        // in the given face's parameters
    std::array<std::uint8_t, 3> edge;  // of the given face, on which this one's lies, or kInside
    Index parent;
};

// The triangle of a piece's corners and midpoints: corner i is i, the midpoint of edge i is 3 + i.
Piece part_of(const Piece& piece, const std::array<Index, 3>& middle,
              const std::array<std::size_t, 3>& corners) {
    Piece part;
    part.parent = piece.parent;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t a = corners[i];
        part.vertex[i] = a < 3 ? piece.vertex[a] : middle[a - 3];
        part.uv[i] =
            a < 3 ? piece.uv[a] : Vector2d(0.5 * (piece.uv[a - 3] + piece.uv[(a - 2) % 3]));
        // A side lies on an edge of the piece when both of its ends do.
        const std::size_t b = corners[(i + 1) % 3];
        part.edge[i] = kInside;
        for (std::size_t e = 0; e < 3; ++e) {
            const auto on_edge = [e](std::size_t c) {
                return c == e || c == (e + 1) % 3 || c == 3 + e;
            };
            if (on_edge(a) && on_edge(b)) {
                part.edge[i] = piece.edge[e];
            }
        }
    }
    return part;
}

void split(const Piece& piece, const std::array<Index, 3>& middle,
           const std::vector<Vector3d>& position, std::vector<Piece>& parts) {
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        parts.push_back(part_of(piece, middle, {a, b, c}));
    };
    const auto whole = std::count(middle.begin(), middle.end(), kWhole);
    if (whole == 3) {
        parts.push_back(piece);
        return;
    }
    if (whole == 0) {
        add(0, 3, 5);
        add(3, 1, 4);
        add(5, 4, 2);
        add(3, 4, 5);
        return;
    }
    // Turned so that edge i is the only one halved, or the first of two.
    std::size_t i = 0;
    while (middle[i] == kWhole || (whole == 1 && middle[(i + 1) % 3] == kWhole)) {
        ++i;
    }
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    if (whole == 2) {
        add(i, 3 + i, k);
        add(3 + i, j, k);
        return;
    }
    add(3 + i, j, 3 + j);
    const auto apart = [&](Index a, Index b) {
        return (position[at(a)] - position[at(b)]).squaredNorm();
    };
    if (apart(piece.vertex[i], middle[j]) < apart(middle[i], piece.vertex[k])) {
        add(i, 3 + i, 3 + j);
        add(i, 3 + j, k);
    } else {
        add(i, 3 + i, k);
        add(3 + i, 3 + j, k);
    }
}

[[noreturn]] void refuse(double edge_mm) {
    throw InputError("refine.too_many", "--refine",
                     "edges of at most " + fixed(edge_mm, 3) + " mm would make more than " +
                         std::to_string(kMaxRefinedFaces / 1'000'000) +
                         " million triangles; ask for longer edges");
}

class Refiner {
public:
    Refiner(const Surface& surface, double edge_mm)
        : surface_(surface), edge_mm_(edge_mm), shape_(surface), position_(surface.position_mm) {
        pieces_.reserve(surface.face.size());
        for (std::size_t f = 0; f < surface.face.size(); ++f) {
            pieces_.push_back(
                {surface.face[f],
                 {SmoothShape::corner_uv(0), SmoothShape::corner_uv(1), SmoothShape::corner_uv(2)},
                 {0, 1, 2},
                 static_cast<Index>(f)});
        }
    }

    // Halves every edge that is too long once; false when there was none.
    bool halve() {
        const std::vector<std::array<Index, 3>> middle = halved_edges();
        if (middle.empty()) {
            return false;
        }
        std::size_t count = pieces_.size();
        for (const auto& m : middle) {
            count += static_cast<std::size_t>(3 - std::count(m.begin(), m.end(), kWhole));
        }
        if (count > kMaxRefinedFaces) {
            refuse(edge_mm_);
        }
        std::vector<Piece> parts;
        parts.reserve(count);
        for (std::size_t p = 0; p < pieces_.size(); ++p) {
            split(pieces_[p], middle[p], position_, parts);
        }
        pieces_ = std::move(parts);
        return true;
    }

    [[nodiscard]] RefinedMesh mesh() && {
        RefinedMesh mesh;
        mesh.soup.points_mm = std::move(position_);
        for (const Piece& piece : pieces_) {
            mesh.soup.faces.push_back(piece.vertex);
            mesh.region.push_back(surface_.region[at(piece.parent)]);
            auto& feature = mesh.feature.emplace_back();
            auto& rim = mesh.rim.emplace_back();
            for (std::size_t e = 0; e < 3; ++e) {
                const std::size_t edge = piece.edge[e];
                const bool inside = piece.edge[e] == kInside;
                feature[e] = inside ? std::uint8_t{0} : surface_.feature[at(piece.parent)][edge];
                rim[e] = inside ? -1 : surface_.rim[at(piece.parent)][edge];
            }
        }
        return mesh;
    }

private:
    // Per piece and edge the new vertex in its middle, or kWhole; empty when no edge is too long.
    std::vector<std::array<Index, 3>> halved_edges() {
        std::vector<std::array<Index, 3>> faces;
        faces.reserve(pieces_.size());
        for (const Piece& piece : pieces_) {
            faces.push_back(piece.vertex);
        }
        struct Middle {
            Index piece;
            std::size_t edge;
        };
        std::vector<Middle> middles;
        std::vector<std::array<Index, 3>> middle(pieces_.size(), {kWhole, kWhole, kWhole});
        const std::vector<EdgeUse> uses = edge_uses(faces);
        const std::size_t known = position_.size();
        for (std::size_t u = 0; u < uses.size(); ++u) {
            const EdgeUse& use = uses[u];
            if ((position_[at(use.low)] - position_[at(use.high)]).norm() <= edge_mm_) {
                continue;
            }
            const auto e = static_cast<std::size_t>(static_cast<std::uint8_t>(use.edge));
            if (u == 0 || uses[u - 1].low != use.low || uses[u - 1].high != use.high) {
                middles.push_back({use.face, e});
            }
            middle[at(use.face)][e] = static_cast<Index>(known + middles.size() - 1);
        }
        if (middles.empty()) {
            return {};
        }
        position_.resize(known + middles.size());
        parallel_for(middles.size(), kPlaceChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Piece& piece = pieces_[at(middles[i].piece)];
                const std::size_t e = middles[i].edge;
                position_[known + i] =
                    shape_.point_at(piece.parent, 0.5 * (piece.uv[e] + piece.uv[(e + 1) % 3]));
            }
        });
        return middle;
    }

    const Surface& surface_;
    double edge_mm_;
    SmoothShape shape_;
    std::vector<Vector3d> position_;
    std::vector<Piece> pieces_;
};

}  // namespace

Surface RefinedMesh::frozen() const {
    return freeze_surface(soup, {.feature = feature, .region = region, .rim = rim});
}

RefinedMesh refined(const Surface& surface, double edge_mm) {
    if (!(edge_mm > 0.0) || !std::isfinite(edge_mm)) {
        throw InputError("refine.not_positive", "--refine",
                         "the longest edge must be a length above 0 mm");
    }
    // No triangle is larger than the equilateral one.
    const double largest_mm2 = std::sqrt(3.0) / 4.0 * edge_mm * edge_mm;
    const double area = area_mm2({surface.position_mm, surface.face});
    if (!(area <= largest_mm2 * static_cast<double>(kMaxRefinedFaces))) {
        refuse(edge_mm);
    }
    Refiner refiner(surface, edge_mm);
    while (refiner.halve()) {
        check_interrupt();
    }
    return std::move(refiner).mesh();
}

}  // namespace meshwind
