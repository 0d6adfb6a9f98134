#include "postproc/ringhead/ring_laydown.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tests/support/l_frame.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTube_mm = 20.0;

FrameAxis straight_axis(double length_mm) {
    return FrameAxis({{Vector3d::Zero(), Vector3d::UnitZ(), Vector3d::UnitY(), 0.0},
                      {length_mm * Vector3d::UnitZ(), Vector3d::UnitZ(), Vector3d::UnitY(), 0.0}});
}

// An arc about (R, 0, 0) from the origin along z, with a station every two degrees: along the axis
// the cubic between them is off by 5e-4 mm (2 / 6.43)^3 (frame_axis.h).
FrameAxis arc_axis(double radius_mm, double angle_rad) {
    std::vector<AxisStation> stations;
    const int steps = static_cast<int>(std::ceil(angle_rad / rad_from_deg(2.0)));
    for (int i = 0; i <= steps; ++i) {
        const double angle = angle_rad * i / steps;
        stations.push_back({{radius_mm * (1.0 - std::cos(angle)), 0.0, radius_mm * std::sin(angle)},
                            {std::sin(angle), 0.0, std::cos(angle)},
                            Vector3d::UnitY(),
                            0.0});
    }
    return FrameAxis(std::move(stations));
}

// The axis in the head's middle at `s`, square to it; `turn` gives both rings against the frame.
std::vector<HeadState> exact_passage(const RingHead& head, const FrameAxis& axis, double from_mm,
                                     double to_mm, double step_mm,
                                     const std::function<double(double)>& turn) {
    Isometry3d base = Isometry3d::Identity();
    base.linear().col(0) = head.reference;
    base.linear().col(1) = head.direction.cross(head.reference);
    base.linear().col(2) = head.direction;
    base.translation() = head.centre_mm;
    std::vector<HeadState> states;
    const int steps = static_cast<int>(std::lround((to_mm - from_mm) / step_mm));
    for (int i = 0; i <= steps; ++i) {
        HeadState state;
        state.s_mm = from_mm + i * step_mm;
        state.time_s = i;
        state.head_in_mandrel = carried_pose(head, axis.at(state.s_mm)).inverse() * base;
        state.ring_rad = {turn(state.s_mm), -turn(state.s_mm)};
        states.push_back(state);
    }
    return states;
}

TEST(TubeSurface, FootOfATorusIsExact) {
    const double bend_mm = 90.0;
    const TubeSurface tube(arc_axis(bend_mm, 1.5), kTube_mm);
    for (const double angle : {0.1, 0.7, 1.3}) {
        for (const double round : {0.0, 1.0, 2.5, -1.2}) {
            const Vector3d point = tube.point(bend_mm * angle, round);
            // The reference is y and the tangent z: round 90 degrees points to -x, away from the
            // centre.
            const double out = bend_mm + kTube_mm * std::sin(round);
            const Vector3d exact(bend_mm - out * std::cos(angle), kTube_mm * std::cos(round),
                                 out * std::sin(angle));
            EXPECT_LT((point - exact).norm(), 2e-5);
            const TubeFoot foot =
                tube.foot(point + 0.2 * (point - tube.axis_at(bend_mm * angle).point_mm), 60.0);
            EXPECT_NEAR(foot.s_mm, bend_mm * angle, 1e-6);
            EXPECT_NEAR(foot.round_rad, round, 1e-7);
            EXPECT_NEAR(foot.distance_mm, 1.2 * kTube_mm, 1e-6);
            EXPECT_LT((foot.surface_mm - exact).norm(), 2e-5);
            EXPECT_NEAR(tube.stretch(foot), out / bend_mm, 1e-5);
            // Euler: sin^2 / r and, along, sin(round) / out; chords of 0.5 mm see an arc 1e-5 less.
            const Vector3d across = foot.tangent.cross(foot.normal);
            EXPECT_NEAR(tube.normal_curvature(foot, across), 1.0 / kTube_mm, 1e-12);
            EXPECT_NEAR(tube.normal_curvature(foot, foot.tangent), std::sin(round) / out, 1e-6);
        }
    }
    const TubeFoot beyond = tube.foot(tube.point(-30.0, 0.4), 0.0);
    EXPECT_NEAR(beyond.s_mm, -30.0, 1e-9);
    EXPECT_NEAR(beyond.round_rad, 0.4, 1e-12);
}

