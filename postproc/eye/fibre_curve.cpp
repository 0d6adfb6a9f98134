#include "postproc/eye/fibre_curve.h"

#include <Eigen/Geometry>

namespace meshwind {

FibreFrame fibre_at(const EyePoint& point) {
    return {.landing_mm = point.landing_mm,
            .tangent = point.tangent,
            .normal = point.tangent.cross(point.binormal),
            .binormal = point.binormal,
            .free_length_mm = point.free_length_mm};
}

FibreFrame fibre_between(const EyePoint& from, const EyePoint& to, double share) {
    const Eigen::Vector3d chord = to.landing_mm - from.landing_mm;
    const double length = chord.norm();
    const double rest = 1.0 - share;
    FibreFrame frame;
    Eigen::Vector3d along;
    if (length < kSamePlace_mm || (from.on_pins && to.on_pins)) {
        frame.landing_mm = from.landing_mm + share * chord;
        along = rest * from.tangent + share * to.tangent;
    } else {
        // Hermite's cubic: the chord, and what the tangents at both ends turn away from it.
        const Eigen::Vector3d start = length * from.tangent - chord;
        const Eigen::Vector3d end = length * to.tangent - chord;
        frame.landing_mm =
            from.landing_mm + share * chord + share * rest * (rest * start - share * end);
        along = chord + rest * (rest - 2.0 * share) * start + share * (share - 2.0 * rest) * end;
    }
    const Eigen::Vector3d normal =
        rest * from.tangent.cross(from.binormal) + share * to.tangent.cross(to.binormal);
    frame.tangent = along.normalized();
    frame.binormal = normal.cross(along).normalized();
    frame.normal = frame.tangent.cross(frame.binormal);
    frame.free_length_mm = rest * from.free_length_mm + share * to.free_length_mm;
    return frame;
}

}  // namespace meshwind
