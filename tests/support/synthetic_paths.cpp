#include "tests/support/synthetic_paths.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind::test {
namespace {

EyePoint eye_point(const Eigen::Vector3d& landing_mm, const Eigen::Vector3d& normal,
                   const Eigen::Vector3d& tangent, double free_length_mm) {
    EyePoint point;
    point.landing_mm = landing_mm;
    point.tangent = tangent.normalized();
    point.binormal = normal.cross(point.tangent).normalized();
    point.free_length_mm = free_length_mm;
    point.eye_mm = landing_mm + free_length_mm * point.tangent;
    return point;
}

EyePoint on_cylinder(double radius_mm, double theta, double z_mm, double angle_rad,
                     double free_length_mm) {
    const Eigen::Vector3d normal(std::cos(theta), std::sin(theta), 0.0);
    const Eigen::Vector3d around(-std::sin(theta), std::cos(theta), 0.0);
    return eye_point(radius_mm * normal + Eigen::Vector3d(0.0, 0.0, z_mm), normal,
                     std::sin(angle_rad) * around + std::cos(angle_rad) * Eigen::Vector3d::UnitZ(),
                     free_length_mm);
}

}  // namespace

EyePath helix(double radius_mm, double angle_rad, double free_length_mm, double step_mm, int n) {
    EyePath path;
    for (int i = 0; i < n; ++i) {
        const double s = step_mm * i;
        path.push_back(on_cylinder(radius_mm, s * std::sin(angle_rad) / radius_mm,
                                   s * std::cos(angle_rad), angle_rad, free_length_mm));
        path.back().s_mm = s;
        path.back().point = i;
    }
    return path;
}

EyePath strokes(double radius_mm, double free_length_mm, double step_mm, double stroke_mm,
                int count) {
    const double half_turn_mm = 4.0 * radius_mm;  // arc of a turn, long enough to be smooth
    EyePath path;
    double theta = 0.0;
    double z_mm = 0.0;
    double s_mm = 0.0;
    double angle = rad_from_deg(45.0);
    for (int piece = 0; piece < 2 * count; ++piece) {
        const bool turn = piece % 2 == 1;
        const double length = turn ? half_turn_mm : stroke_mm / std::cos(rad_from_deg(45.0));
        const double from = angle;
        const double to = turn ? kPi - angle : angle;
        const int n = static_cast<int>(std::ceil(length / step_mm));
        for (int i = 0; i < n; ++i) {
            path.push_back(on_cylinder(radius_mm, theta, z_mm, angle, free_length_mm));
            path.back().s_mm = s_mm;
            path.back().piece = piece;
            path.back().point = i;
            const double t = (i + 1.0) / n;
            const double next = from + (to - from) * 0.5 * (1.0 - std::cos(kPi * t));
            const double middle = 0.5 * (angle + next);
            theta += step_mm * std::sin(middle) / radius_mm;
            z_mm += step_mm * std::cos(middle);
            s_mm += step_mm;
            angle = next;
        }
    }
    return path;
}

EyePath elliptic_helix(int n) {
    constexpr double kHalfA_mm = 70.0;
    constexpr double kHalfB_mm = 40.0;
    constexpr double kPitch_mm = 8.0;
    EyePath path;
    for (int i = 0; i < n; ++i) {
        const double t = 0.05 * i;
        const Eigen::Vector3d landing(kHalfA_mm * std::cos(t), kHalfB_mm * std::sin(t),
                                      kPitch_mm * t);
        const Eigen::Vector3d normal(std::cos(t) / kHalfA_mm, std::sin(t) / kHalfB_mm, 0.0);
        const Eigen::Vector3d tangent(-kHalfA_mm * std::sin(t), kHalfB_mm * std::cos(t), kPitch_mm);
        path.push_back(eye_point(landing, normal.normalized(), tangent,
                                 200.0 + 25.0 * (1.0 + std::tanh((i - 0.5 * n) * 0.05))));
        const EyePoint& before = path[i > 0 ? path.size() - 2 : 0];
        path.back().s_mm = before.s_mm + (landing - before.landing_mm).norm();
        path.back().point = i;
    }
    return path;
}

EyePath on_ellipsoid(const EllipsoidLine& line, int n) {
    const Eigen::Vector3d half_mm(90.0, 60.0, 150.0);
    EyePath path;
    for (int i = 0; i < n; ++i) {
        const double share = n > 1 ? static_cast<double>(i) / (n - 1) : 0.0;
        const double turn = 2.0 * kPi * share;
        const double angle = line.waves * turn + line.phase_rad;
        // Latitude of the stretched sphere and its rate.
        const double latitude = line.swing * std::sin(angle);
        const double rate = line.swing * line.waves * std::cos(angle);
        const Eigen::Vector3d sphere(std::cos(latitude) * std::cos(turn),
                                     std::cos(latitude) * std::sin(turn), std::sin(latitude));
        const Eigen::Vector3d east(-std::sin(turn), std::cos(turn), 0.0);
        const Eigen::Vector3d north(-std::sin(latitude) * std::cos(turn),
                                    -std::sin(latitude) * std::sin(turn), std::cos(latitude));
        const Eigen::Vector3d along = std::cos(latitude) * east + rate * north;
        const double longer = line.longer_mm * (2.0 * share - 1.0);
        path.push_back(eye_point(half_mm.cwiseProduct(sphere),
                                 sphere.cwiseQuotient(half_mm).normalized(),
                                 half_mm.cwiseProduct(along), line.free_length_mm + longer));
        const EyePoint& before = path[i > 0 ? path.size() - 2 : 0];
        path.back().s_mm = before.s_mm + (path.back().landing_mm - before.landing_mm).norm();
        path.back().point = i;
    }
    return path;
}

}  // namespace meshwind::test
