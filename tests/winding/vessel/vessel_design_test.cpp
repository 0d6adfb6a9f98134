#include "winding/vessel/vessel_design.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "core/error.h"
#include "core/units.h"
#include "tests/support/gas_cylinder.h"

namespace meshwind {
namespace {

using Json = nlohmann::json;
using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;

// The published vessel in mm.
VesselDesign published_design(const Json& ref, const std::vector<double>& angles_deg) {
    VesselDesign design;
    design.radius_mm = 10.0 * ref["radius"].get<double>();
    design.opening_radius_mm = 10.0 * ref["opening"].get<double>();
    design.cylinder_length_mm = 10.0 * ref["length"].get<double>();
    design.stiffness_ratio = ref["k_e"]["as_printed"];
    design.band_mm = 10.0 * ref["band"].get<double>();
    for (const double angle : angles_deg) {
        design.angles_rad.push_back(rad_from_deg(angle));
    }
    return design;
}

TEST(StiffnessRatio, KeepsReciprocity) {
    const Json ref = test::gas_cylinder();
    const PlyStiffness ply{ref["E1"], ref["E2"], ref["nu12"]};
    EXPECT_NEAR(stiffness_ratio(ply), ref["k_e"]["value"].get<double>(), 1e-10);
    // The print is E2 / E1 to its last digit.
    EXPECT_NEAR(ply.e2_gpa / ply.e1_gpa, ref["k_e"]["printed"].get<double>(), 5e-6);
    EXPECT_NEAR(ply.e2_gpa / ply.e1_gpa, ref["k_e"]["as_printed"].get<double>(), 1e-10);
    for (const PlyStiffness& bad :
         {PlyStiffness{0.0, 10.0, 0.3}, PlyStiffness{130.0, 0.0, 0.3},
          PlyStiffness{10.0, 10.0, 0.3}, PlyStiffness{130.0, 10.0, 4.0},
          PlyStiffness{130.0, 10.0, std::nan("")}, PlyStiffness{std::nan(""), 10.0, 0.3}}) {
        EXPECT_THROW((void)stiffness_ratio(bad), InputError);
    }
}

// The print cuts the digits off.
TEST(LayersOnCylinder, AreThoseOfTable3) {
    const Json ref = test::gas_cylinder();
    ASSERT_EQ(ref["layers"].size(), 7U);
    for (const Json& row : ref["layers"]) {
        const double circuits = row["i"].get<double>() * row["s"].get<double>();
        const double layers = layers_on_cylinder(2.0 * circuits, ref["band"], ref["radius"],
                                                 rad_from_deg(row["angle_deg"]));
        EXPECT_NEAR(layers, row["value"].get<double>(), 1e-9) << row;
        const double printed = std::stod(row["printed"].get<std::string>());
        EXPECT_EQ(std::floor(layers * 1e4), std::round(printed * 1e4)) << row;
    }
}

TEST(VesselAngles, SayWhichAreGeodesic) {
    const Json ref = test::gas_cylinder();
    const double least = ref["least_geodesic_angle_deg"];
    const auto rows = vessel_angles(
        published_design(ref, {10.0, 15.0, 20.0, least - 1e-6, least + 1e-6, 25.0, 40.0}));
    EXPECT_NEAR(rows[1].clairaut_mm, 10.0 * ref["clairaut_15"]["value"].get<double>(), 1e-9);
    EXPECT_NEAR(rows[1].clairaut_mm, 10.0 * ref["clairaut_15"]["printed"].get<double>(), 5e-4);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].pass.has_value(), i >= 4) << i;
        EXPECT_EQ(rows[i].slip.has_value(), i < 4) << i;
        EXPECT_EQ(rows[i].fibre_length_mm > 0.0, i >= 4) << i;
    }
    // The steeper the less; none at the limit.
    EXPECT_GT(*rows[0].slip, *rows[1].slip);
    EXPECT_GT(*rows[1].slip, *rows[2].slip);
    EXPECT_LT(*rows[3].slip, 1e-6);
    EXPECT_NEAR(std::sin(rad_from_deg(ref["literal_angle_deg"])) * ref["radius"].get<double>(), 1.0,
                1e-9);
}

