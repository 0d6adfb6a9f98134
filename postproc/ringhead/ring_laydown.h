/// Simulates the laying of fibre on a frame that a program carries through a ring head.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "postproc/ringhead/krl.h"
#include "postproc/ringhead/ring_head.h"
#include "postproc/ringhead/tube_surface.h"

namespace meshwind {

/// A line of the table that the rings' drives follow; they turn evenly in between and stand still
/// before and after.
struct RingKnot {
    double time_s = 0.0;               ///< ascending
    std::array<double, 2> ring_rad{};  ///< right-handed about the head's direction, base frame
};

/// Head, frame and rings at one time.
struct HeadState {
    double time_s = 0.0;
    double s_mm = 0.0;  ///< of the tube's axis: nearest to the head's centre
    Eigen::Isometry3d head_in_mandrel = Eigen::Isometry3d::Identity();  ///< z: the head's direction
    std::array<double, 2> ring_rad{};
};

/// Plays a program and a table of the rings in steps in which no ring turns by more than
/// kRingStep_rad against the frame and the axis passes by no more than kPassStep_mm; the ends of
/// all moves and the table's lines are met. \param law how the controller turns the flange
/// \pre the knots cover the program's time
[[nodiscard]] std::vector<HeadState> play_head(const KrlProgram& program,
                                               const std::vector<RingKnot>& knots,
                                               const RingHead& head, const TubeSurface& tube,
                                               TurnLaw law = TurnLaw::SwivelAndSpin);

/// Errors of a landing curve fall with the square of these; with these they are under 2e-3 mm on a
/// straight tube (ring_laydown_test.cpp).
inline constexpr double kRingStep_rad = 1.5 * kPi / 180.0;
inline constexpr double kPassStep_mm = 0.5;

/// The spools of one ring on one passage. Ring 0 stands half the distance between the rings ahead
/// of the centre, along the head's direction, ring 1 as far behind it.
struct RingSpools {
    int ring = 0;
    int count = 12;            ///< >= 1, evenly round the ring
    double radius_mm = 40.0;   ///< of the circle from which the fibres leave; above the tube's
    double phase_rad = 0.0;    ///< of the first spool against the ring
    double tie_s_mm = 0.0;     ///< where the fibres are tied on the tube
    bool right_handed = true;  ///< turn of the ring against the frame, about the head's direction
};

/// A landing point: where a fibre leaves the tube for its spool at some time, and so is laid.
struct LaidRingPoint {
    Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();  ///< on the tube, mandrel frame
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
    double s_mm = 0.0;       ///< along the axis
    double round_rad = 0.0;  ///< TubeFoot's, counted on without limit
    double stretch = 1.0;    ///< TubeSurface::stretch
    double time_s = 0.0;
    double angle_rad = 0.0;  ///< of the fibre from the axis, -pi/2 .. pi/2, > 0 right-handed
    double kn_per_mm = 0.0;  ///< curvature of the tube along the fibre; it bridges where <= 0
    double free_mm = 0.0;    ///< length from here to the spool
};

/// A stretch where a fibre is straight in the air because the tube is hollow along it.
struct RingBridge {
    double s_mm = 0.0;
    double length_mm = 0.0;
    double gap_mm = 0.0;  ///< largest height over the tube, or depth of a part not followed
};

struct RingFibre {
    int ring = 0;
    int spool = 0;                      ///< of the ring, from 0
    int pass = 0;                       ///< set by the caller
    std::vector<LaidRingPoint> points;  ///< from the tie on
    std::vector<RingBridge> bridges;
    double peeled_mm = 0.0;  ///< length that was laid and taken up again
    double length_mm = 0.0;  ///< of the laid fibre, sum of the chords
};

/// Lays the fibre of every spool. A fibre runs straight from its landing point X to the spool P; it
/// does not slip. As P sinks under the tangent plane at X, the landing point moves on until
/// n . (P - X) = 0, in the mean of the directions to the spool at the step's two ends; as P rises
/// over it the fibre peels off. Where the tube is hollow along the fibre, or the straight fibre
/// meets it further on, the landing point goes there and leaves a bridge behind. At the start a
/// fibre is tied on at tie_s_mm where the straight line to its spool touches the tube's round.
/// Accuracy: exact helices, starts of the angle and even advance in a bend are
/// held by ring_laydown_test.cpp.
[[nodiscard]] std::vector<RingFibre> lay_ring_fibres(const std::vector<HeadState>& states,
                                                     const RingHead& head, const TubeSurface& tube,
                                                     const RingSpools& spools);

/// Lag of fibres behind a ring's plane on a straight tube: sqrt(R^2 - r^2) / tan(angle), mm. A
/// change of the angle dies away with exp(-way / this).
/// \pre angle_rad > 0, spool radius above the tube's
[[nodiscard]] double landing_lag_mm(double spool_radius_mm, double tube_radius_mm,
                                    double angle_rad);

}  // namespace meshwind
