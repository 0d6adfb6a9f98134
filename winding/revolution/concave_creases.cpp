#include "winding/revolution/concave_creases.h"

#include <algorithm>
#include <cmath>

namespace meshwind {
namespace {

// The curvature along the fibre differs on both sides; the longer half is this much longer on
// walls that a fibre can bridge within the tolerance.
constexpr double kBridgeShare = 1.5;

}  // namespace

ConcaveCreases::ConcaveCreases(const Meridian& meridian) {
    for (const double crease : meridian.creases_mm()) {
        const double kink =
            meridian.at(crease).slope_rad - meridian.at(std::nextafter(crease, 0.0)).slope_rad;
        if (kink > 0.0) {
            edges_.push_back({crease, kink});
        }
    }
}

bool ConcaveCreases::near_bridge(const MeridianPlace& place, double arc_mm, double angle_rad,
                                 double times) const {
    return std::any_of(edges_.begin(), edges_.end(), [&](const Edge& edge) {
        const double c = std::cos(angle_rad);
        const double s = std::sin(angle_rad);
        const double kn = std::cos(place.slope_rad) * s * s / place.radius_mm;
        const double half_mm = 0.5 * edge.kink_rad * c / kn;
        return std::abs(arc_mm - edge.arc_mm) < times * kBridgeShare * half_mm * c;
    });
}

}  // namespace meshwind
