#include "postproc/ringhead/frame_axis.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/text/text_file.h"
#include "core/units.h"
#include "tests/support/l_frame.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Worst of the fit against the exact frame: across and along the axis, and its directions.
struct FitError {
    double across_mm = 0.0, along_mm = 0.0, tangent = 0.0, reference = 0.0;
};

FitError fit_error(const FrameAxis& axis) {
    FitError worst;
    for (double s = 0.0; s <= test::kFrame_mm; s += 0.173) {
        const AxisFrame is = axis.at(s);
        const AxisFrame exact = test::l_frame_at(s);
        const Vector3d off = is.point_mm - exact.point_mm;
        const double along = off.dot(exact.tangent);
        worst.along_mm = std::max(worst.along_mm, std::abs(along));
        worst.across_mm = std::max(worst.across_mm, (off - along * exact.tangent).norm());
        worst.tangent = std::max(worst.tangent, (is.tangent - exact.tangent).norm());
        worst.reference = std::max(worst.reference, (is.reference - exact.reference).norm());
    }
    return worst;
}

TEST(FrameAxis, MeetsTheExactArcBetweenItsStations) {
    const FrameAxis axis = test::l_frame(10.0);
    EXPECT_NEAR(axis.length_mm(), test::kFrame_mm, 1e-6);
    const FitError error = fit_error(axis);
    EXPECT_LT(error.across_mm, 1e-7);  // 2/27 sin^6(turn/4) R = 3e-9 mm, and along^2 / 2R
    EXPECT_LT(error.along_mm, 5e-4);
    EXPECT_LT(error.tangent, 5e-4 / test::kBendRadius_mm * 1.5);
    EXPECT_LT(error.reference, 5e-5);  // the turn is even in the step's parameter, not in length
}

TEST(FrameAxis, LeavesAnArcByTheSixthPowerOfItsStep) {
    constexpr double kRadius = 100.0;
    for (const int steps : {1, 2, 4}) {
        std::vector<AxisStation> stations;
        for (int i = 0; i <= steps; ++i) {
            const double angle = 0.5 * kPi * i / steps;
            stations.push_back({kRadius * Vector3d(std::cos(angle), std::sin(angle), 0.0),
                                Vector3d(-std::sin(angle), std::cos(angle), 0.0), Vector3d::UnitZ(),
                                0.0});
        }
        const FrameAxis axis(stations);
        double off_mm = 0.0;
        for (int k = 0; k <= 1000; ++k) {
            const double s = axis.length_mm() * k / 1000.0;
            off_mm = std::max(off_mm, std::abs(axis.at(s).point_mm.norm() - kRadius));
        }
        const double q = kPi / 8.0 / steps;  // a quarter of the turn of a step
        const double expected =
            2.0 / 27.0 * std::pow(std::sin(q), 6) / std::pow(std::cos(q), 2) * kRadius;
        EXPECT_NEAR(off_mm, expected, 0.001 * expected) << steps;
    }
}

TEST(FrameAxis, CarriesTheReferenceAlongAHelixWithoutTurning) {
    // A helix of radius r and slope p turns its own binormal by torsion times length; a reference
    // that does not turn lags behind by just that.
    constexpr double kRadius = 100.0;
    constexpr double kPitch = 40.0;  // per rad
    const double speed = std::hypot(kRadius, kPitch);
    const auto at = [&](double t) {
        return Vector3d(kRadius * std::cos(t), kRadius * std::sin(t), kPitch * t);
    };
    const auto tangent = [&](double t) {
        return Vector3d(Vector3d(-kRadius * std::sin(t), kRadius * std::cos(t), kPitch) / speed);
    };
    const auto normal = [](double t) { return Vector3d(-std::cos(t), -std::sin(t), 0.0); };
    const auto lag_error = [&](int steps) {
        constexpr double kEnd = 3.0;
        Vector3d reference = normal(0.0);
        for (int i = 0; i < steps; ++i) {
            const double a = kEnd * i / steps;
            const double b = kEnd * (i + 1) / steps;
            reference = carried_reference(at(a), tangent(a), at(b), tangent(b), reference);
        }
        const Vector3d& n = normal(kEnd);
        const double lag = std::atan2(tangent(kEnd).dot(reference.cross(n)), reference.dot(n));
        return std::abs(lag - kPitch / (speed * speed) * speed * kEnd);
    };
    EXPECT_LT(lag_error(60), 1e-5);
    EXPECT_NEAR(lag_error(30) / lag_error(60), 16.0, 2.0);  // fourth order
}

TEST(FrameAxis, ParabolaTangentsAreOfSecondOrderOnUnevenSpacing) {
    const auto worst = [](double h) {
        std::vector<Vector3d> points, exact;
        double angle = 0.0;
        for (int i = 0; i < 30; ++i) {
            points.emplace_back(70.0 * std::cos(angle), 70.0 * std::sin(angle), 30.0 * angle);
            exact.push_back(
                Vector3d(-70.0 * std::sin(angle), 70.0 * std::cos(angle), 30.0).normalized());
            angle += (i % 2 == 0 ? 1.0 : 2.0) * h / 76.0;
        }
        const std::vector<Vector3d> tangents = parabola_tangents(points);
        double error = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            error = std::max(error, (tangents[i] - exact[i]).norm());
        }
        return error;
    };
    EXPECT_NEAR(worst(2.0) / worst(1.0), 4.0, 0.2);
    EXPECT_LT(worst(1.0), 4e-4);
}

