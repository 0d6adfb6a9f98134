#include "winding/laminate/course_character.h"

#include <cmath>
#include <cstddef>

#include "core/units.h"
#include "winding/laminate/wound_angle.h"

namespace meshwind {
namespace {

// From here on fibre over a pipe is hoop.
constexpr double kHoop_rad = 70.0 * kPi / 180.0;

}  // namespace

CourseCharacter character_of(const Surface& surface, const SurfacePath& path) {
    CourseCharacter character;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const double length = path[i + 1].s_mm - path[i].s_mm;
        const auto angle = winding_angle_rad(surface, path[i]);
        character.length_mm += length;
        if (!angle) {
            character.junction_mm += length;
            continue;
        }
        character.hoop_mm += *angle >= kHoop_rad ? length : 0.0;
        character.clamp_mm += length * std::sin(*angle) * std::sin(*angle);
    }
    return character;
}

Places places_of(const Surface& surface, std::span<const SurfacePath* const> courses) {
    double junction_mm = 0.0;
    double hoop_mm = 0.0;
    Places sum{0.0, 0.0};
    for (std::size_t i = 0; i < courses.size(); ++i) {
        const CourseCharacter character = character_of(surface, *courses[i]);
        const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(courses.size());
        junction_mm += character.junction_mm;
        hoop_mm += character.hoop_mm;
        sum.junction += place * character.junction_mm;
        sum.hoop += place * character.hoop_mm;
    }
    Places places;
    if (junction_mm > 0.0) {
        places.junction = sum.junction / junction_mm;
    }
    if (hoop_mm > 0.0) {
        places.hoop = sum.hoop / hoop_mm;
    }
    return places;
}

}  // namespace meshwind
