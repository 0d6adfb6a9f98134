/// Friction turns of a fibre over a rim and back, on the mandrel's cylindrical extension.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geodesic/slip_and_bridging.h"
#include "geodesic/surface_path.h"
#include "mesh/mandrel.h"
#include "winding/plan/friction.h"
#include "winding/plan/turns.h"

namespace meshwind {

/// Tolerance of a dwell, which is found as an angle of up to 2 pi: it keeps rounding from making a
/// dwell of 0 a whole turn.
inline constexpr double kMinDwell_rad = 1e-9;

struct TurnRule {
    Friction friction = 0.2;      ///< under the fibre on the extension
    double extension_mm = 100.0;  ///< axial length of the extension, > 0
    double band_mm = 6.0;         ///< the band must stay on the extension with its full width
};

/// Unit vector perpendicular to the rim's axis from which azimuths count.
[[nodiscard]] Eigen::Vector3d rim_reference(const Rim& rim);

/// Where the wall leans at the rim, that is a crease to the extension: the angle is that to the
/// rim's tangent, which unfolding keeps. \param position_mm on the rim \param outward unit tangent
/// of the course, leaving the mandrel
[[nodiscard]] RimCrossing crossing_at(const Rim& rim, const Eigen::Vector3d& position_mm,
                                      const Eigen::Vector3d& outward);

/// The same for a fibre in the air there, which has left the wall before a hollow rim and touches
/// the extension beyond: the angle is that to the axis, the same as at the touching point.
/// \param position_mm beside the fibre
/// \param outward unit vector along it, towards the axis or along the rim's tangent plane
[[nodiscard]] RimCrossing crossing_in_air(const Rim& rim, const Eigen::Vector3d& position_mm,
                                          const Eigen::Vector3d& outward);

/// Height over the rim at which a crossing fibre lies on the extension: R tan(ahead) / tan(beta),
/// along the straight line that touches the cylinder there.
[[nodiscard]] double landing_mm(const Rim& rim, const RimCrossing& crossing);

/// Axial run in mm that a turn from `angle_rad` to the hoop direction takes with constant slip
/// ratio on a cylinder: (R / slip)(1 / sin(beta) - 1). Source: geometry.md's closed form, see
/// docs/winding.md.
[[nodiscard]] double turn_run_mm(double radius_mm, double angle_rad, double slip);

/// Least run of any turn on a rim: that of the steepest fibre that turns with all of the friction.
/// Infinite without friction.
[[nodiscard]] double least_run_mm(double radius_mm, Friction friction);

/// Angle around the axis that is wound from `angle_rad` to hoop: (1 / slip) ln cot(beta / 2).
/// Source: andrianov_2022_machine_path, eq. (4). \pre 0 < angle_rad < pi, slip > 0
[[nodiscard]] double turn_angle_rad(double angle_rad, double slip);

/// Fibre length of half a turn, from the rim to hoop: (R / slip) cot(beta) and the part in the air.
/// \pre can_turn
[[nodiscard]] double half_turn_mm(const Rim& rim, const RimCrossing& crossing,
                                  const TurnRule& rule);

/// True when the fibre can be turned by friction within the extension.
[[nodiscard]] bool can_turn(const Rim& rim, const RimCrossing& crossing, const TurnRule& rule);

/// In words what a turn lacks. \param rim_words "the upper rim"
/// \pre can_turn is false
[[nodiscard]] std::string why_no_turn(const std::string& rim_words, const Rim& rim,
                                      const RimCrossing& crossing, const TurnRule& rule);

/// A turn from one course's end to another's start at the same rim.
struct Turn {
    SurfacePath path;        ///< on the extension; faces are kNoFace; slip ratios are kg / kn
    TautString string;       ///< over the path, above it beside hollow rims
    double slip = 0.0;       ///< largest |slip ratio| in it
    double run_mm = 0.0;     ///< how far onto the extension the fibre goes
    double dwell_rad = 0.0;  ///< angle wound along the hoop
};

/// Dwell angle in [0, 2 pi) between the ends of two courses; independent of the direction of
/// travel. \pre the crossings have opposite senses and both can turn
[[nodiscard]] double dwell_rad(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                               const TurnRule& rule);

/// Fibre length of a whole turn, dwell included, as make_turn() winds it. \pre as for dwell_rad
[[nodiscard]] double turn_mm(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                             const TurnRule& rule);

/// The turn itself: straight through the air from the rim to the extension where the rim is hollow,
/// steered with constant slip to hoop, dwelling, and back.
/// \param from crossing of the course that ends \param to of the course that begins
/// \param step_mm largest distance of stations \pre as for dwell_rad
[[nodiscard]] Turn make_turn(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                             const TurnRule& rule, double step_mm);

/// The half of a turn that a course's end needs by itself: from the rim to hoop.
[[nodiscard]] Turn half_turn(const Rim& rim, const RimCrossing& from, const TurnRule& rule,
                             double step_mm);

/// The end of a fibre that goes over a hollow rim: through the air, then `length_mm` along the
/// extension without steering.
[[nodiscard]] Turn run_out(const Rim& rim, const RimCrossing& from, double length_mm,
                           double step_mm);

}  // namespace meshwind