TEST(VesselAngles, HaveThePublishedLengthsAndTurns) {
    const Json ref = test::gas_cylinder();
    for (const Json& row : ref["geodesics"]) {
        if (row["dome"] != "c1.5") {
            continue;
        }
        const auto got = vessel_angles(published_design(ref, {row["angle_deg"]})).front();
        ASSERT_TRUE(got.pass);
        EXPECT_NEAR(got.pass->length_mm, 10.0 * row["pass_length"].get<double>(), 1e-7);
        EXPECT_NEAR(got.circuit_length_mm, 10.0 * row["circuit_length"].get<double>(), 1e-7);
        EXPECT_NEAR(std::fmod(got.circuit_turn_rad, 2.0 * kPi),
                    row["circuit_turn_rad"].get<double>(), 1e-8);
        // The printed total length implies a pass that no geodesic of this vessel has.
        for (const Json& printed : ref["printed_lengths"]) {
            if (printed["angle_deg"] == row["angle_deg"]) {
                EXPECT_GT(printed["implied_pass"].get<double>(),
                          1.1 * row["pass_length"].get<double>());
            }
        }
    }
    for (const Json& row : ref["cylinder_turn"]) {
        const auto got = vessel_angles(published_design(ref, {row["angle_deg"]})).front();
        EXPECT_NEAR(got.cylinder_turn_rad, row["rad"].get<double>(), 1e-9);
    }
}

TEST(VesselAngles, WindWhatIsWanted) {
    VesselDesign design;
    design.angles_rad = {rad_from_deg(25.0), rad_from_deg(54.735610317245346), rad_from_deg(65.0)};
    for (const VesselAngle& row : vessel_angles(design)) {
        EXPECT_GE(row.layers, 2.0 - 1e-9);
        EXPECT_LT(row.layers * (row.circuits - 1) / row.circuits, 2.0);
        EXPECT_EQ(row.hoop_layers, 0);
        EXPECT_NEAR(row.fibre_length_mm, row.circuits * row.circuit_length_mm, 1e-6);
        EXPECT_NEAR(row.mass_kg, row.fibre_length_mm * 1e-3 * 6e-3 * 0.25e-3 * 1550.0, 1e-12);
    }
    design.wall_mm = 3.0;
    for (const VesselAngle& row : vessel_angles(design)) {
        EXPECT_GE(row.layers * design.ply_mm, 3.0 - 1e-9);
        EXPECT_LT(row.layers * design.ply_mm * (row.circuits - 1) / row.circuits, 3.0);
    }
    design.wall_mm.reset();
    design.pressure_mpa = 60.0;
    design.strength_mpa = 1200.0;
    // What the fibres of each direction carry at their strength, against the forces of the
    // pressure.
    int i = 0;
    for (const VesselAngle& row : vessel_angles(design)) {
        const double wound = row.layers * design.ply_mm * 1200.0;
        const double axial = wound * std::pow(std::cos(row.angle_rad), 2);
        const double around =
            wound * std::pow(std::sin(row.angle_rad), 2) + row.hoop_layers * design.ply_mm * 1200.0;
        EXPECT_GE(axial, 0.5 * 60.0 * 75.0 - 1e-6);
        EXPECT_GE(around, 60.0 * 75.0 - 1e-6);
        // And not a circuit or a hoop too many.
        EXPECT_LT(axial * (row.circuits - 1) / row.circuits, 0.5 * 60.0 * 75.0);
        EXPECT_EQ(row.hoop_layers > 0, i == 0);
        if (row.hoop_layers > 0) {
            EXPECT_LT(around - design.ply_mm * 1200.0, 60.0 * 75.0);
            EXPECT_GT(row.fibre_length_mm, row.circuits * row.circuit_length_mm +
                                               row.hoop_layers * 2.0 * kPi * 75.0 * 200.0 / 6.0);
        }
        ++i;
    }
}

