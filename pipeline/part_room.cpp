#include "pipeline/part_room.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/margins.h"
#include "core/units.h"
#include "mesh/segment/spindle_axis.h"
#include "winding/plan/figures.h"
#include "winding/revolution/aim_pass.h"
#include "winding/revolution/hoop_path.h"
#include "winding/turn/turn.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kSlices = 1000;
constexpr std::size_t kRimSamples = 64;

// A fibre whose eye is no further out than its landing point lies along the spindle; what radii of
// meshes are off.
constexpr double kSameRadius_mm = 1e-3;

// Courses on a body between two plain rims reach all of it, and less than kCoveredShare of what
// they reach is refused in the end: so much of the wall may be out of reach.
constexpr double kMaxBareBetweenRims = 0.15;

// Elsewhere nothing is planned where courses reach less than half of the wall
// (winding/cover/cover.cpp).
constexpr double kMaxBare = 1.0 - kCoveredShare * 0.5;

double radius_of(const Vector3d& point) {
    return point.head<2>().norm();
}

// Whether the eye gets around a hoop of a radius.
bool gets_around(const EyeReach& eye, double radius_mm) {
    return hoop_eye_mm(eye, radius_mm) <= eye.range.farthest_mm &&
           radius_mm + eye.longest_fibre_mm >= eye.range.nearest_mm;
}

// Whether patterns can turn at an end of the body of revolution.
bool reaches_end(const PartReach& part, const BodyOfRevolution& body, std::size_t end) {
    if (has_cap(body, end)) {
        const MeridianPlace cap = body.meridian.at(cap_mm(body, end));
        return in_height(part.eye, cap.z_mm) && cap.radius_mm < part.eye.range.farthest_mm;
    }
    const std::int32_t rim = body.end[end].rim;
    return rim < 0 || reaches(part, part.mandrel.rims[static_cast<std::size_t>(rim)]);
}

bool reaches_both_ends(const PartReach& part, const BodyOfRevolution& body) {
    return reaches_end(part, body, 0) && reaches_end(part, body, 1);
}

bool widest_fits(const PartReach& part, const BodyOfRevolution& body) {
    const Meridian& meridian = body.meridian;
    return meridian.at(meridian.widest_mm()).radius_mm < part.eye.range.farthest_mm;
}

// Share of the wall at which no fibre lands: beyond the eye's travel, and where an end of a body of
// revolution cannot be turned at, beyond the widest hoop.
double bare_share(const PartReach& part) {
    const EyeReach& eye = part.eye;
    const bool turns_inside = part.body && !reaches_both_ends(part, *part.body);
    const auto bare = [&](const Vector3d& at) {
        const double radius_mm = radius_of(at);
        return !in_height(eye, at.z()) || radius_mm > eye.range.farthest_mm + kRoomSlack_mm ||
               radius_mm + eye.longest_fibre_mm < eye.range.nearest_mm - kRoomSlack_mm ||
               (turns_inside && !gets_around(eye, radius_mm - 0.5 * part.turns.tow_width_mm));
    };
    double all_mm2 = 0.0;
    double bare_mm2 = 0.0;
    const Surface& surface = part.mandrel.surface;
    for (const auto& face : surface.face) {
        const double mm2 = area_mm2(surface.position_mm, face);
        all_mm2 += mm2;
        const bool out = std::all_of(face.begin(), face.end(), [&](auto corner) {
            return bare(surface.position_mm[static_cast<std::size_t>(corner)]);
        });
        bare_mm2 += out ? mm2 : 0.0;
    }
    return bare_mm2 / all_mm2;
}

}  // namespace

double head_gap_mm(const Machine& machine, const HeadEnvelope& envelope) {
    double gap = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d& eye = machine.eye.position_mm;
    for (const HeadEnvelope::Part& part : envelope.parts) {
        for (const Eigen::Vector3d& point : part.triangles.points_mm) {
            gap = std::min(gap, (point - eye).norm());
        }
        if (part.triangles.points_mm.empty()) {
            const Eigen::Vector3d along = part.capsule.to_mm - part.capsule.from_mm;
            const double length2 = along.squaredNorm();
            const double share =
                length2 > 0.0
                    ? std::clamp((eye - part.capsule.from_mm).dot(along) / length2, 0.0, 1.0)
                    : 0.0;
            gap = std::min(
                gap, (eye - part.capsule.from_mm - share * along).norm() - part.capsule.radius_mm);
        }
    }
    return gap;
}

double free_length_over_cylinder_mm(double radius_mm, double off_mm, double sine) {
    return std::sqrt(off_mm * (2.0 * radius_mm + off_mm)) / sine;
}

