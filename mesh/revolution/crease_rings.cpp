#include "mesh/revolution/crease_rings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Smaller kinks are as good as none: rounded over two edges they turn the fibre by a third of a
// degree at most, what a laid fibre may be off.
constexpr double kMinKink_rad = rad_from_deg(1.0);

// Vertices on a crease are beside it by what lines are beside their vertices, times this: lines
// that meet at a flat angle meet with as much more error. And by rounding of text files.
constexpr double kResidualTimes = 4.0;
constexpr double kRounding_mm = 1e-3;

// But by no more than this share of the distance of the next row, which is a height of triangles.
constexpr double kEdgeShare = 0.1;

// A circle of edges is closed where what it lacks of a turn is less: an edge is far more.
constexpr double kOpen_rad = 1e-3;

struct Edge {
    std::size_t face;
    std::size_t side;
};

double azimuth_between(const Vector3d& a, const Vector3d& b) {
    return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y()));
}

double kink_rad(const Meridian& meridian, double crease_mm) {
    const double before = meridian.at(std::nextafter(crease_mm, 0.0)).slope_rad;
    return std::abs(std::remainder(meridian.at(crease_mm).slope_rad - before, 2.0 * kPi));
}

}  // namespace

bool mark_crease_rings(const BodyOfRevolution& body, const TriangleSoup& soup,
                       std::span<std::array<std::uint8_t, 3>> feature) {
    const double within_mm = kResidualTimes * body.residual_mm + kRounding_mm;
    bool marked = false;
    for (const double crease_mm : body.meridian.creases_mm()) {
        if (kink_rad(body.meridian, crease_mm) < kMinKink_rad) {
            continue;
        }
        const MeridianPlace place = body.meridian.at(crease_mm);
        const auto off_mm = [&](const Vector3d& p) {
            return std::hypot(std::hypot(p.x(), p.y()) - place.radius_mm, p.z() - place.z_mm);
        };
        std::vector<Edge> ring;
        double turn_rad = 0.0;  // each edge is met from both faces
        for (std::size_t f = 0; f < soup.faces.size(); ++f) {
            for (std::size_t e = 0; e < 3; ++e) {
                const Vector3d& a = soup.points_mm[static_cast<std::size_t>(soup.faces[f][e])];
                const Vector3d& b =
                    soup.points_mm[static_cast<std::size_t>(soup.faces[f][(e + 1) % 3])];
                const double limit_mm = std::min(within_mm, kEdgeShare * (b - a).norm());
                if (off_mm(a) <= limit_mm && off_mm(b) <= limit_mm) {
                    ring.push_back({f, e});
                    turn_rad += azimuth_between(a, b);
                }
            }
        }
        if (std::abs(turn_rad - 4.0 * kPi) > 2.0 * kOpen_rad) {
            continue;
        }
        for (const auto& [face, side] : ring) {
            marked = marked || feature[face][side] == 0;
            feature[face][side] = 1;
        }
    }
    return marked;
}

}  // namespace meshwind
