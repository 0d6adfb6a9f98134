#include "winding/vessel/cylinder_circuit.h"

#include <cmath>

#include "core/units.h"
#include "mesh/shapes/make_checks.h"
#include "winding/turn/turn.h"

namespace meshwind {

void CylinderCircuit::validate() const {
    const char* const code = "pattern.out_of_range";
    require(radius_mm > 0.0 && std::isfinite(radius_mm), code, "radius_mm", radius_mm,
            "a finite number above", 0.0);
    require(regular_mm >= 0.0 && std::isfinite(regular_mm), code, "regular_mm", regular_mm,
            "a finite number from", 0.0);
    require(angle_rad > 0.0, code, "angle_rad", angle_rad, "above", 0.0);
    require(angle_rad < 0.5 * kPi, code, "angle_rad", angle_rad, "below", 0.5 * kPi);
    if (slip) {
        require(*slip > 0.0 && std::isfinite(*slip), code, "slip", *slip, "a finite number above",
                0.0);
    }
}

CircuitTurns circuit_turns(const CylinderCircuit& circuit) {
    circuit.validate();
    const double radius_mm = circuit.radius_mm;
    const double beta = circuit.angle_rad;
    CircuitTurns turns;
    turns.regular_rad = circuit.regular_mm * std::tan(beta) / radius_mm;
    double turn_fibre_mm = 0.0;
    if (circuit.slip) {
        turns.run_mm = turn_run_mm(radius_mm, beta, *circuit.slip);
        turns.turn_rad = turn_angle_rad(beta, *circuit.slip);
        turn_fibre_mm = radius_mm / (*circuit.slip * std::tan(beta));
    }
    turns.circuit_rad = 2.0 * turns.regular_rad + 4.0 * turns.turn_rad;
    turns.mandrel_mm = circuit.regular_mm + 2.0 * turns.run_mm;
    turns.fibre_mm = 2.0 * circuit.regular_mm / std::cos(beta) + 4.0 * turn_fibre_mm;
    return turns;
}

double band_angle_rad(double band_mm, double radius_mm, double angle_rad) {
    return band_mm / (radius_mm * std::cos(angle_rad));
}

}  // namespace meshwind
