/// Faces of a CAD part: kind, radius, colour and axis.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace meshwind {

/// A face of a CAD part.
struct CadFace {
    std::string kind;         ///< "plane", "cylinder", "cone", "sphere", "torus", "spline", "other"
    double radius_mm = 0.0;   ///< of cylinders, spheres and the tube of tori; 0: none
    double area_mm2 = 0.0;    ///< of its triangles
    std::int32_t solid = -1;  ///< number of its solid, -1: of none
    std::string colour{};     ///< "#rrggbb"; empty: the file gives it none
    std::int32_t region = -1;  ///< region of the mandrel in which most of it lies
    Eigen::Vector3d axis_point_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis_direction = Eigen::Vector3d::Zero();  ///< unit; zero where it has none
};

/// The words for CadFace::kind.
inline constexpr std::array<std::string_view, 7> kCadFaceKinds = {
    "plane", "cylinder", "cone", "sphere", "torus", "spline", "other"};

/// Whether `word` names this face: by its number from 1, its kind, or its colour, "#rrggbb".
[[nodiscard]] bool is_named(const CadFace& face, std::size_t number, std::string_view word);

}  // namespace meshwind
