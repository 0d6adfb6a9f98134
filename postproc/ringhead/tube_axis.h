/// Axis of a frame whose mesh is a tube.
#pragma once

#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/tube/tube.h"
#include "postproc/ringhead/frame_axis.h"

namespace meshwind {

struct TubeAxisOptions {
    bool from_the_end = false;  ///< the axis starts where the tube's line ends
    /// Turn of the frame over each bend, right-handed about the head's direction, evenly along it.
    double bend_turn_rad = 0.0;
};

/// The axis in a coordinate frame of its own, in which the frame is held: origin at the axis'
/// start, z along it, x towards the inside of the first bend; without a bend square to z near the
/// mandrel's axis that is furthest from it.
struct TubeAxis {
    FrameAxis axis;
    Eigen::Isometry3d in_mandrel = Eigen::Isometry3d::Identity();  ///< that frame's pose
    double radius_mm = 0.0;                                        ///< the tube's mean
    double radius_spread_mm = 0.0;                                 ///< largest less least radius
};

/// Stations at the ends of all straight stretches and arcs, and within arcs every
/// kTubeStation_rad: the cubic between two is then off by under 1e-9 of the bend's radius.
[[nodiscard]] TubeAxis axis_of_tube(const Tube& tube, const TubeAxisOptions& options = {});

inline constexpr double kTubeStation_rad = 4.0 * kPi / 180.0;

}  // namespace meshwind
