#include "postproc/ringhead/ring_pattern.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/ringhead/ring_head.h"

namespace meshwind {
namespace {

// A need of 12.0000001 tows is one of 12.
constexpr double kWhole = 1e-9;

int up_to_whole(double value) {
    return std::max(1, static_cast<int>(std::ceil(value - kWhole)));
}

}  // namespace

RingPattern ring_pattern(const RingPatternTask& task) {
    assert(task.angle_rad > 0.0 && task.angle_rad < 0.5 * kPi && task.spools >= 1);
    if (!(task.bend_radius_mm > task.tube_radius_mm)) {
        throw InputError("carry.tight", "--tube-radius",
                         "is not below the " + fixed(task.bend_radius_mm, 3) +
                             " mm of the axis' tightest bend; a tube cannot turn so");
    }
    const double share = task.tube_radius_mm / task.bend_radius_mm;
    const double around_mm = 2.0 * kPi * task.tube_radius_mm;
    RingPattern pattern;
    pattern.inside_rad = std::atan(std::tan(task.angle_rad) / (1.0 - share));
    pattern.outside_rad = std::atan(std::tan(task.angle_rad) / (1.0 + share));
    pattern.thickness_ratio = std::cos(pattern.outside_rad) / std::cos(pattern.inside_rad);
    pattern.bridging_rad = std::atan(std::sqrt(share / (1.0 - share)));
    const double outside_mm = around_mm * std::cos(pattern.outside_rad);
    pattern.passes = std::max(1, task.passes);
    pattern.tow_width_mm = task.tow_width_mm;
    if (!(task.tow_width_mm > 0.0)) {
        pattern.tow_width_mm = next_tow_width_mm(outside_mm / (task.spools * pattern.passes));
    } else if (task.passes == 0) {
        pattern.passes = up_to_whole(outside_mm / (task.spools * task.tow_width_mm));
    }
    const int tows = task.spools * pattern.passes;
    pattern.offset_rad = 2.0 * kPi / tows;
    pattern.tows_needed = around_mm * std::cos(task.angle_rad) / pattern.tow_width_mm;
    pattern.tows_needed_outside = outside_mm / pattern.tow_width_mm;
    pattern.coverage =
        ring_coverage(tows, pattern.tow_width_mm, task.angle_rad, task.tube_radius_mm);
    pattern.coverage_outside =
        ring_coverage(tows, pattern.tow_width_mm, pattern.outside_rad, task.tube_radius_mm);
    pattern.fibre_per_tow_mm = task.laid_mm / std::cos(task.angle_rad);
    pattern.fibre_mm = 2.0 * tows * pattern.fibre_per_tow_mm;
    return pattern;
}

double next_tow_width_mm(double width_mm) {
    return kTowWidthStep_mm * up_to_whole(width_mm / kTowWidthStep_mm);
}

double fibre_mass_kg(double length_mm, double tex) {
    constexpr double kKgPerMm = 1e-9;  // of one tex: 1e-3 kg over 1e6 mm
    return length_mm * tex * kKgPerMm;
}

}  // namespace meshwind
