#include "mesh/segment/bore_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "mesh/segment/face_outline.h"

namespace meshwind {
namespace {

// A region of which at least this share sees the outside and this share sees nothing is wall and
// bore in one. So many of its faces are asked, evenly among them.
constexpr double kBothSidesShare = 0.1;
constexpr std::size_t kSidesAsked = 4000;

// Wall and bore meet along a few circles: a longer border than so many times the root of the part's
// area parts what only seems to see, for the coordinates have too few digits.
constexpr double kLongestBorder = 6.0;

// Faces across the edges of the end caps, by whether they face away from the cap's middle, as a
// wall does, or toward it, as a bore.
struct Mouth {
    std::vector<std::int32_t> outer;
    std::vector<std::int32_t> inner;
};

Mouth mouth_of(const MeasuredFaces& part, const Segmentation& s, const RegionFacts& cap) {
    Mouth mouth;
    for (const std::int32_t f : cap.faces) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = part.neighbours[at(f)][e];
            if (g < 0 || s.regions[at(s.region[at(g)])].kind != RegionKind::Other) {
                continue;
            }
            const Eigen::Vector3d middle =
                0.5 * (part.soup.points_mm[at(part.soup.faces[at(f)][e])] +
                       part.soup.points_mm[at(part.soup.faces[at(f)][(e + 1) % 3])]);
            // Seen along the cap's normal: a lip leans only a little, and tabs lift the middle.
            const Eigen::Vector3d along = cap.area_normal.normalized();
            const Eigen::Vector3d arm = middle - cap.box.center();
            const bool outward = part.normals[at(g)].dot(arm - along.dot(arm) * along) > 0.0;
            (outward ? mouth.outer : mouth.inner).push_back(g);
        }
    }
    return mouth;
}

// Spreads the sides of the mouths over their pieces, nearest first: 1 = outer, 2 = inner, 0 =
// neither.
std::vector<char> spread(const TriangleSoup& soup, const Segmentation& s,
                         const std::vector<std::int32_t>& piece_of_region, const Mouth& seeds) {
    const auto centre = [&](std::int32_t f) {
        const auto& [a, b, c] = soup.faces[at(f)];
        return Eigen::Vector3d(
            (soup.points_mm[at(a)] + soup.points_mm[at(b)] + soup.points_mm[at(c)]) / 3.0);
    };
    using Entry = std::tuple<double, std::int32_t, char>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<char> side(soup.faces.size(), 0);
    for (const std::int32_t f : seeds.outer) {
        queue.emplace(0.0, f, char{1});
    }
    for (const std::int32_t f : seeds.inner) {
        queue.emplace(0.0, f, char{2});
    }
    while (!queue.empty()) {
        const auto [distance, f, label] = queue.top();
        queue.pop();
        if (side[at(f)] != 0) {
            continue;
        }
        side[at(f)] = label;
        for (const std::int32_t g : s.neighbours[at(f)]) {
            if (g >= 0 && side[at(g)] == 0 &&
                piece_of_region[at(s.region[at(g)])] == piece_of_region[at(s.region[at(f)])]) {
                queue.emplace(distance + (centre(g) - centre(f)).norm(), g, label);
            }
        }
    }
    return side;
}

// Faces of a region that see the outside, and others that see nothing of it; neither where one of
// the two has no share in the region to speak of.
Mouth sides_seen(const MeasuredFaces& part, const RegionFacts& region,
                 const Visibility& visibility) {
    const std::size_t step = 1 + region.faces.size() / kSidesAsked;
    std::vector<char> side((region.faces.size() + step - 1) / step, 0);
    parallel_for(side.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t f = at(region.faces[i * step]);
            const auto& [a, b, c] = part.soup.faces[f];
            const Eigen::Vector3d centre =
                (part.soup.points_mm[at(a)] + part.soup.points_mm[at(b)] +
                 part.soup.points_mm[at(c)]) /
                3.0;
            if (visibility.escapes(centre, part.normals[f], kMaxDirections)) {
                side[i] = 1;
            } else if (!visibility.escapes(centre, part.normals[f], kBlindShare)) {
                side[i] = 2;
            }
        }
    });
    Mouth mouth;
    double all = 0.0;
    double outer = 0.0;
    double inner = 0.0;
    for (std::size_t i = 0; i < side.size(); ++i) {
        const std::int32_t f = region.faces[i * step];
        all += part.area_mm2[at(f)];
        if (side[i] == 1) {
            outer += part.area_mm2[at(f)];
            mouth.outer.push_back(f);
        } else if (side[i] == 2) {
            inner += part.area_mm2[at(f)];
            mouth.inner.push_back(f);
        }
    }
    return std::min(outer, inner) >= kBothSidesShare * all ? mouth : Mouth{};
}

// Length of the edges between both sides.
double border_mm(const TriangleSoup& soup, const Segmentation& s, const std::vector<char>& side) {
    double twice = 0.0;
    for (std::size_t f = 0; f < side.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = s.neighbours[f][e];
            if (g >= 0 && side[at(g)] != side[f]) {
                twice += (soup.points_mm[at(soup.faces[f][(e + 1) % 3])] -
                          soup.points_mm[at(soup.faces[f][e])])
                             .norm();
            }
        }
    }
    return 0.5 * twice;
}

