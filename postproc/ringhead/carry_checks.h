/// Checks on the motion and the program of a frame that is carried through a ring head.
#pragma once

#include <vector>

#include "machines/machine.h"
#include "postproc/motion/axis_loads.h"
#include "postproc/ringhead/carried_path.h"
#include "postproc/ringhead/carry.h"
#include "postproc/ringhead/frame_axis.h"
#include "postproc/ringhead/krl.h"
#include "postproc/ringhead/ring_head.h"
#include "postproc/verify/check.h"

namespace meshwind {

/// Check "ring".
[[nodiscard]] Check ring_fit_check(const RingFit& fit, double ring_radius_mm);

/// Check "reach".
[[nodiscard]] Check pose_reach_check(const CarriedJoints& joints,
                                     const std::vector<CarriedSample>& samples);

/// Check "limits". \param s_mm of the program's points
[[nodiscard]] Check carried_limits_check(const Machine& machine, const CarriedJoints& joints,
                                         const std::vector<CarriedSample>& samples,
                                         const AxisLoads& loads, const std::vector<double>& s_mm);

/// Check "wrist".
[[nodiscard]] Check wrist_flip_check(const CarriedJoints& joints,
                                     const std::vector<CarriedSample>& samples);

/// Check "clearance".
[[nodiscard]] Check frame_clearance_check(const FrameClearance& found,
                                          const std::vector<CarriedSample>& samples,
                                          double clearance_mm);

/// Errors on the moves of a program: the largest of each kind, and where the largest share of a
/// tolerance is.
struct CarriedMovesError {
    CarryError largest;
    double share = 0.0;       ///< of a tolerance; above 1 it is broken
    double share_s_mm = 0.0;  ///< start of that move
};

/// \param program as it was read back, not as it was planned
[[nodiscard]] CarriedMovesError carried_moves_error(const RingHead& head, const FrameAxis& axis,
                                                    const std::vector<double>& s_mm,
                                                    const KrlProgram& program,
                                                    const CarryRequest& request);

/// Check "interpolation".
[[nodiscard]] Check interpolation_error_check(const CarriedMovesError& error,
                                              const CarryRequest& request);

/// The largest errors at the points of a program, the tilt left out.
[[nodiscard]] CarryError carried_points_error(const RingHead& head, const FrameAxis& axis,
                                              const std::vector<double>& s_mm,
                                              const KrlProgram& program);

/// Check "rounding". \param same whether the program that was read back is the planned one
[[nodiscard]] Check krl_rounding_check(bool same, const CarryError& at_points);

}  // namespace meshwind
