/// Ideal mandrel shapes: their dimensions and the rules these must keep. Frame: spindle = z.
#pragma once

namespace meshwind {

/// Two cylinders joined by a rolling-ball blend: the run along z, centred, and the branch along +x.
/// A ball of radius `blend_radius_mm` rolls along the joint touching both from outside; the surface
/// is the run outside the ball's contact curve, the branch beyond it, and the ball's arcs between.
/// It is smooth in its tangent plane everywhere and jumps in curvature along the two contact
/// curves.
struct TeeShape {
    double run_radius_mm = 50.0;
    double branch_radius_mm =
        40.0;  ///< <= run radius; equal radii make the blend vanish in two points
    double blend_radius_mm = 15.0;
    double run_length_mm = 400.0;     ///< whole length
    double branch_length_mm = 236.0;  ///< from the run's axis to the branch's end

    /// \throws InputError make.not_positive, make.branch_too_wide, make.blend_too_large
    void validate() const;
};

}  // namespace meshwind
