#include "mesh/even/long_facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/index.h"
#include "core/interrupt.h"
#include "mesh/even/ruled_shape.h"
#include "mesh/even/work_mesh.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Vertex = WorkMesh::Vertex;
using Edge = WorkMesh::Edge;
using Face = WorkMesh::Face;
using Halfedge = WorkMesh::Halfedge;

// A facet is long from so many times its height.
constexpr double kLong = 3.0;

// Facets hang together over the edges that are this share of their longest: along rulings.
constexpr double kAlong = 0.5;

// Fewer facets than this tell no shape.
constexpr std::size_t kFewFacets = 4;

// What vertices may be off their cylinder: by more than the facets themselves are off it, they do
// not lie on it; less than this share of its radius is rounding.
constexpr double kOfFacets = 1.1;
constexpr double kRounding = 1e-5;

// Wider facets than this share of the radius (34 degrees) are no round wall.
constexpr double kWidest = 0.6;

// Facets with a vertex that is off by more than this share of the worst are left out of a row, as
// long as so much of the row is left.
constexpr double kFarOff = 0.5;
constexpr double kLeastShare = 0.7;

// The middle of an edge is nearer to its shape than this share of the edge, so that halves are
// shorter than the whole; beside the tip of a cone it may not be.
constexpr double kNearShare = 0.25;

// A crease is straight where its middle is off the shapes beside it by less than this share of it.
constexpr double kStraight = 1e-5;

// The longest edges lose at least a quarter of their length in every round: enough for facets of
// 10,000 edges.
constexpr int kMostRounds = 40;

// Halves are no more than this, nor than so many for each of the part's triangles: a pipe 100 times
// as long as wide takes 150 for each. More come of facets with hardly an area.
constexpr double kMostHalves = 300000.0;
constexpr double kMostHalvesEach = 200.0;
constexpr double kFewHalves = 20000.0;

// Triangles turned afterwards stay within 20 degrees.
constexpr double kTurnCosine = 0.94;

struct Facet {
    RuledFacet seen;
    double longest_mm = 0.0;
    double height_mm = 0.0;  // over the longest edge
};

Facet facet_of(const WorkMesh& work, Face face) {
    std::array<Vector3d, 3> p;
    std::size_t i = 0;
    for (const Vertex v : work.mesh.fv_range(face)) {
        p[i++] = work.at(v);
    }
    const Vector3d area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]);
    Facet facet;
    facet.seen.area_mm2 = area.norm();
    facet.seen.normal = area.normalized();
    facet.seen.centre_mm = (p[0] + p[1] + p[2]) / 3.0;
    facet.longest_mm = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    facet.height_mm = 2.0 * facet.seen.area_mm2 / facet.longest_mm;
    return facet;
}

class LongFacetHalver {
public:
    LongFacetHalver(const LabelledMesh& part, const std::vector<char>& kept, double edge_mm,
                    const std::vector<WallShape>& exact)
        : work_(part, kept), edge_mm_(edge_mm), shapes_(exact), exact_(exact.size()) {}

    LongFacets run() {
        survey();
        group();
        const double most = std::clamp(kMostHalvesEach * static_cast<double>(facets_.size()),
                                       kFewHalves, kMostHalves);
        const bool wanted = halves() <= most;
        for (int round = 0; wanted && round < kMostRounds && halve_once(); ++round) {
            check_interrupt();
        }
        if (found_.halved > 0) {
            flip();
        }
        found_.part = work_.part();
        for (std::int32_t& shape : found_.part.shape) {
            shape = shape < static_cast<std::int32_t>(exact_) ? shape : -1;
        }
        found_.shapes = static_cast<int>(shapes_.size());
        return std::move(found_);
    }

private:
    void survey() {
        for (const Face face : work_.mesh.faces()) {
            facets_.push_back(work_.is_wall(face) ? facet_of(work_, face) : Facet{});
            if (work_.label(face).shape >= 0) {
                const WallShape& shape = shapes_[at(work_.label(face).shape)];
                for (const Vertex v : work_.mesh.fv_range(face)) {
                    found_.residual_mm =
                        std::max(found_.residual_mm, shape.distance_mm(work_.at(v)));
                }
            }
        }
    }

