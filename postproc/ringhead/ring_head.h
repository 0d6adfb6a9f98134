/// Kinematics of a frame carried through a fixed ring head: poses, points of the program, ring
/// speed.
///
/// Source: petru_2016_frames, sec. 2. Its iteration over the poses gives the same as the closed
/// form used here. "Base" is the frame in which the head stands, the machine frame.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/units.h"
#include "postproc/ringhead/frame_axis.h"

namespace meshwind {

/// Two rotating rings about one axis; base frame. The defaults are those of the paper.
struct RingHead {
    Eigen::Vector3d centre_mm{-1000.0, 1070.0, 990.0};  ///< half way between the rings
    /// Unit; the axis' tangent is laid along it. The frame moves the other way when it is carried
    /// from its axis' start to its end.
    Eigen::Vector3d direction = Eigen::Vector3d::UnitY();
    Eigen::Vector3d reference = Eigen::Vector3d::UnitZ();  ///< unit, at a right angle to it
    double ring_distance_mm = 70.0;                        ///< >= 0, between the rings
    double ring_radius_mm = 40.0;                          ///< > 0, clear opening
};

/// Pose of the mandrel frame that brings the axis' point to the head's centre, its tangent to the
/// head's direction and its reference to the head's: R = [d r dxr] [t v txv]^T, x = H - R B. All
/// three hold within 1e-9 (ring_head_test.cpp).
[[nodiscard]] Eigen::Isometry3d carried_pose(const RingHead& head, const AxisFrame& axis);

/// R = Rz(a) Ry(b) Rx(c), as KUKA's A, B and C.
struct EulerZyx {
    double a_rad = 0.0;
    double b_rad = 0.0;
    double c_rad = 0.0;

