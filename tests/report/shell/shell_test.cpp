#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/units.h"
#include "report/shell/shell_model.h"
#include "report/shell/strength.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr PlyStrength kStrength{.tension_1_mpa = 2100.0,
                                .compression_1_mpa = 1050.0,
                                .tension_2_mpa = 24.0,
                                .compression_2_mpa = 132.0,
                                .shear_12_mpa = 75.0};

TEST(TsaiWu, IsMetByEachStrengthAlone) {
    for (const PlyStress& stress : {PlyStress{2100.0, 0.0, 0.0},
                                    {-1050.0, 0.0, 0.0},
                                    {0.0, 24.0, 0.0},
                                    {0.0, -132.0, 0.0},
                                    {0.0, 0.0, 75.0},
                                    {0.0, 0.0, -75.0}}) {
        EXPECT_NEAR(tsai_wu_reserve(kStrength, stress), 1.0, 1e-12);
    }
    EXPECT_TRUE(std::isinf(tsai_wu_reserve(kStrength, {})));
}

// The criterion as it is printed, at the stress that the reserve leads to.
TEST(TsaiWu, ReserveLeadsToTheCriterion) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    for (int trial = 0; trial < 200; ++trial) {
        const PlyStress stress{3000.0 * part(random), 200.0 * part(random), 100.0 * part(random)};
        const double reserve = tsai_wu_reserve(kStrength, stress);
        const double s1 = reserve * stress.along;
        const double s2 = reserve * stress.across;
        const double s12 = reserve * stress.shear;
        const double value = s1 / 2100.0 - s1 / 1050.0 + s2 / 24.0 - s2 / 132.0 +
                             s1 * s1 / (2100.0 * 1050.0) + s2 * s2 / (24.0 * 132.0) +
                             s12 * s12 / (75.0 * 75.0) -
                             s1 * s2 / std::sqrt(2100.0 * 1050.0 * 24.0 * 132.0);
        EXPECT_GT(reserve, 0.0);
        EXPECT_NEAR(value, 1.0, 1e-9) << s1 << ' ' << s2 << ' ' << s12;
    }
}

ShellPly ply(std::size_t layer, double angle_deg, double thickness_mm) {
    return {layer, rad_from_deg(angle_deg), thickness_mm};
}

TEST(MergePlies, NearAnglesOfOneLayerAreOne) {
    ShellMesh mesh;
    mesh.triangle.resize(1);
    mesh.triangle[0].plies = {ply(0, 89.0, 0.1), ply(0, 30.0, 0.2), ply(1, 31.0, 0.2),
                              ply(0, -89.0, 0.1), ply(0, 33.0, 0.1)};
    const PlyMerge merge = merge_plies(mesh, rad_from_deg(5.0), 10);
    const std::vector<ShellPly>& plies = mesh.triangle[0].plies;
    ASSERT_EQ(plies.size(), 3U);
    EXPECT_EQ(merge.plies_before, 5U);
    EXPECT_EQ(merge.plies_after, 3U);
    EXPECT_NEAR(std::abs(deg_from_rad(plies[0].angle_rad)), 90.0, 1e-9);
    EXPECT_NEAR(plies[0].thickness_mm, 0.2, 1e-12);
    EXPECT_NEAR(deg_from_rad(plies[1].angle_rad), 31.0, 0.01);  // 30 twice as thick as 33
    EXPECT_NEAR(plies[1].thickness_mm, 0.3, 1e-12);
    EXPECT_EQ(plies[2].layer, 1U);
    EXPECT_NEAR(deg_from_rad(merge.worst_rad), 2.0, 0.01);
}

TEST(MergePlies, LeavesAsManyAsAreAllowed) {
    ShellMesh mesh;
    mesh.triangle.resize(1);
    double thickness_mm = 0.0;
    for (int k = 0; k < 30; ++k) {
        mesh.triangle[0].plies.push_back(ply(static_cast<std::size_t>(k), -87.0 + 6.0 * k, 0.1));
        thickness_mm += 0.1;
    }
    static_cast<void>(merge_plies(mesh, 0.0, 7));
    EXPECT_EQ(mesh.most_plies(), 7U);
    double after_mm = 0.0;
    for (const ShellPly& one : mesh.triangle[0].plies) {
        after_mm += one.thickness_mm;
    }
    EXPECT_NEAR(after_mm, thickness_mm, 1e-12);
}

constexpr double kRadius_mm = 50.0;

// An open tube about Z.
ShellMesh tube(int around, int along) {
    ShellMesh mesh;
    mesh.tow_thickness_mm = 0.25;
    const double edge_mm = 2.0 * kPi * kRadius_mm / around;
    for (int k = 0; k <= along; ++k) {
        for (int i = 0; i < around; ++i) {
            const double at = 2.0 * kPi * (i + 0.5 * (k % 2)) / around;
            mesh.point_mm.emplace_back(kRadius_mm * std::cos(at), kRadius_mm * std::sin(at),
                                       edge_mm * k);
        }
    }
    const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
        ShellTriangle triangle;
        triangle.point = {a, b, c};
        mesh.triangle.push_back(triangle);
    };
    for (int k = 0; k < along; ++k) {
        for (int i = 0; i < around; ++i) {
            const std::int32_t low = k * around + i;
            const std::int32_t next = k * around + (i + 1) % around;
            const std::int32_t up = k % 2 == 0 ? low + around : next + around;
            const std::int32_t up_next = k % 2 == 0 ? next + around : low + around;
            add(low, next, up);
            if (k % 2 == 0) {
                add(next, up_next, up);
            } else {
                add(low, up, up_next);
            }
        }
    }
    return mesh;
}

// How far middles of sides are off the cylinder, away from the rims, where normals are one-sided.
double middles_off_mm(int around) {
    const int along = around / 4;
    const ShellMesh mesh = tube(around, along);
    const WallMaterial material;
    const ShellModel model = shell_model(mesh, material, {}, ElementOrder::Quadratic);
    const double length_mm = mesh.point_mm.back().z();
    double worst = 0.0;
    for (std::size_t i = mesh.point_mm.size(); i < model.node_mm.size(); ++i) {
        const Vector3d& node = model.node_mm[i];
        if (node.z() > 0.2 * length_mm && node.z() < 0.8 * length_mm) {
            worst = std::max(worst, std::abs(std::hypot(node.x(), node.y()) - kRadius_mm));
        }
    }
    return worst;
}

TEST(ShellModel, MiddlesOfSidesLieOnTheWallToFourthOrder) {
    const double coarse = middles_off_mm(24);
    const double fine = middles_off_mm(48);
    EXPECT_GT(std::log2(coarse / fine), 3.5);
    EXPECT_LT(fine, 1e-3);  // a chord is 0.1 mm off
}

TEST(ShellModel, SixSupportsHoldEveryRigidMotion) {
    const ShellMesh mesh = tube(24, 12);
    const WallMaterial material;
    const ShellModel model = shell_model(mesh, material, {}, ElementOrder::Linear);
    ASSERT_EQ(model.support.size(), 6U);
    Eigen::Matrix<double, 6, 6> held;
    for (std::size_t k = 0; k < 6; ++k) {
        const Support& one = model.support[k];
        const Vector3d axis = Vector3d::Unit(one.axis);
        const Vector3d arm = model.node_mm[static_cast<std::size_t>(one.node)] / kRadius_mm;
        held.row(static_cast<Eigen::Index>(k)) << axis.transpose(), arm.cross(axis).transpose();
    }
    EXPECT_GT(std::abs(held.determinant()), 0.1);
}

}  // namespace
}  // namespace meshwind
