#include "mesh/smooth/corner_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/parallel.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Index = std::int32_t;

constexpr std::size_t kEnough = 16;  // fewer than this and one more ring is taken
constexpr double kMinFacing = 0.5;   // cosine between the normals of neighbours in one fit (60 deg)
constexpr double kMinFollowing = 0.95;  // cosine between a fit's normal and the facets' (18 deg)
constexpr std::size_t kFitChunk = 256;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

// The vertex of each corner index.
std::vector<Index> corner_vertices(const Surface& surface) {
    std::vector<Index> vertex;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t corner = at(surface.corner[f][c]);
            vertex.resize(std::max(vertex.size(), corner + 1));
            vertex[corner] = surface.face[f][c];
        }
    }
    return vertex;
}

std::vector<Vector3d> angle_weighted_normals(const Surface& surface, std::size_t corners) {
    std::vector<Vector3d> normals(corners, Vector3d::Zero());
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const auto& v = surface.face[f];
        const Vector3d ab = surface.position_mm[at(v[1])] - surface.position_mm[at(v[0])];
        const Vector3d ac = surface.position_mm[at(v[2])] - surface.position_mm[at(v[0])];
        const Vector3d facet = ab.cross(ac).normalized();
        for (std::size_t c = 0; c < 3; ++c) {
            const Vector3d& p = surface.position_mm[at(v[c])];
            const Vector3d u = surface.position_mm[at(v[(c + 1) % 3])] - p;
            const Vector3d w = surface.position_mm[at(v[(c + 2) % 3])] - p;
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

// What all fits share.
struct Neighbourhoods {
    const Surface& surface;
    std::vector<Index> vertex;       // per corner index
    std::vector<Vector3d> averaged;  // facet normals, per corner index
    Rows next;
    int rings;

    [[nodiscard]] const Vector3d& position(Index corner) const {
        return surface.position_mm[at(vertex[at(corner)])];
    }
};

class CornerFitter {
public:
    explicit CornerFitter(const Neighbourhoods& shared) : shared_(shared) {}

    Jet fit(Index corner) {
        const Vector3d& centre = shared_.position(corner);
        const Vector3d& guess = shared_.averaged[at(corner)];
        gather(corner);
        collect();
        for (int degree = kMaxJetDegree; degree >= 2; --degree) {
            const auto jet = fit_jet(centre, guess, points_, degree);
            if (jet && follows_facets(*jet, corner)) {
                return *jet;
            }
        }
        const auto ring = shared_.next[corner];
        found_.assign(ring.begin(), ring.end());
        collect();
        normals_.clear();
        for (const Index i : found_) {
            normals_.push_back(shared_.averaged[at(i)]);
        }
        return jet_from_normals(centre, guess, points_, normals_);
    }

private:
    // The corners within the rings, nearest first; one ring more where they are few. What has
    // turned too far away is no height over the centre's plane.
    void gather(Index centre) {
        const auto& averaged = shared_.averaged;
        const int rings = shared_.rings;
        found_.assign(1, centre);
        std::size_t begin = 0;
        for (int ring = 0; ring < rings || (ring == rings && found_.size() <= kEnough); ++ring) {
            const std::size_t end = found_.size();
            for (std::size_t i = begin; i < end; ++i) {
                for (const Index next : shared_.next[found_[i]]) {
                    if (averaged[at(next)].dot(averaged[at(centre)]) > kMinFacing &&
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
            const Vector3d d =
                frame.transpose() * (shared_.position(next) - shared_.position(corner));
            const JetHeight h = height_at(jet.height, d.x(), d.y());
            const Vector3d normal = frame * Vector3d(-h.by_x, -h.by_y, 1.0).normalized();
            return normal.dot(shared_.averaged[at(next)]) > kMinFollowing;
        };
        const auto ring = shared_.next[corner];
        return follows(corner) && std::all_of(ring.begin(), ring.end(), follows);
    }

    void collect() {
        points_.clear();
        for (const Index i : found_) {
            points_.push_back(shared_.position(i));
        }
    }

    const Neighbourhoods& shared_;
    std::vector<Index> found_;
    std::vector<Vector3d> points_;
    std::vector<Vector3d> normals_;
};

}  // namespace

std::vector<Jet> fit_corners(const Surface& surface, std::span<const std::int32_t> wanted,
                             int rings) {
    std::vector<Index> vertex = corner_vertices(surface);
    const std::size_t corners = vertex.size();
    const Neighbourhoods shared{surface, std::move(vertex),
                                angle_weighted_normals(surface, corners),
                                one_rings(surface, corners), rings};
    std::vector<Jet> jets(wanted.size());
    parallel_for(wanted.size(), kFitChunk, [&](std::size_t begin, std::size_t end) {
        CornerFitter fitter(shared);
        for (std::size_t i = begin; i < end; ++i) {
            jets[i] = fitter.fit(wanted[i]);
        }
    });
    return jets;
}

}  // namespace meshwind