TEST(FrameAxis, AClosedAxisHasOneTangentAtItsSeam) {
    std::vector<Vector3d> ring;
    for (int i = 0; i <= 40; ++i) {
        const double angle = 2.0 * kPi * i / 40;
        ring.emplace_back(80.0 * std::cos(angle), 80.0 * std::sin(angle), 0.0);
    }
    const std::vector<Vector3d> tangents = parabola_tangents(ring);
    EXPECT_LT((tangents.front() - Vector3d::UnitY()).norm(), 1e-12);
    EXPECT_LT((tangents.back() - Vector3d::UnitY()).norm(), 1e-12);
}

TEST(AxisCsv, TheTableOfTheProjectIsTheExactFrame) {
    const std::string file = std::string(MESHWIND_SOURCE_DIR) + "/data/l_frame_axis.csv";
    const FrameAxis axis = read_axis_csv(read_text_file(file), file);
    ASSERT_EQ(axis.stations().size(), 106u);
    EXPECT_NEAR(axis.length_mm(), test::kFrame_mm, 1e-6);
    const FitError error = fit_error(axis);
    EXPECT_LT(error.across_mm, 1e-7);
    EXPECT_LT(error.along_mm, 5e-4);
}

TEST(AxisCsv, FindsTangentsAndReferencesThatAreNotGiven) {
    std::string text = "z_mm,y_mm,x_mm\n";
    for (int i = 0; i <= 90; ++i) {
        const double angle = rad_from_deg(i);
        text += std::to_string(100.0 * std::sin(angle)) + ",0," +
                std::to_string(100.0 * (1.0 - std::cos(angle))) + "\n";
    }
    const FrameAxis axis = read_axis_csv(text, "a.csv");
    EXPECT_NEAR(axis.length_mm(), 50.0 * kPi, 1e-3);
    for (std::size_t i = 0; i <= 90; ++i) {
        const double angle = rad_from_deg(static_cast<double>(i));
        const AxisStation& station = axis.stations()[i];
        // 1/3 of the turn per step squared at the ends
        EXPECT_LT((station.tangent - Vector3d(std::sin(angle), 0.0, std::cos(angle))).norm(), 2e-4);
        // the arc is in xz: y is furthest from the first tangent, and stays
        EXPECT_LT((station.reference - Vector3d::UnitY()).norm(), 1e-12);
    }
}

std::string refusal(const std::string& text) {
    try {
        (void)read_axis_csv(text, "a.csv");
    } catch (const InputError& error) {
        return error.code() + " " + error.place();
    }
    return "accepted";
}

TEST(AxisCsv, RefusesWhatIsNoAxis) {
    const std::string xyz = "x_mm,y_mm,z_mm";
    const std::string two = "0,0,0\n0,0,10\n";
    EXPECT_EQ(refusal(xyz + "\n" + two), "accepted");
    EXPECT_EQ(refusal(xyz + "\r\n0,0,0\r\n0,0,10"), "accepted");
    EXPECT_EQ(refusal(""), "axis.column a.csv:1");
    EXPECT_EQ(refusal("x_mm,y_mm\n0,0\n0,1\n"), "axis.column a.csv:1");
    EXPECT_EQ(refusal("x,y,z\n" + two), "axis.column a.csv:1");
    EXPECT_EQ(refusal(xyz + ",x_mm\n0,0,0,0\n"), "axis.column a.csv:1");
    EXPECT_EQ(refusal(xyz + ",tx,ty\n"), "axis.column a.csv:1");
    EXPECT_EQ(refusal(xyz + "\n0,0,0\n"), "axis.too_few a.csv:2");
    EXPECT_EQ(refusal(xyz + "\n0,0,0\n0,0,ten\n"), "axis.number a.csv:3");
    EXPECT_EQ(refusal(xyz + "\n0,0,0\n0,0,nan\n"), "axis.number a.csv:3");
    EXPECT_EQ(refusal(xyz + "\n0,0,0\n0,0,1e9\n"), "axis.number a.csv:3");
    EXPECT_EQ(refusal(xyz + "\n0,0,0\n\n0,0,10\n"), "axis.number a.csv:3");
    EXPECT_EQ(refusal(xyz + "\n0,0,0\n0,0,10,4\n"), "axis.number a.csv:3");
    EXPECT_EQ(refusal(xyz + "\n0,0,0\n0,0,0\n0,0,10\n"), "axis.same_point a.csv:3");
    EXPECT_EQ(refusal(xyz + "\n0,0,0\n0,0,10\n0,0,2\n"), "axis.tangent a.csv:3");
    EXPECT_EQ(refusal(xyz + ",tx,ty,tz\n0,0,0,0,0,1\n0,0,10,0,0,-1\n"), "axis.tangent a.csv:3");
    EXPECT_EQ(refusal(xyz + ",tx,ty,tz\n0,0,0,0,0,1\n0,0,10,0,0,0\n"), "axis.tangent a.csv:3");
    EXPECT_EQ(refusal(xyz + ",rx,ry,rz\n0,0,0,0,1,0\n0,0,10,0,0,1\n"), "axis.reference a.csv:3");
}

}  // namespace
}  // namespace meshwind
