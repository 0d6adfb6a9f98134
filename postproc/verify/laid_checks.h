/// Checks on the laid fibre: whether it lies where it was planned, slips or bridges.
#pragma once

#include <optional>
#include <vector>

#include "postproc/verify/check_finding.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// Check "laydown". Where the fibre is off the plan, the blocks of the length over which it was
/// pulled there are to be made finer.
/// \param deviation from the plan; none: nothing was planned
[[nodiscard]] CheckFinding laydown_finding(const VerifyTask& task, const LaidPath& laid,
                                           const std::optional<Deviation>& deviation);

/// Slip ratio that friction has to hold at each laid station (laid_slip.h), by the rules of the
/// task.
[[nodiscard]] std::vector<double> station_slip(const VerifyTask& task, const LaidPath& laid);

/// Check "slip". \param slip station_slip
[[nodiscard]] CheckFinding slip_finding(const VerifyTask& task, const LaidPath& laid,
                                        const std::vector<double>& slip);

/// Check "bridging".
[[nodiscard]] CheckFinding bridging_finding(const VerifyTask& task, const LaidPath& laid);

}  // namespace meshwind
