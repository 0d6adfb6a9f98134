/// Lines that a mandrel might turn about, with figures to choose by.
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
    double residual_mm = 0.0;  ///< as find_spindle has it for the rule; of a chord 0
    double swing_mm = 0.0;     ///< farthest from the line that the part reaches
    int rims = 0;              ///< that lie around it, see kCoaxialSine
    double gap_rad = 0.0;      ///< widest angle about it without wall
    double angle_rad = 0.0;    ///< to the chosen one, 0 to pi / 2
    double off_mm = 0.0;       ///< of the chosen one's origin from the line
    std::string why;           ///< it was chosen, or was not
};

/// The chosen axis first, then the others by rule; lines that coincide with an earlier one are left
/// out, the principal axes from the longest. \pre the mandrel is as it was loaded
[[nodiscard]] std::vector<AxisCandidate> axis_candidates(const Mandrel& mandrel);

}  // namespace meshwind
