#include "postproc/ringhead/ring_pattern.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "postproc/ringhead/ring_cover.h"
#include "postproc/ringhead/ring_drive.h"
#include "tests/support/l_frame.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

TEST(RingPattern, TwelveTowsOfTheFrame) {
    RingPatternTask task;
    task.angle_rad = rad_from_deg(45.0);
    task.tow_width_mm = 7.5;
    task.bend_radius_mm = test::kBendRadius_mm;
    task.laid_mm = 1000.0;
    const RingPattern pattern = ring_pattern(task);
    EXPECT_NEAR(pattern.tows_needed, 2.0 * kPi * 20.0 * std::sqrt(0.5) / 7.5, 1e-12);
    // tan(inside) = 1 / (1 - 20 / 89.13), tan(outside) = 1 / (1 + 20 / 89.13)
    EXPECT_NEAR(deg_from_rad(pattern.inside_rad), 52.203, 1e-3);
    EXPECT_NEAR(deg_from_rad(pattern.outside_rad), 39.240, 1e-3);
    EXPECT_NEAR(pattern.thickness_ratio,
                std::cos(rad_from_deg(39.240)) / std::cos(rad_from_deg(52.203)), 1e-4);
    EXPECT_NEAR(deg_from_rad(pattern.bridging_rad), 28.28, 0.01);
    EXPECT_EQ(pattern.passes, 2) << "12.97 tows are needed outside";
    EXPECT_NEAR(deg_from_rad(pattern.offset_rad), 15.0, 1e-12);
    EXPECT_NEAR(pattern.coverage, 24.0 / pattern.tows_needed, 1e-12);
    EXPECT_NEAR(pattern.fibre_per_tow_mm, 1000.0 * std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(pattern.fibre_mm, 48000.0 * std::sqrt(2.0), 1e-7);
    // 800 tex are 0.8 g a metre.
    EXPECT_NEAR(fibre_mass_kg(pattern.fibre_mm, 800.0), 48.0 * std::sqrt(2.0) * 0.8e-3, 1e-12);
}

TEST(RingPattern, StraightTubeNeedsWholeTows) {
    RingPatternTask task;
    task.angle_rad = rad_from_deg(60.0);
    task.tow_width_mm = 20.0 * kPi / 12.0;  // exactly twelve cover
    RingPattern pattern = ring_pattern(task);
    EXPECT_EQ(pattern.passes, 1);
    EXPECT_NEAR(pattern.tows_needed, 12.0, 1e-12);
    EXPECT_NEAR(pattern.coverage, 1.0, 1e-12);
    EXPECT_DOUBLE_EQ(pattern.thickness_ratio, 1.0);
    task.spools = 5;
    EXPECT_EQ(ring_pattern(task).passes, 3);
    task.tow_width_mm = 0.0;
    pattern = ring_pattern(task);
    EXPECT_EQ(pattern.passes, 1);
    EXPECT_NEAR(pattern.tow_width_mm, 12.6, 1e-12) << "4 pi up to a tenth";
    task.bend_radius_mm = 20.0;
    EXPECT_THROW((void)ring_pattern(task), InputError);
}

TEST(RingPassages, EachRingWindsWhereItComesFirst) {
    RingHead head;
    const auto passages = ring_passages(head, {1000.0, 30.0, 2, 0.1, false});
    ASSERT_EQ(passages.size(), 4u);
    EXPECT_FALSE(passages[0].back);
    EXPECT_TRUE(passages[1].back);
    EXPECT_EQ(passages[1].ring, 1);
    EXPECT_DOUBLE_EQ(passages[0].tie_s_mm, 5.0);
    EXPECT_DOUBLE_EQ(passages[0].end_s_mm, 1000.0);
    EXPECT_DOUBLE_EQ(passages[1].tie_s_mm, 995.0);
    EXPECT_DOUBLE_EQ(passages[1].end_s_mm, 0.0);
    EXPECT_DOUBLE_EQ(passages[0].wait_mm, 0.0);
    EXPECT_DOUBLE_EQ(passages[2].phase_rad, 0.1);
    const auto at_once = ring_passages(head, {1000.0, 40.0, 1, 0.1, true});
    ASSERT_EQ(at_once.size(), 2u);
    EXPECT_FALSE(at_once[1].back);
    EXPECT_FALSE(at_once[1].right_handed);
    EXPECT_DOUBLE_EQ(at_once[0].wait_mm, 5.0);
    EXPECT_DOUBLE_EQ(at_once[0].end_s_mm, 995.0);
    EXPECT_DOUBLE_EQ(at_once[1].wait_mm, 75.0);
    EXPECT_DOUBLE_EQ(at_once[1].end_s_mm, 925.0);
}

// A program along 400 mm of straight tube, at 20 mm/s.
struct Straight {
    FrameAxis axis{{{Vector3d::Zero(), Vector3d::UnitZ(), Vector3d::UnitY(), 0.0},
                    {400.0 * Vector3d::UnitZ(), Vector3d::UnitZ(), Vector3d::UnitY(), 0.0}}};
    TubeSurface tube{axis, 20.0};
    RingHead head;
    KrlProgram forth;
    std::vector<double> s_mm;

    Straight() {
        for (int i = 0; i <= 20; ++i) {
            s_mm.push_back(20.0 * i);
            forth.moves.push_back({krl_frame(carried_pose(head, axis.at(20.0 * i))),
                                   krl_path_speed(0.02), krl_turn_speed(400.0)});
        }
    }

    // What the table and the program lay, all passages.
    [[nodiscard]] std::vector<RingFibre> wind(double angle_rad, int tows,
                                              const RingPassageTask& task) const {
        const KrlProgram back = back_program(forth, "back", {});
        const std::vector<double> back_s_mm(s_mm.rbegin(), s_mm.rend());
        const auto passages = ring_passages(head, task);
        std::vector<std::vector<RingRow>> rows;
        for (const RingPassage& passage : passages) {
            rows.push_back(drive_ring(passage, passage.back ? back : forth,
                                      passage.back ? back_s_mm : s_mm, head,
                                      ring_turns_per_mm(angle_rad, 20.0)));
        }
        const std::string table = rings_csv(passages, rows);
        std::vector<RingFibre> fibres;
        for (const RingPassage& passage : passages) {
            const auto states = play_head(passage.back ? back : forth,
                                          read_rings_csv(table, "rings.csv", passage), head, tube);
            RingSpools spools{passage.ring,        tows, 40.0, passage.phase_rad, passage.tie_s_mm,
                              passage.right_handed};
            for (RingFibre& fibre : lay_ring_fibres(states, head, tube, spools)) {
                fibres.push_back(std::move(fibre));
            }
        }
        return fibres;
    }
};

TEST(RingDrive, WindsRegularHelicesToAndFroAndAtOnce) {
    const Straight straight;
    for (const double angle_deg : {30.0, 45.0, 60.0}) {
        const double angle = rad_from_deg(angle_deg);
        const double lag = landing_lag_mm(40.0, 20.0, angle);
        for (const bool at_once : {false, true}) {
            const auto fibres = straight.wind(angle, 12, {400.0, lag, 1, 0.0, at_once});
            ASSERT_EQ(fibres.size(), 24u);
            // As the ring waits for the angle there is nothing to settle, from the first mm on.
            const RingCoverTask task{35.0, 260.0, angle, 40.0 * kPi * std::cos(angle) / 12.0, 0.0};
            const RingQuality quality = ring_quality(straight.tube, fibres, task);
            EXPECT_LT(deg_from_rad(quality.arm_off_rad), 0.02) << angle_deg << at_once;
            EXPECT_LT(quality.slip, 2e-3);
            EXPECT_LE(quality.ends_short_mm, 0.0);
            for (const RingFibre& fibre : fibres) {
                EXPECT_EQ(fibre.points.back().angle_rad > 0.0, fibre.ring == 0)
                    << "right- and left-handed";
            }
            const RingCover cover = ring_cover(straight.tube, fibres, task);
            EXPECT_NEAR(cover.mean_layers, 2.0, 1e-3);
            EXPECT_NEAR(cover.widest_mm, task.tow_width_mm, 2e-3 * task.tow_width_mm);
            EXPECT_LT(cover.regular_cv, 1e-3);
            EXPECT_NEAR(cover.regular_mm, 225.0, 1e-9);
            EXPECT_EQ(cover.inside_layers, 0.0) << "no bend";
        }
    }
}

TEST(RingCover, NarrowTowsLeaveTheShareThatArithmeticSays) {
    const Straight straight;
    const double angle = rad_from_deg(45.0);
    const double lag = landing_lag_mm(40.0, 20.0, angle);
    const auto one = straight.wind(angle, 6, {400.0, lag, 1, 0.0, false});
    const double full_mm = 40.0 * kPi * std::cos(angle) / 6.0;
    RingCoverTask task{10.0, 390.0, angle, 0.6 * full_mm, 0.0};
    // Both rings cover 0.6 each, independently of one another.
    EXPECT_NEAR(ring_cover(straight.tube, one, task).covered, 0.36, 0.01);
    EXPECT_NEAR(ring_cover(straight.tube, one, task).mean_layers, 1.2, 2e-3);
    // A second pass between the first: 1.2 layers, all covered.
    const auto two = straight.wind(angle, 6, {400.0, lag, 2, kPi / 6.0, false});
    const RingCover cover = ring_cover(straight.tube, two, task);
    EXPECT_DOUBLE_EQ(cover.covered, 1.0);
    EXPECT_NEAR(cover.mean_layers, 2.4, 4e-3);
    // Laid upon the first instead of between it covers no more.
    const auto same = straight.wind(angle, 6, {400.0, lag, 2, 1e-4, false});
    EXPECT_NEAR(ring_cover(straight.tube, same, task).covered, 0.36, 0.01);
}

TEST(RingCover, BendIsThickerInside) {
    const FrameAxis axis = test::l_frame(2.0);
    const TubeSurface tube(axis, 20.0);
    EXPECT_NEAR(tightest_bend_mm(tube), test::kBendRadius_mm, 0.05);
    // Curves of even advance themselves, so that the closed form holds exactly.
    std::vector<RingFibre> fibres;
    for (int i = 0; i < 96; ++i) {
        RingFibre fibre;
        fibre.ring = i % 2;
        const double sense = i % 2 == 0 ? 1.0 : -1.0;
        for (int k = 0; k <= 4200; ++k) {
            LaidRingPoint point;
            point.s_mm = 0.25 * k;
            point.round_rad = 2.0 * kPi * i / 96.0 + sense * point.s_mm / 20.0;
            point.point_mm = tube.point(point.s_mm, point.round_rad);
            const TubeFoot foot = tube.foot(point.point_mm, point.s_mm);
            point.normal = foot.normal;
            point.stretch = tube.stretch(foot);
            point.angle_rad = sense * std::atan(1.0 / point.stretch);
            fibre.points.push_back(point);
        }
        fibres.push_back(std::move(fibre));
    }
    RingPatternTask pattern;
    pattern.angle_rad = rad_from_deg(45.0);
    pattern.spools = 48;
    pattern.bend_radius_mm = test::kBendRadius_mm;
    const RingPattern even = ring_pattern(pattern);
    const RingCoverTask task{5.0, 1045.0, pattern.angle_rad, even.tow_width_mm, 10.0};
    const RingCover cover = ring_cover(tube, fibres, task);
    EXPECT_NEAR(cover.inside_layers / cover.outside_layers, even.thickness_ratio, 5e-3);
    EXPECT_NEAR(cover.outside_layers, 2.0 * even.coverage_outside, 5e-3);
    EXPECT_DOUBLE_EQ(cover.covered, 1.0);
    const RingQuality quality = ring_quality(tube, fibres, task);
    EXPECT_LT(quality.arm_off_rad, 1e-6);
    EXPECT_LT(quality.bend_off_rad, 1e-9);
    EXPECT_NEAR(quality.inside_rad, even.inside_rad, 2e-3);
    EXPECT_NEAR(quality.outside_rad, even.outside_rad, 2e-3);
    // Slip of even advance on a torus, away from the ends of the bend: by the formula of Liouville,
    // with E = r^2 and G = rho^2; its largest value over the round.
    double exact = 0.0;
    for (double v = 0.0; v < 2.0 * kPi; v += 1e-3) {
        const double rho = test::kBendRadius_mm - 20.0 * std::cos(v);
        const double a = std::atan(20.0 * (test::kBendRadius_mm / 20.0) / rho);
        // a from the axis: da/dl of tan a = R / rho, and the turn of the parallels.
        const double dv = std::sin(a) / 20.0;
        const double da = -test::kBendRadius_mm * 20.0 * std::sin(v) /
                          (rho * rho + test::kBendRadius_mm * test::kBendRadius_mm) * dv;
        const double kg = da - std::sin(v) / rho * std::cos(a);
        const double kn =
            std::pow(std::sin(a), 2) / 20.0 - std::pow(std::cos(a), 2) * std::cos(v) / rho;
        exact = std::max(exact, std::abs(kg) / kn);
    }
    RingCoverTask middle = task;
    middle.from_mm = 570.0;
    middle.to_mm = 670.0;
    middle.tow_width_mm = 2.0;
    EXPECT_NEAR(ring_quality(tube, fibres, middle).slip, exact, 0.02 * exact);
}

TEST(RingDrive, BadTablesAreRefused) {
    const RingPassage passage;
    EXPECT_THROW((void)read_rings_csv("pass,ring,time_s\n1,1,0\n", "r", passage), InputError);
    EXPECT_THROW((void)read_rings_csv("pass,ring,time_s,ring_deg\n2,1,0,0\n", "r", passage),
                 InputError);
    EXPECT_THROW(
        (void)read_rings_csv("pass,ring,time_s,ring_deg\n1,1,1,0\n1,1,0,0\n", "r", passage),
        InputError);
}

}  // namespace
}  // namespace meshwind
