// One circuit on a cylinder and the patterns made of it: the numbers of
// andrianov_2022_machine_path.
#include "winding/vessel/cylinder_circuit.h"

#include <cmath>
#include <fstream>
#include <numeric>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/units.h"
#include "winding/revolution/pattern.h"
#include "winding/turn/turn.h"

namespace meshwind {
namespace {

using Json = nlohmann::json;

Json reference(const std::string& name) {
    std::ifstream in(std::string(MESHWIND_SOURCE_DIR) + "/data/reference/" + name);
    return Json::parse(in);
}

// The last digit printed, halved: "82.843" gives 0.0005.
double half_digit(const std::string& printed) {
    const auto point = printed.find('.');
    const auto digits = point == std::string::npos ? 0 : printed.size() - point - 1;
    return 0.5 * std::pow(10.0, -static_cast<double>(digits));
}

// The value in full digits, and that it rounds to the print.
void expect_printed(double value, const Json& entry, double exact) {
    const std::string printed = entry["printed"];
    EXPECT_NEAR(value, entry["value"].get<double>(), exact) << printed;
    EXPECT_NEAR(value, std::stod(printed), half_digit(printed) * (1.0 + 1e-9)) << printed;
}

// The same as expect_printed, where the print is wrong.
void expect_corrected(double value, const Json& entry, double exact) {
    const std::string printed = entry["printed"];
    EXPECT_NEAR(value, entry["value"].get<double>(), exact) << printed;
    EXPECT_GT(std::abs(value - std::stod(printed)), half_digit(printed)) << printed;
}

// References have 16 digits; a handful of operations leave a few units of the last one.
constexpr double kExact = 1e-9;

class Tube : public testing::Test {
protected:
    const Json ref_ = reference("seed001.json");
    const CylinderCircuit circuit_{.radius_mm = ref_["radius_mm"],
                                   .regular_mm = ref_["program"]["l_c_mm"]["value"],
                                   .angle_rad = rad_from_deg(ref_["beta_deg"]),
                                   .slip = ref_["slip_ratio"].get<double>()};
    const CircuitTurns turns_ = circuit_turns(circuit_);
    const double band_rad_ =
        band_angle_rad(ref_["table_3"]["band_mm"], circuit_.radius_mm, circuit_.angle_rad);
    const int cycles_ = ref_["program"]["cycles"];
    const Pattern lattice_ = lattice(turns_.circuit_rad, cycles_, band_rad_);

