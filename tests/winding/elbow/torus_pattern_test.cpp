#include "winding/elbow/torus_pattern.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;

class PublishedElbow : public testing::Test {
protected:
    static Json reference() {
        std::ifstream in(std::string(MESHWIND_SOURCE_DIR) + "/data/reference/seed003.json");
        return Json::parse(in);
    }
    const Json ref_ = reference();
    const TorusElbow elbow_{.ring_radius_mm = ref_["ring_radius_mm"],
                            .tube_radius_mm = ref_["tube_radius_mm"],
                            .span_rad = rad_from_deg(ref_["span_deg"]),
                            .alpha0_rad = rad_from_deg(ref_["alpha0_deg"])};
};

TEST_F(PublishedElbow, CycleAndClairaut) {
    EXPECT_NEAR(elbow_.clairaut_mm(), ref_["clairaut_mm"].get<double>(), 1e-13);
    EXPECT_NEAR(torus_cycle(elbow_).theta_rad, ref_["theta_cycle_rad"].get<double>(), 1e-12);
    const Json& line = ref_["line_0"];
    for (const auto& [name, phi] :
         {std::pair{"half_pi", 0.5 * kPi}, std::pair{"pi", kPi}, std::pair{"two_pi", 2.0 * kPi}}) {
        for (const double sign : {1.0, -1.0}) {
            const TorusStation station = torus_station(elbow_, sign * phi);
            // Given to 12 decimals.
            EXPECT_NEAR(sign * station.theta_rad, line["theta_rad"][name].get<double>(), 1e-12);
            EXPECT_NEAR(sign * station.length_mm, line["length_mm"][name].get<double>(), 1e-11);
        }
    }
    EXPECT_NEAR(deg_from_rad(torus_station(elbow_, kPi).alpha_rad),
                ref_["alpha_inner_deg"].get<double>(), 1e-11);
    EXPECT_NEAR(torus_station(elbow_, 0.0).alpha_rad, elbow_.alpha0_rad, 1e-13);
}

// 22.98965 widths of 0.5 mm: 23 printed. The range of widths for 23 is sharp.
TEST_F(PublishedElbow, NeedsThePrintedNumberOfLines) {
    for (const Json& row : ref_["lines_for_tape"]) {
        EXPECT_EQ(lines_for_tape(elbow_, row[0]), row[1].get<int>());
    }
    const double least_mm = ref_["widths_of_23_lines_mm"][0];
    const double beyond_mm = ref_["widths_of_23_lines_mm"][1];
    EXPECT_EQ(lines_for_tape(elbow_, least_mm * (1.0 + 1e-8)), 23);
    EXPECT_EQ(lines_for_tape(elbow_, least_mm * (1.0 - 1e-8)), 24);
    EXPECT_EQ(lines_for_tape(elbow_, beyond_mm * (1.0 - 1e-8)), 23);
    EXPECT_EQ(lines_for_tape(elbow_, beyond_mm * (1.0 + 1e-8)), 22);
    const Json& spacing = ref_["spacing_of_23_lines_mm"];
    EXPECT_NEAR(line_spacing_mm(elbow_, 23, 0.0), spacing["outer_equator"].get<double>(), 1e-12);
    EXPECT_NEAR(line_spacing_mm(elbow_, 23, kPi), spacing["inner_equator"].get<double>(), 1e-12);
}

