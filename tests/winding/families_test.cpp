#include "winding/families.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kBand_mm = 6.0;
constexpr double kRadius_mm = 40.0;

// A helix on a cylinder, moved along by `shift_mm` at the same angle.
SurfacePath helix(double angle_rad, double shift_mm, double length_mm = 200.0) {
    SurfacePath path;
    for (double s = 0.0; s <= length_mm; s += 2.0) {
        const double around = s * std::sin(angle_rad) / kRadius_mm;
        PathPoint point;
        point.position_mm = {kRadius_mm * std::cos(around), kRadius_mm * std::sin(around),
                             shift_mm + s * std::cos(angle_rad)};
        point.tangent = {-std::sin(around) * std::sin(angle_rad),
                         std::cos(around) * std::sin(angle_rad), std::cos(angle_rad)};
        point.normal = {std::cos(around), std::sin(around), 0.0};
        point.s_mm = s;
        path.push_back(point);
    }
    return path;
}

TEST(Families, JoinsParallelCoursesABandApart) {
    const double angle = rad_from_deg(50.0);
    const double apart = kBand_mm / std::sin(angle);  // along the axis
    const SurfacePath a = helix(angle, 0.0);
    const SurfacePath b = helix(angle, apart);
    const SurfacePath c = helix(angle, 2.0 * apart);
    const SurfacePath alone = helix(angle, 8.0 * apart);
    const SurfacePath other_hand = helix(-angle, apart);
    const std::vector<const SurfacePath*> courses{&alone, &a, &other_hand, &c, &b};
    EXPECT_EQ(families_of(courses, kBand_mm), (std::vector<std::int32_t>{-1, 0, -1, 0, 0}));
}

TEST(Families, TwoAreNone) {
    const SurfacePath a = helix(0.8, 0.0);
    const SurfacePath b = helix(0.8, 7.0);
    EXPECT_EQ(families_of(std::vector<const SurfacePath*>{&a, &b}, kBand_mm),
              (std::vector<std::int32_t>{-1, -1}));
}

TEST(Families, CrossingCoursesAreNotParallel) {
    std::vector<SurfacePath> paths;
    std::vector<const SurfacePath*> courses;
    for (int i = 0; i < 4; ++i) {
        paths.push_back(helix(0.4 + 0.3 * i, 0.0));
    }
    for (const SurfacePath& path : paths) {
        courses.push_back(&path);
    }
    EXPECT_EQ(families_of(courses, kBand_mm), std::vector<std::int32_t>(4, -1));
}

}  // namespace
}  // namespace meshwind
