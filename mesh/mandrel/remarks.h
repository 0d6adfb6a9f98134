/// Remarks on a part for the user, in words and with their places.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "mesh/mandrel.h"

namespace meshwind {

/// Adds a remark for each finding of the mandrel, with its places.
/// \param holes_mm of the wall, too small for rims \param crumbs_mm pieces of the wall that are
/// left out; both in the mandrel frame \pre all else of the mandrel is final
void add_remarks(Mandrel& mandrel, std::span<const Eigen::Vector3d> holes_mm,
                 std::span<const Eigen::Vector3d> crumbs_mm);

/// Adds one remark with one place for each of the largest groups of near places.
void add_remark(Mandrel& mandrel, std::string words, std::span<const Eigen::Vector3d> places_mm);

/// One point for each group, the one nearest to the group's middle. A point belongs to the first
/// group that begins nearer than `near_mm`. Larger groups first.
[[nodiscard]] std::vector<Eigen::Vector3d> middles_of_groups(
    std::span<const Eigen::Vector3d> points_mm, double near_mm);

}  // namespace meshwind