TEST_F(PublishedElbow, LinesEndWhereTheyShould) {
    const std::vector<TorusLine> lines = torus_lines(elbow_, 23);
    const Json& rows = ref_["geodesics"];
    ASSERT_EQ(lines.size(), rows.size());
    double whole_mm = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const TorusLine& line = lines[i];
        EXPECT_NEAR(line.theta_rad, rows[i]["theta_i"].get<double>(), 1e-12);
        EXPECT_NEAR(line.phi_minus_rad, rows[i]["phi_minus"].get<double>(), 1e-11);
        EXPECT_NEAR(line.phi_plus_rad, rows[i]["phi_plus"].get<double>(), 1e-11);
        EXPECT_NEAR(line.length_mm, rows[i]["length"].get<double>(), 1e-11);
        whole_mm += line.length_mm;
        for (const bool plus : {true, false}) {
            const double phi = rows[i][plus ? "phi_plus" : "phi_minus"];
            const double theta = (plus ? 0.5 : -0.5) * elbow_.span_rad;
            const double rho = 20.0 + 5.0 * std::cos(phi);
            const Vector3d at(rho * std::cos(theta), rho * std::sin(theta), 5.0 * std::sin(phi));
            // 5 mm of tube times 1e-11 rad.
            EXPECT_LT(((plus ? line.plus_mm : line.minus_mm) - at).norm(), 5e-11);
        }
    }
    EXPECT_NEAR(whole_mm, ref_["total_length_of_23_lines_mm"].get<double>(), 1e-9);
    // Line 0 is its own image in the plane of symmetry.
    EXPECT_EQ(lines[0].phi_minus_rad, -lines[0].phi_plus_rad);
    // After 23 lines comes the first one again, one cycle on.
    const TorusLine next = torus_line(elbow_, torus_cycle(elbow_).theta_rad);
    EXPECT_NEAR(next.phi_plus_rad, lines[0].phi_plus_rad - 2.0 * kPi, 1e-12);
    EXPECT_NEAR(next.length_mm, lines[0].length_mm, 1e-11);
}

// The equation of geodesics in space, x'' = -kn n, by the classical Runge-Kutta method: knows
// nothing of Clairaut.
struct Flight {
    Vector3d position_mm, tangent;
};

Vector3d bend(const TorusElbow& elbow, const Vector3d& p, const Vector3d& t) {
    const Vector3d out = Vector3d(p.x(), p.y(), 0.0).normalized();
    const Vector3d normal = (p - elbow.ring_radius_mm * out).normalized();
    const Vector3d around(-out.y(), out.x(), 0.0);
    const double along = t.dot(around);
    const double across = t.dot(normal.cross(around));
    const double kn = across * across / elbow.tube_radius_mm +
                      along * along * normal.dot(out) / std::hypot(p.x(), p.y());
    return -kn * normal;
}

