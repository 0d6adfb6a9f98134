/// Smooth normal and curvature at a vertex from a least-squares height fit over its neighbours.
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace meshwind {

struct Jet {
    Eigen::Vector3d normal;                 ///< unit, on the side of the guess
    Eigen::Matrix3d shape_operator_per_mm;  ///< symmetric, `normal` in its kernel, > 0 where convex
};

/// Fits z = polynomial(x, y) of the given degree through `centre` over the plane of `normal_guess`.
/// \param degree 2 or 3 \param neighbours points of the same smooth surface, without `centre`
/// \return nothing when the neighbours are too few or do not determine the coefficients
/// Accuracy: normals of order `degree`, curvature of order `degree` - 1 in the neighbours'
/// distance. Source: cazals_2005_jets, sec. 3 (Monge form by polynomial fitting).
[[nodiscard]] std::optional<Jet> fit_jet(const Eigen::Vector3d& centre,
                                         const Eigen::Vector3d& normal_guess,
                                         std::span<const Eigen::Vector3d> neighbours, int degree);

/// Curvature alone, from how unit normals differ between `centre` and its neighbours (first order).
/// \param neighbours, normals as long as each other \return zero where they determine nothing
[[nodiscard]] Eigen::Matrix3d shape_operator_from_normals(
    const Eigen::Vector3d& centre, const Eigen::Vector3d& normal,
    std::span<const Eigen::Vector3d> neighbours, std::span<const Eigen::Vector3d> normals);

}  // namespace meshwind
