/// Writes the table motion.csv: the positions of all axes, block by block.
#pragma once

#include <string>

#include "machines/machine.h"
#include "postproc/motion/block.h"

namespace meshwind {

/// Columns `block,time_s,<axis letters>,ex_mm,ey_mm,ez_mm,rx,ry,rz,course,point`, one row per
/// block: the time at its end, absolute positions in mm or **deg** with the decimals of the
/// resolution, the eye and its roller's direction in the mandrel frame by forward kinematics of
/// these rounded positions. Block 0 is the start. Course and point are empty where unknown. \pre
/// list has the axes of the machine
[[nodiscard]] std::string motion_csv(const Machine& machine, const BlockList& list);

}  // namespace meshwind