std::vector<Eigen::Vector2d> outline(const TriangleSoup& part) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Eigen::Vector3d& point : part.points_mm) {
        low = std::min(low, point.z());
        high = std::max(high, point.z());
    }
    std::vector<Eigen::Vector2d> widest(kSlices, {-1.0, 0.0});
    for (const Eigen::Vector3d& point : part.points_mm) {
        const double share = high > low ? (point.z() - low) / (high - low) : 0.0;
        auto& slice =
            widest[std::min(kSlices - 1, static_cast<std::size_t>(share * double{kSlices}))];
        const double radius = point.head<2>().norm();
        if (radius > slice.x()) {
            slice = {radius, point.z()};
        }
    }
    std::erase_if(widest, [](const Eigen::Vector2d& at) { return at.x() < 0.0; });
    return widest;
}

double needed_extension_mm(const TurnRoom& turns, const Rim& rim) {
    return least_run_mm(rim.radius_mm, turns.friction) + 0.5 * turns.tow_width_mm;
}

bool has_room(const TurnRoom& turns, const Rim& rim) {
    return needed_extension_mm(turns, rim) <= turns.extension_mm;
}

bool about_spindle(const Rim& rim) {
    return rim.axis.head<2>().norm() < kCoaxialSine &&
           rim.centre_mm.head<2>().norm() < kCoaxialSine * rim.radius_mm;
}

double hoop_height_mm(const TurnRoom& turns, const Rim& rim) {
    const double run_mm = turns.takes_run ? least_run_mm(rim.radius_mm, turns.friction) : 0.0;
    return rim.centre_mm.z() + std::copysign(run_mm, rim.axis.z());
}

bool has_cap(const BodyOfRevolution& body, std::size_t end) {
    return cap_mm(body, end) != (end == 0 ? 0.0 : body.meridian.length_mm());
}

bool in_height(const EyeReach& eye, double z_mm) {
    return z_mm >= eye.range.low_mm - kRoomSlack_mm && z_mm <= eye.range.high_mm + kRoomSlack_mm;
}

double hoop_eye_mm(const EyeReach& eye, double radius_mm) {
    const double free_mm = std::max(0.0, eye.shortest_fibre_mm - margin::kFreeLength_mm);
    return std::max(
        {std::hypot(radius_mm, free_mm), radius_mm + eye.off_wall_mm, radius_mm + kSameRadius_mm});
}

bool reaches(const PartReach& part, const Rim& rim) {
    if (part.turns.takes_run && !has_room(part.turns, rim)) {
        return true;  // that is told by the turns
    }
    if (part.turns.takes_run && about_spindle(rim)) {
        return in_height(part.eye, hoop_height_mm(part.turns, rim)) &&
               gets_around(part.eye, rim.radius_mm);
    }
    const Vector3d x = rim_reference(rim);
    const Vector3d y = rim.axis.cross(x);
    for (std::size_t i = 0; i < kRimSamples; ++i) {
        const double turn = 2.0 * kPi * static_cast<double>(i) / kRimSamples;
        const Vector3d at =
            rim.centre_mm + rim.radius_mm * (std::cos(turn) * x + std::sin(turn) * y);
        if (in_height(part.eye, at.z()) &&
            radius_of(at) < part.eye.range.farthest_mm + kRoomSlack_mm) {
            return true;
        }
    }
    return false;
}

bool patterns_fit(const PartReach& part) {
    return part.body && reaches_both_ends(part, *part.body) && widest_fits(part, *part.body);
}

bool courses_fit(const PartReach& part) {
    const std::vector<Rim>& rims = part.mandrel.rims;
    if (rims.empty()) {
        return true;  // for the planner to refuse
    }
    const bool any_rim =
        std::any_of(rims.begin(), rims.end(), [&](const Rim& rim) { return reaches(part, rim); });
    const bool between_rims = part.body && !has_cap(*part.body, 0) && !has_cap(*part.body, 1);
    return any_rim && bare_share(part) <= (between_rims ? kMaxBareBetweenRims : kMaxBare);
}

bool hoops_fit(const PartReach& part) {
    if (!part.body) {
        return true;
    }
    const Meridian& meridian = part.body->meridian;
    const CylinderPart cylinder = cylinder_at(meridian, meridian.widest_mm());
    const double inside_mm = part.turns.tow_width_mm;
    return in_height(part.eye, meridian.at(cylinder.from_mm).z_mm + inside_mm) &&
           in_height(part.eye, meridian.at(cylinder.to_mm).z_mm - inside_mm) &&
           widest_fits(part, *part.body);
}

std::array<double, 2> needed_heights_mm(const PartReach& part) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    const auto add = [&](double z_mm) {
        low = std::min(low, z_mm);
        high = std::max(high, z_mm);
    };
    for (const Rim& rim : part.mandrel.rims) {
        const double z_mm = hoop_height_mm(part.turns, rim);
        add(std::isfinite(z_mm) ? z_mm : rim.centre_mm.z());
    }
    for (std::size_t end = 0; part.body && end < 2; ++end) {
        if (has_cap(*part.body, end)) {
            add(part.body->meridian.at(cap_mm(*part.body, end)).z_mm);
        }
    }
    return {low, high};
}

}  // namespace meshwind
