/// Leads passes straight over hollow rims. At these a wall that narrows towards the rim and the
/// extension beyond make a concave crease.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mesh/revolution/meridian.h"
#include "winding/revolution/meridian_path.h"

namespace meshwind {

/// Angle by which the wall narrows towards the extension at an end; <= 0: the rim is no hollow.
[[nodiscard]] double rim_kink_rad(const Meridian& meridian, bool upper);

/// Shallower rims count as straight: the meridian of a fine mesh leans by as much, and over them a
/// turn steered by friction is off by less than 0.01 deg.
inline constexpr double kMinRimKink_rad = 1e-3;

/// The ways of a fibre at a rim.
enum class RimLift {
    OnWall,      ///< the rim is no hollow: it lies on the wall up to it
    Straight,    ///< it leaves the wall before the rim and touches the extension beyond
    NeverOnWall  ///< no place of the pass has a tangent that touches the extension
};

/// Leads the end of a pass over a hollow rim. With c = r sin(a) on the wall, whose slope towards
/// the rim is psi, and R the rim's radius, the tangent of the path passes the spindle at
///
///     c / sqrt(sin(a)^2 + cos(a)^2 sin(psi)^2)
///
/// which falls towards the rim from above R to below; where it is R the fibre leaves the wall: from
/// there it runs straight and touches the extension, at sin(beta) = c / R to the axis. A station is
/// put there, and those further on are replaced by others below the straight fibre, up to the rim
/// (MeridianStation::gap_mm). \param upper which end \param stations of a pass from its lower end
/// to its upper one, which comes to that end; s is kept at 0 at its beginning Accuracy: c between
/// stations is taken as linear; tests/winding/revolution/hollow_rim_test.cpp.
[[nodiscard]] RimLift lift_over_rim(const Meridian& meridian, bool upper, double station_mm,
                                    std::vector<MeridianStation>& stations);

/// Whether a pass goes over a hollow rim at its lower end (0) or upper one (1).
[[nodiscard]] bool in_air(const MeridianPass& pass, std::size_t end);

struct LiftOptions {
    double angle_rad = 0.0;    ///< of the pass at its widest place; for words
    double most_gap_mm = 0.5;  ///< largest height of a tow over the rim
    double station_mm = 4.0;
};

/// A pass as fibre lies between two turns.
struct LaidPass {
    MeridianPass pass;
    std::string failure{};  ///< empty, or in words why it cannot go over a rim
};

/// The pass with both ends led over hollow rims where it comes to them. \param on_wall up to rims
[[nodiscard]] LaidPass lifted_over_rims(const Meridian& meridian, const MeridianPass& on_wall,
                                        const LiftOptions& options);

/// The way of a fibre's first pass, from one end to the other: as the other passes, but tied on at
/// the rim, on the wall; azimuths are those of `laid`, or of way_back(laid).
[[nodiscard]] std::vector<MeridianStation> tied_on_way(const Meridian& meridian,
                                                       const MeridianPass& on_wall,
                                                       const MeridianPass& laid, std::size_t from,
                                                       double station_mm);

/// Azimuth by which it begins ahead of the place where the others come back over that rim.
[[nodiscard]] double tied_on_beside_rad(const MeridianPass& on_wall, const MeridianPass& laid,
                                        std::size_t from);

}  // namespace meshwind
