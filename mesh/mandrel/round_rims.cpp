#include "mesh/mandrel/round_rims.h"

#include <algorithm>
#include <cmath>

#include "core/text/text_number.h"

namespace meshwind {
namespace {

// Largest distance of the rim's vertices from its plane.
double off_plane_mm(const Mandrel& mandrel, const Rim& rim) {
    double farthest = 0.0;
    for (const std::int32_t v : rim.vertices) {
        const Eigen::Vector3d arm =
            mandrel.surface.position_mm[static_cast<std::size_t>(v)] - rim.centre_mm;
        farthest = std::max(farthest, std::abs(rim.axis.dot(arm)));
    }
    return farthest;
}

}  // namespace

const Rim* worst_off_circle(const Mandrel& mandrel) {
    const auto off = [](const Rim& rim) { return rim.circularity_mm / rim.radius_mm; };
    const auto worst =
        std::max_element(mandrel.rims.begin(), mandrel.rims.end(),
                         [&](const Rim& a, const Rim& b) { return off(a) < off(b); });
    return worst == mandrel.rims.end() || is_round(*worst) ? nullptr : &*worst;
}

std::string off_circle_words(const Mandrel& mandrel, const Rim& rim) {
    // An end that was cut askew is a plane loop, and off its circle by less than half its radius:
    // an oblique one is then 60 deg off square.
    constexpr double kFlatShare = 0.5;  // of what it is off
    constexpr double kMaxOfAnEnd = 0.5;
    const Eigen::Vector3d& p = rim.centre_mm;
    const bool is_end = rim.circularity_mm < kMaxOfAnEnd * rim.radius_mm &&
                        off_plane_mm(mandrel, rim) < kFlatShare * rim.circularity_mm;
    return "rim " + std::to_string(rim.id) + " around (" + fixed(p.x(), 1) + ", " +
           fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ") is no circle: up to " +
           fixed(rim.circularity_mm, 2) + " mm off radius " + fixed(rim.radius_mm, 2) +
           (is_end
                ? " mm: the end is oblique or not round; cut it square to its leg in the modeller"
                : " mm: a face is missing, the wall has a window, or it is half of a part; close "
                  "it or export the whole part");
}

std::string angular_end_words(const Mandrel& mandrel) {
    const AngularEnd& end = mandrel.angular_ends.front();
    const Eigen::Vector3d& p = end.middle_mm;
    return "the flat face around (" + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " +
           fixed(p.z(), 1) + "), " + fixed(end.area_mm2 / 100.0, 1) +
           " cm2, ends a leg that is not round; take the leg off where it is round in the "
           "modeller, or name what is to be wound, with region " +
           std::to_string(end.region) + " as it is: \"mandrel\": {\"keep_regions\": [...]}";
}

}  // namespace meshwind