TEST(RingLaydown, StraightTubeIsWoundInExactHelices) {
    for (const double angle_deg : {20.0, 45.0, 70.0}) {
        const double angle = rad_from_deg(angle_deg);
        RingHead head;
        RingSpools spools;
        const double lag = landing_lag_mm(spools.radius_mm, kTube_mm, angle);
        EXPECT_NEAR(lag, std::sqrt(1200.0) / std::tan(angle), 1e-12);
        head.ring_distance_mm = 2.0 * lag + 4.0;  // so fibres land 2 mm ahead of the centre
        const FrameAxis axis = straight_axis(400.0);
        const TubeSurface tube(axis, kTube_mm);
        const double per_mm = std::tan(angle) / kTube_mm;
        const auto states =
            exact_passage(head, axis, 0.0, 300.0, 0.25, [&](double s) { return per_mm * s; });
        spools.count = 3;
        spools.tie_s_mm = 2.0;
        const auto fibres = lay_ring_fibres(states, head, tube, spools);
        ASSERT_EQ(fibres.size(), 3u);
        // What a step of the trapezoid leaves of a turn: step^2 / 12 of the lengths it acts on.
        const double turn = per_mm * 0.25;
        const double off_mm = (spools.radius_mm + lag) * turn * turn / 12.0;
        for (const RingFibre& fibre : fibres) {
            EXPECT_TRUE(fibre.bridges.empty());
            EXPECT_EQ(fibre.peeled_mm, 0.0);
            ASSERT_EQ(fibre.points.size(), states.size());
            const double start = 2.0 * kPi * fibre.spool / 3.0 - std::acos(0.5);
            for (const LaidRingPoint& point : fibre.points) {
                EXPECT_NEAR(point.s_mm, 2.0 + point.time_s * 0.25, off_mm);
                EXPECT_NEAR(std::remainder(point.round_rad - start - per_mm * (point.s_mm - 2.0),
                                           2.0 * kPi),
                            0.0, per_mm * off_mm);
                EXPECT_NEAR(point.angle_rad, angle, turn * turn / 12.0);
                EXPECT_NEAR(point.kn_per_mm, std::pow(std::sin(angle), 2) / kTube_mm,
                            turn * turn / 12.0 / kTube_mm);
            }
            // The chords of the turn's steps are shorter by step^2 / 24, 1e-4 at most here.
            EXPECT_NEAR(fibre.length_mm, 300.0 / std::cos(angle), 2e-4 * fibre.length_mm);
        }
    }
}

// ds/dturn = r (p - s) / q with p the ring's place and q = sqrt(R^2 - r^2), solved by hand.
TEST(RingLaydown, AngleStartsAsTheClosedFormSays) {
    const FrameAxis axis = straight_axis(400.0);
    const TubeSurface tube(axis, kTube_mm);
    const RingHead head;
    RingSpools spools;
    spools.count = 1;
    const double q = std::sqrt(1200.0);
    const double c = 30.0;  // mm of passage per rad
    double error_mm = 0.0;
    double coarse_mm = 0.0;
    for (const double step : {0.8, 0.4}) {
        const auto states =
            exact_passage(head, axis, 0.0, 200.0, step, [&](double s) { return s / c; });
        for (const double tie : {0.0, 20.0}) {
            spools.tie_s_mm = tie;
            const RingFibre fibre = lay_ring_fibres(states, head, tube, spools).front();
            ASSERT_EQ(fibre.points.size(), states.size());
            coarse_mm = std::max(coarse_mm, step == 0.8 ? error_mm : 0.0);
            for (const LaidRingPoint& point : fibre.points) {
                const double turn = point.time_s * step / c;
                const double exact =
                    35.0 + c * turn - c * q / kTube_mm +
                    (tie - 35.0 + c * q / kTube_mm) * std::exp(-turn * kTube_mm / q);
                const double off = std::abs(point.s_mm - exact);
                if (step == 0.8) {
                    coarse_mm = std::max(coarse_mm, off);
                } else {
                    error_mm = std::max(error_mm, off);
                }
            }
        }
    }
    EXPECT_LT(error_mm, 1e-3);
    EXPECT_GT(coarse_mm / error_mm, 3.5) << "of second order";
    EXPECT_LT(coarse_mm / error_mm, 4.5);
}