Flight flown(const TorusElbow& elbow, double length_mm, int steps) {
    Vector3d p(elbow.ring_radius_mm + elbow.tube_radius_mm, 0.0, 0.0);
    Vector3d t(0.0, std::cos(elbow.alpha0_rad), std::sin(elbow.alpha0_rad));
    const double h = length_mm / steps;
    for (int i = 0; i < steps; ++i) {
        const Vector3d a = bend(elbow, p, t);
        const Vector3d tb = t + 0.5 * h * a;
        const Vector3d b = bend(elbow, p + 0.5 * h * t, tb);
        const Vector3d tc = t + 0.5 * h * b;
        const Vector3d c = bend(elbow, p + 0.5 * h * tb, tc);
        const Vector3d td = t + h * c;
        const Vector3d d = bend(elbow, p + h * tc, td);
        p += h / 6.0 * (t + 2.0 * tb + 2.0 * tc + td);
        t += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    return {p, t};
}

// Elbows slender and tight, lines steep and hardly passing; after one cycle the line is on the
// outer equator again. 20,000 steps leave (2 pi / 20000)^4, 1e-14, per radian, more where it hardly
// passes.
TEST(TorusCycle, AgreesWithTheEquationOfGeodesics) {
    for (const double tube_mm : {1.0, 5.0, 14.0}) {
        TorusElbow elbow{.ring_radius_mm = 20.0, .tube_radius_mm = tube_mm, .span_rad = 2.0};
        const double least = std::acos((20.0 - tube_mm) / (20.0 + tube_mm));
        for (const double share : {0.001, 0.1, 0.5, 0.9, 0.999}) {
            elbow.alpha0_rad = least + share * (0.5 * kPi - least);
            const TorusCycle cycle = torus_cycle(elbow);
            const Flight end = flown(elbow, cycle.length_mm, 20'000);
            const Vector3d outer((20.0 + tube_mm) * std::cos(cycle.theta_rad),
                                 (20.0 + tube_mm) * std::sin(cycle.theta_rad), 0.0);
            EXPECT_LT((end.position_mm - outer).norm(), share < 0.01 ? 1e-6 : 1e-9)
                << tube_mm << " " << share;
            const TorusStation station = torus_station(elbow, 2.0 * kPi);
            EXPECT_EQ(station.theta_rad, cycle.theta_rad);
        }
    }
}

// A line that hardly passes stays near the inner equator, where x'' = x / a^2 with
// 1 / a^2 = 1 / (r (R - r)): each tenfold nearer miss takes it a ln(10) further, half before and
// half after the equator's nearest place.
TEST(TorusCycle, GrowsAsTheLogarithmWhereALineHardlyPasses) {
    TorusElbow elbow{.ring_radius_mm = 20.0, .tube_radius_mm = 5.0, .span_rad = 2.0};
    const double least = std::acos(15.0 / 25.0);
    const auto cycle_mm = [&](double over) {
        elbow.alpha0_rad = least + over;
        return torus_cycle(elbow).length_mm;
    };
    const double a_mm = std::sqrt(5.0 * 15.0);
    for (const double over : {1e-6, 1e-7, 1e-8}) {
        // alpha itself is known to 1e-16: 1e-7 of the smallest miss.
        EXPECT_NEAR(cycle_mm(0.1 * over) - cycle_mm(over), a_mm * std::log(10.0), 1e-4) << over;
    }
}

TEST(TorusLine, RunsFromEndToEndThroughItsPlace) {
    const TorusElbow elbow{
        .ring_radius_mm = 100.0, .tube_radius_mm = 30.0, .span_rad = 1.5, .alpha0_rad = 1.3};
    for (const double theta : {-0.9, -0.75, -0.1, 0.0, 0.3, 0.75, 2.0}) {
        const TorusLine line = torus_line(elbow, theta);
        const TorusStation minus = torus_station(elbow, line.phi_minus_rad);
        const TorusStation plus = torus_station(elbow, line.phi_plus_rad);
        EXPECT_NEAR(theta + minus.theta_rad, -0.75, 1e-13);
        EXPECT_NEAR(theta + plus.theta_rad, 0.75, 1e-13);
        EXPECT_NEAR(plus.length_mm - minus.length_mm, line.length_mm, 1e-10);
    }
    // Through the middle from one rim: all of it lies ahead.
    EXPECT_EQ(torus_line(elbow, -0.75).phi_minus_rad, 0.0);
}

TEST(TorusElbow, RefusesWhatIsOutOfRange) {
    const TorusElbow good{
        .ring_radius_mm = 100.0, .tube_radius_mm = 30.0, .span_rad = 1.5, .alpha0_rad = 1.3};
    const auto refused = [](const auto& call) {
        try {
            call();
        } catch (const InputError& error) {
            return error.code() == "pattern.out_of_range";
        }
        return false;
    };
    EXPECT_FALSE(refused([&] { (void)torus_lines(good, 3); }));
    EXPECT_TRUE(refused([&] { (void)torus_lines(good, 0); }));
    EXPECT_TRUE(refused([&] { (void)line_spacing_mm(good, 0, 0.0); }));
    const double nan = std::nan("");
    EXPECT_TRUE(refused([&] { (void)torus_line(good, nan); }));
    EXPECT_TRUE(refused([&] { (void)torus_station(good, HUGE_VAL); }));
    for (const double bad : {0.0, -1.0, nan}) {
        EXPECT_TRUE(refused([&] { (void)lines_for_tape(good, bad); })) << bad;
        for (double TorusElbow::*field : {&TorusElbow::ring_radius_mm, &TorusElbow::tube_radius_mm,
                                          &TorusElbow::span_rad, &TorusElbow::alpha0_rad}) {
            TorusElbow elbow = good;
            elbow.*field = bad;
            EXPECT_TRUE(refused([&] { (void)torus_cycle(elbow); })) << bad;
        }
    }
    TorusElbow elbow = good;
    elbow.alpha0_rad = std::acos(70.0 / 130.0);  // just touches the inner equator
    EXPECT_TRUE(refused([&] { (void)torus_cycle(elbow); }));
    elbow.alpha0_rad = 0.5 * kPi;
    EXPECT_TRUE(refused([&] { (void)torus_cycle(elbow); }));
    elbow = good;
    elbow.tube_radius_mm = 100.0;
    EXPECT_TRUE(refused([&] { (void)torus_cycle(elbow); }));
}

}  // namespace
}  // namespace meshwind
