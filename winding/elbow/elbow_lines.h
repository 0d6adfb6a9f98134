/// Fibre lines on an elbow of straight leg, bend and straight leg, without a mesh. They are
/// geodesics through the bend, steered on the legs until they run evenly.
///
/// Places on the tube: `along_mm` of the centre line, and phi about it, from the outer equator,
/// unwrapped. All lines here wind with phi growing along the tube; the other hand is their mirror
/// image in the plane of the bend.
#pragma once

#include <array>
#include <vector>

#include "winding/elbow/torus_pattern.h"

namespace meshwind {

struct ElbowTube {
    double tube_radius_mm = 0.0;
    double ring_radius_mm = 0.0;
    double span_rad = 0.0;
    std::array<double, 2> leg_mm{};  ///< >= 0, before and after the bend

    [[nodiscard]] double bend_mm() const { return ring_radius_mm * span_rad; }
    [[nodiscard]] double length_mm() const { return leg_mm[0] + bend_mm() + leg_mm[1]; }
};

struct ElbowOptions {
    double alpha0_rad = 0.0;  ///< angle to the tube's axis at the outer equator
    double width_mm = 6.0;
    double slip = 0.15;       ///< largest |slip ratio| of the steering on the legs
    double layers = 1.0;      ///< >= 1: of either hand, where they are fewest
    double station_mm = 4.0;  ///< largest distance of stations
};

struct ElbowStation {
    double along_mm = 0.0;
    double phi_rad = 0.0;
    double angle_rad = 0.0;  ///< from the centre line towards growing phi
    double s_mm = 0.0;       ///< along the line
    double kn_per_mm = 0.0;  ///< of the tube; where leg and bend meet that of the bend
};

/// The lines on a leg, from the bend outward.
struct ElbowLeg {
    double run_mm = 0.0;     ///< over which they are steered; beyond it they are helices
    double angle_rad = 0.0;  ///< of all lines beyond it, where `even` is 1
    /// Evenness that the slip allows, from geodesics (0) to one angle and even distances (1).
    double even = 0.0;
    double slip = 0.0;       ///< largest |slip ratio|
    double widest_mm = 0.0;  ///< largest distance of neighbours, square to them
    double closed_mm = 0.0;  ///< from the bend on, as far as that is at most the width
};

struct ElbowLines {
    TorusElbow bend;
    int needed = 0;  ///< dimovski_2018_elbows, eq. (18), for the layers asked for
    double theta_cycle_rad = 0.0;
    std::array<ElbowLeg, 2> leg;
    std::vector<std::vector<ElbowStation>> line;  ///< M; from the first rim to the second

    [[nodiscard]] int count() const { return static_cast<int>(line.size()); }

    /// Distance of neighbours on the bend, square to them.
    [[nodiscard]] double spacing_mm(double phi_rad) const;
};

/// Least alpha0 at which lines pass the inner equator and do not lift off there:
/// tan(alpha)^2 >= r / (R - r) and (R + r) cos(alpha0) = (R - r) cos(alpha).
[[nodiscard]] double least_elbow_angle_rad(const ElbowTube& tube);

/// M lines. On the bend they are theta_cycle / M apart in theta (torus_pattern.h). They meet the
/// legs with different angles, steep outside and flat inside, and as geodesics would cross within
/// about a radius on one side and leave gaps on the other. Each is steered by two constant slip
/// ratios, one after the other, so that after a common run all lines have one angle and even
/// distances. With u = 1 / sin(angle) on a cylinder of radius r
///
///     du/dz = -slip / r,   dphi/dz = 1 / (r sqrt(u^2 - 1))
///
/// so u at half the run decides, and the way around is (acosh(u1) - acosh(u0)) / (u1 - u0) dz / r.
/// Among the runs and angles that the slip allows it takes those that leave no gap with the least
/// fibre, or else the least gaps. M is eq. (18), or more where lines on the legs are farther apart
/// than the width; at most half as many again, and then `closed_mm` says how far the legs are
/// closed. Accuracy: tests/winding/elbow/elbow_lines_test.cpp. \throws InputError
/// pattern.out_of_range
[[nodiscard]] ElbowLines elbow_lines(const ElbowTube& tube, const ElbowOptions& options);

}  // namespace meshwind
