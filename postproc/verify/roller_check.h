/// Checks that the fibre leaves the eye's roller at a right angle, and measures the band's twist.
#pragma once

#include <cstddef>
#include <optional>

#include "core/units.h"
#include "machines/machine.h"
#include "postproc/verify/laydown.h"

namespace meshwind {

/// Largest angle of the fibre off the square on the roller at the end of a block, beyond the angle
/// that the machine's axes force. Programs are exact there: at most 0.29 deg on `data/tee.stl`,
/// from the error of the laid fibre over a short free length. In between the axes go straight.
inline constexpr double kRollerOff_rad = rad_from_deg(1.0);

struct RollerFinding {
    double worst_rad = 0.0;  ///< largest angle off the square at the end of a block, forced or not
    std::size_t worst_sample = 0;
    /// Angle about the fibre between roller and laid band at the ends of blocks, 0 to pi/2: the
    /// twist of the band on its way from the eye to the wall.
    double mean_twist_rad = 0.0;
    double worst_twist_rad = 0.0;
    /// Turn of the head about the fibre, either way, while the band does not turn: a tape is laid
    /// with that twist.
    double turned_rad = 0.0;
    std::size_t turned_over = 0;  ///< blocks in which it goes over to the band's other side
    std::optional<std::size_t> wrong_sample{};  ///< the first that is off by more than it need be
    double wrong_rad = 0.0;                     ///< how far off the square it is
    double forced_rad = 0.0;                    ///< angle that the machine forces at this place
};

/// Looks at the ends of blocks. Where the fibre is off the square, the machine's inverse gives how
/// near to it the head can bring the roller with eye and mandrel where they are. So a machine
/// without a turning head is not at fault, and near the singular pose of a wrist nothing is
/// required.
[[nodiscard]] RollerFinding find_roller(const Machine& machine, const LaidPath& laid);

}  // namespace meshwind