// Pieces in which wall and bore run together.
struct JoinedPieces {
    std::vector<std::int32_t> of_region;  // per region its piece, -1: none
    std::vector<char> joined;             // per piece
    Mouth seeds;                          // faces of both sides, of all of them
    bool by_sight = false;                // whether what sees the outside told one of them
};

void add_seeds(const Mouth& mouth, JoinedPieces& pieces) {
    Mouth& all = pieces.seeds;
    all.outer.insert(all.outer.end(), mouth.outer.begin(), mouth.outer.end());
    all.inner.insert(all.inner.end(), mouth.inner.begin(), mouth.inner.end());
}

// None of them is joined yet.
JoinedPieces pieces_apart(const Segmentation& s, const std::vector<RegionFacts>& facts) {
    const auto pieces = pieces_of(s.regions, facts);
    JoinedPieces result;
    result.of_region.assign(s.regions.size(), -1);
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        for (const std::int32_t id : pieces[p]) {
            result.of_region[at(id)] = static_cast<std::int32_t>(p);
        }
    }
    result.joined.assign(pieces.size(), 0);
    return result;
}

// Pieces that touch one end cap from both sides.
void join_at_caps(const MeasuredFaces& part, const Segmentation& s,
                  const std::vector<RegionFacts>& facts, JoinedPieces& pieces) {
    constexpr std::size_t kFew = 8;  // of the faces around a cap, one in so many may be misjudged
    const auto piece_of = [&](std::int32_t f) { return pieces.of_region[at(s.region[at(f)])]; };
    for (std::size_t id = 0; id < facts.size(); ++id) {
        if (s.regions[id].kind != RegionKind::EndCap) {
            continue;
        }
        const Mouth mouth = mouth_of(part, s, facts[id]);
        std::map<std::int32_t, std::array<std::size_t, 2>> counts;
        for (const std::int32_t f : mouth.outer) {
            ++counts[piece_of(f)][0];
        }
        for (const std::int32_t f : mouth.inner) {
            ++counts[piece_of(f)][1];
        }
        const std::size_t few = (mouth.outer.size() + mouth.inner.size()) / kFew;
        for (const auto& [piece, count] : counts) {
            pieces.joined[at(piece)] |= static_cast<char>(std::min(count[0], count[1]) > few);
        }
        add_seeds(mouth, pieces);
    }
}

// Pieces of which a region sees the outside here and nothing there.
void join_by_sight(const MeasuredFaces& part, const Segmentation& s,
                   const std::vector<RegionFacts>& facts, const Visibility& visibility,
                   JoinedPieces& pieces) {
    for (const Region& region : s.regions) {
        if (region.kind == RegionKind::Other && region.visible_fraction > kBothSidesShare &&
            region.visible_fraction < 1.0 - kBothSidesShare) {
            const Mouth mouth = sides_seen(part, facts[at(region.id)], visibility);
            if (!mouth.inner.empty()) {
                pieces.by_sight = true;
                pieces.joined[at(pieces.of_region[at(region.id)])] = 1;
                add_seeds(mouth, pieces);
            }
        }
    }
}

}  // namespace

std::vector<std::vector<std::int32_t>> pieces_of(const std::vector<Region>& regions,
                                                 const std::vector<RegionFacts>& facts) {
    const auto blocks = [&](std::int32_t id) {
        return regions[at(id)].kind == RegionKind::EndCap ||
               regions[at(id)].kind == RegionKind::Bore;
    };
    std::vector<char> reached(regions.size(), 0);
    std::vector<std::vector<std::int32_t>> pieces;
    for (std::int32_t seed = 0; seed < static_cast<std::int32_t>(regions.size()); ++seed) {
        if (blocks(seed) || reached[at(seed)] != 0) {
            continue;
        }
        std::vector<std::int32_t> piece{seed};
        reached[at(seed)] = 1;
        for (std::size_t i = 0; i < piece.size(); ++i) {
            for (const std::int32_t other : facts[at(piece[i])].beside) {
                if (!blocks(other) && reached[at(other)] == 0) {
                    reached[at(other)] = 1;
                    piece.push_back(other);
                }
            }
        }
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

std::vector<char> bore_sides(const TriangleSoup& soup, const Segmentation& s,
                             const std::vector<RegionFacts>& facts,
                             const std::vector<Eigen::Vector3d>& normals,
                             const std::vector<double>& face_area, const Visibility& visibility) {
    JoinedPieces pieces = pieces_apart(s, facts);
    const MeasuredFaces part{soup, s.neighbours, normals, face_area};
    join_at_caps(part, s, facts, pieces);
    join_by_sight(part, s, facts, visibility, pieces);
    if (std::count(pieces.joined.begin(), pieces.joined.end(), 1) == 0) {
        return {};
    }
    std::vector<char> side = spread(soup, s, pieces.of_region, pieces.seeds);
    for (std::size_t f = 0; f < side.size(); ++f) {
        const std::int32_t piece = pieces.of_region[at(s.region[f])];
        side[f] = static_cast<char>(piece >= 0 && pieces.joined[at(piece)] != 0 && side[f] == 2);
    }
    const double total_mm2 = std::accumulate(face_area.begin(), face_area.end(), 0.0);
    if (pieces.by_sight && border_mm(soup, s, side) > kLongestBorder * std::sqrt(total_mm2)) {
        return {};
    }
    return side;
}

}  // namespace meshwind
