#include "postproc/tables/landing_circuits.h"

#include <iterator>
#include <utility>

namespace meshwind {

LandingTable repeated(LandingTable table, int times, double turn_rad,
                      const Eigen::Affine3d& mandrel_from_table) {
    const std::size_t first = table.courses.size();
    for (int circuit = 1; circuit < times; ++circuit) {
        const Eigen::Affine3d turn(Eigen::AngleAxisd(circuit * turn_rad, Eigen::Vector3d::UnitZ()));
        const Eigen::Affine3d in_table = mandrel_from_table.inverse() * turn * mandrel_from_table;
        for (std::size_t i = 0; i < first; ++i) {
            LandingCourse course = table.courses[i];
            course.name += " of circuit " + std::to_string(circuit + 1);
            for (LandingRow& row : course.rows) {
                row.position = in_table * row.position;
                if (row.normal) {
                    row.normal = in_table.linear() * *row.normal;
                }
                if (row.tangent) {
                    row.tangent = in_table.linear() * *row.tangent;
                }
            }
            table.courses.push_back(std::move(course));
        }
    }
    return table;
}

LandingTable joined(LandingTable table, double meets_mm,
                    const Eigen::Affine3d& mandrel_from_table) {
    std::vector<LandingCourse> courses;
    for (LandingCourse& course : table.courses) {
        const bool meets = !courses.empty() &&
                           (mandrel_from_table.linear() *
                            (course.rows.front().position - courses.back().rows.back().position))
                                   .norm() <= meets_mm;
        if (meets) {
            std::vector<LandingRow>& rows = courses.back().rows;
            rows.insert(rows.end(), std::next(course.rows.begin()), course.rows.end());
        } else {
            courses.push_back(std::move(course));
        }
    }
    table.courses = std::move(courses);
    return table;
}

}  // namespace meshwind
