#include "mesh/surface.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "mesh/edge_table.h"
#include "mesh/jet_fit.h"

namespace meshwind {
namespace {

using Index = std::int32_t;

constexpr int kRings = 2;            // of neighbours for a fit: 18 on a regular mesh
constexpr std::size_t kEnough = 16;  // fewer than this and one more ring is taken
constexpr double kMinFacing = 0.5;   // cosine between the normals of neighbours in one fit (60 deg)
constexpr double kMinFollowing = 0.95;  // cosine between a fit's normal and the facets' (18 deg)
constexpr std::size_t kFitChunk = 256;

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

std::vector<Eigen::Vector3d> angle_weighted_normals(const Surface& surface, std::size_t corners) {
    std::vector<Eigen::Vector3d> normals(corners, Eigen::Vector3d::Zero());
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const auto& v = surface.face[f];
        const Eigen::Vector3d ab = surface.position_mm[at(v[1])] - surface.position_mm[at(v[0])];
        const Eigen::Vector3d ac = surface.position_mm[at(v[2])] - surface.position_mm[at(v[0])];
        const Eigen::Vector3d facet = ab.cross(ac).normalized();
        for (std::size_t c = 0; c < 3; ++c) {
            const Eigen::Vector3d& p = surface.position_mm[at(v[c])];
            const Eigen::Vector3d u = surface.position_mm[at(v[(c + 1) % 3])] - p;
            const Eigen::Vector3d w = surface.position_mm[at(v[(c + 2) % 3])] - p;
            const double angle = std::atan2(u.cross(w).norm(), u.dot(w));
            normals[at(surface.corner[f][c])] += angle * facet;
        }
    }
    for (std::size_t i = 0; i < corners; ++i) {
        normals[i].normalize();
    }
    return normals;
}

// Compressed rows: row i holds the indices next to i.
struct Rows {
    std::vector<Index> begin;
    std::vector<Index> item;

