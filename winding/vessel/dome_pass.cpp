#include "winding/vessel/dome_pass.h"

#include <cmath>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "core/roots.h"
#include "core/units.h"

namespace meshwind {
namespace {

struct MomentEnd {
    double excess_mm;  // of the moment over the radius where the fibre is to turn
    bool pressed;      // all the way
};

// The moment by the classical Runge-Kutta method in the dome's parameter. 400 steps leave
// (1 / 400)^4 of a few units, 1e-10.
MomentEnd follow_moment(const IsotensoidDome& dome, double clairaut_mm, double turn_mm,
                        double slip) {
    constexpr int kSteps = 400;
    const double end = dome.parameter_at(turn_mm);
    const double h = end / kSteps;
    bool pressed = true;
    const auto rate = [&](double t, double m) {
        const double y = dome.radius_mm(t);
        const auto [along, across] = dome.curvatures(t);
        const double press = across * m * m + along * (y - m) * (y + m);
        pressed = pressed && press > 0.0;
        return slip * press / y * dome.rate_mm(t).norm();
    };
    double m = clairaut_mm;
    for (int i = 0; i < kSteps; ++i) {
        const double t = h * i;
        const double a = rate(t, m);
        const double b = rate(t + 0.5 * h, m + 0.5 * h * a);
        const double c = rate(t + 0.5 * h, m + 0.5 * h * b);
        const double d = rate(t + h, m + h * c);
        m += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    return {m - turn_mm, pressed};
}

}  // namespace

// With sin(t) = sin(t_turn) sin(phi), cos(alpha) dphi / dt has no zero left.
DomePass geodesic_pass(const IsotensoidDome& dome, double clairaut_mm) {
    constexpr unsigned kDepth = 15;
    constexpr double kAccuracy = 1e-12;
    const double equator = dome.design().equator_radius_mm;
    const double least = dome.least_radius_mm();
    const double across = std::sqrt((equator - least) * (equator + least));
    const double turn = dome.parameter_at(clairaut_mm);
    const double s = std::sin(turn);
    const double c = std::cos(turn);
    const auto length_rate = [&](double phi) {
        const double sin_t = s * std::sin(phi);
        const double cos_t = std::hypot(c, s * std::cos(phi));
        const double t = std::atan2(sin_t, cos_t);
        return dome.rate_mm(t).norm() * dome.radius_mm(t) / (across * cos_t);
    };
    const auto turn_rate = [&](double phi) {
        const double y = dome.radius_mm(std::asin(s * std::sin(phi)));
        return length_rate(phi) * clairaut_mm / (y * y);
    };
    using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
    return {Rule::integrate(length_rate, 0.0, 0.5 * kPi, kDepth, kAccuracy),
            2.0 * Rule::integrate(turn_rate, 0.0, 0.5 * kPi, kDepth, kAccuracy)};
}

double slip_ratio(const MeridianFibre& fibre) {
    const double y = fibre.radius_mm;
    const double a2 = 1.0 + fibre.slope * fibre.slope;
    const double s = std::sin(fibre.angle_rad);
    const double c = std::cos(fibre.angle_rad);
    return (y * std::sqrt(a2) * fibre.angle_rate_per_mm + fibre.slope * s) /
           (s * s - y * fibre.bend_per_mm * c * c / a2);
}

std::optional<double> slip_to_turn(const IsotensoidDome& dome, double clairaut_mm, double turn_mm) {
    constexpr double kMost = 1.0;
    constexpr int kBits = 40;  // 2e-12, finer than the moment is known
    const auto excess = [&](double slip) {
        return follow_moment(dome, clairaut_mm, turn_mm, slip).excess_mm;
    };
    const double low = excess(0.0);
    const double high = excess(kMost);
    if (low >= 0.0) {
        return 0.0;
    }
    if (!(high > 0.0)) {
        return std::nullopt;
    }
    const double slip = zero_between({0.0, kMost, low, high}, excess, {.bits = kBits}).middle();
    if (!follow_moment(dome, clairaut_mm, turn_mm, slip).pressed) {
        return std::nullopt;
    }
    return slip;
}

}  // namespace meshwind
