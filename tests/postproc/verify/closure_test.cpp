#include "postproc/verify/closure.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/tells.h"

namespace meshwind {
namespace {

constexpr double kTurn_rad = 2.0 * kPi;
constexpr double kRadius_mm = 50.0;
constexpr double kHalf_mm = 100.0;
constexpr double kPass_rad = 4.0;

// Chords instead of arcs of a helix: interpolated azimuths are exact, so only rounding is left.
constexpr double kExact_rad = 1e-9;

struct Wound {
    SurfacePath laid;
    std::vector<double> starts_rad;
};

// Circuits up and down a cylinder, n of them in k turns, turning far beyond its ends; `off` moves
// a place of the fibre about the spindle, by circuit (with its fraction) and pass.
Wound wound(int n, int k, const std::function<double(double circuit, int pass, double z)>& off) {
    Wound made;
    const double turn = kTurn_rad * k / n;
    for (int i = 0; i < n; ++i) {
        made.starts_rad.push_back(std::fmod(static_cast<double>(i) * k / n, 1.0) * kTurn_rad);
        for (int pass = 0; pass < 2; ++pass) {
            constexpr int kStations = 300;
            for (int s = 0; s <= kStations; ++s) {
                const double share = static_cast<double>(s) / kStations;
                const double along = (pass == 0 ? 2.0 * share - 1.0 : 1.0 - 2.0 * share);
                const double z = 1.2 * kHalf_mm * along;
                const double azimuth = made.starts_rad.back() + pass * 0.5 * turn +
                                       kPass_rad * share + off(i + 0.5 * (pass + share), pass, z);
                PathPoint point;
                point.position_mm = {kRadius_mm * std::cos(azimuth), kRadius_mm * std::sin(azimuth),
                                     z};
                point.normal = {std::cos(azimuth), std::sin(azimuth), 0.0};
                point.tangent = Eigen::Vector3d::UnitZ();
                made.laid.push_back(point);
            }
        }
    }
    return made;
}

LaidClosure closure_of(const Wound& w) {
    return laid_closure(w.laid, w.starts_rad, -kHalf_mm, kHalf_mm);
}

TEST(Closure, APatternThatClosesDoesSo) {
    for (const auto& [n, k] : {std::pair(2, 5), {3, 4}, {7, 5}, {51, 245}}) {
        const LaidClosure closure = closure_of(wound(n, k, [](auto...) { return 0.0; }));
        EXPECT_TRUE(closure.holds()) << closure.failure;
        EXPECT_LT(closure.closure_rad, kExact_rad);
        EXPECT_LT(closure.drift_rad, kExact_rad);
        EXPECT_EQ(closure.parallels, 21U);
    }
}

TEST(Closure, DriftOfEachCircuitAddsUp) {
    for (const int n : {5, 20, 51}) {
        const double per_circuit = rad_from_deg(0.001);
        const LaidClosure closure = closure_of(
            wound(n, n + 1, [&](double circuit, int, double) { return per_circuit * circuit; }));
        EXPECT_NEAR(closure.closure_rad, n * per_circuit, 1e-3 * n * per_circuit);
        EXPECT_EQ(closure.holds(), n < 10);
        EXPECT_NEAR(closure.drift_rad, 0.5 * n * per_circuit, per_circuit);
    }
}

// As blocks do it: the same at the same places of like circuits, of which there are three kinds,
// twenty times as large as the limit.
TEST(Closure, FollowingThePlanBadlyIsNoDrift) {
    const auto badly = [](double circuit, int pass, double z) {
        const int kind = static_cast<int>(circuit) % 3;
        return rad_from_deg(0.2) * std::sin(0.05 * z + kind + 2.0 * pass);
    };
    const LaidClosure closed = closure_of(wound(27, 79, badly));
    EXPECT_TRUE(closed.holds());
    EXPECT_LT(closed.closure_rad, 0.1 * kClosureLimit_rad);
    EXPECT_GT(closed.drift_rad, kClosureLimit_rad);
    const LaidClosure open = closure_of(wound(27, 79, [&](double circuit, int pass, double z) {
        return badly(circuit, pass, z) + rad_from_deg(0.001) * std::floor(circuit);
    }));
    EXPECT_FALSE(open.holds());
    EXPECT_NEAR(deg_from_rad(open.closure_rad), 0.027, 0.002);
}

TEST(Closure, TheTieOnPullsTheFirstPassAlone) {
    const LaidClosure closure = closure_of(wound(34, 53, [](double circuit, int, double z) {
        return circuit < 0.5 ? rad_from_deg(0.3) * std::exp(-(z + 120.0) / 50.0) : 0.0;
    }));
    EXPECT_LT(closure.closure_rad, kExact_rad);
}

TEST(Closure, AJumpInTheMiddleIsSeen) {
    const LaidClosure closure = closure_of(wound(40, 37, [](double circuit, int, double) {
        return circuit < 20.0 ? 0.0 : rad_from_deg(0.05);
    }));
    EXPECT_FALSE(closure.holds());
    EXPECT_GT(deg_from_rad(closure.closure_rad), 0.04);
}

TEST(Closure, PassesThatLeadThereDoNotCount) {
    const auto drift = [](double circuit, int, double) { return rad_from_deg(0.001) * circuit; };
    const Wound w = wound(20, 21, drift);
    Wound after;
    after.starts_rad = w.starts_rad;
    // Up and down, a circuit of its own.
    const Wound before = wound(2, 3, [](auto...) { return 0.3; });
    after.laid.assign(before.laid.begin(), before.laid.begin() + 602);
    after.laid.insert(after.laid.end(), w.laid.begin(), w.laid.end());
    EXPECT_NEAR(closure_of(after).closure_rad, closure_of(w).closure_rad, kExact_rad);
}

TEST(Closure, TooFewCircuitsAreAFailure) {
    Wound w = wound(7, 5, [](auto...) { return 0.0; });
    w.laid.resize(w.laid.size() / 2);
    const LaidClosure closure = closure_of(w);
    EXPECT_FALSE(closure.holds());
    EXPECT_TRUE(test::tells(closure.failure, "7 circuits")) << closure.failure;
}

// A tube with a leg of 150 mm on either side of a bend of 90 degrees.
CentreLine bent_line() {
    const double bend_mm = 120.0 * 0.5 * kPi;
    return {CentrePlace{},
            {{150.0, Eigen::Vector2d::Zero()},
             {bend_mm, Eigen::Vector2d(-1.0 / 120.0, 0.0)},
             {150.0, Eigen::Vector2d::Zero()}}};
}

// Both hands of helices on it, n circuits up and down and a little beyond its ends. `phi` moves a
// place of the fibre about the line and `along_mm` along it, by circuit, pass and share of the way.
struct Moved {
    double phi_rad = 0.0;
    double along_mm = 0.0;
};

SurfacePath wound_on_tube(const CentreLine& line, int n,
                          const std::function<Moved(double circuit, int pass, double along)>& off) {
    constexpr int kStations = 400;
    constexpr double kTubeRadius_mm = 40.0;
    constexpr double kBeyond_mm = 20.0;
    const double length_mm = line.length_mm() + 2.0 * kBeyond_mm;
    SurfacePath path;
    for (int i = 0; i < n; ++i) {
        for (int pass = 0; pass < 2; ++pass) {
            const auto place = [&](double share) {
                const double up = pass == 0 ? share : 1.0 - share;
                const Moved moved = off(i + 0.5 * pass, pass, up);
                const CentrePlace at = line.at(length_mm * up - kBeyond_mm + moved.along_mm);
                const double phi = 5.0 * i + 2.0 * pass + 9.0 * share + moved.phi_rad;
                return Eigen::Vector3d(
                    at.position_mm +
                    kTubeRadius_mm * (std::cos(phi) * at.reference + std::sin(phi) * at.across()));
            };
            for (int s = 0; s <= kStations; ++s) {
                constexpr double kDelta = 1e-6;
                const double share = static_cast<double>(s) / kStations;
                PathPoint point;
                point.position_mm = place(share);
                point.tangent = (place(share + kDelta) - place(share - kDelta)).normalized();
                point.normal = Eigen::Vector3d::UnitX();  // not looked at
                path.push_back(point);
            }
        }
    }
    return path;
}

std::vector<double> sections_of(const CentreLine& line) {
    std::vector<double> sections;
    for (int k = 1; k < 20; ++k) {
        sections.push_back(line.length_mm() * k / 20.0);
    }
    return sections;
}

// Stations are a rotation by 9 / 400 rad apart: cubics of such chords are off by (9 / 400)^4 / 384,
// 7e-10 of the radius, and slopes taken over 2e-6 of the way are known to 1e-9.
constexpr double kCubic_rad = 1e-8;

TEST(TubeClosure, FollowingAndMovesAlongTheTubeAreNoDrift) {
    const CentreLine line = bent_line();
    const auto badly = [](double circuit, int pass, double along) {
        return Moved{rad_from_deg(0.3) * std::sin(7.0 * circuit + 20.0 * along + pass), 0.0};
    };
    const SurfacePath meant = wound_on_tube(line, 7, badly);
    LaidClosure closure = laid_tube_closure(meant, meant, 7, line, sections_of(line));
    EXPECT_TRUE(closure.holds());
    EXPECT_EQ(closure.closure_rad, 0.0);
    EXPECT_EQ(closure.parallels, 19U);
    // 0.1 mm further up after each pass: one hand moves on by what the other moves back.
    const SurfacePath even = wound_on_tube(line, 7, [](auto...) { return Moved{}; });
    const SurfacePath further = wound_on_tube(line, 7, [](double, int, double) {
        return Moved{0.0, 0.1};
    });
    closure = laid_tube_closure(further, even, 7, line, sections_of(line));
    EXPECT_TRUE(closure.holds());
    EXPECT_LT(closure.closure_rad, kCubic_rad);
    EXPECT_LT(closure.drift_rad, kCubic_rad);
}

TEST(TubeClosure, DriftOfEachCircuitAddsUp) {
    const CentreLine line = bent_line();
    for (const int n : {5, 23}) {
        const double per_circuit = rad_from_deg(0.001);
        const SurfacePath meant = wound_on_tube(line, n, [](auto...) { return Moved{}; });
        const SurfacePath laid = wound_on_tube(line, n, [&](double circuit, int, double) {
            return Moved{per_circuit * circuit, 0.0};
        });
        const LaidClosure closure =
            laid_tube_closure(laid, meant, static_cast<std::size_t>(n), line, sections_of(line));
        EXPECT_NEAR(closure.closure_rad, n * per_circuit, n * kCubic_rad);
        EXPECT_EQ(closure.holds(), n < 10);
        EXPECT_NEAR(closure.drift_rad, 0.5 * (n - 1) * per_circuit, kCubic_rad);
    }
}

TEST(TubeClosure, SaysWhereThereIsNothingToCompare) {
    const CentreLine line = bent_line();
    const SurfacePath meant = wound_on_tube(line, 4, [](auto...) { return Moved{}; });
    const LaidClosure closure = laid_tube_closure(meant, meant, 5, line, sections_of(line));
    EXPECT_FALSE(closure.holds());
    EXPECT_TRUE(test::tells(closure.failure, "5 circuits")) << closure.failure;
}

}  // namespace
}  // namespace meshwind
