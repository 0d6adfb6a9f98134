// Every row of data/reference/seed004.json, which was computed apart from this program.
#include "study/helix_law.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "core/units.h"

namespace meshwind {
namespace {

using Json = nlohmann::json;

const Json& reference() {
    static const Json json = [] {
        std::ifstream in(std::string(MESHWIND_SOURCE_DIR) + "/data/reference/seed004.json");
        return Json::parse(in);
    }();
    return json;
}

const Json& entry(const std::string& id) {
    for (const Json& each : reference()["entries"]) {
        if (each["id"] == id) {
            return each;
        }
    }
    throw std::out_of_range(id);
}

double free_length_mm() {
    return reference()["error_table"]["L_mm"];
}

Helix helix(double radius_mm, double angle_deg = 45.0) {
    return {radius_mm, rad_from_deg(angle_deg)};
}

double c_deg(TangentRule rule, const Helix& on, double h) {
    return deg_from_rad(helix_error(rule, on, {h, h}, free_length_mm()).c_rad);
}

TEST(HelixLaw, AgreesWithEveryRowOfTheTable) {
    const Json& table = reference()["error_table"];
    const double tolerance = table["tolerance_abs"];
    ASSERT_EQ(table["rows"].size(), 108U);
    for (const Json& row : table["rows"]) {
        const Helix on = helix(row["R"], row["beta_deg"]);
        const double h = row["h"];
        for (const auto& [rule, key] : {std::pair{TangentRule::Chord, "one_sided"},
                                        std::pair{TangentRule::Central, "central"}}) {
            const EyeError error = helix_error(rule, on, {h, h}, free_length_mm());
            SCOPED_TRACE(row.dump());
            EXPECT_NEAR(deg_from_rad(error.c_rad), row[key]["dC_deg"], tolerance);
            EXPECT_NEAR(deg_from_rad(error.direction_rad), row[key]["dir_deg"], tolerance);
            EXPECT_NEAR(error.eye_mm, row[key]["eye_mm"], tolerance);
            EXPECT_NEAR(deg_from_rad(error.a_rad), row[key]["dA_deg"], tolerance);
        }
    }
}

TEST(HelixLaw, UnevenSpacingCostsTheCentralChordAnOrderAndTheParabolaNone) {
    const Json& each = entry("irregular_spacing");
    for (const Json& row : each["value"]) {
        const Spacing spacing{row[0], row[1]};
        const auto direction_deg = [&](TangentRule rule) {
            return deg_from_rad(
                helix_error(rule, helix(70.0), spacing, free_length_mm()).direction_rad);
        };
        EXPECT_NEAR(direction_deg(TangentRule::Central), row[2], each["tolerance"]);
        EXPECT_NEAR(direction_deg(TangentRule::Parabola), row[3], each["tolerance"]);
    }
}

TEST(HelixLaw, ChordIsSecondOrderAtTheMiddleOfTheSegment) {
    const Json& each = entry("midpoint_rule");
    for (const Json& row : each["value"]) {
        const double h = row[0];
        const CurveState from = helix_state(helix(70.0), -h);
        const CurveState middle = helix_state(helix(70.0), -0.5 * h);
        const CurveState to = helix_state(helix(70.0), 0.0);
        const Eigen::Vector3d chord =
            tangent_by(TangentRule::Chord, {from.position_mm, to.position_mm, {}, to.tangent});
        const EyeError error =
            eye_error(middle.position_mm, middle.tangent, chord, free_length_mm());
        EXPECT_NEAR(deg_from_rad(error.direction_rad), row[1], each["tolerance"]);
    }
}

TEST(HelixLaw, OrdersAreOneAndTwo) {
    const Json& each = entry("orders");
    for (const Json& row : each["value"]) {
        const TangentRule rule = row[1] == 1 ? TangentRule::Chord : TangentRule::Central;
        const Helix on = helix(row[0]);
        EXPECT_NEAR(std::log2(c_deg(rule, on, 1.0) / c_deg(rule, on, 0.5)), row[2],
                    each["tolerance"]);
    }
}

// The leading terms stated in helix_law.h.
TEST(HelixLaw, LeadingTermsHold) {
    const double sine = std::sin(rad_from_deg(45.0));
    const double length = free_length_mm();
    for (const double radius : {20.0, 70.0, 450.0}) {
        const Json& each = entry("lead_check_R" + std::to_string(static_cast<int>(radius)));
        const double turn = sine / radius;  // h = 1
        const double square = radius * radius + length * length * sine * sine;
        const double chord = -0.5 * turn * length * length * sine * sine / square;
        const double central = -radius * length * sine * sine * sine / square * turn * turn / 6.0;
        const auto rad = [&](TangentRule rule) {
            return rad_from_deg(c_deg(rule, helix(radius), 1.0));
        };
        EXPECT_NEAR(chord / rad(TangentRule::Chord) - 1.0, each["value"][0], each["tolerance"]);
        EXPECT_NEAR(central / rad(TangentRule::Central) - 1.0, each["value"][1], each["tolerance"]);
    }
}

TEST(HelixLaw, SpacingForAnErrorOfC) {
    const double paper_deg = std::abs(c_deg(TangentRule::Chord, helix(450.0), 2.0));
    EXPECT_NEAR(paper_deg, entry("claim_R450_h2")["value"], entry("claim_R450_h2")["tolerance"]);
    for (const auto& [id, error_deg] :
         {std::pair{"same_C_error", paper_deg}, std::pair{"C01", 0.1}}) {
        const Json& each = entry(id);
        for (const Json& row : each["value"]) {
            const auto spacing = [&, error = error_deg](TangentRule rule) {
                return spacing_for_c_error_mm(rule, helix(row[0]), free_length_mm(),
                                              rad_from_deg(error), 60.0);
            };
            SCOPED_TRACE(row.dump());
            EXPECT_NEAR(spacing(TangentRule::Chord), row[1], each["tolerance"]);
            EXPECT_NEAR(spacing(TangentRule::Central), row[2], each["tolerance"]);
        }
    }
}

// A helix is the same at every size: the direction depends on h / R alone.
TEST(HelixLaw, SameDirectionErrorAtTheSameShareOfTheRadius) {
    const auto direction_deg = [&](double radius, double h) {
        return deg_from_rad(
            helix_error(TangentRule::Chord, helix(radius), {h, h}, free_length_mm()).direction_rad);
    };
    for (const Json& row : entry("same_dir_error")["value"]) {
        EXPECT_NEAR(direction_deg(row[0], row[1]), direction_deg(450.0, 2.0),
                    entry("same_dir_error")["tolerance"]);
    }
}

}  // namespace
}  // namespace meshwind