// Thickness times area, from the innermost turn to the equator, is the fibre that lies there: the
// passes of all the geodesics between both edges of the band.
TEST(ThicknessOnDome, LosesNoFibre) {
    const IsotensoidDome dome({75.0, 25.0, 0.1});
    for (const double angle_deg : {25.0, 40.0, 60.0}) {
        const double clairaut = 75.0 * std::sin(rad_from_deg(angle_deg));
        const TurningBand band{clairaut, 6.0, 0.25, 80.0};
        const double inner = clairaut - 3.0;
        ASSERT_GT(inner, dome.least_radius_mm());
        const double outer_t = dome.parameter_at(clairaut + 3.0);
        const auto ring = [&](double t) {
            const double y = dome.radius_mm(t);
            return thickness_on_dome_mm(band, y) * 2.0 * kPi * y * dome.rate_mm(t).norm();
        };
        const double volume = Rule::integrate(ring, 0.0, outer_t, 15, 1e-12) +
                              Rule::integrate(ring, outer_t, dome.parameter_at(inner), 15, 1e-12);
        const double exact =
            80.0 * 0.25 *
            Rule::integrate([&](double c) { return geodesic_pass(dome, c).length_mm; }, inner,
                            clairaut + 3.0, 10, 1e-10);
        // Square roots at both ends of the second integral: 1e-6.
        EXPECT_NEAR(volume / exact, 1.0, 1e-6) << angle_deg;
    }
}

TEST(ThicknessOnDome, IsThatOfTheCylinderAtTheEquator) {
    for (const double band_mm : {6.0, 3.0, 1.5}) {
        const double angle = rad_from_deg(35.0);
        const TurningBand band{75.0 * std::sin(angle), band_mm, 0.25, 100.0};
        const double wall = 0.25 * layers_on_cylinder(100.0, band_mm, 75.0, angle);
        // asin's third derivative at sin 35 deg is 4: off by 4 cos / 24 of (band / R)^2.
        EXPECT_NEAR(thickness_on_dome_mm(band, 75.0) / wall, 1.0,
                    0.2 * std::pow(band_mm / 75.0, 2));
    }
}

TEST(ThicknessOnDome, IsLargestHalfABandOutsideTheTurn) {
    const TurningBand band{30.0, 6.0, 0.25, 100.0};
    const double most = thickness_on_dome_mm(band, 33.0);
    EXPECT_TRUE(std::isfinite(most));
    EXPECT_GT(most, thickness_on_dome_mm(band, 32.9));
    EXPECT_GT(most, thickness_on_dome_mm(band, 33.1));
    EXPECT_EQ(thickness_on_dome_mm(band, 27.0), 0.0);
    EXPECT_EQ(thickness_on_dome_mm(band, 20.0), 0.0);
}

std::string code_of(VesselDesign design) {
    if (design.angles_rad.empty()) {
        design.angles_rad = {0.5};
    }
    try {
        (void)vessel_angles(design);
    } catch (const InputError& error) {
        return error.code();
    }
    return "none";
}

TEST(VesselAngles, RefuseWhatIsNoVessel) {
    const double infinite = std::numeric_limits<double>::infinity();
    EXPECT_EQ(code_of({}), "none");
    EXPECT_EQ(code_of({.radius_mm = -1.0}), "vessel.not_positive");
    EXPECT_EQ(code_of({.opening_radius_mm = std::nan("")}), "vessel.not_positive");
    EXPECT_EQ(code_of({.cylinder_length_mm = infinite}), "vessel.not_positive");
    EXPECT_EQ(code_of({.band_mm = 0.0}), "vessel.not_positive");
    EXPECT_EQ(code_of({.ply_mm = -0.0}), "vessel.not_positive");
    EXPECT_EQ(code_of({.opening_radius_mm = 75.0}), "vessel.opening");
    EXPECT_EQ(code_of({.stiffness_ratio = 0.0}), "vessel.opening");
    EXPECT_EQ(code_of({.stiffness_ratio = 1.5}), "make.stiffness_ratio");
    EXPECT_EQ(code_of({.design_radius_mm = -3.0}), "vessel.not_positive");
    EXPECT_EQ(code_of({.wall_mm = 0.0}), "vessel.not_positive");
    EXPECT_EQ(code_of({.wall_mm = 1e9}), "vessel.out_of_range");
    EXPECT_EQ(code_of({.wall_mm = 1.0, .pressure_mpa = 1.0}), "vessel.demand");
    EXPECT_EQ(code_of({.pressure_mpa = 1.0}), "vessel.not_positive");
    EXPECT_EQ(code_of({.pressure_mpa = 1.0, .strength_mpa = 1e-12}), "vessel.out_of_range");
    for (const double bad : {0.0, -0.1, 0.5 * kPi, 2.0, infinite, std::nan("")}) {
        EXPECT_EQ(code_of({.angles_rad = {bad}}), "vessel.angle") << bad;
    }
    VesselDesign none;
    EXPECT_THROW((void)vessel_angles(none), InputError);
}

}  // namespace
}  // namespace meshwind
