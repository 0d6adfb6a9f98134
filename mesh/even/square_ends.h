/// Trims the ends of a wall to circles on their legs.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mesh/even/labelled_mesh.h"

namespace meshwind {

struct EndCut {
    Eigen::Vector3d centre_mm;  ///< of the leg's circle where it is cut
    double depth_mm = 0.0;      ///< from the end's farthest point to there
};

struct SquareEnds {
    LabelledMesh part;
    std::vector<char> kept;  ///< per region; each cut-off end is a new region that is not kept
    std::vector<EndCut> cuts;
};

/// Cuts off all that is no part of an end's leg: rounded lips, fillets and chamfers that lead from
/// the leg to its end face or bore, tabs and notches. The leg is the cylinder or cone of the wall
/// beside the rim; the cut is square to its axis, where the last of it begins. An end that would
/// lose more than a quarter of its radius stays as it is, and so does one without such a leg (a
/// dome, an oblique end), or with a collar, which stands out from its leg.
/// \param kept per region: whether it is wall \param depth_mm cut off each end with a leg instead;
/// 0: nothing \return none where nothing is cut off \pre part is an oriented manifold, mm
[[nodiscard]] std::optional<SquareEnds> square_ends(const LabelledView& part,
                                                    const std::vector<char>& kept,
                                                    const std::optional<double>& depth_mm);

}  // namespace meshwind
