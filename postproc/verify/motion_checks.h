/// Checks on the motion that lays the fibre: free fibre, head, axes and pay-out.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "machines/machine.h"
#include "postproc/verify/check_finding.h"
#include "postproc/verify/roller_check.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// Check "collision".
[[nodiscard]] CheckFinding collision_finding(const VerifyTask& task, const LaidPath& laid);

struct FreeLengthRange {
    double shortest_mm = std::numeric_limits<double>::infinity();
    double longest_mm = 0.0;
    std::size_t shortest_at = 0;  ///< sample
};

[[nodiscard]] FreeLengthRange free_length_range(const LaidPath& laid);

/// Check "free_length".
[[nodiscard]] CheckFinding free_length_finding(const VerifyTask& task, const LaidPath& laid,
                                               const FreeLengthRange& range);

/// Check "roller". Programs from elsewhere may be for an eye without a roller: only their twist is
/// judged.
[[nodiscard]] CheckFinding roller_finding(const VerifyTask& task, const LaidPath& laid,
                                          const RollerFinding& roller);

/// Check "limits".
[[nodiscard]] CheckFinding limits_finding(const VerifyTask& task, const LaidPath& laid);

/// The fibre through the eye. Indices are of samples.
struct LaidPayout {
    double fastest_mm_s = 0.0;
    double back_mm = 0.0;  ///< most fibre that is to be taken back
    std::size_t back_at = 0;
    std::optional<std::size_t> too_fast{};  ///< the first beyond the machine's speed
    std::optional<std::size_t> slack{};     ///< the first beyond the tensioner's take-up
    std::vector<FastBlock> fast_blocks{};   ///< ascending
};

[[nodiscard]] LaidPayout find_payout(const LaidPath& laid, const FibreLimits& limits);

/// Check "payout".
[[nodiscard]] CheckFinding payout_finding(const VerifyTask& task, const LaidPath& laid,
                                          const LaidPayout& payout);

}  // namespace meshwind
