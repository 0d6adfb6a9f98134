/// Eye paths with closed-form landing points, for tests.
#pragma once

#include "postproc/eye/eye_path.h"

namespace meshwind::test {

/// Helix on a cylinder about Z: from (R, 0, 0) towards +Z, at `angle_rad` from the axis.
/// n points at arc distance `step_mm`, free length constant.
[[nodiscard]] EyePath helix(double radius_mm, double angle_rad, double free_length_mm,
                            double step_mm, int n);

/// Forward and return strokes of about `stroke_mm` at 45 degrees on a cylinder, joined by turns in
/// which the winding angle goes smoothly through 90 degrees; every stroke and turn is a piece.
[[nodiscard]] EyePath strokes(double radius_mm, double free_length_mm, double step_mm,
                              double stroke_mm, int count);

/// Helix on an elliptic cylinder with half axes 70 and 40 mm, 8 mm of pitch per rad, the free
/// length going from 200 to 250 mm halfway.
[[nodiscard]] EyePath elliptic_helix(int n);

/// A line that winds around an ellipsoid of half axes 90, 60 and 150 mm: one turn about Z while its
/// height swings.
struct EllipsoidLine {
    double swing = 0.5;             ///< of the height, as a share of the half axis, below 0.8
    double waves = 1.0;             ///< swings a turn
    double phase_rad = 0.0;         ///< of the swing
    double free_length_mm = 200.0;  ///< at the middle
    double longer_mm = 0.0;         ///< change of the free length from the middle to either end
};

/// n points at even turns from 0 to 1.
[[nodiscard]] EyePath on_ellipsoid(const EllipsoidLine& line, int n);

}  // namespace meshwind::test
