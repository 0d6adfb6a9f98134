/// Which courses of a fibre come early and which late.
#pragma once

#include <span>
#include <vector>

#include "winding/order.h"

namespace meshwind {

/// What a course has to do with what holds the laminate together.
struct CourseCharacter {
    double length_mm = 0.0;
    double junction_mm =
        0.0;                ///< of it, where the wall is not like a pipe: blends, knuckles, domes
    double hoop_mm = 0.0;   ///< over pipes within 20 degrees of hoop
    double clamp_mm = 0.0;  ///< over pipes, weighed by how far it presses on: sin^2 of the angle
    /// From -1, all in junctions, to 1, all hoop.
    [[nodiscard]] double lateness() const {
        return length_mm > 0.0 ? (clamp_mm - junction_mm) / length_mm : 0.0;
    }
};
[[nodiscard]] CourseCharacter character_of(const Surface& surface, const SurfacePath& path);

/// Brings courses over junctions forward and hoops back, so that hoops clamp what lies under them:
/// stretches of a fibre that begin and end at one node change places, as long as what is gained is
/// worth the dwell: a course that comes later by the whole plan for being hoop instead of junction
/// is worth two turns. Fibres stay what they are. \param lateness per entry of the order
void arrange(std::span<const Rim> rims, std::span<const Member> members, const TurnRule& rule,
             std::span<const double> lateness, std::vector<OrderedCourse>& order);

/// Where in the order the fibre of each kind lies: 0 first, 1 last, 0.5 where the order does not
/// matter. 0.5 where there is none.
struct Places {
    double junction = 0.5;
    double hoop = 0.5;
};
[[nodiscard]] Places places_of(const Surface& surface, std::span<const SurfacePath* const> courses);

}  // namespace meshwind
