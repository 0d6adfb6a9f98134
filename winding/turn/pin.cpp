#include "winding/turn/pin.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"
#include "winding/turn/turn.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Sides of the prism that stands for a pin among the obstacles; its corners are on the pin.
constexpr int kSegments = 16;

// A place is on the flank within this: the fibre is followed along it in steps, whose errors add up
// to less.
constexpr double kOnFlank_mm = 0.01;

// Across the pin's axis, and along it. Mirrored where the pin is on the left, so that the fibre
// always goes about it clockwise.
struct PinFrame {
    Vector3d base_mm, u, v, axis;

    PinFrame(const Pin& pin, PinSide side)
        : base_mm(pin.base_mm),
          u(pin.axis.unitOrthogonal()),
          v((side == PinSide::Right ? 1.0 : -1.0) * pin.axis.cross(u)),
          axis(pin.axis) {}

    [[nodiscard]] Vector2d across(const Vector3d& place) const {
        return {u.dot(place - base_mm), v.dot(place - base_mm)};
    }
    [[nodiscard]] double height(const Vector3d& place) const { return axis.dot(place - base_mm); }
    [[nodiscard]] Vector3d direction(const Vector2d& across, double slope) const {
        return (across.x() * u + across.y() * v + slope * axis).normalized();
    }
    [[nodiscard]] Vector3d place(const Vector2d& across, double height) const {
        return base_mm + across.x() * u + across.y() * v + height * axis;
    }
};

Vector2d on_circle(double radius, double angle) {
    return radius * Vector2d(std::cos(angle), std::sin(angle));
}

double polar_angle(const Vector2d& v) {
    return std::atan2(v.y(), v.x());
}

}  // namespace

double strand_radius_mm(double width_mm, double thickness_mm) {
    return std::sqrt(width_mm * thickness_mm / kPi);
}

double pin_extension_mm(const PinRing& ring, double band_mm) {
    return ring.offset_mm + 0.5 * ring.diameter_mm + ring.strand_mm + 0.5 * band_mm;
}

std::vector<Pin> pins_of(const PinRing& ring, const Rim& rim) {
    const Vector3d x = rim_reference(rim);
    const Vector3d y = rim.axis.cross(x);
    std::vector<Pin> pins;
    for (int i = 0; i < ring.count; ++i) {
        const double azimuth = ring.azimuth_rad + 2.0 * kPi * i / ring.count;
        Pin pin;
        pin.axis = std::cos(azimuth) * x + std::sin(azimuth) * y;
        pin.base_mm = rim.centre_mm + ring.offset_mm * rim.axis + rim.radius_mm * pin.axis;
        pin.radius_mm = 0.5 * ring.diameter_mm;
        pin.height_mm = ring.height_mm;
        pin.strand_mm = ring.strand_mm;
        pins.push_back(pin);
    }
    return pins;
}

TriangleSoup mesh_of(const Pin& pin) {
    const PinFrame frame(pin, PinSide::Right);
    TriangleSoup soup;
    const std::array heights{-pin.radius_mm, pin.height_mm};
    for (const double height : heights) {
        soup.points_mm.push_back(frame.place(Vector2d::Zero(), height));
    }
    for (int i = 0; i < kSegments; ++i) {
        const Vector2d corner = on_circle(pin.radius_mm, 2.0 * kPi * i / kSegments);
        for (const double height : heights) {
            soup.points_mm.push_back(frame.place(corner, height));
        }
    }
    for (int i = 0; i < kSegments; ++i) {
        const std::int32_t low = 2 + 2 * i;
        const std::int32_t next = 2 + 2 * ((i + 1) % kSegments);
        soup.faces.push_back({low, next, next + 1});
        soup.faces.push_back({low, next + 1, low + 1});
        soup.faces.push_back({0, next, low});
        soup.faces.push_back({1, low + 1, next + 1});
    }
    return soup;
}

PinString string_about(const Pin& pin, PinSide side, const Vector3d& from_mm,
                       const Vector3d& to_mm) {
    const PinFrame frame(pin, side);
    const Vector2d from = frame.across(from_mm);
    const Vector2d to = frame.across(to_mm);
    // A place inside goes round at its own distance.
    const double radius = std::min(pin.held_mm(), from.norm());
    const double to_flank = std::sqrt(std::max(0.0, from.squaredNorm() - radius * radius));
    const double from_flank = std::sqrt(std::max(0.0, to.squaredNorm() - radius * radius));
    // Clockwise: the fibre's polar angle falls from one place of touch to the other.
    const double in_rad = polar_angle(from) - std::atan2(to_flank, radius);
    const double out_rad = polar_angle(to) + std::atan2(from_flank, radius);
    PinString string;
    string.bend_rad = std::remainder(in_rad - out_rad, 2.0 * kPi);
    string.on_pin = from.norm() < pin.held_mm() + kOnFlank_mm;
    const double on_flank = radius * string.bend_rad;
    const double across = to_flank + on_flank + from_flank;
    const double begin = frame.height(from_mm);
    const double slope = (frame.height(to_mm) - begin) / across;
    const double stretch = std::hypot(1.0, slope);
    string.direction = frame.direction({std::sin(in_rad), -std::cos(in_rad)}, slope);
    const double in_height = begin + slope * to_flank;
    const double out_height = in_height + slope * on_flank;
    string.top_mm = std::max(in_height, out_height);
    string.out_mm = frame.place(on_circle(radius, out_rad), out_height);
    string.to_out_mm = stretch * (to_flank + on_flank);
    string.length_mm = stretch * across;
    return string;
}

std::optional<PinSide> side_touched(const Pin& pin, const Vector3d& from_mm,
                                    const Vector3d& to_mm) {
    const PinFrame frame(pin, PinSide::Right);
    const Vector2d from = frame.across(from_mm);
    const Vector2d way = frame.across(to_mm) - from;
    const double share = -from.dot(way) / way.squaredNorm();
    if (share <= 0.0 || share >= 1.0) {
        return std::nullopt;
    }
    const double height = (1.0 - share) * frame.height(from_mm) + share * frame.height(to_mm);
    if ((from + share * way).norm() >= pin.held_mm() || height >= pin.height_mm ||
        height < -pin.held_mm()) {
        return std::nullopt;
    }
    const double left = way.x() * -from.y() - way.y() * -from.x();
    return left > 0.0 ? PinSide::Left : PinSide::Right;
}

}  // namespace meshwind
