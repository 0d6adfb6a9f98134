#include "winding/laminate/families.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
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

TEST(Families, ManyCoursesOfTwoHands) {
    const double angle = rad_from_deg(50.0);
    std::vector<SurfacePath> paths;
    std::vector<const SurfacePath*> courses;
    constexpr int kCourses = 2000;
    for (int i = 0; i < kCourses; ++i) {
        paths.push_back(helix(i % 2 == 0 ? angle : -angle, 1.1 * kBand_mm * (i / 2), 100.0));
    }
    for (const SurfacePath& path : paths) {
        courses.push_back(&path);
    }
    const std::vector<std::int32_t> family = families_of(courses, kBand_mm);
    for (std::size_t i = 0; i < family.size(); ++i) {
        EXPECT_EQ(family[i], static_cast<std::int32_t>(i % 2)) << i;
    }
}

// Courses that come and go one by one are the same as all of them at once.
TEST(Neighbourhood, KeepsUpWithCoursesThatComeAndGo) {
    Neighbourhood kept;
    std::vector<SurfacePath> paths;
    std::uint64_t index = 0;
    const auto draw = [&] { return random_unit(4, index++); };
    const auto any_helix = [&] { return helix(draw() < 0.5 ? 0.7 : 0.9, 60.0 * draw()); };
    const auto row_of = [&](const CourseShape& shape) { return kept.beside(shape); };
    for (int i = 0; i < 200; ++i) {
        const double kind = draw();
        const auto one = paths.empty() ? 0 : random_bits(4, index++) % paths.size();
        if (paths.size() < 5 || kind < 0.4) {
            paths.push_back(any_helix());
            const CourseShape shape(paths.back(), kBand_mm);
            kept.add(shape, row_of(shape));
        } else if (kind < 0.7) {
            const SurfacePath path = any_helix();
            const CourseShape shape(path, kBand_mm);
            std::vector<SurfacePath> after = paths;
            after[one] = path;
            std::vector<const SurfacePath*> courses;
            for (const SurfacePath& course : after) {
                courses.push_back(&course);
            }
            const auto family = families_of(courses, kBand_mm);
            const std::vector<char> row = row_of(shape);
            EXPECT_EQ(kept.without_family(one, &row), std::count(family.begin(), family.end(), -1));
            kept.replace(one, shape, row);
            paths = std::move(after);
        } else {
            kept.remove(one);
            paths.erase(paths.begin() + static_cast<std::ptrdiff_t>(one));
        }
        std::vector<const SurfacePath*> courses;
        for (const SurfacePath& course : paths) {
            courses.push_back(&course);
        }
        ASSERT_EQ(kept.families(), families_of(courses, kBand_mm)) << "step " << i;
    }
}

}  // namespace
}  // namespace meshwind
