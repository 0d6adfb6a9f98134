#include "winding/elbow/torus_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "core/roots.h"
#include "core/units.h"
#include "mesh/shapes/make_checks.h"

namespace meshwind {
namespace {

using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;

constexpr const char* kRange = "pattern.out_of_range";

// Share of a line that is no reason for one line more: widths that divide the way around come with
// rounding.
constexpr double kSameCount = 1e-9;

// Of an integral, relative: a few hundred units of rounding, below which its error cannot be
// estimated. The integrands are smooth, so few halvings reach it.
constexpr double kIntegral = 1e-13;
constexpr unsigned kHalvings = 6;

// dtheta/dphi = c r / (rho sqrt(rho^2 - c^2)), ds/dphi = r rho / sqrt(rho^2 - c^2). The root nearly
// vanishes at the inner equator where a line hardly passes it. On the inner half of the tube
// tan((pi - phi) / 2) = sqrt(d / (d + 2 r)) sinh(u), d = R - r - c, takes it out:
// dphi / sqrt(rho - c) = 2 / sqrt(d + 2 r) cos((pi - phi) / 2) du.
class Geodesic {
public:
    explicit Geodesic(const TorusElbow& elbow)
        : ring_mm_(elbow.ring_radius_mm),
          tube_mm_(elbow.tube_radius_mm),
          clairaut_mm_(elbow.clairaut_mm()) {
        half_ = part(kPi);
    }

    [[nodiscard]] double rho_mm(double phi) const { return ring_mm_ + tube_mm_ * std::cos(phi); }
    [[nodiscard]] double alpha_rad(double phi) const {
        return std::acos(clairaut_mm_ / rho_mm(phi));
    }
    [[nodiscard]] TorusCycle cycle() const {
        return {2.0 * half_.theta_rad, 2.0 * half_.length_mm};
    }

    /// From 0 to any phi: whole cycles, and what is left of at most half of one.
    [[nodiscard]] TorusCycle up_to(double phi) const {
        const double cycles = std::round(phi / (2.0 * kPi));
        const TorusCycle rest = part(phi - cycles * 2.0 * kPi);
        return {2.0 * cycles * half_.theta_rad + rest.theta_rad,
                2.0 * cycles * half_.length_mm + rest.length_mm};
    }

    /// Where theta has grown by so much since phi = 0.
    [[nodiscard]] double phi_at(double theta) const {
        const double halves = std::round(theta / (2.0 * half_.theta_rad)) * 2.0;
        const double wanted = theta - halves * half_.theta_rad;
        return halves * kPi + std::copysign(phi_within(std::abs(wanted)), wanted);
    }

private:
    // 0 <= wanted <= half a cycle's theta, but for rounding
    [[nodiscard]] double phi_within(double wanted) const {
        if (wanted <= 0.0) {
            return 0.0;
        }
        if (wanted >= half_.theta_rad) {
            return kPi;
        }
        const auto excess = [&](double phi) { return integral(true, phi) - wanted; };
        return zero_between({0.0, kPi, -wanted, half_.theta_rad - wanted}, excess).middle();
    }

    // From 0, |phi| <= pi.
    [[nodiscard]] TorusCycle part(double phi) const {
        return {integral(true, phi), integral(false, phi)};
    }
    [[nodiscard]] double integral(bool of_theta, double phi) const {
        const double way = std::abs(phi);
        const double turned = 0.5 * kPi;
        const double sum = way <= turned ? outer(of_theta, way)
                                         : outer(of_theta, turned) + inner(of_theta, turned) -
                                               inner(of_theta, way);
        return std::copysign(sum, phi);
    }
    // From 0 to phi <= pi / 2.
    [[nodiscard]] double outer(bool of_theta, double phi) const {
        const auto integrand = [&](double p) {
            const double rho = rho_mm(p);
            return rate(of_theta, rho) / std::sqrt(rho - clairaut_mm_);
        };
        return Quadrature::integrate(integrand, 0.0, phi, kHalvings, kIntegral);
    }
    // From phi >= pi / 2 to pi.
    [[nodiscard]] double inner(bool of_theta, double phi) const {
        const double spare_mm = ring_mm_ - tube_mm_ - clairaut_mm_;
        const double width_mm = spare_mm + 2.0 * tube_mm_;
        const double scale = std::sqrt(spare_mm / width_mm);
        const auto integrand = [&](double u) {
            const double tangent = scale * std::sinh(u);
            const double cos2 = 1.0 / (1.0 + tangent * tangent);
            const double rho = ring_mm_ - tube_mm_ * (2.0 * cos2 - 1.0);
            return rate(of_theta, rho) * 2.0 * std::sqrt(cos2 / width_mm);
        };
        const double end = std::asinh(std::tan(0.5 * std::max(0.0, kPi - phi)) / scale);
        return Quadrature::integrate(integrand, 0.0, end, kHalvings, kIntegral);
    }
    // dtheta/dphi or ds/dphi, times sqrt(rho - c).
    [[nodiscard]] double rate(bool of_theta, double rho) const {
        return tube_mm_ * (of_theta ? clairaut_mm_ / rho : rho) / std::sqrt(rho + clairaut_mm_);
    }

