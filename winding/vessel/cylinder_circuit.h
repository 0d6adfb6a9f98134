/// One circuit on a cylinder in closed form, as input of a pattern: helix, turn, helix back, turn.
#pragma once

#include <optional>

namespace meshwind {

struct CylinderCircuit {
    double radius_mm = 0.0;   ///< > 0
    double regular_mm = 0.0;  ///< >= 0: axial length of the helix
    double angle_rad = 0.0;   ///< beta of the helix from the axis, 0 < beta < pi / 2
    /// > 0: constant slip ratio with which the fibre is steered to hoop and back beyond the helix;
    /// nothing: it is turned on the spot, by pins.
    std::optional<double> slip{};

    /// \throws InputError pattern.out_of_range
    void validate() const;
};

/// Angles of a circuit: turns of the landing point around the axis.
struct CircuitTurns {
    double regular_rad = 0.0;  ///< Phi_c, eq. (2): regular tan(beta) / R
    double turn_rad = 0.0;     ///< Phi_t, eq. (4): from the helix to hoop, once
    double circuit_rad = 0.0;  ///< Phi_1 = 2 Phi_c + 4 Phi_t, eq. (5)
    double run_mm = 0.0;       ///< l_t, eq. (1): axial length from the helix to hoop
    double mandrel_mm = 0.0;   ///< regular + 2 l_t: the least length of the mandrel
    double fibre_mm = 0.0;     ///< of the circuit
};

/// Source: andrianov_2022_machine_path, the equations named; (1) with the bracket for pi / 4 that
/// its print lacks. \throws InputError pattern.out_of_range
[[nodiscard]] CircuitTurns circuit_turns(const CylinderCircuit& circuit);

/// Angle of the circle that a band covers, Phi_w: band / (R cos(beta)). \pre all > 0, beta below
/// pi / 2. Source: andrianov_2022_machine_path, eq. (8).
[[nodiscard]] double band_angle_rad(double band_mm, double radius_mm, double angle_rad);

}  // namespace meshwind
