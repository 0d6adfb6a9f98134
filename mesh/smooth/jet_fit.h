/// Jet fitting: height polynomials of the surface through the neighbours of a vertex.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "mesh/height_jet.h"

namespace meshwind {

inline constexpr int kMaxJetDegree = 4;
/// Terms that the neighbours determined: all up to a degree; some of the quadratic ones and above;
/// none, so that normal and curvature are averages of the facets.
enum class JetTerms : std::uint8_t { Quartic, Cubic, Quadratic, Reduced, Averaged };

struct Jet {
    HeightJet height;                       ///< passes through the vertex
    Eigen::Vector3d normal;                 ///< unit, on the side of the guess
    Eigen::Matrix3d shape_operator_per_mm;  ///< symmetric, `normal` in its kernel, > 0 where convex
    JetTerms terms = JetTerms::Quartic;
};

/// Least-squares fit of z = polynomial(x, y) through `centre` over the plane of `normal_guess`, of
/// the highest degree up to `max_degree` that the neighbours determine. One that they determine
/// badly, as to one side of a wall's end, is kept only if the slope is clearly better by its
/// standard error. Where not even all quadratic terms are determined, as on long facets between
/// two end circles, the undetermined terms are left out: the surface is taken as ruled where
/// nothing is known of it.
/// \param neighbours points of the same smooth surface, without `centre` \param max_degree 2 to 4
/// \return nothing when the neighbours are too few or lie on a line
/// Accuracy: normals of order `degree`, curvature of order `degree` - 1 in the neighbours'
/// distance. Source: cazals_2005_jets, sec. 3 (Monge form by polynomial fitting).
[[nodiscard]] std::optional<Jet> fit_jet(const Eigen::Vector3d& centre,
                                         const Eigen::Vector3d& normal_guess,
                                         std::span<const Eigen::Vector3d> neighbours,
                                         int max_degree = kMaxJetDegree);

/// A jet with a given normal whose curvature alone comes from the neighbours: how unit normals
/// differ between `centre` and there (first order; flat where they determine nothing).
/// \param neighbours, normals as long as each other
[[nodiscard]] Jet jet_from_normals(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal,
                                   std::span<const Eigen::Vector3d> neighbours,
                                   std::span<const Eigen::Vector3d> normals);

}  // namespace meshwind
