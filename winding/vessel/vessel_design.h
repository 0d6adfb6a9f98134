/// Design of vessels with isotensoid domes: figures of each winding angle, before any mesh is made.
#pragma once

#include <optional>
#include <vector>

#include "mesh/shapes/isotensoid.h"
#include "winding/vessel/dome_pass.h"

namespace meshwind {

/// Stiffness of one ply, along the fibres and across them in its plane.
struct PlyStiffness {
    double e1_gpa = 0.0;
    double e2_gpa = 0.0;
    double nu12 = 0.0;
};

/// k_e = E2 (1 + nu12) / (E1 (1 + nu21)) with nu21 = nu12 E2 / E1, as reciprocity asks. Source: eq.
/// (8) of chen_2023_gas_cylinders, whose number for it takes nu21 = nu12.
/// \throws InputError vessel.stiffness
[[nodiscard]] double stiffness_ratio(const PlyStiffness& ply);

/// A cylinder with two equal domes and the band it is wound with, all the way by one angle.
struct VesselDesign {
    double radius_mm = 75.0;
    double opening_radius_mm = 25.0;
    double cylinder_length_mm = 200.0;
    double stiffness_ratio = 0.1;   ///< k_e of the domes; 0.1: carbon in epoxy, nearly
    double design_radius_mm = 0.0;  ///< Clairaut radius the domes are made for; 0: the opening's
    double band_mm = 6.0;
    double ply_mm = 0.25;                          ///< thickness of the band
    double density_kg_m3 = 1550.0;                 ///< of the band; carbon in epoxy, 60 % fibres
    std::optional<double> wall_mm = std::nullopt;  ///< wanted on the cylinder, of the wound angle
    std::optional<double> pressure_mpa = std::nullopt;  ///< to hold, instead of a wall
    double strength_mpa = 0.0;  ///< along the fibres, over the whole band; with pressure_mpa
    std::vector<double> angles_rad = {};  ///< on the cylinder, from the axis, 0 to pi / 2 exclusive

    [[nodiscard]] IsotensoidDesign dome() const;

    /// \throws InputError vessel.not_positive, vessel.opening, vessel.angle, vessel.demand; what
    /// the dome's validate throws
    void validate() const;
};

/// Mean number of layers of a band laid `passes` times along a cylinder; each hand counts.
/// Source: eq. (25) of chen_2023_gas_cylinders with the divisor 2 pi rho that its print lacks.
[[nodiscard]] double layers_on_cylinder(double passes, double band_mm, double radius_mm,
                                        double angle_rad);

/// Bands whose fibres turn evenly spread over a band's width about the Clairaut radius.
struct TurningBand {
    double clairaut_mm = 0.0;
    double band_mm = 0.0;
    double ply_mm = 0.0;
    double passes = 0.0;  ///< from equator to turning circle, or back
};

/// Thickness at the radius Y of a dome,
///     passes ply / (2 pi) (asin(min(c_out, Y) / Y) - asin(min(c_in, Y) / Y)),
/// c_in and c_out half a band inside and outside the Clairaut radius. A fibre that turns at c
/// crosses the parallel at the angle asin(c / Y); the fibres of the width dc of all passes take up
/// passes dc / cos of that parallel, and the sum over the band is the formula. The thickness of a
/// single line, ~ 1 / sqrt(Y^2 - c^2), has no bound at its turn; this has its largest value at
/// c_out. No fibre is lost or added: tests/winding/vessel/vessel_design_test.cpp.
[[nodiscard]] double thickness_on_dome_mm(const TurningBand& band, double radius_mm);

/// Figures of one winding angle.
struct VesselAngle {
    double angle_rad = 0.0;
    double clairaut_mm = 0.0;        ///< R sin(angle): where a geodesic turns
    double cylinder_turn_rad = 0.0;  ///< about the axis, along the cylinder once
    /// None: the Clairaut radius is inside the opening, no geodesic of this angle turns on the
    /// dome.
    std::optional<DomePass> pass;
    /// Where it is none: the constant slip ratio on the dome that turns the fibre at the opening.
    std::optional<double> slip;
    int circuits = 0;     ///< to and fro; enough for the demand, or for one layer of each hand
    double layers = 0.0;  ///< of the wound angle, on the cylinder
    int hoop_layers = 0;  ///< on the cylinder besides, where a pressure is wanted

    // Of geodesics alone; zero otherwise.
    double circuit_turn_rad = 0.0;  ///< about the axis, both ways and both domes
    double circuit_length_mm = 0.0;
    double fibre_length_mm = 0.0;  ///< all circuits and hoops
    double mass_kg = 0.0;
    double thickest_mm = 0.0;  ///< on the dome, half a band outside the turning circle

    [[nodiscard]] TurningBand band(const VesselDesign& design) const;
};

/// One row for each angle, in their order.
///
/// A pressure p with fibres of strength S along them alone needs, on the cylinder, the thickness
/// p R / (2 S cos^2(angle)) of the wound angle against the axial force, and hoops for the rest of
/// p R around it: p R / S - thickness sin^2(angle). The domes are then strained like the axial
/// direction. \throws InputError what validate throws
[[nodiscard]] std::vector<VesselAngle> vessel_angles(const VesselDesign& design);

}  // namespace meshwind
