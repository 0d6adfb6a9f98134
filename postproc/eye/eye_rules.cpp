#include "postproc/eye/eye_rules.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Share of a fibre's direction across the spindle below which it counts as parallel to it: the
// eye would be a million times as far away as the cylinder or plane.
constexpr double kAlongSpindle = 1e-6;

// Rounding of lengths that are computed from places of some metres.
constexpr double kSameLength_mm = 1e-6;

// What the rule makes of one landing point.
struct Place {
    double length_mm = 0.0;
    double azimuth_rad = 0.0;
    std::string words;  // why there is none
};

// A landing point and its fibre, seen along the spindle.
struct Section {
    double across;       // share of the fibre's direction across the spindle
    double along_mm;     // landing point along the fibre's direction there
    double lever_mm;     // and the fibre's lever arm about the spindle, > 0 counter-clockwise
    double distance_mm;  // of the landing point from the axis

    explicit Section(const EyePoint& point) {
        const Eigen::Vector2d landing = point.landing_mm.head<2>();
        const Eigen::Vector2d tangent = point.tangent.head<2>();
        across = tangent.norm();
        const Eigen::Vector2d unit = across > 0.0 ? Eigen::Vector2d(tangent / across) : tangent;
        along_mm = landing.dot(unit);
        lever_mm = landing.x() * unit.y() - landing.y() * unit.x();
        distance_mm = landing.norm();
    }
};

std::string along_spindle(const Section& section, const std::string& what) {
    return "the free fibre runs along the spindle, " + fixed(section.across, 8) +
           " of it across, and does not meet the " + what;
}

Place on_cylinder(const EyePoint& point, const EyeLaw& law) {
    const Section section(point);
    const std::string cylinder = "cylinder of " + fixed(law.radius_mm, 2) + " mm about the spindle";
    if (section.distance_mm >= law.radius_mm) {
        return {0.0, 0.0,
                "the landing point is " + fixed(section.distance_mm, 2) +
                    " mm from the spindle axis, not within the " + cylinder};
    }
    if (section.across < kAlongSpindle) {
        return {0.0, 0.0, along_spindle(section, cylinder)};
    }
    const double half =
        std::sqrt(law.radius_mm * law.radius_mm - section.lever_mm * section.lever_mm);
    return {(half - section.along_mm) / section.across, 0.0, {}};
}

// In the plane x = `plane_mm` of a machine turned so that the fibre runs along +X, seen along the
// spindle: the eye is below the axis there by the lever arm. `turned_rad` turns all of it about +Z.
Place on_plane(const EyePoint& point, double plane_mm, double turned_rad, const std::string& name) {
    const Section section(point);
    if (section.across < kAlongSpindle) {
        return {0.0, 0.0, along_spindle(section, name)};
    }
    if (section.along_mm >= plane_mm) {
        return {0.0, 0.0,
                "the landing point is " + fixed(section.along_mm - plane_mm, 2) +
                    " mm beyond the " + name};
    }
    return {(plane_mm - section.along_mm) / section.across,
            std::atan2(-section.lever_mm, plane_mm) + turned_rad,
            {}};
}

Place place_of(const EyePoint& point, const EyeLaw& law) {
    switch (law.rule) {
        case EyeRule::Cylinder:
            return on_cylinder(point, law);
        case EyeRule::VerticalPlane:
            return on_plane(point, law.plane_x_mm, 0.0,
                            "plane x = " + fixed(law.plane_x_mm, 2) + " mm");
        case EyeRule::HorizontalPlane:
            return on_plane(point, std::abs(law.plane_y_mm),
                            std::copysign(0.5 * kPi, law.plane_y_mm),
                            "plane y = " + fixed(law.plane_y_mm, 2) + " mm");
        default:
            return {law.free_length_mm, 0.0, {}};
    }
}

// Length that the law names for a point, before the rates.
double told_length_mm(const EyePoint& point, const EyeLaw& law) {
    double told = law.free_length_mm;
    for (const LengthPiece& piece : law.lengths) {
        const bool here = piece.piece ? *piece.piece == point.piece
                                      : piece.from_mm <= point.s_mm && point.s_mm <= piece.to_mm;
        told = here ? piece.free_length_mm : told;
    }
    return told;
}

// The shortest lengths that respect the given ones and the limits of their rates.
std::vector<double> piecewise_lengths(const EyePath& path, const EyeLaw& law) {
    std::vector<double> length;
    for (const EyePoint& point : path) {
        length.push_back(told_length_mm(point, law));
    }
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double ds = path[i].s_mm - path[i - 1].s_mm;
        length[i] = std::max(length[i], length[i - 1] - kShorteningRate * ds);
    }
    for (std::size_t i = path.size(); i-- > 1;) {
        const double ds = path[i].s_mm - path[i - 1].s_mm;
        length[i - 1] = std::max(length[i - 1], length[i] - kLengtheningRate * ds);
    }
    return length;
}

// Words where the machine cannot wind with a length. What is in the air over a hollow ahead of the
// landing point is no free fibre.
std::string out_of_range(double length_mm, double ahead_mm, const FreeFibreRule& range) {
    if (length_mm - ahead_mm >= range.min_mm - kSameLength_mm &&
        length_mm <= range.max_mm + kSameLength_mm) {
        return {};
    }
    return "the rule asks for a free fibre of " + fixed(length_mm - ahead_mm, 2) +
           " mm; the machine winds with " + fixed(range.min_mm, 0) + " to " +
           fixed(range.max_mm, 0) + " mm";
}

}  // namespace

EyePathResult strict_eye_path(std::span<const Piece> pieces, const EyeLaw& law,
                              const FreeFibreRule& range) {
    assert(law.rule != EyeRule::Adaptive);
    EyePathResult result;
    LandingPoints points = landing_points(pieces);
    result.path = std::move(points.path);
    const std::vector<double> lengths = law.rule == EyeRule::EqualFreeLength
                                            ? piecewise_lengths(result.path, law)
                                            : std::vector<double>();
    double azimuth_rad = 0.0;
    for (std::size_t i = 0; i < result.path.size(); ++i) {
        EyePoint& point = result.path[i];
        const Place place = lengths.empty() ? place_of(point, law) : Place{lengths[i], 0.0, {}};
        azimuth_rad = place.words.empty() ? place.azimuth_rad : azimuth_rad;
        const std::string words = place.words.empty()
                                      ? out_of_range(place.length_mm, points.ahead_mm[i], range)
                                      : place.words;
        if (!words.empty()) {
            result.words = result.blocked.empty() ? words : result.words;
            result.blocked.push_back(i);
        }
        point.azimuth_rad = azimuth_rad;
        set_eye(point, std::clamp(place.length_mm, range.min_mm, range.max_mm));
    }
    result.ahead_mm = std::move(points.ahead_mm);
    measure_lengths(result);
    return result;
}

EyePathResult eye_path(std::span<const Piece> pieces, const EyeLaw& law, const RayQuery& obstacles,
                       const FreeFibreRule& rule, std::span<const double> more_clearance_mm,
                       LengthSearch search) {
    return law.rule == EyeRule::Adaptive
               ? adaptive_free_length(pieces, obstacles, rule, more_clearance_mm, search)
               : strict_eye_path(pieces, law, rule);
}

}  // namespace meshwind