    [[nodiscard]] std::span<const Index> operator[](Index i) const {
        const std::size_t first = at(begin[at(i)]);
        return {item.data() + first, at(begin[at(i) + 1]) - first};
    }
};

// For each corner index the corner indices it shares an edge with, all on its smooth side.
Rows one_rings(const Surface& surface, std::size_t corners) {
    std::vector<std::pair<Index, Index>> pairs;
    pairs.reserve(surface.face.size() * 6);
    for (const auto& c : surface.corner) {
        for (std::size_t e = 0; e < 3; ++e) {
            pairs.emplace_back(c[e], c[(e + 1) % 3]);
            pairs.emplace_back(c[(e + 1) % 3], c[e]);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    Rows rows;
    rows.begin.assign(corners + 1, 0);
    rows.item.reserve(pairs.size());
    for (const auto& [from, to] : pairs) {
        rows.item.push_back(to);
        ++rows.begin[at(from) + 1];
    }
    for (std::size_t i = 0; i < corners; ++i) {
        rows.begin[i + 1] += rows.begin[i];
    }
    return rows;
}

class CornerFitter {
public:
    CornerFitter(const Surface& surface, const Rows& rings, std::span<const Index> corner_vertex,
                 std::span<const Eigen::Vector3d> averaged)
        : surface_(surface), rings_(rings), corner_vertex_(corner_vertex), averaged_(averaged) {}

    Jet fit(Index corner) {
        const Eigen::Vector3d& centre = position(corner);
        const Eigen::Vector3d& guess = averaged_[at(corner)];
        gather(corner);
        collect(found_);
        for (int degree = kMaxJetDegree; degree >= 2; --degree) {
            const auto jet = fit_jet(centre, guess, points_, degree);
            if (jet && follows_facets(*jet, corner)) {
                return *jet;
            }
        }
        found_.assign(rings_[corner].begin(), rings_[corner].end());
        collect(found_);
        normals_.clear();
        for (const Index i : found_) {
            normals_.push_back(averaged_[at(i)]);
        }
        return jet_from_normals(centre, guess, points_, normals_);
    }

private:
    [[nodiscard]] const Eigen::Vector3d& position(Index corner) const {
        return surface_.position_mm[at(corner_vertex_[at(corner)])];
    }

    // The corners within `kRings` rings, nearest first; one ring more where they are few. What has
    // turned too far away is no height over the centre's plane.
    void gather(Index centre) {
        found_.assign(1, centre);
        std::size_t begin = 0;
        for (int ring = 0; ring < kRings || (ring == kRings && found_.size() <= kEnough); ++ring) {
            const std::size_t end = found_.size();
            for (std::size_t i = begin; i < end; ++i) {
                for (const Index next : rings_[found_[i]]) {
                    if (averaged_[at(next)].dot(averaged_[at(centre)]) > kMinFacing &&
                        std::find(found_.begin(), found_.end(), next) == found_.end()) {
                        found_.push_back(next);
                    }
                }
            }
            begin = end;
        }
        found_.erase(found_.begin());
    }

    // Whether the fit's normals next to the corner are those of the facets, roughly: a polynomial
    // that swings between its points is worse than one of a lower degree.
    [[nodiscard]] bool follows_facets(const Jet& jet, Index corner) const {
        const Eigen::Matrix3d& frame = jet.height.frame;
        const auto follows = [&](Index next) {
            const Eigen::Vector3d d = frame.transpose() * (position(next) - position(corner));
            const JetHeight h = height_at(jet.height, d.x(), d.y());
            const Eigen::Vector3d normal =
                frame * Eigen::Vector3d(-h.by_x, -h.by_y, 1.0).normalized();
            return normal.dot(averaged_[at(next)]) > kMinFollowing;
        };
        const auto ring = rings_[corner];
        return follows(corner) && std::all_of(ring.begin(), ring.end(), follows);
    }

    void collect(const std::vector<Index>& corners) {
        points_.clear();
        for (const Index i : corners) {
            points_.push_back(position(i));
        }
    }

    const Surface& surface_;
    const Rows& rings_;
    std::span<const Index> corner_vertex_;
    std::span<const Eigen::Vector3d> averaged_;
    std::vector<Index> found_;
    std::vector<Eigen::Vector3d> points_;
    std::vector<Eigen::Vector3d> normals_;
};

void fit_corners(Surface& surface, std::span<const Index> corner_vertex) {
    const std::size_t corners = corner_vertex.size();
    const std::vector<Eigen::Vector3d> averaged = angle_weighted_normals(surface, corners);
    const Rows rings = one_rings(surface, corners);
    surface.normal.resize(corners);
    surface.shape_operator_per_mm.resize(corners);
    surface.jet.resize(corners);
    std::vector<JetTerms> terms(corners);
    parallel_for(corners, kFitChunk, [&](std::size_t begin, std::size_t end) {
        CornerFitter fitter(surface, rings, corner_vertex, averaged);
        for (std::size_t i = begin; i < end; ++i) {
            const Jet jet = fitter.fit(static_cast<Index>(i));
            terms[i] = jet.terms;
            surface.normal[i] = jet.normal;
            surface.shape_operator_per_mm[i] = jet.shape_operator_per_mm;
            surface.jet[i] = jet.height;
        }
    });
    const auto count = [&](JetTerms kind) {
        return static_cast<int>(std::count(terms.begin(), terms.end(), kind));
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
    surface.walk_corner.resize(corner_vertex.size());
    for (std::size_t i = 0; i < corner_vertex.size(); ++i) {
        const Eigen::Matrix3d& s = surface.shape_operator_per_mm[i];
        WalkCorner& packed = surface.walk_corner[i];
        packed.position_mm = surface.position_mm[at(corner_vertex[i])];
        packed.normal = surface.normal[i];
        packed.shape_operator_per_mm << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2);
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
    fit_corners(surface, corner_vertex);
    pack_for_walks(surface, corner_vertex);
    surface.mean_edge_mm = mean_edge(surface);
    return surface;
}

}  // namespace meshwind
