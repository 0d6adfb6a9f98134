/// Shifts a course into the gap between its neighbours, or to the pins that it turns on. A fit says
/// how far it is moved, turned and steered.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "winding/cover/placed_course.h"
#include "winding/laminate/footprint.h"

namespace meshwind {

/// How far a fit may move any place of a course, in bands: half of what a strip shows on either
/// side of the band.
inline constexpr double kFitBands = 0.4;

/// Width of the strip that a fit needs, in bands.
inline constexpr double kStripBands = 1.0 + 2.0 * kFitBands;

/// Displacements to the left in mm, per station of a course: per mm to the left, per rad, and per
/// unit of the steering ahead of the seed and behind.
using CourseFields = Eigen::Matrix<double, Eigen::Dynamic, 4>;

/// Displacements by each part of a move from the seed's station, to first order.
[[nodiscard]] CourseFields displacements(const Surface& surface, const SurfacePath& path,
                                         const Candidate& candidate, std::size_t seed);

/// A move, and the saving of the course after it, to first order.
struct Fit {
    CourseMove move;
    double saved = 0.0;
};

/// The move that saves most, to first order: the displacement of every place is the sum of four
/// **Jacobi fields**, one for each part of the move (geodesic/jacobi_field.h; steering adds kn as a
/// source), and the band covers the samples that then lie within half its width. No place moves by
/// more than kFitBands, and steering stays within what moved() allows. Where fibre turns on pins
/// only moves count that leave both ends at theirs, to first order. \param strip of the course's
/// path, kStripBands wide \param saving per entry of the strip: saving by covering it, negative
/// where it costs \return the move from seed_station(); nothing where none saves more than the
/// course does now
[[nodiscard]] Fit fit_course(const CourseRules& rules, const PlacedCourse& course,
                             const Strip& strip, std::span<const float> saving);

/// True when both ends are within `within_mm` of where pins take hold of them, or turn by friction.
[[nodiscard]] bool ends_at_pins(const CourseRules& rules, const LibraryCourse& member,
                                double within_mm);

/// The move from seed_station() by which both ends come to the nearest pins, to first order:
/// sideways and about the seed. Nothing where a place would move by more than two pitches.
[[nodiscard]] std::optional<CourseMove> move_to_pins(const CourseRules& rules,
                                                     const PlacedCourse& course);

}  // namespace meshwind
