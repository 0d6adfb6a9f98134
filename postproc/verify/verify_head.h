/// Checks on a program's head: tie-on, approach, path mode.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "postproc/verify/verify.h"

namespace meshwind {

/// The tie-on is printed to 0.001 mm, and its place on a curved patch is known as well; 0.1 mm is
/// clear of that and still half the tolerance of the laid fibre (Job::tolerance).
inline constexpr double kTieOnOff_mm = 0.1;

/// Whether the program must have the form of our own programs: it says that it is one, or there is
/// a plan that it is to follow. Others may come without a stop and without words on corners.
/// \pre task.program.head
[[nodiscard]] bool keeps_form(const VerifyTask& task);

/// Largest cut of corners: the least that words of the program allow where it winds; the machine's
/// own where there is no text.
[[nodiscard]] double corner_limit_mm(const VerifyTask& task);

/// Check "approach": rapid moves end within the axes' travel; between places that are known the
/// head keeps the clearance and the eye off the mandrel; no rotary axis is placed after the linear
/// axes have brought the head near the mandrel; the program stops (M0) for the fibre behind the
/// last one. The position of an axis is unknown before its first absolute word: its sweep up to
/// there is up to the operator, as the program's head says. \pre task.program.head->has_approach
[[nodiscard]] Check approach_check(const VerifyTask& task);

/// Check "tie_on": within kTieOnOff_mm of the wall, and of the plan's first point.
/// \param landing_mm where the fibre is laid from, on the wall
[[nodiscard]] Check tie_on_check(const VerifyTask& task, const Eigen::Vector3d& landing_mm);

struct PathModeFinding {
    Check check;
    std::size_t block = 0;  ///< the first that runs in another mode
};

/// Check "path_mode": each block runs with the words of the machine's own lines.
/// \pre task.program.head->has_approach
[[nodiscard]] PathModeFinding path_mode_check(const VerifyTask& task);

}  // namespace meshwind
