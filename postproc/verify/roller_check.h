/// Whether the fibre leaves the eye's roller at a right angle, and how flat the band is.
#pragma once

#include <cstddef>
#include <optional>

#include "core/units.h"
#include "machines/machine.h"
#include "postproc/verify/laydown.h"

namespace meshwind {

/// The fibre may lean so far against the square on the roller at the end of a block, beyond what
/// the machine's axes force. Programs are exact there: 0.29 deg at most on `data/tee.stl`, what the
/// laid fibre is off its plan over a short free length. In between the axes go straight.
inline constexpr double kRollerOff_rad = rad_from_deg(1.0);

struct RollerFinding {
    double worst_rad = 0.0;  ///< off the square at the end of a block, at most, forced or not
    std::size_t worst_sample = 0;
    /// Angle about the fibre between roller and laid band at the ends of blocks, 0 to pi/2: by so
    /// much the band twists on its way from the eye to the wall.
    double mean_twist_rad = 0.0;
    double worst_twist_rad = 0.0;
    /// By how much the head turns about the fibre, this way and that, while the band does not: a
    /// tape is laid with that twist.
    double turned_rad = 0.0;
    std::size_t turned_over = 0;  ///< blocks in which it goes over to the band's other side
    std::optional<std::size_t> wrong_sample{};  ///< the first that is off by more than it need be
    double wrong_rad = 0.0;                     ///< how far off the square it is
    double forced_rad = 0.0;                    ///< and the machine forces at this place
};

/// Looks at the ends of blocks. Where the fibre is off the square the machine's inverse tells how
/// near to it the head can bring the roller with eye and mandrel where they are: a machine that
/// turns no head has nothing to answer for, and near the singular pose of a wrist nothing is asked.
[[nodiscard]] RollerFinding find_roller(const Machine& machine, const LaidPath& laid);

}  // namespace meshwind
