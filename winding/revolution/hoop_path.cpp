#include "winding/revolution/hoop_path.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "winding/vessel/hoop_layer.h"

namespace meshwind {
namespace {

constexpr double kHoop_rad = 0.5 * kPi;

// A straight piece with less slope than this is part of a cylinder: over a metre it is 1 um off.
constexpr double kLevel_rad = 1e-6;

// Slopes of a hoop's part are looked at in so many places.
constexpr int kSlopeSamples = 1000;

bool is_level(const MeridianPiece& piece) {
    const double rise = std::abs(piece.to_mm.x() - piece.from_mm.x());
    return piece.straight && rise <= kLevel_rad * piece.length_mm &&
           piece.to_mm.y() > piece.from_mm.y();
}

// Stations one after the other on a cylinder.
class PlyPath {
public:
    PlyPath(double radius_mm, double station_mm) : radius_mm_(radius_mm), station_mm_(station_mm) {}

    void start(double arc_mm) { add(arc_mm, 0.0, kHoop_rad, 0.0); }

    // A straight helix (or hoop) of a fibre length.
    void run(double angle_rad, double length_mm) {
        const MeridianStation from = stations_.back();
        for_parts(length_mm, [&](double s) {
            add(from.arc_mm + s * std::cos(angle_rad),
                from.azimuth_rad + s * std::sin(angle_rad) / radius_mm_, angle_rad, from.s_mm + s);
        });
    }

    // From hoop to an angle under it or back, with constant slip: cot(angle) changes by slip s / R,
    // the arc and the azimuth by its integrals.
    void steer(double angle_rad, double slip_ratio, bool to_hoop) {
        const MeridianStation from = stations_.back();
        const double most = 1.0 / std::tan(angle_rad);
        const double length_mm = radius_mm_ * most / slip_ratio;
        const double scale = radius_mm_ / slip_ratio;
        const auto arc = [&](double cot) { return scale * (std::hypot(1.0, cot) - 1.0); };
        const auto turn = [&](double cot) { return std::asinh(cot) / slip_ratio; };
        for_parts(length_mm, [&](double s) {
            const double cot = slip_ratio * (to_hoop ? length_mm - s : s) / radius_mm_;
            const double rise = to_hoop ? arc(most) - arc(cot) : arc(cot);
            const double round = to_hoop ? turn(most) - turn(cot) : turn(cot);
            add(from.arc_mm + rise, from.azimuth_rad + round, std::atan2(1.0, cot), from.s_mm + s);
        });
    }

    std::vector<MeridianStation> take() { return std::move(stations_); }

private:
    template <typename Add>
    void for_parts(double length_mm, const Add& add_at) {
        const int parts = std::max(1, static_cast<int>(std::ceil(length_mm / station_mm_)));
        for (int i = 1; i <= parts; ++i) {
            add_at(length_mm * i / parts);
        }
    }

    void add(double arc_mm, double azimuth_rad, double angle_rad, double s_mm) {
        stations_.push_back({{}, arc_mm, azimuth_rad, angle_rad, s_mm});
    }

