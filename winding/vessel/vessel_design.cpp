#include "winding/vessel/vessel_design.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

// From a micrometre to a kilometre: beyond, no vessel is wound, and squares of the numbers leave
// what a double holds.
constexpr double kLeast_mm = 1e-3;
constexpr double kMost_mm = 1e6;

// Narrower openings are points beside the radius; their domes cannot be told from that of a pole.
constexpr double kMinOpening = 1e-4;

// Pressures, strengths, stiffnesses and densities of anything that is wound, with room.
constexpr double kMinProperty = 1e-6;
constexpr double kMaxProperty = 1e9;

// A count that comes out a whole number but for rounding is that number.
constexpr double kWhole = 1e-9;

std::string text_of(double value) {
    std::string text;
    if (!std::isfinite(value)) {
        return std::isnan(value) ? "not a number" : "infinity";
    }
    append_shortest(text, value);
    return text;
}

void require_above_zero(const char* name, double value) {
    if (!(value > 0.0) || std::isinf(value)) {
        throw InputError("vessel.not_positive", name,
                         text_of(value) + " must be a finite number > 0");
    }
}

void require_between(const char* name, double value, double least, double most) {
    require_above_zero(name, value);
    if (value < least || value > most) {
        throw InputError(
            "vessel.out_of_range", name,
            text_of(value) + " must be between " + text_of(least) + " and " + text_of(most));
    }
}

void require_length(const char* name, double value_mm) {
    require_between(name, value_mm, kLeast_mm, kMost_mm);
}

void require_property(const char* name, double value) {
    require_between(name, value, kMinProperty, kMaxProperty);
}

void check_demand(const VesselDesign& design) {
    if (design.wall_mm && design.pressure_mpa) {
        throw InputError("vessel.demand", "wall",
                         "and a pressure are both wanted; name one of them");
    }
    if (design.wall_mm) {
        require_length("wall", *design.wall_mm);
    }
    if (design.pressure_mpa) {
        require_property("pressure", *design.pressure_mpa);
        require_property("strength", design.strength_mpa);
    }
}

// Whole layers or circuits. \throws InputError where no vessel has so many
int whole_count(double wanted) {
    constexpr double kMost = 1e6;
    if (!(wanted <= kMost)) {
        throw InputError("vessel.demand", "wall, pressure",
                         "needs more than a million layers or circuits; ask for less");
    }
    return static_cast<int>(std::ceil(wanted - kWhole));
}

// Of the wound angle on the cylinder.
double wanted_layers(const VesselDesign& design, double angle_rad) {
    if (design.wall_mm) {
        return *design.wall_mm / design.ply_mm;
    }
    if (design.pressure_mpa) {
        const double axial = std::pow(std::cos(angle_rad), 2);
        return *design.pressure_mpa * design.radius_mm / (2.0 * design.strength_mpa * axial) /
               design.ply_mm;
    }
    return 2.0;
}

int wanted_hoops(const VesselDesign& design, const VesselAngle& row) {
    if (!design.pressure_mpa) {
        return 0;
    }
    const double around = *design.pressure_mpa * design.radius_mm / design.strength_mpa;
    const double wound = row.layers * design.ply_mm * std::pow(std::sin(row.angle_rad), 2);
    return whole_count(std::max(0.0, around - wound) / design.ply_mm);
}

// One strip around the cylinder, pitch by pitch of a band.
double hoop_length_mm(const VesselDesign& design) {
    const double turns = design.cylinder_length_mm / design.band_mm;
    return turns * std::hypot(2.0 * kPi * design.radius_mm, design.band_mm);
}

void add_geodesic(const VesselDesign& design, const IsotensoidDome& dome, VesselAngle& row) {
    row.pass = geodesic_pass(dome, row.clairaut_mm);
    row.circuit_turn_rad = 2.0 * (row.cylinder_turn_rad + row.pass->turn_rad);
    row.circuit_length_mm =
        2.0 * design.cylinder_length_mm / std::cos(row.angle_rad) + 4.0 * row.pass->length_mm;
    row.fibre_length_mm =
        row.circuits * row.circuit_length_mm + row.hoop_layers * hoop_length_mm(design);
    constexpr double kCubicMetre = 1e-9;  // of a cubic millimetre
    row.mass_kg =
        row.fibre_length_mm * design.band_mm * design.ply_mm * kCubicMetre * design.density_kg_m3;
    const double outer = std::min(row.clairaut_mm + 0.5 * design.band_mm, design.radius_mm);
    row.thickest_mm = thickness_on_dome_mm(row.band(design), outer);
}

}  // namespace