    [[nodiscard]] Eigen::Matrix3d matrix() const;
};

/// Angles of a rotation matrix. Without `previous`: b in -pi/2 .. pi/2, a and c in -pi .. pi. With
/// it: the one of the two solutions and their whole turns whose largest step is least. Where
/// b = +-pi/2 (within kSingularCosine) only a - c or a + c is defined: a is then kept, 0 without
/// `previous`, and c makes up for it, so that matrix() is R in any case; near there a and c may
/// swing far for a small motion, and rotations are to be compared by matrix().
[[nodiscard]] EulerZyx euler_zyx(const Eigen::Matrix3d& rotation,
                                 const std::optional<EulerZyx>& previous = std::nullopt);

/// Below this cosine of b, a is rounding noise; keeping it turns R by no more than this.
inline constexpr double kSingularCosine = 1e-10;

/// Law by which a controller turns the flange in a linear move, evenly in both cases.
enum class TurnLaw {
    OneAxis,        ///< about one axis by the shorter way, as the paper takes it
    SwivelAndSpin,  ///< the tool's X on a great circle, and about X by the missing angle (KUKA)
};

/// Pose within a controller's linear move: the origin on a straight line, the orientation by `law`.
/// Over a swivel and a spin of a few degrees the laws differ by an eighth of their product (rad).
/// \param share 0 .. 1
[[nodiscard]] Eigen::Isometry3d lin_between(const Eigen::Isometry3d& from,
                                            const Eigen::Isometry3d& to, double share,
                                            TurnLaw law = TurnLaw::OneAxis);

/// Angles of the second law, rad: of the swivel >= 0, of the spin signed.
struct SwivelSpin {
    double swivel_rad = 0.0;
    double spin_rad = 0.0;
};

[[nodiscard]] SwivelSpin swivel_and_spin(const Eigen::Isometry3d& from,
                                         const Eigen::Isometry3d& to);

/// Angle of the rotation between two poses, rad.
[[nodiscard]] double turn_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// Error of a pose against the one wanted at a place of the axis.
struct CarryError {
    double distance_mm = 0.0;  ///< of the axis' point from the head's centre
    double tilt_rad = 0.0;     ///< of the tangent from the head's direction
    double turn_rad = 0.0;     ///< of the whole frame from what is wanted; >= tilt_rad
};

[[nodiscard]] CarryError carry_error(const RingHead& head, const Eigen::Isometry3d& pose,
                                     const AxisFrame& axis);

/// The worst on a linear move between the poses at two places, by either law, since controllers
/// differ; the axis passes evenly meanwhile.
/// Measured at kErrorSamples places in each step between stations and as many in the move at least;
/// an error that is a parabola between its ends is seen to (1 - 1 / kErrorSamples^2) of its top or
/// better. \pre from_s_mm < to_s_mm
[[nodiscard]] CarryError lin_error(const RingHead& head, const FrameAxis& axis, double from_s_mm,
                                   double to_s_mm, const Eigen::Isometry3d& from,
                                   const Eigen::Isometry3d& to);

inline constexpr int kErrorSamples = 8;

struct CarryTolerance {
    double distance_mm = 0.2;  ///< > 0
    double angle_rad =
        rad_from_deg(0.2);     ///< > 0; for the turn of the whole frame, so for the tilt
    double longest_mm = 25.0;  ///< > 0; longer moves are halved: each has but one speed
};

/// Places of the axis whose poses become points of the program.
struct CarryPoints {
    std::vector<double> s_mm;  ///< ascending from 0 to the length of the axis
    CarryError worst;          ///< on the linear moves between them
    bool ok = true;            ///< false: a tolerance is broken on a move that cannot be halved
    double worst_s_mm = 0.0;   ///< start of the move with the largest share of a tolerance
};

/// Halves moves, at a station where there is one within, until each keeps the tolerance:
/// lin_error() <= kKeptShare of it, which leaves room for errors between its samples and for the
/// rounding of the program. The error of a move falls with the square of its length, where the
/// axis' curvature and turn are even (ring_head_test.cpp). Moves under kShortestMove_mm are kept as
/// they are.
[[nodiscard]] CarryPoints choose_carry_points(const RingHead& head, const FrameAxis& axis,
                                              const CarryTolerance& tolerance);

inline constexpr double kKeptShare = 0.95;
/// A controller of 4 ms needs 40 mm/s for one such move per cycle; shorter ones are not executed.
inline constexpr double kShortestMove_mm = 0.16;

/// Room that the frame takes in the rings while one place of it is at the head's centre.
struct RingFit {
    double reach_mm = 0.0;   ///< offset + tube radius / cos(tilt): what must be clear
    double offset_mm = 0.0;  ///< of the axis from the ring's centre in the plane of the ring
    double tilt_rad = 0.0;   ///< of the axis there
    double s_mm = 0.0;       ///< place at the head's centre
    bool through = true;     ///< false: the axis turns back before it meets a ring
};

/// The largest reach at either ring over all places, kErrorSamples to a step. The axis is followed
/// from the centre each way to the plane of the ring; where it ends before, nothing is there.
[[nodiscard]] RingFit worst_ring_fit(const RingHead& head, const FrameAxis& axis,
                                     double tube_radius_mm);

/// Turns of a ring per mm of passage that lay fibres at `angle_rad` on a straight tube:
/// angle = atan(2 pi r n / v). \pre 0 <= angle_rad < pi/2, tube_radius_mm > 0
[[nodiscard]] double ring_turns_per_mm(double angle_rad, double tube_radius_mm);

/// Angle from the axis at which a ring lays fibres, positive for a right-handed helix: the ring and
/// the frame turn about the head's direction, and their difference counts.
/// \param passage_mm_s > 0, of the axis through the head
[[nodiscard]] double laid_angle_rad(double tube_radius_mm, double ring_rad_s, double frame_rad_s,
                                    double passage_mm_s);

/// Share of the tube's surface under `tows` bands side by side. \pre 0 <= angle_rad < pi/2
[[nodiscard]] double ring_coverage(int tows, double tow_width_mm, double angle_rad,
                                   double tube_radius_mm);

/// Turn about the head's direction from one pose to another, right-handed, rad; less than half a
/// turn.
[[nodiscard]] double frame_turn_rad(const RingHead& head, const Eigen::Isometry3d& from,
                                    const Eigen::Isometry3d& to);

}  // namespace meshwind