    double ring_mm_;
    double tube_mm_;
    double clairaut_mm_;
    TorusCycle half_;
};

void require_count(int count) {
    require(count > 0, kRange, "count", count, "above", 0.0);
}

TorusLine line_through(const TorusElbow& elbow, const Geodesic& geodesic, double theta) {
    const auto place_mm = [&](double at_theta, double phi) -> Eigen::Vector3d {
        const double rho = geodesic.rho_mm(phi);
        return {rho * std::cos(at_theta), rho * std::sin(at_theta),
                elbow.tube_radius_mm * std::sin(phi)};
    };
    const double half = 0.5 * elbow.span_rad;
    TorusLine line;
    line.theta_rad = theta;
    line.phi_minus_rad = geodesic.phi_at(-half - theta);
    line.phi_plus_rad = geodesic.phi_at(half - theta);
    line.minus_mm = place_mm(-half, line.phi_minus_rad);
    line.plus_mm = place_mm(half, line.phi_plus_rad);
    line.length_mm =
        geodesic.up_to(line.phi_plus_rad).length_mm - geodesic.up_to(line.phi_minus_rad).length_mm;
    return line;
}

}  // namespace

void TorusElbow::validate() const {
    require(ring_radius_mm > 0.0 && std::isfinite(ring_radius_mm), kRange, "ring_radius_mm",
            ring_radius_mm, "a finite number above", 0.0);
    require(tube_radius_mm > 0.0, kRange, "tube_radius_mm", tube_radius_mm, "above", 0.0);
    require(tube_radius_mm < ring_radius_mm, kRange, "tube_radius_mm", tube_radius_mm,
            "less than the ring radius", ring_radius_mm);
    require(span_rad > 0.0 && span_rad <= 2.0 * kPi, kRange, "span_rad", span_rad,
            "above 0 and at most", 2.0 * kPi);
    require(alpha0_rad < 0.5 * kPi, kRange, "alpha0_rad", alpha0_rad, "below", 0.5 * kPi);
    const double least =
        std::acos((ring_radius_mm - tube_radius_mm) / (ring_radius_mm + tube_radius_mm));
    require(alpha0_rad > least, kRange, "alpha0_rad", alpha0_rad,
            "above, to pass the inner equator,", least);
}

double TorusElbow::clairaut_mm() const {
    return (ring_radius_mm + tube_radius_mm) * std::cos(alpha0_rad);
}

TorusCycle torus_cycle(const TorusElbow& elbow) {
    elbow.validate();
    return Geodesic(elbow).cycle();
}

int lines_for_tape(const TorusElbow& elbow, double width_mm) {
    const double around_mm = (elbow.ring_radius_mm + elbow.tube_radius_mm) *
                             torus_cycle(elbow).theta_rad * std::sin(elbow.alpha0_rad);
    require(width_mm > 0.0, kRange, "width_mm", width_mm, "above", 0.0);
    constexpr double kMaxLines = 1e6;  // far more than can be wound
    require(around_mm / width_mm <= kMaxLines, kRange, "width_mm", width_mm, "at least",
            around_mm / kMaxLines);
    return static_cast<int>(std::ceil(around_mm / width_mm - kSameCount));
}

double line_spacing_mm(const TorusElbow& elbow, int count, double phi_rad) {
    elbow.validate();
    require_count(count);
    const Geodesic geodesic(elbow);
    return geodesic.cycle().theta_rad / count * geodesic.rho_mm(phi_rad) *
           std::sin(geodesic.alpha_rad(phi_rad));
}

TorusLine torus_line(const TorusElbow& elbow, double theta_rad) {
    elbow.validate();
    require(std::isfinite(theta_rad), kRange, "theta_rad", theta_rad, "finite, as is", 0.0);
    return line_through(elbow, Geodesic(elbow), theta_rad);
}

std::vector<TorusLine> torus_lines(const TorusElbow& elbow, int count) {
    elbow.validate();
    require_count(count);
    const Geodesic geodesic(elbow);
    std::vector<TorusLine> lines;
    lines.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        lines.push_back(line_through(elbow, geodesic, geodesic.cycle().theta_rad * i / count));
    }
    return lines;
}

TorusStation torus_station(const TorusElbow& elbow, double phi_rad) {
    elbow.validate();
    require(std::isfinite(phi_rad), kRange, "phi_rad", phi_rad, "finite, as is", 0.0);
    const Geodesic geodesic(elbow);
    const TorusCycle since = geodesic.up_to(phi_rad);
    return {since.theta_rad, since.length_mm, geodesic.alpha_rad(phi_rad)};
}

}  // namespace meshwind
