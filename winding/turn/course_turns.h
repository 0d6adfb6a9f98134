/// Turns of single courses over rims, by friction or on rings of evenly spaced pins. The pins are
/// the same for all courses. A course that turns on pins has to end where a pin takes hold of it.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "mesh/rim.h"
#include "winding/plan/assemble.h"
#include "winding/plan/tow.h"
#include "winding/plan/turns.h"
#include "winding/turn/pin_turn.h"
#include "winding/turn/turn.h"

namespace meshwind {

/// A ring of pins at a rim. Any of them may begin a turn, and any that is far enough on may end it.
struct PinStand {
    PinRing ring;             ///< `skip`: least number of pins that a turn runs behind
    PinTurnShape shape;       ///< of every turn; the courses have its angles and its skip
    double widest_rad = 0.0;  ///< between fibre and axis; wider, fibre touches the next pin
};

struct CourseTurns {
    TurnRule rule{};               ///< by friction
    std::vector<PinStand> pins{};  ///< by rim; empty: fibre turns by friction
};

/// Rings that leave the free fibre most room, one for each rim.
/// \return none, with the reason in `failure`, where pins cannot take hold of fibre at a rim or
/// need more extension
[[nodiscard]] std::vector<PinStand> stand_pins(std::span<const Rim> rims,
                                               const PinConstraints& wish, const Tow& tow,
                                               double extension_mm, std::string& failure);

[[nodiscard]] bool can_turn(const Rim& rim, const RimCrossing& crossing, const CourseTurns& turns);

/// Fibre of the half of a turn that a course's end needs by itself.
/// \pre can_turn(), as below
[[nodiscard]] double half_turn_mm(const Rim& rim, const RimCrossing& crossing,
                                  const CourseTurns& turns);

/// Fibre of the turn from one course to another. \pre the crossings have opposite senses
[[nodiscard]] double turn_mm(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                             const CourseTurns& turns);

/// How far the course's end is, around the rim, from where a pin takes hold of it: to be moved the
/// way that the fibre circles. 0 where it turns by friction.
[[nodiscard]] double off_pins_mm(const Rim& rim, const RimCrossing& crossing,
                                 const CourseTurns& turns);

/// Derivative of that distance by the angle of the crossing.
[[nodiscard]] double off_pins_mm_per_rad(const Rim& rim, const RimCrossing& crossing,
                                         const CourseTurns& turns);

/// The turn itself. \param station_mm largest distance of stations, by friction
[[nodiscard]] LaidTurn turn_between(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                                    const CourseTurns& turns, double station_mm);

/// The half of a turn that leads on from a course's end, and the half that leads to a course's
/// start.
[[nodiscard]] Piece half_turn_from(const Rim& rim, const RimCrossing& end, const CourseTurns& turns,
                                   double station_mm);
[[nodiscard]] Piece half_turn_to(const Rim& rim, const RimCrossing& start, const CourseTurns& turns,
                                 double station_mm);

[[nodiscard]] std::vector<PinRing> rings_of(std::span<const PinStand> stands);

}  // namespace meshwind