    [[nodiscard]] bool is_long(Face face) const {
        const Facet& facet = facets_[at(face.idx())];
        return work_.is_wall(face) && work_.label(face).shape < 0 && facet.seen.area_mm2 > 0.0 &&
               facet.longest_mm > edge_mm_ && facet.longest_mm > kLong * facet.height_mm;
    }

    // Long facets beside each other along their long edges, and the shape of each such row.
    void group() {
        std::vector<char> used(facets_.size(), 0);
        for (const Face seed : work_.mesh.faces()) {
            if (used[at(seed.idx())] != 0 || !is_long(seed)) {
                continue;
            }
            std::vector<Face> row{seed};
            used[at(seed.idx())] = 1;
            for (std::size_t i = 0; i < row.size(); ++i) {
                for (const Halfedge half : work_.mesh.fh_range(row[i])) {
                    const Edge edge = work_.mesh.edge_handle(half);
                    const Face other =
                        work_.mesh.face_handle(work_.mesh.opposite_halfedge_handle(half));
                    if (work_.is_line(edge) || !other.is_valid() || used[at(other.idx())] != 0 ||
                        !is_long(other) ||
                        work_.length(edge) < kAlong * facets_[at(row[i].idx())].longest_mm ||
                        work_.length(edge) < kAlong * facets_[at(other.idx())].longest_mm) {
                        continue;
                    }
                    used[at(other.idx())] = 1;
                    row.push_back(other);
                }
            }
            add_shape(row);
        }
    }

    // What a row's facets say together.
    struct RowFit {
        std::optional<RuledShape> shape;
        double most_off_mm = 0.0;  // what vertices of the shape may be off it
    };

