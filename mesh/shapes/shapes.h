/// Parametric mandrel shapes: their dimensions and the limits of these. Frame: spindle = z.
#pragma once

#include "core/units.h"
#include "mesh/shapes/isotensoid.h"

namespace meshwind {

/// Around z, from -length / 2 to +length / 2; two rims.
struct CylinderShape {
    double radius_mm = 50.0;
    double length_mm = 300.0;

    /// \throws InputError make.not_positive
    void validate() const;
};

/// Frustum around z, from -length / 2 (radius1) to +length / 2 (radius2); two rims.
struct ConeShape {
    double radius1_mm = 60.0;
    double radius2_mm = 30.0;
    double length_mm = 200.0;

    /// \throws InputError make.not_positive
    void validate() const;
};

/// Cylinder around z with half an ellipsoid at each end, centred; smooth in its tangent plane. Two
/// rims, or none when the openings are closed.
struct VesselShape {
    double radius_mm = 75.0;
    double cylinder_length_mm = 200.0;
    double dome_height_mm = 50.0;  ///< of the whole half ellipsoid, from the cylinder to its pole
    double opening_radius_mm = 15.0;               ///< of both polar openings; 0: closed
    double upper_opening_radius_mm = kAsLower_mm;  ///< of the upper one, where it differs

    static constexpr double kAsLower_mm = -1.0;  ///< no radius: the upper opening is as the lower

    [[nodiscard]] double upper_opening_mm() const {
        return upper_opening_radius_mm == kAsLower_mm ? opening_radius_mm : upper_opening_radius_mm;
    }

    /// \throws InputError make.not_positive, make.negative, make.opening_too_large
    void validate() const;
};

/// Cylinder around z with an isotensoid dome at each end (mesh/shapes/isotensoid.h), centred;
/// smooth in its tangent plane. Two rims, of the openings.
struct IsotensoidShape {
    double radius_mm = 75.0;
    double cylinder_length_mm = 200.0;
    double opening_radius_mm = 25.0;  ///< of both polar openings
    double stiffness_ratio = 0.1;     ///< k_e of the domes; 0: netting
    double design_radius_mm = 0.0;    ///< Clairaut radius they are made for; 0: that of the opening

    [[nodiscard]] IsotensoidDesign dome() const;

    /// \throws InputError make.not_positive, make.negative, make.stiffness_ratio,
    /// make.design_radius, make.opening_too_large, make.opening_too_small
    void validate() const;
};

/// Pipe along leg, arc, leg: leg 1 on z from 0, then a bend towards +x, then leg 2; smooth in its
/// tangent plane. Two rims.
struct ElbowShape {
    double pipe_radius_mm = 40.0;
    double bend_radius_mm = 100.0;  ///< of the pipe's centre line
    double angle_rad = 0.5 * kPi;   ///< of the bend, at most pi
    double leg1_mm = 80.0;          ///< >= 0
    double leg2_mm = 80.0;          ///< >= 0

    /// \throws InputError make.not_positive, make.negative, make.bend_too_tight,
    /// make.angle_too_large
    void validate() const;
};

/// Around z from 0 upward: cylinder 1, cone, cylinder 2, half an ellipsoid. Both ends of the cone
/// are sharp rings; the dome joins smoothly. Two rims, or one when the opening is closed.
struct CombinationShape {
    double radius1_mm = 60.0;
    double length1_mm = 120.0;
    double cone_length_mm = 60.0;
    double radius2_mm = 40.0;
    double length2_mm = 80.0;
    double dome_height_mm = 30.0;
    double opening_radius_mm = 10.0;  ///< 0: closed

    /// \throws InputError make.not_positive, make.opening_too_large
    void validate() const;
};

/// Ring around z; closed, or an arc of it from +x towards +y with two rims.
struct TorusShape {
    double ring_radius_mm = 200.0;
    double tube_radius_mm = 50.0;
    double angle_rad = 2.0 * kPi;  ///< 2 pi: closed

    /// \throws InputError make.not_positive, make.bend_too_tight, make.angle_too_large
    void validate() const;
};

/// Spheroid around z; closed.
struct EllipsoidShape {
    double equator_radius_mm = 100.0;
    double pole_radius_mm = 75.0;  ///< half its length along z

    /// \throws InputError make.not_positive
    void validate() const;
};

/// Two cylinders joined by a rolling-ball blend: the run along z, centred, and the branch along +x.
/// A ball of radius `blend_radius_mm` rolls along the joint touching both from outside; the surface
/// is the run outside the ball's contact curve, the branch beyond it, and the ball's arcs between.
/// It is smooth in its tangent plane everywhere and jumps in curvature along the two contact
/// curves.
struct TeeShape {
    double run_radius_mm = 50.0;
    double branch_radius_mm =
        40.0;  ///< <= run radius; equal radii make the blend vanish in two points
    double blend_radius_mm = 15.0;    ///< of the ball; up to twice the branch radius always fits
    double run_length_mm = 400.0;     ///< whole length
    double branch_length_mm = 236.0;  ///< from the run's axis to the branch's end
    double lean_rad = 0.0;  ///< of the branch, from square to the run towards +z; at most pi / 3

    /// Extent of the blend on the run, towards the rim to which the branch leans, and on the
    /// branch, from the run's axis.
    [[nodiscard]] double blend_end_on_run_mm() const;
    [[nodiscard]] double blend_end_on_branch_mm() const;

    /// \throws InputError make.not_positive, make.negative, make.branch_too_wide,
    /// make.blend_too_large, make.lean_too_large
    void validate() const;
};

/// Three equal pipes in one plane, joined by a rolling-ball blend (see the tee): the stem along z
/// below the point where the axes meet, two arms above it, at either side of the z axis in the
/// plane of x and z. The blend vanishes in two points, where the crotches meet. Three rims.
struct WyeShape {
    double pipe_radius_mm = 40.0;
    double blend_radius_mm = 15.0;  ///< of the ball
    double stem_length_mm = 200.0;  ///< from the meeting point to the stem's end
    double arm_length_mm = 200.0;   ///< the same of both arms
    double angle_rad = 0.5 * kPi;   ///< between the arms, pi / 6 to 5 pi / 6

    /// \throws InputError make.not_positive, make.arms_angle, make.blend_too_large,
    /// make.leg_too_short
    void validate() const;
};

/// Two equal pipes that cross square in one point, joined by a rolling-ball blend (see the tee):
/// the run along z, centred, and branches along +x and -x. The blend vanishes in two points. Four
/// rims.
struct CrossShape {
    double pipe_radius_mm = 40.0;
    double blend_radius_mm = 15.0;    ///< of the ball
    double run_length_mm = 400.0;     ///< whole length
    double branch_length_mm = 200.0;  ///< from the run's axis to each branch's end

    /// \throws InputError make.not_positive, make.blend_too_large, make.leg_too_short
    void validate() const;
};

}  // namespace meshwind
