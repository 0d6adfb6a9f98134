#include "mesh/segment/feature_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "mesh/edge_table.h"

namespace meshwind {
namespace {

// Longest line of sharp edges that is no crease where it ends inside the surface or closes there.
constexpr int kFoldEdges = 4;

// Triangles of a patch that is no region of its own where one region surrounds it, at most, and
// their area as a share of that of the largest beside them. Specks of a mesh of 1.7 mm2 on average
// had 0.33 mm2 at most; a larger facet that stands askew is a spike, and round walls have none.
constexpr std::size_t kSpeckFaces = 2;
constexpr double kSpeckArea = 0.25;

// A sliver waiting to take over the normal of the face it was reached from.
struct Offer {
    double edge_mm = 0.0;
    std::int32_t face = 0;
    std::int32_t giver = 0;
    // Longest edge first; ties by index keep the order reproducible.
    bool operator<(const Offer& other) const {
        return std::tie(edge_mm, other.face, other.giver) < std::tie(other.edge_mm, face, giver);
    }
};

double edge_length_mm(const TriangleSoup& soup, const std::array<std::int32_t, 3>& face,
                      std::size_t e) {
    return (soup.points_mm[static_cast<std::size_t>(face[(e + 1) % 3])] -
            soup.points_mm[static_cast<std::size_t>(face[e])])
        .norm();
}

// Sharp edges that hang together by their vertices.
class Lines {
public:
    explicit Lines(std::size_t vertices) : parent_(vertices, -1), lines_(vertices) {}

    void join(std::int32_t a, std::int32_t b) {
        ++ends_at(a);
        ++ends_at(b);
        const std::int32_t root = root_of(a);
        const std::int32_t other = root_of(b);
        if (root != other) {
            parent_[static_cast<std::size_t>(other)] = root;
            line(root).edges += line(other).edges;
        }
        ++line(root).edges;
    }

    // To be asked when every edge is joined.
    void mark_border(std::int32_t vertex) {
        ++ends_at(vertex);
        line(root_of(vertex)).meets_border = true;
    }
    void count_loose_end(std::int32_t vertex) {
        if (ends_at(vertex) == 1) {
            ++line(root_of(vertex)).loose_ends;
        }
    }
    [[nodiscard]] bool is_fold(std::int32_t vertex) {
        const Line& of = line(root_of(vertex));
        return of.edges <= kFoldEdges && (of.loose_ends > 0 || !of.meets_border);
    }

private:
    struct Line {
        int edges = 0;
        int loose_ends = 0;
        bool meets_border = false;
        int ends = 0;  // of edges at this vertex
    };

    std::int32_t root_of(std::int32_t v) {
        std::int32_t root = v;
        while (parent_[static_cast<std::size_t>(root)] >= 0) {
            root = parent_[static_cast<std::size_t>(root)];
        }
        while (v != root) {  // the next search starts at the root
            v = std::exchange(parent_[static_cast<std::size_t>(v)], root);
        }
        return root;
    }
    Line& line(std::int32_t v) { return lines_[static_cast<std::size_t>(v)]; }
    int& ends_at(std::int32_t v) { return line(v).ends; }

