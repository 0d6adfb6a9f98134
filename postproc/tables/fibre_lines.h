/// Exports the fibre of a program as polylines (OBJ, STEP) for other software.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "winding/plan/plan.h"

namespace meshwind {

/// The stations lie within this of the polylines: a twentieth of the tolerance of the lay-down, and
/// less than the bulge of the arcs between the stations.
inline constexpr double kFibreChord_mm = 0.01;

/// One piece of the fibre, mandrel frame.
struct FibreLine {
    std::string name;  ///< "course_12", "transition_13": the number in path.csv
    std::vector<Eigen::Vector3d> points_mm;  ///< n >= 2, in the direction of travel
};

/// The pieces of one fibre in winding order, simplified to as few stations as keep the others
/// within `chord_mm` (Douglas and Peucker); both ends stay. A piece without length is left out.
/// \param chord_mm >= 0
[[nodiscard]] std::vector<FibreLine> fibre_lines(std::span<const Piece> fibre,
                                                 double chord_mm = kFibreChord_mm);

/// Wavefront OBJ: an object with one `l` element for each line, mm to 0.1 um. The same lines give
/// the same bytes.
[[nodiscard]] std::string fibre_obj(std::span<const FibreLine> lines);

/// STEP, ISO 10303-21 of application protocol 214: a wireframe with a curve set for each line that
/// holds a polyline, both of its name; mm to 0.1 um. The time in the head is always the same, so
/// that the same lines give the same bytes.
/// \param product name of the part that readers show \param version of the program
[[nodiscard]] std::string fibre_step(std::span<const FibreLine> lines, const std::string& product,
                                     const std::string& version);

}  // namespace meshwind
