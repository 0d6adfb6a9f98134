#include "mesh/feature_edges.h"

#include <cmath>
#include <queue>
#include <tuple>

#include <Eigen/Geometry>

namespace meshwind {
namespace {

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
    const std::vector<Eigen::Vector3d>& normals,
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
    return flags;
}

}  // namespace meshwind
