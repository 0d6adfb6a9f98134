#include "mesh/visibility.h"

#include <array>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind {
namespace {

constexpr int kEvery = -1;       // no number of rays is enough
constexpr int kDirections = 64;  // resolves a share of 2 %, half of them decide "most"

// Rays start this share of the diagonal off the surface: a hundred times Embree's single precision.
constexpr double kLiftShare = 1e-5;

// Cosine-weighted directions over +z on a golden-angle spiral.
std::array<Eigen::Vector3d, kDirections> make_directions() {
    std::array<Eigen::Vector3d, kDirections> directions;
    const double golden = kPi * (3.0 - std::sqrt(5.0));
    for (int i = 0; i < kDirections; ++i) {
        const double sine = std::sqrt((i + 0.5) / kDirections);
        directions[static_cast<std::size_t>(i)] = {
            sine * std::cos(golden * i), sine * std::sin(golden * i), std::sqrt(1.0 - sine * sine)};
    }
    return directions;
}

}  // namespace

Visibility::Visibility(const TriangleSoup& soup)
    : rays_(std::span<const TriangleSoup>(&soup, 1)), diagonal_mm_(diagonal_mm(soup)) {}

// Rays that escape. With `enough` of them, or once there cannot be so many, the rest is not asked.
int Visibility::escaped(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                        int enough) const {
    static const std::array<Eigen::Vector3d, kDirections> kRays = make_directions();
    const Eigen::Vector3d side = normal.unitOrthogonal();
    const Eigen::Vector3d up = normal.cross(side);
    const Eigen::Vector3d start = point + kLiftShare * diagonal_mm_ * normal;
    int count = 0;
    int left = kDirections;
    for (const Eigen::Vector3d& d : kRays) {
        if (enough != kEvery && (count >= enough || count + left < enough)) {
            break;
        }
        const Eigen::Vector3d direction = d.x() * side + d.y() * up + d.z() * normal;
        count += rays_.occluded(start, start + 2.0 * diagonal_mm_ * direction) ? 0 : 1;
        --left;
    }
    return count;
}

double Visibility::escape_fraction(const Eigen::Vector3d& point,
                                   const Eigen::Vector3d& normal) const {
    return static_cast<double>(escaped(point, normal, kEvery)) / kDirections;
}

bool Visibility::escapes(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                         double share) const {
    const int enough = static_cast<int>(share * kDirections) + 1;
    return escaped(point, normal, enough) >= enough;
}

}  // namespace meshwind