// Spools close to the tube leave no room for a free fibre: what is laid is the ring's own turn.
TEST(RingLaydown, BendTakesEvenAdvance) {
    const double bend_mm = 90.0;
    const FrameAxis axis = arc_axis(bend_mm, 3.0);
    const TubeSurface tube(axis, kTube_mm);
    RingHead head;
    head.ring_distance_mm = 0.0;
    const double per_mm = 1.0 / kTube_mm;  // 45 deg on the axis' length
    const auto states =
        exact_passage(head, axis, 5.0, 265.0, 0.1, [&](double s) { return per_mm * s; });
    double before = 1.0;
    for (const double gap : {0.4, 0.1, 0.025}) {
        RingSpools spools;
        spools.count = 4;
        spools.radius_mm = kTube_mm + gap;
        spools.tie_s_mm = 5.0;
        double worst = 0.0;
        double inside_deg = 0.0;
        double outside_deg = 90.0;
        for (const RingFibre& fibre : lay_ring_fibres(states, head, tube, spools)) {
            EXPECT_TRUE(fibre.bridges.empty());
            for (const LaidRingPoint& point : fibre.points) {
                if (point.s_mm < 60.0) {
                    continue;
                }
                worst = std::max(worst, std::abs(point.angle_rad - std::atan(1.0 / point.stretch)));
                inside_deg = std::max(inside_deg, deg_from_rad(point.angle_rad));
                outside_deg = std::min(outside_deg, deg_from_rad(point.angle_rad));
            }
        }
        // The free fibre is sqrt(2 r gap) long: the error falls by half as the gap by a quarter.
        EXPECT_LT(worst, 0.6 * before) << gap;
        before = worst;
        if (gap < 0.05) {
            EXPECT_NEAR(inside_deg, deg_from_rad(std::atan(1.0 / (1.0 - kTube_mm / bend_mm))), 0.5);
            EXPECT_NEAR(outside_deg, deg_from_rad(std::atan(1.0 / (1.0 + kTube_mm / bend_mm))),
                        0.5);
        }
    }
    EXPECT_LT(before, rad_from_deg(0.8));
}

// X' = -(n . P') / (l kn) u on the torus in its own coordinates, by Runge's and Kutta's steps.
TEST(RingLaydown, BendAgreesWithTheDifferentialEquation) {
    const double bend_mm = 90.0;
    const FrameAxis axis = arc_axis(bend_mm, 2.0);
    const TubeSurface tube(axis, kTube_mm);
    RingHead head;
    RingSpools spools;
    spools.count = 5;
    const double per_mm = 1.0 / kTube_mm;
    const auto turn = [&](double s) { return per_mm * s; };
    const double step_mm = 0.1;
    const auto states = exact_passage(head, axis, 40.0, 120.0, step_mm, turn);
    spools.tie_s_mm = 40.4;
    for (const RingFibre& fibre : lay_ring_fibres(states, head, tube, spools)) {
        ASSERT_TRUE(fibre.bridges.empty());
        // The spool at a passage, from the closed form of the arc: x', y', z' of the head.
        const auto spool_at = [&](double s) {
            const double a = s / bend_mm;
            const Vector3d tangent(std::sin(a), 0.0, std::cos(a));
            const Vector3d reference = Vector3d::UnitY();
            const double phase = turn(s) + 2.0 * kPi * fibre.spool / spools.count;
            return Vector3d(
                Vector3d(bend_mm * (1.0 - std::cos(a)), 0.0, bend_mm * std::sin(a)) +
                35.0 * tangent +
                40.0 * (std::cos(phase) * reference + std::sin(phase) * tangent.cross(reference)));
        };
        const auto point_of = [&](const Eigen::Vector2d& x) {
            const double out = bend_mm + kTube_mm * std::sin(x[1]);
            return Vector3d(bend_mm - out * std::cos(x[0]), kTube_mm * std::cos(x[1]),
                            out * std::sin(x[0]));
        };
        const auto rate = [&](double s, const Eigen::Vector2d& x) {
            const double out = bend_mm + kTube_mm * std::sin(x[1]);
            const Vector3d along(std::sin(x[0]), 0.0, std::cos(x[0]));
            const Vector3d away(-std::cos(x[0]), 0.0, std::sin(x[0]));
            const Vector3d normal = std::sin(x[1]) * away + std::cos(x[1]) * Vector3d::UnitY();
            const Vector3d round = std::cos(x[1]) * away - std::sin(x[1]) * Vector3d::UnitY();
            const double h = 1e-4;
            const Vector3d moved = (spool_at(s + h) - spool_at(s - h)) / (2.0 * h);
            Vector3d way = spool_at(s) - point_of(x);
            way -= way.dot(normal) * normal;
            const double u = way.normalized().dot(along);
            const double v = way.normalized().dot(round);
            const double kn = v * v / kTube_mm + u * u * std::sin(x[1]) / out;
            const double speed = -normal.dot(moved) / (way.norm() * kn);
            return Eigen::Vector2d(speed * u / out, speed * v / kTube_mm);
        };
        // From a landing point well behind the tie on, where the fibre touches the round.
        const std::size_t first = 50;
        ASSERT_GT(fibre.points.size(), first);
        Eigen::Vector2d x(fibre.points[first].s_mm / bend_mm, fibre.points[first].round_rad);
        double s = 40.0 + fibre.points[first].time_s * step_mm;
        double worst_mm = 0.0;
        for (std::size_t i = first + 1; i < fibre.points.size(); ++i) {
            const double h = 40.0 + fibre.points[i].time_s * step_mm - s;
            const Eigen::Vector2d k1 = rate(s, x);
            const Eigen::Vector2d k2 = rate(s + 0.5 * h, x + 0.5 * h * k1);
            const Eigen::Vector2d k3 = rate(s + 0.5 * h, x + 0.5 * h * k2);
            const Eigen::Vector2d k4 = rate(s + h, x + h * k3);
            x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            s += h;
            worst_mm = std::max(worst_mm, (point_of(x) - fibre.points[i].point_mm).norm());
        }
        EXPECT_LT(worst_mm, 2e-3) << "spool " << fibre.spool;
    }
}