    std::vector<std::int32_t> parent_;
    std::vector<Line> lines_;
};

// A crease is a line. A few sharp edges that end inside the surface, or go around a facet there,
// are folds of facets too coarse for a round wall; taken as creases they would leave the fits
// nothing.
void drop_folds(const std::vector<std::array<std::int32_t, 3>>& faces,
                const std::vector<std::array<std::int32_t, 3>>& neighbours,
                std::vector<std::array<std::uint8_t, 3>>& flags) {
    std::int32_t vertices = 0;
    for (const auto& face : faces) {
        vertices = std::max({vertices, face[0] + 1, face[1] + 1, face[2] + 1});
    }
    Lines lines(static_cast<std::size_t>(vertices));
    const auto each_edge = [&](const auto& use) {
        for (std::size_t f = 0; f < faces.size(); ++f) {
            for (std::size_t e = 0; e < 3; ++e) {
                use(f, e, faces[f][e], faces[f][(e + 1) % 3]);
            }
        }
    };
    each_edge([&](std::size_t f, std::size_t e, std::int32_t a, std::int32_t b) {
        if (flags[f][e] != 0 && static_cast<std::int32_t>(f) < neighbours[f][e]) {
            lines.join(a, b);
        }
    });
    each_edge([&](std::size_t f, std::size_t e, std::int32_t a, std::int32_t b) {
        if (neighbours[f][e] < 0) {
            lines.mark_border(a);
            lines.mark_border(b);
        }
    });
    for (std::int32_t v = 0; v < vertices; ++v) {
        lines.count_loose_end(v);
    }
    each_edge([&](std::size_t f, std::size_t e, std::int32_t a, std::int32_t /*b*/) {
        if (flags[f][e] != 0 && lines.is_fold(a)) {
            flags[f][e] = 0;
        }
    });
}

// Slivers that stand askew in one region, one or two, as where vertices have been moved, are no
// region, and their edges no creases; nor where another such speck lies beside them.
void drop_specks(const TriangleSoup& soup,
                 const std::vector<std::array<std::int32_t, 3>>& neighbours,
                 std::vector<std::array<std::uint8_t, 3>>& flags) {
    const std::vector<std::int32_t> patch =
        patches_of(neighbours, [&](std::size_t f, std::size_t e) { return flags[f][e] != 0; });
    std::vector<std::size_t> size(patch.size(), 0);  // of each patch
    for (const std::int32_t p : patch) {
        ++size[static_cast<std::size_t>(p)];
    }
    const auto is_small = [&](std::int32_t p) {
        return size[static_cast<std::size_t>(p)] <= kSpeckFaces;
    };
    std::map<std::int32_t, std::vector<std::size_t>> small_patches;
    for (std::size_t f = 0; f < patch.size(); ++f) {
        if (is_small(patch[f])) {
            small_patches[patch[f]].push_back(f);
        }
    }
    const auto is_speck = [&](std::int32_t own, const std::vector<std::size_t>& faces) {
        std::set<std::int32_t> small;
        std::set<std::int32_t> large;
        double own_mm2 = 0.0;
        double beside_mm2 = 0.0;
        for (const std::size_t f : faces) {
            own_mm2 = std::max(own_mm2, area_mm2(soup.points_mm, soup.faces[f]));
            for (const std::int32_t g : neighbours[f]) {
                if (g < 0) {
                    return false;
                }
                const std::int32_t other = patch[static_cast<std::size_t>(g)];
                if (other != own) {
                    (is_small(other) ? small : large).insert(other);
                    beside_mm2 =
                        std::max(beside_mm2,
                                 area_mm2(soup.points_mm, soup.faces[static_cast<std::size_t>(g)]));
                }
            }
        }
        return large.size() == 1 && small.size() <= 1 && own_mm2 <= kSpeckArea * beside_mm2;
    };
    for (const auto& [own, faces] : small_patches) {
        if (!is_speck(own, faces)) {
            continue;
        }
        for (const std::size_t f : faces) {
            for (std::size_t e = 0; e < 3; ++e) {
                const auto g = static_cast<std::size_t>(neighbours[f][e]);
                const int back = shared_edge(neighbours[g], static_cast<std::int32_t>(f));
                flags[f][e] = 0;
                flags[g][static_cast<std::size_t>(back)] = 0;
            }
        }
    }
}

}  // namespace

std::vector<Eigen::Vector3d> steady_normals(
    const TriangleSoup& soup, const std::vector<std::array<std::int32_t, 3>>& neighbours) {
    const double limit = kSliverHeightShare * diagonal_mm(soup);
    std::vector<Eigen::Vector3d> normals(soup.faces.size());
    std::vector<char> settled(soup.faces.size(), 0);
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        const auto& face = soup.faces[f];
        const Eigen::Vector3d& origin = soup.points_mm[static_cast<std::size_t>(face[0])];
        const Eigen::Vector3d twice =
            (soup.points_mm[static_cast<std::size_t>(face[1])] - origin)
                .cross(soup.points_mm[static_cast<std::size_t>(face[2])] - origin);
        const double longest =
            std::max({edge_length_mm(soup, face, 0), edge_length_mm(soup, face, 1),
                      edge_length_mm(soup, face, 2)});
        normals[f] = twice.normalized();
        settled[f] = twice.norm() > limit * longest ? 1 : 0;
    }
    std::priority_queue<Offer> offers;
    const auto offer_around = [&](std::size_t f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = neighbours[f][e];
            if (g >= 0 && settled[static_cast<std::size_t>(g)] == 0) {
                offers.push(
                    {edge_length_mm(soup, soup.faces[f], e), g, static_cast<std::int32_t>(f)});
            }
        }
    };
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        if (settled[f] != 0) {
            offer_around(f);
        }
    }
    while (!offers.empty()) {
        const Offer offer = offers.top();
        offers.pop();
        const auto f = static_cast<std::size_t>(offer.face);
        if (settled[f] == 0) {
            settled[f] = 1;
            normals[f] = normals[static_cast<std::size_t>(offer.giver)];
            offer_around(f);
        }
    }
    return normals;
}

std::vector<std::array<std::uint8_t, 3>> feature_edges(
    const TriangleSoup& soup, const std::vector<Eigen::Vector3d>& normals,
    const std::vector<std::array<std::int32_t, 3>>& neighbours) {
    const double limit = std::cos(kFeatureAngleRad);
    std::vector<std::array<std::uint8_t, 3>> flags(normals.size(), {0, 0, 0});
    for (std::size_t f = 0; f < normals.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = neighbours[f][e];
            if (g >= 0 && normals[f].dot(normals[static_cast<std::size_t>(g)]) <= limit) {
                flags[f][e] = 1;
            }
        }
    }
    drop_specks(soup, neighbours, flags);
    drop_folds(soup.faces, neighbours, flags);
    return flags;
}

}  // namespace meshwind
