#include "mesh/segment/segment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <queue>
#include <string_view>
#include <tuple>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "mesh/edge_table.h"
#include "mesh/segment/end_caps.h"
#include "mesh/segment/feature_edges.h"
#include "mesh/segment/flat_ends.h"
#include "mesh/visibility.h"

namespace meshwind {
namespace {

constexpr double kSamples = 4000.0;      // over the whole part, shared out by area
constexpr double kSamplesPerRegion = 4;  // at least: small regions decide nothing alone

// A point sees the outside when most directions escape. The wall of a long bore never does: even at
// its very mouth half of the directions meet the opposite wall.
constexpr double kMostDirections = 0.5;

constexpr double kBlindShare = 0.05;  // of its area, from which a blind region may see

// A region of which at least this share sees the outside and this share sees nothing is wall and
// bore in one. So many of its faces are asked, evenly among them.
constexpr double kBothSidesShare = 0.1;
constexpr std::size_t kSidesAsked = 4000;

// Wall and bore meet along a few circles: a longer border than so many times the root of the part's
// area parts what only seems to see, for the coordinates have too few digits.
constexpr double kLongestBorder = 6.0;

// A blind region smaller than this share of the part may be a nook of the wall.
constexpr double kBoreAreaShare = 0.01;

// Regions are bounded by feature edges; each flat end is one with all that stands on it.
std::vector<std::int32_t> label_faces(const Segmentation& s,
                                      const std::vector<std::int32_t>& flat_end) {
    return patches_of(s.neighbours, [&](std::size_t f, std::size_t e) {
        return flat_end[f] != flat_end[at(s.neighbours[f][e])] ||
               (flat_end[f] < 0 && s.feature[f][e] != 0);
    });
}

// Renumbers labels by area, largest first; equal areas keep the order of their first face.
void sort_labels(std::vector<std::int32_t>& label, const std::vector<double>& face_area) {
    const std::int32_t count = *std::max_element(label.begin(), label.end()) + 1;
    std::vector<double> area(at(count), 0.0);
    for (std::size_t f = 0; f < label.size(); ++f) {
        area[at(label[f])] += face_area[f];
    }
    std::vector<std::int32_t> order(area.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::int32_t a, std::int32_t b) { return area[at(a)] > area[at(b)]; });
    std::vector<std::int32_t> rank(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        rank[at(order[i])] = static_cast<std::int32_t>(i);
    }
    for (std::int32_t& l : label) {
        l = rank[at(l)];
    }
}

struct Sample {
    std::int32_t face = 0;
    std::int32_t region = 0;
    Eigen::Vector3d bary;
};

// Evenly over the region's area, in face order; inside a face by an additive (plastic-number)
// sequence.
std::vector<Sample> samples_of(const std::vector<RegionFacts>& facts,
                               const std::vector<double>& face_area) {
    constexpr double kStep[2] = {0.7548776662466927, 0.5698402909980532};
    const double total = std::accumulate(face_area.begin(), face_area.end(), 0.0);
    std::vector<Sample> samples;
    for (std::size_t id = 0; id < facts.size(); ++id) {
        const RegionFacts& r = facts[id];
        const double count = std::max(kSamplesPerRegion, std::round(kSamples * r.area_mm2 / total));
        double before = 0.0;
        double next = 0.5;
        for (const std::int32_t f : r.faces) {
            before += face_area[at(f)] * count / r.area_mm2;
            for (; next < before; next += 1.0) {
                const double u = std::sqrt(std::fmod(next * kStep[0], 1.0));
                const double v = std::fmod(next * kStep[1], 1.0);
                samples.push_back(
                    {f, static_cast<std::int32_t>(id), {1.0 - u, u * (1.0 - v), u * v}});
            }
        }
    }
    return samples;
}

void look_around(const TriangleSoup& soup, const std::vector<Eigen::Vector3d>& normals,
                 const std::vector<RegionFacts>& facts, const std::vector<double>& face_area,
                 const Visibility& visibility, std::vector<Region>& regions) {
    const std::vector<Sample> samples = samples_of(facts, face_area);
    std::vector<char> sees(samples.size(), 0);
    parallel_for(samples.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto& [a, b, c] = soup.faces[at(samples[i].face)];
            const Eigen::Vector3d point = samples[i].bary[0] * soup.points_mm[at(a)] +
                                          samples[i].bary[1] * soup.points_mm[at(b)] +
                                          samples[i].bary[2] * soup.points_mm[at(c)];
            sees[i] = static_cast<char>(
                visibility.escapes(point, normals[at(samples[i].face)], kMostDirections));
        }
    });
    std::vector<int> asked(regions.size(), 0);
    std::vector<int> seen(regions.size(), 0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ++asked[at(samples[i].region)];
        seen[at(samples[i].region)] += sees[i];
    }
    for (std::size_t id = 0; id < regions.size(); ++id) {
        regions[id].visible_fraction =
            asked[id] > 0 ? static_cast<double>(seen[id]) / asked[id] : 0;
    }
}

