/// A wound wall as shell elements: the bare mandrel's triangles with their plies.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

struct ShellPly {
    std::size_t layer = 0;      ///< of the job, from 0
    double angle_rad = 0.0;     ///< from the triangle's axis 1, above -pi/2 up to pi/2
    double thickness_mm = 0.0;  ///< > 0
};

struct ShellTriangle {
    std::array<std::int32_t, 3> point{};                ///< counter-clockwise from outside
    Eigen::Vector3d axis_1 = Eigen::Vector3d::UnitX();  ///< unit, in its plane, as is axis 2
    Eigen::Vector3d axis_2 = Eigen::Vector3d::UnitY();
    std::vector<ShellPly> plies;  ///< from the bottom to the top
};

/// A circle of open edges.
struct ShellRim {
    std::vector<std::int32_t> point;  ///< in loop order
    Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d area_mm2 =
        Eigen::Vector3d::Zero();  ///< of a lid over it, outward, as long as it is large
};

struct ShellMesh {
    double tow_thickness_mm = 0.0;
    std::vector<Eigen::Vector3d> point_mm;
    std::vector<ShellTriangle> triangle;
    std::vector<ShellRim> rim;  ///< in the order of their lowest points

    [[nodiscard]] std::size_t most_plies() const;
    [[nodiscard]] std::size_t bare() const;  ///< triangles without a ply
};

/// The lay-up of a run. \param file layup.json, or the folder of the run
/// \throws IoError io.cannot_read; InputError json.*, and layup.broken for indices out of range
[[nodiscard]] ShellMesh read_shell_mesh(const std::filesystem::path& file);

/// Report of merging plies.
struct PlyMerge {
    std::size_t plies_before = 0, plies_after = 0;  ///< of all triangles
    double worst_rad = 0.0;                         ///< largest change of a ply's angle by it
};

/// Merges plies of one layer and of near angles into one, at the place of the lowest: first those
/// less than `near_rad` apart, then on triangles with more than `most` left the two nearest, of any
/// layer. Thickness is kept, the angle is the mean of their directions by thickness.
PlyMerge merge_plies(ShellMesh& mesh, double near_rad, std::size_t most);

}  // namespace meshwind