    double radius_mm_;
    double station_mm_;
    std::vector<MeridianStation> stations_;
};

// From the cylinder to the meridian: arc and azimuth stay, tan(angle) = r dazimuth/darc.
void lay_on(const Meridian& meridian, double radius_mm, std::vector<MeridianStation>& ply) {
    double before_s_mm = ply.front().s_mm;
    for (std::size_t i = 0; i < ply.size(); ++i) {
        MeridianStation& station = ply[i];
        station.place = meridian.at(station.arc_mm);
        const double c = std::cos(station.angle_rad);
        const double s = std::sin(station.angle_rad);
        station.angle_rad = std::atan2(s * station.place.radius_mm / radius_mm, c);
        if (i == 0) {
            continue;
        }
        // Simpson's rule over the step, which is short.
        const auto stretch = [&](double radius) { return std::hypot(c, s * radius / radius_mm); };
        const double middle = meridian.at(0.5 * (ply[i - 1].arc_mm + station.arc_mm)).radius_mm;
        const double mean = (stretch(ply[i - 1].place.radius_mm) + 4.0 * stretch(middle) +
                             stretch(station.place.radius_mm)) /
                            6.0;
        const double step_mm = station.s_mm - before_s_mm;
        before_s_mm = station.s_mm;
        station.s_mm = ply[i - 1].s_mm + mean * step_mm;
    }
}

}  // namespace

CylinderPart cylinder_between(const Meridian& meridian, double low_z_mm, double high_z_mm) {
    const double radius_mm = meridian.at(meridian.widest_mm()).radius_mm;
    return {meridian.foot(radius_mm, low_z_mm).arc_mm, meridian.foot(radius_mm, high_z_mm).arc_mm,
            radius_mm};
}

CylinderPart level_part(const Meridian& meridian, const CylinderPart& part, double band_mm,
                        double most_slope) {
    const double middle_mm = 0.5 * (part.from_mm + part.to_mm);
    const double half_mm = 0.5 * band_mm;
    // From the middle as far as a hoop holds, half a band within the part.
    const auto reach = [&](double end_mm) {
        const double last_mm = end_mm > middle_mm ? std::max(middle_mm, end_mm - half_mm)
                                                  : std::min(middle_mm, end_mm + half_mm);
        double held_mm = middle_mm;
        for (int i = 0; i <= kSlopeSamples; ++i) {
            const double arc_mm = middle_mm + (last_mm - middle_mm) * i / kSlopeSamples;
            if (std::abs(std::tan(meridian.at(arc_mm).slope_rad)) > most_slope) {
                break;
            }
            held_mm = arc_mm;
        }
        return held_mm == last_mm ? end_mm : held_mm + std::copysign(half_mm, end_mm - middle_mm);
    };
    if (std::abs(std::tan(meridian.at(middle_mm).slope_rad)) > most_slope) {
        return {middle_mm, middle_mm, part.radius_mm};
    }
    return {reach(part.from_mm), reach(part.to_mm), part.radius_mm};
}

CylinderPart cylinder_at(const Meridian& meridian, double arc_mm) {
    const auto pieces = meridian.pieces();
    const auto nodes = meridian.nodes_mm();
    const auto behind = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, arc_mm);
    auto first = static_cast<std::size_t>(behind - nodes.begin()) - 1;
    if (!is_level(pieces[first])) {
        return {arc_mm, arc_mm, meridian.at(arc_mm).radius_mm};
    }
    std::size_t last = first;
    while (first > 0 && is_level(pieces[first - 1])) {
        --first;
    }
    while (last + 1 < pieces.size() && is_level(pieces[last + 1])) {
        ++last;
    }
    return {nodes[first], nodes[last + 1], meridian.at(arc_mm).radius_mm};
}

std::vector<MeridianStation> hoop_ply(const Meridian& meridian, const CylinderPart& part,
                                      double band_mm, double slip_ratio, double station_mm,
                                      bool downward) {
    const double around_mm = 2.0 * kPi * part.radius_mm;
    const double rise_mm = part.to_mm - part.from_mm - band_mm;
    PlyPath path(part.radius_mm, station_mm);
    if (rise_mm <= 0.0) {
        path.start(0.5 * (part.from_mm + part.to_mm));
        path.run(kHoop_rad, around_mm);
    } else {
        path.start(part.from_mm + 0.5 * band_mm);
        path.run(kHoop_rad, around_mm);
        const double angle = hoop_layer({.radius_mm = part.radius_mm,
                                         .length_mm = part.to_mm - part.from_mm,
                                         .band_mm = band_mm})
                                 .angle_rad;
        // Steeper steering where the ends of the helix would meet.
        const double steered =
            std::max(slip_ratio, 2.0 * part.radius_mm * (1.0 / std::sin(angle) - 1.0) / rise_mm);
        const double ends_mm = 2.0 * part.radius_mm / steered * (1.0 / std::sin(angle) - 1.0);
        path.steer(angle, steered, false);
        path.run(angle, (rise_mm - ends_mm) / std::cos(angle));
        path.steer(angle, steered, true);
        path.run(kHoop_rad, around_mm);
    }
    std::vector<MeridianStation> ply = path.take();
    if (downward) {
        const double ends_mm = ply.front().arc_mm + ply.back().arc_mm;
        for (MeridianStation& station : ply) {
            station.arc_mm = ends_mm - station.arc_mm;
            station.angle_rad = kPi - station.angle_rad;
        }
    }
    lay_on(meridian, part.radius_mm, ply);
    return ply;
}

}  // namespace meshwind
