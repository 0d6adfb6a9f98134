/// Rules for the fibre's tangent from landing points, and the resulting error at the eye.
#pragma once

#include <array>

#include <Eigen/Core>

namespace meshwind {

/// fu_2009_post_processing, sec. 1, has the first two: the chord for dense meshes, the central one
/// for others. The parabola goes through three points at any spacing; the traced tangent is that of
/// the tracer.
enum class TangentRule { Chord, Central, Parabola, Traced };

inline constexpr std::array kTangentRules{TangentRule::Chord, TangentRule::Central,
                                          TangentRule::Parabola, TangentRule::Traced};

/// "chord", "central", "parabola", "traced".
[[nodiscard]] const char* name_of(TangentRule rule);

/// Three landing points in a row, mm, and the tracer's unit tangent at the middle one.
struct Landing {
    Eigen::Vector3d before;
    Eigen::Vector3d here;
    Eigen::Vector3d after;
    Eigen::Vector3d traced;
};

/// Unit direction of travel at `landing.here`. \pre the three points differ
[[nodiscard]] Eigen::Vector3d tangent_by(TangentRule rule, const Landing& landing);

/// Approximate minus exact at one landing point, in the conventions of fu_2009_post_processing with
/// the eye at E = P + L tau: C = atan2(E_y, E_x) in the mandrel frame, A = atan2(tau_z, tau_y) with
/// the mandrel turned by -C.
struct EyeError {
    double c_rad = 0.0;          ///< of the spindle angle C, in (-pi, pi]
    double direction_rad = 0.0;  ///< angle between the directions, >= 0
    double eye_mm = 0.0;         ///< distance of the eye points, >= 0
    double a_rad = 0.0;          ///< of the head's roll A, in (-pi, pi]
};

/// \param exact, approximate unit fibre directions at `landing_mm` \pre no eye is on the spindle
/// axis
[[nodiscard]] EyeError eye_error(const Eigen::Vector3d& landing_mm, const Eigen::Vector3d& exact,
                                 const Eigen::Vector3d& approximate, double free_length_mm);

}  // namespace meshwind
