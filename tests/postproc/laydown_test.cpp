#include "postproc/laydown.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "machines/kinematics.h"
#include "mesh/make.h"
#include "tests/postproc/exact_winding.h"
#include "tests/winding/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::ExactCurve;

constexpr double kFree_mm = 200.0;

const Surface& torus() {
    static const Surface surface = test::frozen(make_torus(
        {.ring_radius_mm = 200.0, .tube_radius_mm = 50.0}, {.edge_mm = 5.0, .irregular = true}));
    return surface;
}

const Surface& cylinder() {
    static const Surface surface =
        test::made_cylinder(test::ExactCylinder{}.radius_mm, 400.0, 5.0).surface;
    return surface;
}

// On the outside of the tube, at an angle to the meridian.
ExactCurve torus_curve(double slip_ratio, double step_mm, double length_mm = 240.0) {
    const double angle = rad_from_deg(50.0);
    return test::exact_curve(
        test::ExactTorus{},
        test::CurveState{Vector3d(250.0, 0.0, 0.0), {0.0, std::sin(angle), std::cos(angle)}},
        slip_ratio, step_mm, length_mm);
}

ExactCurve helix(double step_mm, double length_mm = 240.0) {
    const double angle = rad_from_deg(50.0);
    return test::exact_curve(
        test::ExactCylinder{},
        test::CurveState{Vector3d(50.0, 0.0, -120.0), {0.0, std::sin(angle), std::cos(angle)}}, 0.0,
        step_mm, length_mm);
}

LaidPath lay(const Surface& surface, const Machine& machine, const ExactCurve& curve,
             RedundancyPolicy policy, const LaydownOptions& options = {}) {
    return lay_down(surface, machine,
                    test::program(machine, test::eye_path(curve, kFree_mm), policy),
                    curve.states.front().position_mm, options);
}

TEST(X, Y) {
    const Machine m = test::fine_machine();
    for (auto pol : {RedundancyPolicy::Hold, RedundancyPolicy::CentralAngle})
        for (double step : {4.0, 2.0, 1.0, 0.5}) {
            auto run = [&](const Surface& s, const ExactCurve& c) {
                const LaidPath l = lay(s, m, c, pol);
                return std::make_tuple(test::farthest_mm(l, c), l.path.back().s_mm, l.failure,
                                       l.peeled_mm);
            };
            for (int k = 0; k < 3; k++) {
                auto [d, s, f, p] = k == 0 ? run(cylinder(), helix(step))
                                           : run(torus(), torus_curve(k == 1 ? 0 : 0.15, step));
                printf("pol %d step %g case %d: %.3e s %.6f '%s' peel %.2e\n", (int)pol, step, k, d,
                       s, f.c_str(), p);
            }
        }
}
}  // namespace
}  // namespace meshwind