TEST(RingLaydown, FibresAlongTheAxisBridgeInsideABend) {
    const double bend_mm = 90.0;
    const FrameAxis axis = arc_axis(bend_mm, 1.5);
    const TubeSurface tube(axis, kTube_mm);
    RingHead head;
    head.ring_distance_mm = 0.0;
    RingSpools spools;
    spools.count = 8;
    spools.radius_mm = kTube_mm + 0.05;
    spools.tie_s_mm = 5.0;
    // Even advance with a turn per mm w has tan(inside) = r w / (1 - r/R); the inside is hollow
    // along the fibre where tan^2 < r / (R - r).
    const double limit = std::sqrt(kTube_mm / (bend_mm - kTube_mm));
    for (const double share : {0.7, 0.9, 1.1, 1.3}) {
        const double per_mm = share * limit * (1.0 - kTube_mm / bend_mm) / kTube_mm;
        const auto states =
            exact_passage(head, axis, 5.0, 130.0, 0.1, [&](double s) { return per_mm * s; });
        std::size_t bridges = 0;
        for (const RingFibre& fibre : lay_ring_fibres(states, head, tube, spools)) {
            bridges += fibre.bridges.size();
        }
        EXPECT_EQ(bridges > 0, share < 1.0) << share;
    }
}

TEST(PlayHead, MeetsMovesAndLinesOfTheTable) {
    const FrameAxis axis = straight_axis(100.0);
    const TubeSurface tube(axis, kTube_mm);
    const RingHead head;
    KrlProgram program;
    for (const double s : {0.0, 10.0, 30.0}) {
        program.moves.push_back({krl_frame(carried_pose(head, axis.at(s))), krl_path_speed(0.01),
                                 krl_turn_speed(400.0)});
    }
    const std::vector<RingKnot> knots = {{0.0, {0.0, 0.0}}, {0.5, {0.0, 0.0}}, {3.0, {2.5, -5.0}}};
    const auto states = play_head(program, knots, head, tube);
    EXPECT_DOUBLE_EQ(states.front().time_s, 0.0);
    EXPECT_NEAR(states.back().time_s, 3.0, 1e-12);
    bool met_knot = false;
    bool met_point = false;
    for (std::size_t i = 0; i < states.size(); ++i) {
        const HeadState& state = states[i];
        EXPECT_NEAR(state.s_mm, 10.0 * state.time_s, 1e-3);
        EXPECT_NEAR(state.ring_rad[0], std::max(0.0, state.time_s - 0.5), 1e-12);
        EXPECT_NEAR(state.ring_rad[1], -2.0 * state.ring_rad[0], 1e-12);
        met_knot = met_knot || std::abs(state.time_s - 0.5) < 1e-12;
        met_point = met_point || std::abs(state.time_s - 1.0) < 1e-12;
        if (i > 0) {
            EXPECT_LE(std::abs(state.ring_rad[1] - states[i - 1].ring_rad[1]),
                      kRingStep_rad + 1e-12);
            EXPECT_LE(state.s_mm - states[i - 1].s_mm, kPassStep_mm + 1e-3);
        }
    }
    EXPECT_TRUE(met_knot);
    EXPECT_TRUE(met_point);
}

}  // namespace
}  // namespace meshwind
