#include "winding/revolution/regular_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/units.h"

namespace meshwind {
namespace {

// Left out at either end of a part, in tow widths: bands turn or end there, or belong to two parts.
constexpr double kMarginTows = 2.0;

constexpr double kSteep_rad = rad_from_deg(45.0);

// Nearer to hoop layers have no number; two tow widths off a turn they are flatter.
constexpr double kMinCosine = 1e-3;

// Rings of the wall whose areas are summed up.
constexpr int kRings = 2000;

// r sin(a) by arc length, ascending.
struct Turning {
    std::vector<double> arc_mm;
    std::vector<double> c_mm;

    [[nodiscard]] double at(double arc) const {
        const auto above = std::upper_bound(arc_mm.begin() + 1, arc_mm.end() - 1, arc);
        const auto i = static_cast<std::size_t>(above - arc_mm.begin());
        const double step = arc_mm[i] - arc_mm[i - 1];
        const double share = step > 0.0 ? std::clamp((arc - arc_mm[i - 1]) / step, 0.0, 1.0) : 0.0;
        return c_mm[i - 1] + share * (c_mm[i] - c_mm[i - 1]);
    }
};

MeridianFoot foot_of(const Meridian& meridian, const Eigen::Vector3d& position) {
    return meridian.foot(std::hypot(position.x(), position.y()), position.z());
}

}  // namespace

void regular_parts(const BodyOfRevolution& body, const MeridianPass& pass,
                   const std::array<double, 2>& wound_mm, double tow_width_mm, PlanZones& zones) {
    const Meridian& meridian = body.meridian;
    std::vector<std::pair<double, double>> regular;
    for (const MeridianPart& part : body.parts) {
        if (part.kind == MeridianPartKind::Dome || std::abs(part.slope_rad) >= kSteep_rad) {
            continue;
        }
        const double from_mm = std::max(part.from_mm, wound_mm[0]) + kMarginTows * tow_width_mm;
        const double to_mm = std::min(part.to_mm, wound_mm[1]) - kMarginTows * tow_width_mm;
        if (from_mm < to_mm) {
            regular.emplace_back(from_mm, to_mm);
        }
    }
    if (regular.empty()) {
        return;
    }
    zones.regular = [&meridian, regular](const Eigen::Vector3d& position) {
        const double arc = foot_of(meridian, position).arc_mm;
        return std::any_of(regular.begin(), regular.end(), [arc](const auto& part) {
            return arc >= part.first && arc <= part.second;
        });
    };
    if (pass.stations.empty()) {
        return;
    }
    Turning turning;
    for (const MeridianStation& station : pass.stations) {
        turning.arc_mm.push_back(station.arc_mm);
        turning.c_mm.push_back(station.place.radius_mm * std::sin(station.angle_rad));
    }
    zones.meant = [&meridian, turning](const Eigen::Vector3d& position) {
        const double arc = foot_of(meridian, position).arc_mm;
        const double radius = meridian.at(arc).radius_mm;
        const double sine = std::min(1.0, turning.at(arc) / radius);
        return 1.0 / (radius * std::max(kMinCosine, std::sqrt(1.0 - sine * sine)));
    };
}

double share_between(const Meridian& meridian, const std::array<double, 2>& wound_mm) {
    double all = 0.0;
    double between = 0.0;
    for (int i = 0; i < kRings; ++i) {
        const double arc_mm = meridian.length_mm() * (i + 0.5) / kRings;
        const double radius_mm = meridian.at(arc_mm).radius_mm;
        all += radius_mm;
        between += arc_mm >= wound_mm[0] && arc_mm <= wound_mm[1] ? radius_mm : 0.0;
    }
    return between / all;
}

}  // namespace meshwind