    [[nodiscard]] RowFit fit_row(const std::vector<Face>& row) const {
        std::vector<RuledFacet> facets;
        std::vector<std::int32_t> vertices;
        double widest = 0.0;
        for (const Face face : row) {
            facets.push_back(facets_[at(face.idx())].seen);
            widest = std::max(widest, facets_[at(face.idx())].height_mm);
            for (const Vertex v : work_.mesh.fv_range(face)) {
                vertices.push_back(v.idx());
            }
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        std::vector<Vector3d> points;
        points.reserve(vertices.size());
        for (const std::int32_t v : vertices) {
            points.push_back(work_.at(Vertex(v)));
        }
        RowFit fit{fit_ruled_shape(points, facets), 0.0};
        if (fit.shape && widest <= kWidest * fit.shape->radius_mm) {
            const double sagitta = widest * widest / (8.0 * fit.shape->radius_mm);
            fit.most_off_mm = std::max(kOfFacets * sagitta, kRounding * fit.shape->radius_mm);
        } else {
            fit.shape.reset();
        }
        return fit;
    }

    // Facets that belong to something else are left out, a few at a time.
    void add_shape(std::vector<Face> row) {
        const std::size_t whole = row.size();
        while (row.size() >= kFewFacets &&
               static_cast<double>(row.size()) >= kLeastShare * static_cast<double>(whole)) {
            const RowFit fit = fit_row(row);
            if (!fit.shape) {
                return;
            }
            if (fit.shape->residual_mm <= fit.most_off_mm) {
                for (const Face face : row) {
                    work_.label(face).shape = static_cast<std::int32_t>(shapes_.size());
                }
                WallShape shape;
                shape.kind = WallShape::Kind::Ruled;
                shape.ruled = *fit.shape;
                shapes_.push_back(shape);
                found_.residual_mm = std::max(found_.residual_mm, fit.shape->residual_mm);
                return;
            }
            const double limit = std::max(fit.most_off_mm, kFarOff * fit.shape->residual_mm);
            row.erase(std::remove_if(row.begin(), row.end(),
                                     [&](Face face) {
                                         return std::any_of(
                                             work_.mesh.cfv_begin(face), work_.mesh.cfv_end(face),
                                             [&](Vertex v) {
                                                 return fit.shape->distance_mm(work_.at(v)) > limit;
                                             });
                                     }),
                      row.end());
        }
    }

    // Not of a ball: its facets are as long as high.
    [[nodiscard]] std::int32_t shape_of(Edge edge) const {
        for (const unsigned side : {0U, 1U}) {
            const Face face = work_.mesh.face_handle(work_.mesh.halfedge_handle(edge, side));
            if (work_.is_wall(face) && work_.label(face).shape >= 0 &&
                shapes_[at(work_.label(face).shape)].kind != WallShape::Kind::Ball) {
                return work_.label(face).shape;
            }
        }
        return -1;
    }

    // Straight creases are halved too: a facet beside one has no other long edge.
    [[nodiscard]] bool may_halve(Edge edge) const {
        if (shape_of(edge) < 0) {
            return false;
        }
        if (!work_.is_line(edge)) {
            return true;
        }
        const Vector3d middle = middle_of(edge);
        for (const unsigned side : {0U, 1U}) {
            const Face face = work_.mesh.face_handle(work_.mesh.halfedge_handle(edge, side));
            if (!work_.is_wall(face) || work_.label(face).shape < 0 ||
                shapes_[at(work_.label(face).shape)].distance_mm(middle) >
                    kStraight * work_.length(edge)) {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] Vector3d middle_of(Edge edge) const {
        const Halfedge half = work_.mesh.halfedge_handle(edge, 0);
        return 0.5 * (work_.at(work_.mesh.from_vertex_handle(half)) +
                      work_.at(work_.mesh.to_vertex_handle(half)));
    }

    // How many pieces the long edges come to, about.
    [[nodiscard]] double halves() const {
        double count = 0.0;
        for (const Edge edge : work_.mesh.edges()) {
            if (!work_.is_line(edge) && shape_of(edge) >= 0) {
                count += work_.length(edge) / edge_mm_;
            }
        }
        return count;
    }

    // The longest edges first, each once.
    bool halve_once() {
        struct Entry {
            double length;
            std::int32_t edge;
        };
        std::vector<Entry> entries;
        for (const Edge edge : work_.mesh.edges()) {
            const double length = work_.length(edge);
            if (length > edge_mm_ && may_halve(edge)) {
                entries.push_back({length, edge.idx()});
            }
        }
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            return a.length != b.length ? a.length > b.length : a.edge < b.edge;
        });
        // Those much shorter than the longest wait for the next round.
        constexpr double kThisRound = 0.7;
        for (const Entry& entry : entries) {
            if (entry.length < kThisRound * entries.front().length) {
                break;
            }
            const Edge edge(entry.edge);
            const Vector3d chord = middle_of(edge);
            const Vector3d foot = shapes_[at(shape_of(edge))].nearest(chord);
            const bool near =
                !work_.is_line(edge) && (foot - chord).norm() <= kNearShare * entry.length;
            work_.split(edge, near ? foot : chord);
            ++found_.halved;
        }
        return !entries.empty();
    }

    void flip() {
        constexpr int kRounds = 4;
        for (int round = 0; round < kRounds; ++round) {
            for (const Edge edge : work_.mesh.edges()) {
                if (work_.mesh.is_boundary(edge) || work_.is_line(edge) || shape_of(edge) < 0) {
                    continue;
                }
                const auto [before, after] = work_.angles(edge);
                if (after < before && work_.may_flip(edge, kTurnCosine)) {
                    work_.flip(edge);
                }
            }
        }
    }

    WorkMesh work_;
    double edge_mm_;
    std::vector<Facet> facets_;  // per face of the part
    std::vector<WallShape> shapes_;
    std::size_t exact_;  // of them, the first
    LongFacets found_;
};

}  // namespace

LongFacets halve_long_facets(const LabelledMesh& part, const std::vector<char>& kept,
                             double edge_mm, const std::vector<WallShape>& exact) {
    return LongFacetHalver(part, kept, edge_mm, exact).run();
}

}  // namespace meshwind
