#include "mesh/smooth/freeze.h"

#include <algorithm>
#include <numeric>

#include "mesh/edge_table.h"
#include "mesh/smooth/corner_fit.h"

namespace meshwind {
namespace {

using Index = std::int32_t;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

std::size_t corner_of_vertex(const Surface& surface, Index face, Index vertex) {
    const auto& v = surface.face[at(face)];
    return v[0] == vertex ? 0 : (v[1] == vertex ? 1 : 2);
}

// One corner index per smooth fan: faces around a vertex joined across edges that are no features.
void number_corners(Surface& surface, std::vector<Index>& corner_vertex) {
    surface.corner.assign(surface.face.size(), {-1, -1, -1});
    std::vector<std::pair<Index, std::size_t>> stack;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            if (surface.corner[f][c] >= 0) {
                continue;
            }
            const Index vertex = surface.face[f][c];
            const Index id = static_cast<Index>(corner_vertex.size());
            corner_vertex.push_back(vertex);
            stack.assign(1, {static_cast<Index>(f), c});
            while (!stack.empty()) {
                const auto [g, k] = stack.back();
                stack.pop_back();
                if (surface.corner[at(g)][k] >= 0) {
                    continue;
                }
                surface.corner[at(g)][k] = id;
                for (const std::size_t e : {k, (k + 2) % 3}) {  // the two edges at this corner
                    const Index next = surface.neighbour[at(g)][e];
                    if (next != kNoFace && surface.feature[at(g)][e] == 0) {
                        stack.emplace_back(next, corner_of_vertex(surface, next, vertex));
                    }
                }
            }
        }
    }
}

void fit_all(Surface& surface, std::size_t corners) {
    std::vector<Index> all(corners);
    std::iota(all.begin(), all.end(), 0);
    const std::vector<Jet> jets = fit_corners(surface, all, kFitRings);
    surface.normal.resize(corners);
    surface.shape_operator_per_mm.resize(corners);
    surface.jet.resize(corners);
    surface.walk_corner.resize(corners);
    surface.exact.assign(corners, 0);
    for (std::size_t i = 0; i < corners; ++i) {
        set_jet(surface, i, jets[i]);
    }
    const auto count = [&](JetTerms kind) {
        return static_cast<int>(std::count_if(
            jets.begin(), jets.end(), [kind](const Jet& jet) { return jet.terms == kind; }));
    };
    surface.fit = {count(JetTerms::Quartic), count(JetTerms::Cubic), count(JetTerms::Quadratic),
                   count(JetTerms::Reduced), count(JetTerms::Averaged)};
}

void pack_for_walks(Surface& surface, std::span<const Index> corner_vertex) {
    surface.walk_face.resize(surface.face.size());
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        WalkFace& packed = surface.walk_face[f];
        packed.corner = surface.corner[f];
        packed.feature = surface.feature[f];
        for (std::size_t e = 0; e < 3; ++e) {
            const Index next = surface.neighbour[f][e];
            const Index start = surface.face[f][(e + 1) % 3];  // of the edge as `next` runs it
            packed.across[e] =
                next == kNoFace
                    ? kNoFace
                    : 4 * next + static_cast<Index>(corner_of_vertex(surface, next, start));
        }
    }
    for (std::size_t i = 0; i < corner_vertex.size(); ++i) {
        surface.walk_corner[i].position_mm = surface.position_mm[at(corner_vertex[i])];
    }
}

double mean_edge(const Surface& surface) {
    double sum = 0.0;
    for (const auto& v : surface.face) {
        for (std::size_t e = 0; e < 3; ++e) {
            sum += (surface.position_mm[at(v[(e + 1) % 3])] - surface.position_mm[at(v[e])]).norm();
        }
    }
    return surface.face.empty() ? 0.0 : sum / (3.0 * static_cast<double>(surface.face.size()));
}

}  // namespace

Surface freeze_surface(const TriangleSoup& soup, const FreezeInput& input) {
    Surface surface;
    surface.position_mm = soup.points_mm;
    surface.face = soup.faces;
    surface.feature.assign(input.feature.begin(), input.feature.end());
    surface.region.assign(input.region.begin(), input.region.end());
    surface.rim.assign(input.rim.begin(), input.rim.end());
    surface.neighbour = face_neighbours(soup.faces);
    std::vector<Index> corner_vertex;
    number_corners(surface, corner_vertex);
    fit_all(surface, corner_vertex.size());
    pack_for_walks(surface, corner_vertex);
    surface.mean_edge_mm = mean_edge(surface);
    return surface;
}

void set_jet(Surface& surface, std::size_t corner, const Jet& jet) {
    surface.normal[corner] = jet.normal;
    surface.shape_operator_per_mm[corner] = jet.shape_operator_per_mm;
    surface.jet[corner] = jet.height;
    const Eigen::Matrix3d& s = jet.shape_operator_per_mm;
    WalkCorner& packed = surface.walk_corner[corner];
    packed.normal = jet.normal;
    packed.shape_operator_per_mm << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2);
}

}  // namespace meshwind
