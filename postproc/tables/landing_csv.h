/// Reads tables of landing points made elsewhere.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// One row, in the frame and the units of the table.
struct LandingRow {
    int line = 0;  ///< of the file, counted from 1
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d> normal{};   ///< as given, any length but 0
    std::optional<Eigen::Vector3d> tangent{};  ///< direction of travel, any length but 0
};

/// Rows that belong together, in order.
struct LandingCourse {
    std::string name;  ///< the cell of the column `course`; "1" without one
    bool transition = false;
    std::vector<LandingRow> rows;  ///< n >= 2
};

struct LandingTable {
    std::vector<LandingCourse> courses;  ///< n >= 1
    bool in_mm = false;                  ///< the columns are named x_mm, y_mm and z_mm
};

/// Columns `x_mm,y_mm,z_mm` or `x,y,z` in any order among others; `course`, where there is one: a
/// new course begins where its cell changes; `kind` with the word "transition" for a piece that
/// only leads from one course to the next; outward normals `nx,ny,nz`; directions of travel
/// `tx,ty,tz`. Other columns are not read, so path.csv and the tables of `meshwind trace` can be
/// read.
/// \param file name for messages
/// \throws InputError import.column, import.number, import.empty, each with file and line
[[nodiscard]] LandingTable read_landing_csv(std::string_view text, const std::string& file);

}  // namespace meshwind