double stiffness_ratio(const PlyStiffness& ply) {
    const double share = ply.e2_gpa / ply.e1_gpa;
    if (!std::isfinite(ply.nu12)) {
        throw InputError("vessel.stiffness", "nu12", "must be a finite number");
    }
    if (!(ply.e1_gpa > 0.0) || !(ply.e2_gpa > 0.0) || !(share < 1.0) || !std::isfinite(share)) {
        throw InputError("vessel.stiffness", "e1, e2",
                         "must be above 0, and the stiffness along the fibres, e1, the larger");
    }
    // A ply under any load stores energy only where nu12^2 < E1 / E2.
    if (!(std::abs(ply.nu12) < 1.0 / std::sqrt(share))) {
        throw InputError("vessel.stiffness", "nu12",
                         text_of(ply.nu12) + " must be less than sqrt(e1 / e2), " +
                             text_of(1.0 / std::sqrt(share)));
    }
    return share * (1.0 + ply.nu12) / (1.0 + ply.nu12 * share);
}

IsotensoidDesign VesselDesign::dome() const {
    return {radius_mm, design_radius_mm != 0.0 ? design_radius_mm : opening_radius_mm,
            stiffness_ratio};
}

void VesselDesign::validate() const {
    require_length("radius", radius_mm);
    require_between("opening", opening_radius_mm, kMinOpening * radius_mm, kMost_mm);
    require_length("length", cylinder_length_mm);
    require_length("band", band_mm);
    require_length("thickness", ply_mm);
    require_property("density", density_kg_m3);
    if (design_radius_mm != 0.0) {
        require_between("design-radius", design_radius_mm, kMinOpening * radius_mm, kMost_mm);
    }
    check_demand(*this);
    if (opening_radius_mm >= radius_mm) {
        throw InputError(
            "vessel.opening", "opening",
            text_of(opening_radius_mm) + " must be less than the radius, " + text_of(radius_mm));
    }
    const double least = IsotensoidDome(dome()).least_radius_mm();
    if (opening_radius_mm < least) {
        throw InputError("vessel.opening", "opening",
                         text_of(opening_radius_mm) + " is narrower than where the dome turns " +
                             "back, " + fixed(least, 3) +
                             "; give a wider one, a smaller design radius or a larger ke");
    }
    if (angles_rad.empty()) {
        throw InputError("vessel.angle", "angles", "are none; give degrees from the axis");
    }
    for (const double angle : angles_rad) {
        if (!(angle > 0.0 && angle < 0.5 * kPi)) {
            throw InputError(
                "vessel.angle", "angles",
                text_of(deg_from_rad(angle)) + " must be between 0 and 90 degrees from the axis");
        }
    }
}

double layers_on_cylinder(double passes, double band_mm, double radius_mm, double angle_rad) {
    return passes * band_mm / (2.0 * kPi * radius_mm * std::cos(angle_rad));
}

double thickness_on_dome_mm(const TurningBand& band, double radius_mm) {
    const auto crossing = [&](double clairaut_mm) {
        return std::asin(std::clamp(clairaut_mm / radius_mm, 0.0, 1.0));
    };
    const double half = 0.5 * band.band_mm;
    return band.passes * band.ply_mm / (2.0 * kPi) *
           (crossing(band.clairaut_mm + half) - crossing(band.clairaut_mm - half));
}

TurningBand VesselAngle::band(const VesselDesign& design) const {
    return {clairaut_mm, design.band_mm, design.ply_mm, 2.0 * circuits};
}

std::vector<VesselAngle> vessel_angles(const VesselDesign& design) {
    design.validate();
    const IsotensoidDome dome(design.dome());
    std::vector<VesselAngle> rows;
    for (const double angle : design.angles_rad) {
        VesselAngle& row = rows.emplace_back();
        row.angle_rad = angle;
        row.clairaut_mm = design.radius_mm * std::sin(angle);
        row.cylinder_turn_rad = design.cylinder_length_mm * std::tan(angle) / design.radius_mm;
        const double circuit_layers =
            layers_on_cylinder(2.0, design.band_mm, design.radius_mm, angle);
        row.circuits = std::max(1, whole_count(wanted_layers(design, angle) / circuit_layers));
        row.layers = row.circuits * circuit_layers;
        row.hoop_layers = wanted_hoops(design, row);
        // At the least radius itself a geodesic circles for ever.
        if (row.clairaut_mm >= design.opening_radius_mm &&
            row.clairaut_mm > dome.least_radius_mm()) {
            add_geodesic(design, dome, row);
        } else {
            row.slip = slip_to_turn(dome, row.clairaut_mm, design.opening_radius_mm);
        }
    }
    return rows;
}

}  // namespace meshwind
