#include "mesh/shapes/isotensoid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "core/roots.h"
#include "core/units.h"
#include "mesh/shapes/make_checks.h"

namespace meshwind {
namespace {

// Chebyshev's points on a panel; with panels that halve towards what is nearly singular the last
// coefficients fall below kTail within a few halvings.
constexpr int kNodes = 20;
constexpr double kTail = 1e-13;
constexpr int kDeepest = 40;

// ((1 + x)^p - 1) / x without loss of digits.
double power_rate(double x, double p) {
    return x == 0.0 ? p : std::expm1(p * std::log1p(x)) / x;
}

// What is added to u (u + r)^2 from u0 to u0 + d, over d.
double cubic_rate(double u0, double r, double d) {
    return (u0 + r) * (u0 + r) + (u0 + d) * (2.0 * (u0 + r) + d);
}

double cubic(double u, double r) {
    return u * (u + r) * (u + r);
}

using Coefficients = std::array<double, kNodes>;

// Of the polynomial through values at the zeros of the Chebyshev polynomial, first kind.
Coefficients chebyshev(const Coefficients& value) {
    Coefficients c{};
    for (int k = 0; k < kNodes; ++k) {
        double sum = 0.0;
        for (int i = 0; i < kNodes; ++i) {
            sum += value[static_cast<std::size_t>(i)] * std::cos(kPi * k * (i + 0.5) / kNodes);
        }
        c[static_cast<std::size_t>(k)] = (k == 0 ? 1.0 : 2.0) / kNodes * sum;
    }
    return c;
}

// Integral of the series, zero at -1.
std::vector<double> integrated(const Coefficients& c) {
    std::vector<double> out(kNodes + 1);
    const auto at = [&](int k) { return k < kNodes ? c[static_cast<std::size_t>(k)] : 0.0; };
    double at_low = 0.0;
    for (int k = 1; k <= kNodes; ++k) {
        const double before = k == 1 ? 2.0 * c[0] : at(k - 1);
        out[static_cast<std::size_t>(k)] = (before - at(k + 1)) / (2.0 * k);
        at_low += (k % 2 == 0 ? 1.0 : -1.0) * out[static_cast<std::size_t>(k)];
    }
    out[0] = -at_low;
    return out;
}

double clenshaw(const std::vector<double>& c, double x) {
    double b1 = 0.0;
    double b2 = 0.0;
    for (std::size_t k = c.size() - 1; k > 0; --k) {
        const double b = 2.0 * x * b1 - b2 + c[k];
        b2 = b1;
        b1 = b;
    }
    return x * b1 - b2 + c[0];
}

}  // namespace

void IsotensoidDesign::validate() const {
    require_positive("radius", equator_radius_mm);
    require_positive("design-radius", design_radius_mm);
    require_not_negative("ke", stiffness_ratio);
    require(stiffness_ratio < 1.0, "make.stiffness_ratio", "ke", stiffness_ratio, "less than", 1.0);
    const double g = design_radius_mm / equator_radius_mm;
    const double r = axial_share;
    require_not_negative("axial-share", r);
    // dG/du < 0 at the equator: the meridian bends towards the axis. k_e = 0, r = 0: g^2 < 2 / 3.
    const double k = stiffness_ratio;
    const double square = ((1.0 + r) * (k + 1.0) / (3.0 + r) - 1.0) / (k - 1.0);
    // At the limit u_min meets the equator, and the digits of 1 - u_min go; nearer than this the
    // dome would close by less than a hundredth of its radius anyway.
    constexpr double kNear = 1e-4;
    const double limit = (1.0 - kNear) * std::sqrt(std::clamp(square, 0.0, 1.0));
    require(g < limit, "make.design_radius", "design-radius", design_radius_mm,
            "less than, as a steeper fibre would bend the dome outward at the equator,",
            equator_radius_mm * limit);
}

IsotensoidDome::IsotensoidDome(const IsotensoidDesign& design) : design_(design) {
    design.validate();
    const double g = design.design_radius_mm / design.equator_radius_mm;
    q_ = (design.stiffness_ratio - 1.0) * g * g;
    find_least();
    add_panels(0.0, 0.5 * kPi, 0);
}

// The logarithm's derivative, of the forces' ratio by u, is a quadratic over positive factors with
// one positive zero: from there inward G falls, from above zero to - u (u + r)^2 where q + u is
// none.
void IsotensoidDome::find_least() {
    const double r = design_.axial_share;
    const double k = design_.stiffness_ratio;
    const double lowest = -q_;
    // By v = q + u, which is far smaller than u where design radius or k_e are small.
    const auto excess = [&](double v) {
        return std::pow(v / (q_ + 1.0), k + 1.0) * (1.0 + r) * (1.0 + r) - cubic(lowest + v, r);
    };
    constexpr int kMaxEvaluations = 300;  // v may be next to 0, the end of the bracket
    const double a = k - 2.0;
    const double b = k * r - 3.0 * q_;
    const double high = (-b - std::sqrt(b * b + 4.0 * a * q_ * r)) / (2.0 * a) - lowest;
    const SignChange ends{0.0, high, excess(0.0), excess(high)};
    least_above_ = zero_between(ends, excess, {.most_evaluations = kMaxEvaluations}).middle();
    least_square_ = lowest + least_above_;
}

double IsotensoidDome::square(double t) const {
    const double c = std::cos(t);
    return least_square_ + (1.0 - least_square_) * c * c;
}

// dZ/dt = Y_eq (u + r) / sqrt(H) with H = G / ((u - u_min) (1 - u)), from the nearer end.
double IsotensoidDome::height_rate(double t) const {
    const double r = design_.axial_share;
    const double p = design_.stiffness_ratio + 1.0;
    const double c = std::cos(t);
    const double s = std::sin(t);
    const double above = (1.0 - least_square_) * c * c;  // u - u_min
    const double below = (1.0 - least_square_) * s * s;  // 1 - u
    double h = 0.0;
    if (below <= above) {
        const double force =
            (1.0 + r) * (1.0 + r) / (q_ + 1.0) * power_rate(-below / (q_ + 1.0), p);
        h = (cubic_rate(1.0, r, -below) - force) / above;
    } else {
        const double u0 = least_square_;
        const double force = cubic(u0, r) / least_above_ * power_rate(above / least_above_, p);
        h = (force - cubic_rate(u0, r, above)) / below;
    }
    return design_.equator_radius_mm * (least_square_ + above + r) / std::sqrt(h);
}

void IsotensoidDome::add_panels(double low, double high, int depth) {
    Coefficients value{};
    const double half = 0.5 * (high - low);
    for (int i = 0; i < kNodes; ++i) {
        const double x = std::cos(kPi * (i + 0.5) / kNodes);
        value[static_cast<std::size_t>(i)] = half * height_rate(low + half * (1.0 + x));
    }
    const Coefficients c = chebyshev(value);
    const double tail = std::abs(c[kNodes - 1]) + std::abs(c[kNodes - 2]);
    if (tail > kTail * design_.equator_radius_mm && depth < kDeepest) {
        const double middle = 0.5 * (low + high);
        add_panels(low, middle, depth + 1);
        add_panels(middle, high, depth + 1);
        return;
    }
    std::vector<double> height = integrated(c);
    height[0] += panels_.empty() ? 0.0 : clenshaw(panels_.back().height, 1.0);
    panels_.push_back({low, high, std::move(height)});
}

double IsotensoidDome::least_radius_mm() const {
    return design_.equator_radius_mm * std::sqrt(least_square_);
}

double IsotensoidDome::parameter_at(double radius_mm) const {
    const double y = radius_mm / design_.equator_radius_mm;
    const double least = std::sqrt(least_square_);
    return std::atan2(std::sqrt(std::max(0.0, (1.0 - y) * (1.0 + y))),
                      std::sqrt(std::max(0.0, (y - least) * (y + least))));
}

double IsotensoidDome::radius_mm(double t) const {
    return design_.equator_radius_mm * std::sqrt(square(t));
}

double IsotensoidDome::height_mm(double t) const {
    const double size = std::abs(t);
    const auto panel = std::find_if(panels_.begin(), panels_.end() - 1,
                                    [&](const Panel& each) { return size <= each.high; });
    const double x = (2.0 * size - panel->low - panel->high) / (panel->high - panel->low);
    return std::copysign(clenshaw(panel->height, x), t);
}

Eigen::Vector2d IsotensoidDome::rate_mm(double t) const {
    const double fall = (1.0 - least_square_) * std::sin(t) * std::cos(t) / std::sqrt(square(t));
    return {-design_.equator_radius_mm * fall, height_rate(t)};
}

double IsotensoidDome::meridian_mm(double t) const {
    constexpr unsigned kDepth = 15;
    constexpr double kAccuracy = 1e-13;
    return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double x) { return rate_mm(x).norm(); }, 0.0, t, kDepth, kAccuracy);
}

// With S, the radial component of the normal, the curvatures are S / Y and dS/dY, and
// S = dZ/ds = sqrt(u) (u + r) / sqrt(G + u (u + r)^2).
IsotensoidDome::Curvatures IsotensoidDome::curvatures(double t) const {
    const double r = design_.axial_share;
    const double p = design_.stiffness_ratio + 1.0;
    const double u = square(t);
    const double above_q = least_above_ + (u - least_square_);
    const double force = (1.0 + r) * std::pow(above_q / (q_ + 1.0), 0.5 * p);
    const double size = design_.equator_radius_mm;
    const double over_y = (u + r) / (force * size);
    // dS/dY = 2 u (S / Y) d(ln S)/du
    const double steepness = 1.0 + 2.0 * u / (u + r) - p * u / above_q;
    return {over_y * steepness, over_y};
}

}  // namespace meshwind
