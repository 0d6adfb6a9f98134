/// Reads the plan's tables back, for comparison with a program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "machines/machine.h"
#include "postproc/motion/block.h"
#include "postproc/verify/deviation.h"

namespace meshwind {

/// The landing points of path.csv (postproc/tables/path_csv.h). Columns are found by their names;
/// further ones do not matter. \param file name used in messages \throws InputError plan.column,
/// plan.number, plan.empty, each with file and line
[[nodiscard]] PlannedFibre read_path_csv(std::string_view text, const std::string& file);

/// A row of motion.csv (postproc/tables/motion_csv.h).
struct PlannedMotion {
    double time_s = 0.0;        ///< from the program's start, at the end of the block
    std::vector<double> value;  ///< per axis of the machine, absolute, mm or **deg**
    Eigen::Vector3d eye_mm = Eigen::Vector3d::Zero();   ///< mandrel frame
    Eigen::Vector3d roller = Eigen::Vector3d::UnitZ();  ///< its direction, mandrel frame
};

/// \throws InputError as read_path_csv
[[nodiscard]] std::vector<PlannedMotion> read_motion_csv(std::string_view text,
                                                         const std::string& file,
                                                         const Machine& machine);

/// The first block in which a program differs from the plan.
struct MotionDifference {
    std::size_t block = 0;
    std::string words;  ///< e.g. "X is 101.000 mm, planned 100.000 mm"; empty: no difference
};

/// Positions must agree to half a step of each axis, the eye to kSameEye_mm and its roller to
/// kSameRoller, the time to
/// kSameTime_s and its millionth part per block, and there must be as many blocks. Rapid moves
/// before the first lead nowhere but to the start.
[[nodiscard]] MotionDifference first_difference(const Machine& machine, const BlockList& list,
                                                const std::vector<PlannedMotion>& planned);

/// The table carries six decimals; another machine is off by more.
inline constexpr double kSameEye_mm = 1e-4;
inline constexpr double kSameRoller = 1e-5;  ///< between unit vectors

/// The table carries microseconds, F six digits.
inline constexpr double kSameTime_s = 2e-6;
inline constexpr double kSameTimeShare = 1e-5;

}  // namespace meshwind
