/// Estimates before planning: room taken by head, part and turns, and the reach of the eye around a
/// part.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "machines/eye_range.h"
#include "machines/machine.h"
#include "mesh/mandrel.h"
#include "mesh/revolution/revolution.h"
#include "mesh/triangle_soup.h"
#include "postproc/collision/collision.h"
#include "winding/plan/friction.h"

namespace meshwind {

/// Distance from the eye to the nearest part of the head; where the eye is within a part, minus the
/// radius of the ball about it that this part fills.
[[nodiscard]] double head_gap_mm(const Machine& machine, const HeadEnvelope& envelope);

/// Free fibre length with which the eye is `off_mm` off a cylinder. The fibre leaves along its
/// tangent, so with L mm of it at the winding angle a the eye is sqrt(R^2 + (L sin a)^2) from the
/// axis.
/// \param off_mm >= 0 \param sine of the winding angle, > 0
[[nodiscard]] double free_length_over_cylinder_mm(double radius_mm, double off_mm, double sine);

/// The outline of a part that turns about Z: radius and z of the widest vertex of each of a
/// thousand slices. Each goes round a circle.
[[nodiscard]] std::vector<Eigen::Vector2d> outline(const TriangleSoup& part);

/// Slack for blocks off their stations, meshes off their circles and samples between points: no
/// part is refused for less than this.
inline constexpr double kRoomSlack_mm = 1.0;

/// How a job's fibre turns round at a rim.
struct TurnRoom {
    bool takes_run = false;     ///< by friction, along the extension
    Friction friction = 0.0;    ///< the largest of all layers
    double extension_mm = 0.0;  ///< > 0
    double tow_width_mm = 0.0;  ///< > 0
};

/// Extension length that the least turn by friction needs at a rim.
[[nodiscard]] double needed_extension_mm(const TurnRoom& turns, const Rim& rim);

/// Whether a rim leaves room for a turn by friction at all.
[[nodiscard]] bool has_room(const TurnRoom& turns, const Rim& rim);

/// Whether a turn at a rim takes the eye to one height and one distance from the spindle.
[[nodiscard]] bool about_spindle(const Rim& rim);

/// Height of the hoop of the least turn at a rim about the spindle.
[[nodiscard]] double hoop_height_mm(const TurnRoom& turns, const Rim& rim);

/// Whether patterns turn round before they reach an end of the body. \param end 0 or 1
[[nodiscard]] bool has_cap(const BodyOfRevolution& body, std::size_t end);

/// Range of the eye, and its least distance from a part.
struct EyeReach {
    EyeRange range;
    double shortest_fibre_mm = 0.0;  ///< free fibre
    double longest_fibre_mm = 0.0;
    double off_wall_mm = 0.0;  ///< least distance of the eye, for the head's clearance
};

/// Whether the eye reaches a height, to within kRoomSlack_mm.
[[nodiscard]] bool in_height(const EyeReach& eye, double z_mm);

/// Distance from the spindle that the eye needs for a hoop of a radius.
[[nodiscard]] double hoop_eye_mm(const EyeReach& eye, double radius_mm);

/// A part to be wound, and the reach of the eye around it.
struct PartReach {
    const Mandrel& mandrel;
    const std::optional<BodyOfRevolution>& body;  ///< the part as one, if it is one
    const TurnRoom& turns;
    const EyeReach& eye;
};

/// Whether fibre can be turned at a rim; true as well where the turn itself has no room.
[[nodiscard]] bool reaches(const PartReach& part, const Rim& rim);

/// Whether patterns can be wound: the eye gets around both ends of a body of revolution and its
/// widest place.
[[nodiscard]] bool patterns_fit(const PartReach& part);

/// Whether courses can be wound: over some rim, on enough of the wall. True where there is no rim.
[[nodiscard]] bool courses_fit(const PartReach& part);

/// Whether hoops can be wound, on the widest cylinder of a body of revolution; true for other
/// parts.
[[nodiscard]] bool hoops_fit(const PartReach& part);

/// Least and greatest height that the eye has to reach: hoops at rims, the caps of domes.
[[nodiscard]] std::array<double, 2> needed_heights_mm(const PartReach& part);

}  // namespace meshwind