// Regions that hang together without crossing an end cap or a bore.
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

// Share of the piece's area that sees the outside.
double view_of(const std::vector<std::int32_t>& piece, const std::vector<Region>& regions) {
    double seen = 0.0;
    double area = 0.0;
    for (const std::int32_t id : piece) {
        seen += regions[at(id)].area_mm2 * regions[at(id)].visible_fraction;
        area += regions[at(id)].area_mm2;
    }
    return area > 0.0 ? seen / area : 0.0;
}

// Faces across the edges of the end caps, by whether they face away from the cap's middle, as a
// wall does, or toward it, as a bore.
struct Mouth {
    std::vector<std::int32_t> outer;
    std::vector<std::int32_t> inner;
};

Mouth mouth_of(const TriangleSoup& soup, const Segmentation& s, const RegionFacts& cap,
               const std::vector<Eigen::Vector3d>& normals) {
    Mouth mouth;
    for (const std::int32_t f : cap.faces) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = s.neighbours[at(f)][e];
            if (g < 0 || s.regions[at(s.region[at(g)])].kind != RegionKind::Other) {
                continue;
            }
            const Eigen::Vector3d middle =
                0.5 * (soup.points_mm[at(soup.faces[at(f)][e])] +
                       soup.points_mm[at(soup.faces[at(f)][(e + 1) % 3])]);
            // Seen along the cap's normal: a lip leans only a little, and tabs lift the middle.
            const Eigen::Vector3d along = cap.area_normal.normalized();
            const Eigen::Vector3d arm = middle - cap.box.center();
            const bool outward = normals[at(g)].dot(arm - along.dot(arm) * along) > 0.0;
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
Mouth sides_seen(const TriangleSoup& soup, const RegionFacts& region,
                 const std::vector<Eigen::Vector3d>& normals, const std::vector<double>& face_area,
                 const Visibility& visibility) {
    const std::size_t step = 1 + region.faces.size() / kSidesAsked;
    std::vector<char> side((region.faces.size() + step - 1) / step, 0);
    parallel_for(side.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t f = at(region.faces[i * step]);
            const auto& [a, b, c] = soup.faces[f];
            const Eigen::Vector3d centre =
                (soup.points_mm[at(a)] + soup.points_mm[at(b)] + soup.points_mm[at(c)]) / 3.0;
            if (visibility.escapes(centre, normals[f], kMostDirections)) {
                side[i] = 1;
            } else if (!visibility.escapes(centre, normals[f], kBlindShare)) {
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
        all += face_area[at(f)];
        if (side[i] == 1) {
            outer += face_area[at(f)];
            mouth.outer.push_back(f);
        } else if (side[i] == 2) {
            inner += face_area[at(f)];
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

// Where an end face is notched or its lip rounded, wall and bore run into each other: such pieces
// touch one end cap from both sides, or a region of theirs sees the outside here and nothing there.
// They are parted halfway between the two. Returns per face 1 where it is on the bore's side; empty
// when nothing runs together.
std::vector<char> bore_sides(const TriangleSoup& soup, const Segmentation& s,
                             const std::vector<RegionFacts>& facts,
                             const std::vector<Eigen::Vector3d>& normals,
                             const std::vector<double>& face_area, const Visibility& visibility) {
    constexpr std::size_t kFew = 8;  // of the faces around a cap, one in so many may be misjudged
    std::vector<std::int32_t> piece_of_region(s.regions.size(), -1);
    const auto pieces = pieces_of(s.regions, facts);
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        for (const std::int32_t id : pieces[p]) {
            piece_of_region[at(id)] = static_cast<std::int32_t>(p);
        }
    }
    const auto piece_of = [&](std::int32_t f) { return piece_of_region[at(s.region[at(f)])]; };
    Mouth all;
    std::vector<char> joined(pieces.size(), 0);
    for (std::size_t id = 0; id < facts.size(); ++id) {
        if (s.regions[id].kind != RegionKind::EndCap) {
            continue;
        }
        const Mouth mouth = mouth_of(soup, s, facts[id], normals);
        std::map<std::int32_t, std::array<std::size_t, 2>> counts;
        for (const std::int32_t f : mouth.outer) {
            ++counts[piece_of(f)][0];
        }
        for (const std::int32_t f : mouth.inner) {
            ++counts[piece_of(f)][1];
        }
        const std::size_t few = (mouth.outer.size() + mouth.inner.size()) / kFew;
        for (const auto& [piece, count] : counts) {
            joined[at(piece)] |= static_cast<char>(std::min(count[0], count[1]) > few);
        }
        all.outer.insert(all.outer.end(), mouth.outer.begin(), mouth.outer.end());
        all.inner.insert(all.inner.end(), mouth.inner.begin(), mouth.inner.end());
    }
    bool by_sight = false;
    for (const Region& region : s.regions) {
        if (region.kind == RegionKind::Other && region.visible_fraction > kBothSidesShare &&
            region.visible_fraction < 1.0 - kBothSidesShare) {
            const Mouth mouth =
                sides_seen(soup, facts[at(region.id)], normals, face_area, visibility);
            if (!mouth.inner.empty()) {
                by_sight = true;
                joined[at(piece_of_region[at(region.id)])] = 1;
                all.outer.insert(all.outer.end(), mouth.outer.begin(), mouth.outer.end());
                all.inner.insert(all.inner.end(), mouth.inner.begin(), mouth.inner.end());
            }
        }
    }
    if (std::count(joined.begin(), joined.end(), 1) == 0) {
        return {};
    }
    std::vector<char> side = spread(soup, s, piece_of_region, all);
    for (std::size_t f = 0; f < side.size(); ++f) {
        const std::int32_t piece = piece_of(static_cast<std::int32_t>(f));
        side[f] = static_cast<char>(piece >= 0 && joined[at(piece)] != 0 && side[f] == 2);
    }
    const double total_mm2 = std::accumulate(face_area.begin(), face_area.end(), 0.0);
    if (by_sight && border_mm(soup, s, side) > kLongestBorder * std::sqrt(total_mm2)) {
        return {};
    }
    return side;
}

// Per region 1 where it lies in the hole of an end cap, plus 2 where it lies on the outline of one.
// A piece in holes only is the wall of a bore, however short and well lit.
std::vector<char> sides_of_caps(const std::vector<Region>& regions,
                                const std::vector<RegionFacts>& facts) {
    std::vector<char> hole(regions.size(), 0);
    for (const Region& r : regions) {
        for (const std::int32_t id : r.kind == RegionKind::EndCap ? facts[at(r.id)].in_holes
                                                                  : std::vector<std::int32_t>{}) {
            hole[at(id)] |= 1;
        }
        for (const std::int32_t id : r.kind == RegionKind::EndCap ? facts[at(r.id)].beyond_outline
                                                                  : std::vector<std::int32_t>{}) {
            hole[at(id)] |= 2;
        }
    }
    return hole;
}

// Large regions that see nothing, and from them on every blind region they touch: the walls of
// holes that lead to the bore.
void mark_bores(Segmentation& s, const std::vector<RegionFacts>& facts, double total_mm2) {
    const auto blind = [&](const Region& r) {
        return r.kind == RegionKind::Other && r.visible_fraction <= kBlindShare;
    };
    std::vector<std::int32_t> bores;
    for (Region& r : s.regions) {
        if (blind(r) && r.area_mm2 >= kBoreAreaShare * total_mm2) {
            r.kind = RegionKind::Bore;
            bores.push_back(r.id);
        }
    }
    for (std::size_t i = 0; i < bores.size(); ++i) {
        for (const std::int32_t other : facts[at(bores[i])].beside) {
            if (blind(s.regions[at(other)])) {
                s.regions[at(other)].kind = RegionKind::Bore;
                bores.push_back(other);
            }
        }
    }
}

void classify(Segmentation& s, const std::vector<RegionFacts>& facts) {
    const std::vector<char> mouths = sides_of_caps(s.regions, facts);
    for (const auto& piece : pieces_of(s.regions, facts)) {
        int touched = 0;
        for (const std::int32_t id : piece) {
            touched |= mouths[at(id)];
        }
        if (touched == 1) {
            for (const std::int32_t id : piece) {
                s.regions[at(id)].kind = RegionKind::Bore;
            }
            continue;
        }
        const bool blind = view_of(piece, s.regions) < kMostDirections;
        for (const std::int32_t id : piece) {
            Region& r = s.regions[at(id)];
            if (blind && r.visible_fraction < kMostDirections) {
                r.kind = RegionKind::Bore;
            }
        }
    }
    // What is left and hangs on a bore alone belongs to it.
    double widest = 0.0;
    const auto pieces = pieces_of(s.regions, facts);
    std::vector<double> seen;
    for (const auto& piece : pieces) {
        double area = 0.0;
        for (const std::int32_t id : piece) {
            area += s.regions[at(id)].area_mm2 * s.regions[at(id)].visible_fraction;
        }
        seen.push_back(area);
        widest = std::max(widest, area);
    }
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const bool by_bore = std::any_of(pieces[p].begin(), pieces[p].end(), [&](std::int32_t id) {
            return std::any_of(
                facts[at(id)].beside.begin(), facts[at(id)].beside.end(),
                [&](std::int32_t other) { return s.regions[at(other)].kind == RegionKind::Bore; });
        });
        const bool wall = seen[p] == widest || (!by_bore && seen[p] > 0.0);
        for (const std::int32_t id : pieces[p]) {
            s.regions[at(id)].kind = wall ? RegionKind::OuterWall : RegionKind::Bore;
        }
    }
    for (Region& r : s.regions) {
        r.kept = r.kind == RegionKind::OuterWall;
    }
}

void make_regions(Segmentation& s, const std::vector<RegionFacts>& facts) {
    s.regions.clear();
    for (std::size_t id = 0; id < facts.size(); ++id) {
        s.regions.push_back({.id = static_cast<std::int32_t>(id),
                             .triangles = static_cast<int>(facts[id].faces.size()),
                             .area_mm2 = facts[id].area_mm2});
    }
}

// Gives the bore's side of each region a label of its own.
void part_regions(std::vector<std::int32_t>& region, const std::vector<char>& bore_side) {
    std::int32_t next = *std::max_element(region.begin(), region.end()) + 1;
    std::map<std::int32_t, std::int32_t> parted;
    for (std::size_t f = 0; f < region.size(); ++f) {
        if (bore_side[f] != 0) {
            const auto [entry, is_new] = parted.try_emplace(region[f], next);
            next += is_new ? 1 : 0;
            region[f] = entry->second;
        }
    }
}

std::vector<double> face_areas(const TriangleSoup& soup) {
    std::vector<double> areas(soup.faces.size());
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        const auto& [a, b, c] = soup.faces[f];
        areas[f] = 0.5 * (soup.points_mm[at(b)] - soup.points_mm[at(a)])
                             .cross(soup.points_mm[at(c)] - soup.points_mm[at(a)])
                             .norm();
    }
    return areas;
}

}  // namespace

Segmentation segment(const TriangleSoup& soup) {
    Segmentation s;
    s.neighbours = face_neighbours(soup.faces);
    const std::vector<Eigen::Vector3d> normals = steady_normals(soup, s.neighbours);
    const std::vector<double> face_area = face_areas(soup);
    const double total_mm2 = std::accumulate(face_area.begin(), face_area.end(), 0.0);
    const Visibility visibility(soup);
    std::vector<RegionFacts> facts;
    const auto survey = [&] {
        sort_labels(s.region, face_area);
        facts = region_facts(soup, s, normals, face_area);
        make_regions(s, facts);
        look_around(soup, normals, facts, face_area, visibility, s.regions);
    };
    s.feature = feature_edges(soup, normals, s.neighbours);
    const std::vector<std::int32_t> flat_end = flat_ends(soup, s.neighbours, normals, face_area);
    s.region = label_faces(s, flat_end);
    survey();
    mark_end_caps(soup, flat_end, s, facts);
    mark_bores(s, facts, total_mm2);
    const std::vector<char> bore_side = bore_sides(soup, s, facts, normals, face_area, visibility);
    if (!bore_side.empty()) {
        std::vector<RegionKind> kind(soup.faces.size());
        for (std::size_t f = 0; f < kind.size(); ++f) {
            kind[f] = bore_side[f] != 0 ? RegionKind::Bore : s.regions[at(s.region[f])].kind;
        }
        part_regions(s.region, bore_side);
        survey();
        for (std::size_t f = 0; f < kind.size(); ++f) {
            s.regions[at(s.region[f])].kind = kind[f];
        }
        for (const Region& r : s.regions) {
            if (r.kind == RegionKind::EndCap) {
                trace_outline(soup, s, r.id, facts[at(r.id)]);
            }
        }
        mark_bores(s, facts, total_mm2);
    }
    classify(s, facts);
    s.angular_ends = angular_ends(soup, s, std::move(facts));
    return s;
}

}  // namespace meshwind
