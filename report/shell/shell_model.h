/// Finite element model of a wound wall: nodes, elements, loads and supports, in no program's
/// format yet.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "report/shell/shell_mesh.h"
#include "report/shell/wall_material.h"

namespace meshwind {

/// Loads on the wall, in balance with each other.
struct ShellLoads {
    double pressure_mpa = 0.0;  ///< inside; lids over the rims bear it too and pull at them
    double axial_n = 0.0;       ///< tension between two rims, along the line of their centres
    /// Moment on the second of both rims, bending and twisting; the first takes the opposite.
    Eigen::Vector3d moment_nmm = Eigen::Vector3d::Zero();
    /// The two rims, from 0; by default those whose lids face away from each other most, and of
    /// such the furthest apart.
    std::optional<std::array<std::size_t, 2>> rims;
};

struct NodalForce {
    std::int32_t node = 0;
    Eigen::Vector3d force_n;
};

/// A displacement that is held at zero.
struct Support {
    std::int32_t node = 0;
    int axis = 0;  ///< 0 .. 2: X, Y, Z
};

enum class ElementOrder {
    Linear,    ///< three nodes
    Quadratic  ///< six: the middles of the sides 1-2, 2-3 and 3-1 too
};

struct ShellModel {
    const ShellMesh* mesh = nullptr;
    const WallMaterial* material = nullptr;
    double pressure_mpa = 0.0;             ///< on every element, along its normal
    std::vector<Eigen::Vector3d> node_mm;  ///< the mesh's points, then the middles
    /// Per triangle; of linear elements the first three.
    std::vector<std::array<std::int32_t, 6>> element;
    std::vector<NodalForce> force;  ///< by node
    std::vector<Support> support;   ///< six: they hold the body still and strain nothing
};

/// Middles of sides lie on the smooth surface through the triangles, except on sides where
/// triangles meet at more than 30 degrees, which are straight. Forces at a rim are spread evenly
/// along it, those of a moment in proportion to the distance from the neutral line. \pre mesh and
/// material outlive it
/// \throws InputError shell.no_rim for rims that do not exist, shell.no_pair where a load between
/// two rims has none
[[nodiscard]] ShellModel shell_model(const ShellMesh& mesh, const WallMaterial& material,
                                     const ShellLoads& loads, ElementOrder order);

}  // namespace meshwind
