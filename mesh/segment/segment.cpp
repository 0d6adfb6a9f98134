#include "mesh/segment/segment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string_view>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "mesh/edge_table.h"
#include "mesh/segment/bore_sides.h"
#include "mesh/segment/end_caps.h"
#include "mesh/segment/feature_edges.h"
#include "mesh/segment/flat_ends.h"
#include "mesh/visibility.h"

namespace meshwind {
namespace {

constexpr double kSamples = 4000.0;      // over the whole part, shared out by area
constexpr double kSamplesPerRegion = 4;  // at least: small regions decide nothing alone

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
                visibility.escapes(point, normals[at(samples[i].face)], kMaxDirections));
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
        const bool blind = view_of(piece, s.regions) < kMaxDirections;
        for (const std::int32_t id : piece) {
            Region& r = s.regions[at(id)];
            if (blind && r.visible_fraction < kMaxDirections) {
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
