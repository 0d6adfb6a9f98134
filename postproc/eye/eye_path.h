/// Positions of the delivery eye for all landing points, with the adaptive free length.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "mesh/ray_query.h"
#include "winding/plan/free_fibre.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// One landing point and its eye. Mandrel frame; directions unit.
struct EyePoint {
    std::int32_t piece = 0;  ///< index of the course or transition in winding order
    std::int32_t point = 0;  ///< index within the piece
    double s_mm = 0.0;       ///< fibre laid since the start of the program
    Eigen::Vector3d landing_mm = Eigen::Vector3d::Zero();  ///< P, where the fibre touches down
    Eigen::Vector3d tangent =
        Eigen::Vector3d::Zero();  ///< tau, from the landing point along the free fibre to the eye
    Eigen::Vector3d binormal = Eigen::Vector3d::Zero();  ///< across the band; the roller is to be
                                                         ///< parallel to it, sign free
    Eigen::Vector3d eye_mm = Eigen::Vector3d::Zero();    ///< E = P + free_length tau
    double free_length_mm = 0.0;                         ///< L
    double turn_rad = 0.0;  ///< turn of the mandrel about +Z, where it is chosen with the eye
    /// Polar angle of the eye about the spindle axis in the machine; 0 unless the rule sets it
    /// (eye_rules.h), and the mandrel then turns for it.
    double azimuth_rad = 0.0;
    /// In a turn on pins: `landing_mm` is where the free fibre begins, on a pin or on the way
    /// there, and does not move in its direction from point to point.
    bool on_pins = false;
    /// A pin sets where the fibre is laid; an error of the eye does not move the laid fibre.
    bool held = false;
};

using EyePath = std::vector<EyePoint>;

/// Eye points, and the points that no allowed eye position serves.
struct EyePathResult {
    EyePath path;
    std::vector<std::size_t> blocked;  ///< eye points that the rule does not allow, ascending
    std::string words;                 ///< what is wrong with the first of them; else empty
    std::vector<double> ahead_mm;      ///< per point: how far ahead of it the free fibre begins
    double shortest_mm = 0.0;          ///< free lengths used
    double longest_mm = 0.0;
};

/// Landing points of pieces, without eyes.
struct LandingPoints {
    EyePath path;                  ///< one per station of the pieces
    std::vector<double> ahead_mm;  ///< how far ahead of each the free fibre begins: 0, but for
                                   ///< stations from which a bridge runs on
};

/// Stations under a bridge lie on the taut string.
[[nodiscard]] LandingPoints landing_points(std::span<const Piece> pieces);

/// Puts the eye on the free fibre, `length_mm` from the landing point.
void set_eye(EyePoint& point, double length_mm);

/// Shortest and longest free length of the path.
void measure_lengths(EyePathResult& result);

/// Free lengths that are tried where the preferred one is not clear.
enum class LengthSearch {
    Near,  ///< longer ones only where no shorter one is clear
    All    ///< if none of those works, all that the machine can wind with: slow
};

/// Rule adaptive: L is the preferred length wherever free fibre and head are clear, and differs
/// from it only as far as it must, at most by the rates of free_fibre.h; the fibre ahead of a
/// bridge is no shorter than the machine's shortest. Blocked are points for which no allowed length
/// is free of collision. Where circuits repeat (repeated_path.h), the lengths of a few serve all.
/// \param more_clearance_mm per piece, on top of the rule's: lengths are clear at the
/// stations, and between two of them the head may come nearer; empty: none
[[nodiscard]] EyePathResult adaptive_free_length(std::span<const Piece> pieces,
                                                 const RayQuery& obstacles,
                                                 const FreeFibreRule& rule,
                                                 std::span<const double> more_clearance_mm = {},
                                                 LengthSearch search = LengthSearch::Near);

/// Length that counts for the fibre's speed at each point of a path, mm: max(|ds|, |ds + dL|),
/// fibre laid and drawn through the eye, evenly from the point before; 0 for the first.
[[nodiscard]] std::vector<double> fibre_moved_mm(const EyePath& path);

}  // namespace meshwind
