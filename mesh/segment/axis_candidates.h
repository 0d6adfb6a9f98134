/// Candidates for the spindle axis of a mandrel, with figures to choose by.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "mesh/mandrel.h"

namespace meshwind {

struct AxisCandidate {
    /// "given", "coaxial-rims", "revolution", "chord" (through the centres of two rims),
    /// "principal"
    std::string rule;
    Eigen::Vector3d through_mm = Eigen::Vector3d::Zero();  ///< mandrel frame
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit, mandrel frame
    double residual_mm = 0.0;  ///< by find_spindle for the rule; 0 for a chord
    double swing_mm = 0.0;     ///< largest distance of the part from the line
    int rims = 0;              ///< number of rims that lie around it, see kCoaxialSine
    double gap_rad = 0.0;      ///< widest angle about it without wall
    double angle_rad = 0.0;    ///< to the chosen one, 0 to pi / 2
    double off_mm = 0.0;       ///< of the chosen one's origin from the line
    std::string why;           ///< why it was chosen, or was not
};

/// The chosen axis first, then the others by rule; lines that coincide with an earlier one are left
/// out, the principal axes from the longest. \pre the mandrel is as it was loaded
[[nodiscard]] std::vector<AxisCandidate> axis_candidates(const Mandrel& mandrel);

}  // namespace meshwind
