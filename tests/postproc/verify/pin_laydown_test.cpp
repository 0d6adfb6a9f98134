#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/extension.h"
#include "postproc/eye/eye_path.h"
#include "postproc/verify/laydown.h"
#include "tests/support/exact_winding.h"
#include "tests/support/fixtures.h"
#include "winding/turn/pin_turn.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kExtension_mm = 60.0;
constexpr double kFree_mm = 200.0;

// Rays of the program are dense, so what is left is the foot of a pin, which is no circle on the
// unrolled wall: rho^3 / (6 R^2), 5e-4 mm at most here, the mesh, and what the simulation counts as
// brushing a pin.
constexpr double kDeviation_mm = 0.02;

// A turn over the upper rim of a pipe.
struct PinnedPipe {
    Mandrel mandrel;
    Rim rim;
    RimCrossing crossing;
    PinTurnShape shape;
    PinFit fit;
    LaidTurn turn;
    std::vector<Pin> pins;

    PinnedPipe(double radius_mm, double angle_deg, int count)
        : mandrel(test::made_cylinder(radius_mm, 100.0, radius_mm / 12.0)),
          rim(mandrel.rims[mandrel.rims[0].axis.z() > 0.0 ? 0 : 1]) {
        crossing = {rim.id, 0.3, rad_from_deg(angle_deg), 1};
        const double strand = strand_radius_mm(6.0, 0.25);
        shape = {.radius_mm = rim.radius_mm,
                 .angle_rad = crossing.angle_rad,
                 .held_mm = 1.0 + strand,
                 .offset_mm = 9.0,
                 .pitch_mm = 2.0 * kPi * rim.radius_mm / count,
                 .diameter_mm = 2.0};
        fit = fit_pins(shape, strand, std::nullopt);
        shape.lead_mm = fit.lead_mm;
        shape.skip = fit.least_skip;
        turn = turn_on_pins(rim, crossing, shape, 6.0);
        PinRing ring = ring_for(rim, crossing, shape);
        ring.height_mm = fit.height_mm;
        pins = pins_of(ring, rim);
    }

    [[nodiscard]] LaidPath lay(const std::vector<Pin>& standing) const {
        const Machine machine = test::fine_machine();
        EyePath path = landing_points(std::span(&turn.piece, 1)).path;
        for (EyePoint& point : path) {
            set_eye(point, kFree_mm);
        }
        return lay_down(
            LaydownSurface(extended_surface(mandrel, kExtension_mm), kBridgeReach_mm, standing),
            machine, test::program(machine, path, RedundancyPolicy::CentralAngle),
            turn.piece.path.front().position_mm);
    }

    // Unrolled: around from the crossing, and from the rim.
    [[nodiscard]] Eigen::Vector2d unrolled(const Vector3d& place) const {
        const Vector3d off = place - rim.centre_mm;
        const Vector3d x = rim_reference(rim);
        const double azimuth = std::atan2(off.dot(rim.axis.cross(x)), off.dot(x));
        // From a little before the crossing, where rounding may put its first point.
        const double middle_rad = 0.9 * kPi;
        const double around =
            std::remainder(azimuth - crossing.azimuth_rad - middle_rad, 2.0 * kPi) + middle_rad;
        return {rim.radius_mm * around, off.dot(rim.axis)};
    }
};

// Distance from a curve of straights and arcs that touch, and along it, by closed form.
struct Nearest {
    double distance_mm;
    double along_mm;
};

Nearest nearest_on_turn(const PinTurnShape& shape, const Eigen::Vector2d& at) {
    const double sine = std::sin(shape.angle_rad);
    const double cosine = std::cos(shape.angle_rad);
    const double rho = shape.held_mm;
    const double run = shape.skip * shape.pitch_mm;
    // The turn is its own mirror image: one half will do.
    const double whole = run + 2.0 * shape.offset_mm * sine / cosine + 2.0 * rho / cosine;
    const double length = pin_turn_length_mm(shape);
    const bool second = at.x() > 0.5 * whole;
    const Eigen::Vector2d p(second ? whole - at.x() : at.x(), at.y());
    const double straight = (shape.offset_mm + rho * sine) / cosine;
    const Eigen::Vector2d pin(shape.offset_mm * sine / cosine + rho / cosine, shape.offset_mm);
    Nearest found;
    const double along = p.dot(Eigen::Vector2d(sine, cosine));
    if (along <= straight) {
        found = {std::abs(p.x() * cosine - p.y() * sine), along};
    } else if (p.x() <= pin.x()) {
        const Eigen::Vector2d off = p - pin;
        found = {std::abs(off.norm() - rho),
                 straight + rho * (0.5 * kPi - shape.angle_rad - std::atan2(-off.x(), off.y()))};
    } else {
        found = {std::abs(p.y() - shape.offset_mm - rho),
                 straight + rho * (0.5 * kPi - shape.angle_rad) + p.x() - pin.x()};
    }
    return {found.distance_mm, second ? length - found.along_mm : found.along_mm};
}

class PinLaydown : public testing::TestWithParam<std::array<double, 3>> {
protected:
    PinnedPipe pipe_{GetParam()[0], GetParam()[1], static_cast<int>(GetParam()[2])};
};

TEST_P(PinLaydown, FibreLiesOnTangentsAndArcs) {
    ASSERT_EQ(pipe_.fit.failure, "");
    const LaidPath laid = pipe_.lay(pipe_.pins);
    ASSERT_EQ(laid.failure, "");
    double held_mm = 0.0;
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        const Nearest at = nearest_on_turn(pipe_.shape, pipe_.unrolled(laid.path[i].position_mm));
        EXPECT_LT(at.distance_mm, kDeviation_mm) << laid.path[i].s_mm;
        EXPECT_NEAR(at.along_mm, laid.path[i].s_mm, 0.1);  // chords, over some 100 stations
        held_mm += i > 0 && laid.at[i].held ? laid.path[i].s_mm - laid.path[i - 1].s_mm : 0.0;
    }
    EXPECT_NEAR(laid.path.back().s_mm, pin_turn_length_mm(pipe_.shape), 0.1);
    const double arcs = (kPi - 2.0 * pipe_.shape.angle_rad) * pipe_.shape.held_mm;
    EXPECT_GT(held_mm, arcs - 1.0);
}

// The same program without pins, and with pins that are too short to take hold of the fibre.
TEST_P(PinLaydown, WithoutPinsItLiesElsewhere) {
    std::vector<Pin> low = pipe_.pins;
    for (Pin& pin : low) {
        pin.height_mm *= 0.25;
    }
    for (const std::vector<Pin>& pins : {std::vector<Pin>{}, low}) {
        const LaidPath laid = pipe_.lay(pins);
        double off_mm = 0.0;
        for (const PathPoint& station : laid.path) {
            off_mm = std::max(
                off_mm,
                nearest_on_turn(pipe_.shape, pipe_.unrolled(station.position_mm)).distance_mm);
        }
        EXPECT_TRUE(!laid.failure.empty() || off_mm > 1.0) << off_mm;
    }
}

INSTANTIATE_TEST_SUITE_P(Pipes, PinLaydown,
                         testing::Values(std::array{40.0, 20.0, 40.0}, std::array{40.0, 35.0, 36.0},
                                         std::array{100.0, 20.0, 99.0}));

}  // namespace
}  // namespace meshwind