    [[nodiscard]] std::int64_t thousandths(const Json& printed) const {
        return std::llround(1000.0 * std::stod(printed.get<std::string>()));
    }
};

TEST_F(Tube, TurnsAreThoseOfTable3) {
    expect_printed(turns_.run_mm, ref_["l_t_mm"], kExact);
    expect_printed(deg_from_rad(turns_.regular_rad), ref_["program"]["Phi_c_deg"], kExact);
    expect_printed(deg_from_rad(turns_.turn_rad), ref_["Phi_t_deg"], kExact);
    // Printed 1792.042: two digits exchanged, for the pitch printed belongs to 1729.042.
    expect_corrected(deg_from_rad(turns_.circuit_rad), ref_["program"]["Phi_1_deg"], kExact);
    expect_printed(turns_.mandrel_mm, ref_["table_3"]["mandrel_mm"], kExact);
    expect_printed(deg_from_rad(band_rad_), ref_["program"]["Phi_w_deg"], kExact);
    EXPECT_NEAR(turns_.fibre_mm,
                2.0 * 251.0 * std::sqrt(2.0) + 4.0 * ref_["fibre_length_mm"].get<double>(), kExact);
}

// Phi_p is the smallest m 360 / n from Phi_p* on: 300 = 5 * 60.
TEST_F(Tube, PitchAndCompensationAreThoseOfTable3) {
    const double star_deg = std::fmod(deg_from_rad(turns_.circuit_rad), 360.0);
    expect_printed(star_deg, ref_["table_3"]["Phi_p_star_deg"], kExact);
    expect_printed(std::fmod(deg_from_rad(lattice_.turn_rad), 360.0), ref_["table_3"]["Phi_p_deg"],
                   kExact);
    expect_printed(0.5 * deg_from_rad(lattice_.dwell_rad), ref_["program"]["Phi_f_deg"], kExact);
    EXPECT_EQ(lattice_.turns, 29);
    EXPECT_EQ(lattice_.starts, 1);
    EXPECT_EQ(lattice_.order, BandOrder::Lagging);
    EXPECT_NEAR(deg_from_rad(lattice_.turn_rad), ref_["program"]["cycle_deg"].get<double>(),
                kExact);
}

TEST_F(Tube, IsFilledByNineSeries) {
    const Series series = fill_lattice(lattice_, band_rad_);
    EXPECT_EQ(series.count, ref_["program"]["series"].get<int>());
    EXPECT_EQ(series.circuits, 54);
    EXPECT_NEAR(series.overlap, 9.0 * 7.08999098973721 / 60.0 - 1.0, kExact);
    EXPECT_NEAR(deg_from_rad(series.total_rad), 9.0 * (29.0 * 360.0 + 7.08999098973721), 1e-7);
}

// The program's increments, added in thousandths as printed, against the plan in steps.
TEST_F(Tube, SumsOfTheProgramAreThoseOfThePattern) {
    const Json& sums = ref_["sums"];
    std::int64_t stroke = thousandths(sums["regular_X_printed"]);
    for (const char* section : {"section_1", "section_3"}) {
        for (const Json& row : ref_[section]) {
            stroke += thousandths(row["X_printed"]);
        }
    }
    const auto in_thousandths = [](double deg) { return std::llround(1000.0 * deg); };
    EXPECT_EQ(stroke, in_thousandths(sums["stroke_X_deg"]));
    const double exact_deg = 0.5 * deg_from_rad(turns_.circuit_rad);
    EXPECT_NEAR(exact_deg, sums["stroke_X_exact_deg"].get<double>(), kExact);
    EXPECT_NEAR(1e-3 * static_cast<double>(stroke), exact_deg, 0.001);

    // Circuits by the pattern, in the program's hundredths, against the printed sums.
    const std::int64_t cycle = 2 * (stroke + thousandths(sums["Phi_f_printed"]));
    EXPECT_EQ(cycle, in_thousandths(sums["cycle_X_deg"]));
    const StepClosure closure = closure_in_steps(lattice_, {36'000, 1});
    for (const std::int64_t increment : closure.increments) {
        EXPECT_EQ(10 * increment, cycle);
    }
    const std::int64_t ring =
        std::accumulate(closure.increments.begin(), closure.increments.end(), std::int64_t{0});
    const std::int64_t series = 10 * ring + thousandths(sums["Phi_w_printed"]);
    EXPECT_EQ(series, in_thousandths(sums["series_X_deg"]));
    const Series filled = fill_lattice(lattice_, band_rad_);
    EXPECT_EQ(filled.count * series, in_thousandths(sums["program_X_deg"]));
    // Phi_w is cut to hundredths nine times.
    EXPECT_NEAR(deg_from_rad(filled.total_rad), sums["program_X_deg"].get<double>(), 9.0 * 0.005);

    // As a lattice: 35.48 at either end make the cycle five turns; 60 more move it on.
    const std::int64_t grid = 2 * (stroke + thousandths(sums["grid_Phi_f_printed"]));
    EXPECT_EQ(grid, in_thousandths(sums["grid_cycle_X_deg"]));
    const double grid_deg = 1e-3 * static_cast<double>(grid + 60'000);
    const Pattern program = lattice(rad_from_deg(grid_deg), cycles_, band_rad_);
    EXPECT_EQ(program.turns, 31);
    EXPECT_EQ(program.order, BandOrder::Leading);
    EXPECT_NEAR(program.dwell_rad, 0.0, kSameTurn_rad);
    EXPECT_NEAR(deg_from_rad(program.step_rad),
                std::stod(sums["grid_Phi_w_printed"].get<std::string>()), kExact);
}

// What the series need 54 circuits and 9 offsets for a single pattern lays in 51 circuits or a few
// more, without an offset.
TEST_F(Tube, AlsoClosesAsOnePattern) {
    PatternRequest request{.circuit_rad = turns_.circuit_rad,
                           .band_rad = band_rad_,
                           .most_dwell_rad = lattice_.dwell_rad};
    request.wanted_starts = cycles_;
    const std::vector<Pattern> patterns = find_patterns(request);
    ASSERT_FALSE(patterns.empty());
    EXPECT_EQ(patterns.front().circuits, 51);  // ceil(360 / 7.09)
    // T = (360 / n)(k +- 1 / N) with n = 6, k = 29 needs 5 N = -+1 mod 6: N = 53 or 55.
    bool lagging = false;
    bool leading = false;
    for (const Pattern& p : patterns) {
        lagging = lagging || (p.circuits == 53 && p.starts == 6 && p.skip == 29 &&
                              p.order == BandOrder::Lagging);
        leading = leading || (p.circuits == 55 && p.starts == 6 && p.skip == 29 &&
                              p.order == BandOrder::Leading);
    }
    EXPECT_TRUE(lagging);
    // 360 / 6 (29 + 1 / 55) = 1741.09 is over the lattice's 1740: its dwell is not enough.
    EXPECT_FALSE(leading);
}

// Two lattices on one cylinder, turned at pins.
TEST(DoubleDouble, ClosesAsInTable4Corrected) {
    const Json ref = reference("seed001.json");
    for (const Json& row : ref["table_4"]) {
        CylinderCircuit circuit{.radius_mm = ref["radius_mm"],
                                .regular_mm = row["l_c_mm"],
                                .angle_rad = rad_from_deg(row["beta_deg"])};
        const CircuitTurns as_printed = circuit_turns(circuit);
        EXPECT_EQ(as_printed.turn_rad, 0.0);
        EXPECT_EQ(as_printed.mandrel_mm, circuit.regular_mm);
        expect_corrected(deg_from_rad(as_printed.regular_rad), row["Phi_c_deg"], kExact);
        const int cycles = row["cycles"];
        const Pattern p = lattice(as_printed.circuit_rad, cycles, 0.01);
        expect_corrected(std::fmod(deg_from_rad(p.turn_rad), 360.0), row["Phi_p_deg"], kExact);
        // The pitch printed: 9 * 180 and 3 * 270 are 4.5 and 2.25 turns.
        const double printed_deg = std::stod(row["Phi_p_deg"]["printed"].get<std::string>());
        EXPECT_NE(std::remainder(cycles * printed_deg, 360.0), 0.0);
        // With the length for which Phi_c is the target, no dwell: known to 1e-4 mm.
        circuit.regular_mm = row["closing_l_c_mm"];
        const CircuitTurns closing = circuit_turns(circuit);
        const double half_mm_rad = 1e-4 * std::tan(circuit.angle_rad) / circuit.radius_mm;
        EXPECT_NEAR(closing.regular_rad,
                    rad_from_deg(std::stod(row["Phi_c_deg"]["printed"].get<std::string>())),
                    half_mm_rad);
        const Pattern none = lattice(closing.circuit_rad - 2.0 * half_mm_rad, cycles, 0.01);
        expect_printed(0.5 * deg_from_rad(none.dwell_rad), row["Phi_f_deg"], 0.0005);
    }
}

struct Walked {
    double run_mm = 0.0, turn_rad = 0.0, fibre_mm = 0.0;
};

// dbeta/ds = slip sin^2(beta) / R over the angle by Simpson's rule, 2000 intervals: h^4 / 180 of
// the fourth derivative is below 1e-9 for angles from 20 degrees.
Walked walked(double radius_mm, double beta, double slip) {
    constexpr int kIntervals = 2000;
    const double h = (0.5 * kPi - beta) / kIntervals;
    Walked sum;
    for (int i = 0; i <= kIntervals; ++i) {
        const double b = beta + i * h;
        const double weight = (i == 0 || i == kIntervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * h / 3.0;
        const double ds = weight * radius_mm / (slip * std::sin(b) * std::sin(b));
        sum.fibre_mm += ds;
        sum.run_mm += ds * std::cos(b);
        sum.turn_rad += ds * std::sin(b) / radius_mm;
    }
    return sum;
}

TEST(CircuitTurns, AreTheIntegralsOfTheSlipLaw) {
    for (const double beta_deg : {20.0, 35.0, 60.0, 85.0, 89.9}) {
        for (const double slip : {0.05, 0.2, 0.5}) {
            const CylinderCircuit circuit{.radius_mm = 33.0,
                                          .regular_mm = 0.0,
                                          .angle_rad = rad_from_deg(beta_deg),
                                          .slip = slip};
            const CircuitTurns turns = circuit_turns(circuit);
            const Walked sum = walked(33.0, circuit.angle_rad, slip);
            EXPECT_NEAR(turns.run_mm, sum.run_mm, 1e-7);
            EXPECT_NEAR(turns.turn_rad, sum.turn_rad, 1e-8);
            EXPECT_NEAR(turns.circuit_rad, 4.0 * sum.turn_rad, 1e-8);
            EXPECT_NEAR(turns.fibre_mm, 4.0 * sum.fibre_mm, 1e-6);
        }
    }
}

// The half turn that a plan winds with the slip of the circuit.
TEST_F(Tube, TurnsAreThoseOfTheFrictionTurn) {
    Rim rim;
    rim.centre_mm = {0.0, 0.0, 0.0};
    rim.axis = {0.0, 0.0, 1.0};
    rim.radius_mm = circuit_.radius_mm;
    // A turn uses 0.85 of the friction where the extension is long enough.
    const TurnRule rule{.friction = *circuit_.slip / 0.85, .extension_mm = 500.0, .band_mm = 3.5};
    const RimCrossing crossing{0, 0.0, circuit_.angle_rad, 1};
    const Turn turn = half_turn(rim, crossing, rule, 1.0);
    EXPECT_NEAR(turn.slip, *circuit_.slip, 1e-12);
    EXPECT_NEAR(turn.run_mm, turns_.run_mm, 1e-9);
    EXPECT_NEAR(turn.path.back().s_mm, ref_["fibre_length_mm"].get<double>(), 1e-9);
    double wound_rad = 0.0;
    for (std::size_t i = 1; i < turn.path.size(); ++i) {
        const Eigen::Vector3d& a = turn.path[i - 1].position_mm;
        const Eigen::Vector3d& b = turn.path[i].position_mm;
        wound_rad += std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
    }
    EXPECT_NEAR(wound_rad, turns_.turn_rad, 1e-9);
}

TEST(CircuitTurns, RefusesWhatIsOutOfRange) {
    const CylinderCircuit good{.radius_mm = 40, .regular_mm = 1, .angle_rad = 1, .slip = 0.2};
    const auto refused = [&](auto change) {
        CylinderCircuit circuit = good;
        change(circuit);
        try {
            (void)circuit_turns(circuit);
        } catch (const InputError& error) {
            return error.code() == "pattern.out_of_range";
        }
        return false;
    };
    EXPECT_FALSE(refused([](CylinderCircuit&) {}));
    EXPECT_FALSE(refused([](CylinderCircuit& c) { c.regular_mm = 0.0; }));
    for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_TRUE(refused([&](CylinderCircuit& c) { c.radius_mm = bad; })) << bad;
        EXPECT_TRUE(refused([&](CylinderCircuit& c) { c.regular_mm = bad; })) << bad;
        EXPECT_TRUE(refused([&](CylinderCircuit& c) { c.angle_rad = bad; })) << bad;
        EXPECT_TRUE(refused([&](CylinderCircuit& c) { c.slip = bad; })) << bad;
    }
    EXPECT_TRUE(refused([](CylinderCircuit& c) { c.angle_rad = 0.5 * kPi; }));
    EXPECT_TRUE(refused([](CylinderCircuit& c) { c.slip = 0.0; }));
}

}  // namespace
}  // namespace meshwind
