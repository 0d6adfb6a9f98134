#include "study/tangent_rules.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

struct EyeAngles {
    double c_rad;
    double a_rad;
};

EyeAngles eye_angles(const Vector3d& eye_mm, const Vector3d& direction) {
    const double c = std::atan2(eye_mm.y(), eye_mm.x());
    const double across = std::cos(c) * direction.y() - std::sin(c) * direction.x();
    return {c, std::atan2(direction.z(), across)};
}

double difference_rad(double a, double b) {
    return std::remainder(a - b, 2.0 * kPi);
}

}  // namespace

const char* name_of(TangentRule rule) {
    switch (rule) {
        case TangentRule::Chord:
            return "chord";
        case TangentRule::Central:
            return "central";
        case TangentRule::Parabola:
            return "parabola";
        case TangentRule::Traced:
            return "traced";
    }
    return "";
}

Vector3d tangent_by(TangentRule rule, const Landing& landing) {
    const Vector3d in = landing.here - landing.before;
    const Vector3d out = landing.after - landing.here;
    switch (rule) {
        case TangentRule::Chord:
            return in.normalized();
        case TangentRule::Central:
            return (in + out).normalized();
        case TangentRule::Parabola: {
            const double in_mm = in.norm();
            const double out_mm = out.norm();
            return (out * (in_mm / out_mm) + in * (out_mm / in_mm)).normalized();
        }
        case TangentRule::Traced:
            return landing.traced;
    }
    return landing.traced;
}

EyeError eye_error(const Vector3d& landing_mm, const Vector3d& exact, const Vector3d& approximate,
                   double free_length_mm) {
    const EyeAngles right = eye_angles(landing_mm + free_length_mm * exact, exact);
    const EyeAngles taken = eye_angles(landing_mm + free_length_mm * approximate, approximate);
    return {.c_rad = difference_rad(taken.c_rad, right.c_rad),
            .direction_rad = std::atan2(exact.cross(approximate).norm(), exact.dot(approximate)),
            .eye_mm = free_length_mm * (approximate - exact).norm(),
            .a_rad = difference_rad(taken.a_rad, right.a_rad)};
}

}  // namespace meshwind
