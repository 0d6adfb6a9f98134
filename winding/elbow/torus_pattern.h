/// Geodesics around the tube of a torus elbow in closed form, and the number of them for a tape.
///
/// The ring lies around z, as make_torus() has it, but theta counts from the middle of the elbow,
/// at +x, towards +y; phi counts around the tube from the outer equator towards +z, unwrapped:
/// ((R + r cos phi) cos theta, (R + r cos phi) sin theta, r sin phi). alpha is the angle from the
/// direction of growing theta towards that of growing phi. The other hand is the mirror image in z.
/// Source: dimovski_2018_elbows, sec. 2 (there y and z are exchanged).
#pragma once

#include <vector>

#include <Eigen/Core>

namespace meshwind {

struct TorusElbow {
    double ring_radius_mm = 0.0;  ///< R
    double tube_radius_mm = 0.0;  ///< 0 < r < R
    double span_rad = 0.0;        ///< 0 < span <= 2 pi, theta from -span / 2 to +span / 2
    double alpha0_rad = 0.0;      ///< at the outer equator, below pi / 2 and so steep that the
                                  ///< line passes the inner one: (R + r) cos(alpha0) < R - r

    /// \throws InputError pattern.out_of_range
    void validate() const;

    /// (R + r cos phi) cos alpha, the same all along a geodesic. Eq. (15).
    [[nodiscard]] double clairaut_mm() const;
};

/// Once around the tube, from phi to phi + 2 pi.
struct TorusCycle {
    double theta_rad = 0.0;  ///< theta_cycle, eq. (17)
    double length_mm = 0.0;
};

/// Accuracy: theta_cycle to 1e-12 rad (tests/winding/elbow/torus_pattern_test.cpp).
/// \throws InputError pattern.out_of_range
[[nodiscard]] TorusCycle torus_cycle(const TorusElbow& elbow);

/// M: the least number of lines, evenly spaced in theta over one cycle, whose tapes leave no gap at
/// the outer equator, where they are farthest apart: ceil((R + r) theta_cycle sin(alpha0) / width),
/// eq. (18). \param width_mm > 0 \throws InputError pattern.out_of_range
[[nodiscard]] int lines_for_tape(const TorusElbow& elbow, double width_mm);

/// Distance of neighbours among `count` lines at phi, at right angles to them:
/// theta_cycle / count sqrt((R + r cos phi)^2 - c^2).
/// \param count > 0 \throws InputError pattern.out_of_range
[[nodiscard]] double line_spacing_mm(const TorusElbow& elbow, int count, double phi_rad);

/// The geodesic through (theta, 0), from one end of the elbow to the other.
struct TorusLine {
    double theta_rad = 0.0;
    double phi_minus_rad = 0.0;  ///< where it is at theta = -span / 2
    double phi_plus_rad = 0.0;   ///< and at +span / 2
    Eigen::Vector3d minus_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d plus_mm = Eigen::Vector3d::Zero();
    double length_mm = 0.0;
};

/// Accuracy: phi to 1e-11 rad. \param theta_rad any finite value: beyond the elbow it is the line
/// that would pass there. \throws InputError pattern.out_of_range
[[nodiscard]] TorusLine torus_line(const TorusElbow& elbow, double theta_rad);

/// `count` lines through theta = i theta_cycle / count, i = 0 .. count - 1, eq. (19).
/// \param count > 0 \throws InputError pattern.out_of_range
[[nodiscard]] std::vector<TorusLine> torus_lines(const TorusElbow& elbow, int count);

/// Place of a line at phi, counted from phi = 0 (may be negative): theta, length, and alpha there.
struct TorusStation {
    double theta_rad = 0.0;  ///< since phi = 0, signed; eq. (16)
    double length_mm = 0.0;  ///< since phi = 0, signed
    double alpha_rad = 0.0;
};

/// \throws InputError pattern.out_of_range
[[nodiscard]] TorusStation torus_station(const TorusElbow& elbow, double phi_rad);

}  // namespace meshwind
