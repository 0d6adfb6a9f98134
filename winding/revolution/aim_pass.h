/// Slip ratios with which a helical pass reaches both ends of a body of revolution.
#pragma once

#include <array>
#include <string>

#include "mesh/revolution/revolution.h"
#include "winding/revolution/meridian_path.h"

namespace meshwind {

struct AimTask {
    double angle_rad = 0.0;  ///< at the widest place, 0 to pi / 2
    double most_slip = 0.0;  ///< >= 0: largest that the friction holds
    /// Per end: a turn nearer to the axis would put the band over the opening or the pole.
    std::array<double, 2> touching_mm{};
};

struct PassAim {
    HalfSlips slip;
    std::string failure;  ///< not empty: no slip leads there; says how far it comes and what would
};

/// The slip ratios below and above the widest place with which a pass comes to both ends.
///  - An end that closes towards the axis is a cap: the parts before it that are curved or lean by
///    45 deg or more, where that one narrows to the end and is convex, but for a hollow lip. A pass
///    that turns there, or runs over its opening, needs no steering.
///  - To any other end it must come at no more than the angle asked for or 70 deg, whichever is
///    more: beyond, layers pile up as 1 / cos. The least slip is taken with which it is no steeper
///    on its way either. Where the friction does not suffice for that, all of it is used, and the
///    corner of a neck may be crossed at up to 85 deg.
///  - Where a pass would turn before a cap it is steered as far into it as the friction and the
///    band's touching the opening allow: most of the wall is wound.
/// \return slip 0 where none is needed
[[nodiscard]] PassAim aim_at_ends(const BodyOfRevolution& body, const AimTask& task);

/// Arc length at which the cap of an end begins, that of the end itself where it has none.
[[nodiscard]] double cap_mm(const BodyOfRevolution& body, std::size_t end);

}  // namespace meshwind
