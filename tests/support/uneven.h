/// Meshes as CAD programs and other meshers leave them.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include "core/random.h"
#include "core/units.h"
#include "mesh/edge_table.h"
#include "mesh/triangle_soup.h"

namespace meshwind::test {

/// A closed cylinder about z with one row of facets from end to end and a fan on each end.
inline TriangleSoup one_row_cylinder(double radius_mm, double length_mm, int facets) {
    TriangleSoup soup;
    for (const double z : {-0.5 * length_mm, 0.5 * length_mm}) {
        for (int i = 0; i < facets; ++i) {
            const double phi = 2.0 * kPi * i / facets;
            soup.points_mm.emplace_back(radius_mm * std::cos(phi), radius_mm * std::sin(phi), z);
        }
    }
    const auto low = [&](int i) { return i % facets; };
    const auto high = [&](int i) { return facets + i % facets; };
    const int bottom = 2 * facets;
    const int top = bottom + 1;
    soup.points_mm.emplace_back(0.0, 0.0, -0.5 * length_mm);
    soup.points_mm.emplace_back(0.0, 0.0, 0.5 * length_mm);
    for (int i = 0; i < facets; ++i) {
        soup.faces.push_back({low(i), low(i + 1), high(i)});
        soup.faces.push_back({low(i + 1), high(i + 1), high(i)});
        soup.faces.push_back({low(i + 1), low(i), bottom});
        soup.faces.push_back({high(i), high(i + 1), top});
    }
    return soup;
}

/// Halves `count` edges at a small share of their length from one end: needles, whose new vertices
/// are off a smooth surface by that share of the sagitta.
inline TriangleSoup with_needles(TriangleSoup soup, int count, double share, std::uint64_t seed) {
    Draws draws(seed, 0);
    for (int i = 0; i < count; ++i) {
        const std::size_t f = draws.below(soup.faces.size());
        const auto neighbours = face_neighbours(soup.faces);
        const std::size_t e = draws.below(3);
        const std::int32_t g = neighbours[f][e];
        if (g < 0) {
            continue;
        }
        const std::int32_t a = soup.faces[f][e];
        const std::int32_t b = soup.faces[f][(e + 1) % 3];
        const std::int32_t c = soup.faces[f][(e + 2) % 3];
        const Eigen::Vector3d p = (1.0 - share) * soup.points_mm[static_cast<std::size_t>(a)] +
                                  share * soup.points_mm[static_cast<std::size_t>(b)];
        const auto m = static_cast<std::int32_t>(soup.points_mm.size());
        soup.points_mm.push_back(p);
        std::int32_t d = -1;
        for (const std::int32_t v : soup.faces[static_cast<std::size_t>(g)]) {
            d = v != a && v != b ? v : d;
        }
        soup.faces[f] = {a, m, c};
        soup.faces.push_back({m, b, c});
        soup.faces[static_cast<std::size_t>(g)] = {b, m, d};
        soup.faces.push_back({m, a, d});
    }
    return soup;
}

}  // namespace meshwind::test
