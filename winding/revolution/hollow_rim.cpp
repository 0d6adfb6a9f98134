#include "winding/revolution/hollow_rim.h"

#include <algorithm>
#include <cmath>

#include "core/roots.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

// The place where the fibre leaves the wall is halved to rounding.
constexpr int kHalvings = 60;

// Stretches in the air have at least so many stations.
constexpr int kMinStations = 2;

// A pass seen on its way out over one end: arc, z, azimuth and s grow towards the rim.
class WayOut {
public:
    WayOut(const Meridian& meridian, bool upper, double station_mm,
           std::vector<MeridianStation>& stations)
        : meridian_(meridian),
          sign_(upper ? 1.0 : -1.0),
          station_mm_(station_mm),
          stations_(stations),
          end_(meridian.at(upper ? meridian.length_mm() : 0.0)) {
        if (!upper) {
            std::reverse(stations_.begin(), stations_.end());
        }
    }

    bool lift() {
        std::size_t last = stations_.size();
        while (last > 0 && beside_mm(stations_[last - 1]) < 0.0) {
            --last;
        }
        if (last == 0) {
            return false;
        }
        const MeridianStation rim = stations_.back();
        MeridianStation leaves = stations_[last - 1];
        if (last < stations_.size()) {
            leaves = leaving(leaves, stations_[last]);
            stations_.resize(last);
            if (leaves.s_mm != stations_.back().s_mm) {
                stations_.push_back(leaves);
            }
            go_straight(leaves, rim);
        }
        return true;
    }

    void turn_back() {
        if (sign_ < 0.0) {
            std::reverse(stations_.begin(), stations_.end());
        }
        const double s0 = stations_.front().s_mm;
        for (MeridianStation& station : stations_) {
            station.s_mm -= s0;
        }
    }

private:
    // Of the tangent at a station: radial, around, along the axis and outward.
    struct Tangent {
        double radial, around, axial;
    };
    [[nodiscard]] Tangent tangent(const MeridianStation& at) const {
        const double psi = sign_ * at.place.slope_rad;
        const double c = std::cos(at.angle_rad);
        return {c * std::sin(psi), std::sin(at.angle_rad), c * std::cos(psi)};
    }

    // How far outside the extension the tangent passes the spindle.
    [[nodiscard]] double beside_mm(const MeridianStation& at) const {
        const Tangent t = tangent(at);
        if (t.radial >= 0.0) {
            return at.place.radius_mm - end_.radius_mm;
        }
        return at.place.radius_mm * t.around / std::hypot(t.radial, t.around) - end_.radius_mm;
    }

    // Between two stations: arc and azimuth by cubics, c linear.
    [[nodiscard]] MeridianStation between(const MeridianStation& a, const MeridianStation& b,
                                          double share) const {
        const double span = b.s_mm - a.s_mm;
        const auto cubic = [&](double from, double to, double rate0, double rate1) {
            const double r = 1.0 - share;
            const double chord = to - from;
            const double bulge = r * (span * rate0 - chord) + share * (chord - span * rate1);
            return from + share * chord + share * r * bulge;
        };
        const auto c_mm = [](const MeridianStation& at) {
            return at.place.radius_mm * std::sin(at.angle_rad);
        };
        const auto around = [](const MeridianStation& at) {
            return std::sin(at.angle_rad) / at.place.radius_mm;
        };
        MeridianStation at;
        at.s_mm = a.s_mm + share * span;
        at.arc_mm = cubic(a.arc_mm, b.arc_mm, std::cos(a.angle_rad), std::cos(b.angle_rad));
        at.azimuth_rad = cubic(a.azimuth_rad, b.azimuth_rad, around(a), around(b));
        at.place = meridian_.at(at.arc_mm);
        const double c = c_mm(a) + share * (c_mm(b) - c_mm(a));
        at.angle_rad = std::asin(std::min(1.0, c / at.place.radius_mm));
        return at;
    }

    // Where the tangent touches the extension.
    [[nodiscard]] MeridianStation leaving(const MeridianStation& outside,
                                          const MeridianStation& inside) const {
        if (inside.s_mm == outside.s_mm) {
            return outside;  // the two sides of a crease
        }
        const auto is_within = [&](double share) {
            return beside_mm(between(outside, inside, share)) < 0.0;
        };
        const double share = halve({.holds = 1.0, .fails = 0.0}, kHalvings, is_within).fails;
        return share > 0.0 ? between(outside, inside, share) : outside;
    }

    // Stations below the straight fibre, up to the rim.
    void go_straight(const MeridianStation& leaves, const MeridianStation& rim) {
        const Tangent t = tangent(leaves);
        const double length = sign_ * (rim.place.z_mm - leaves.place.z_mm) / t.axial;
        const int steps = std::max(kMinStations, static_cast<int>(std::ceil(length / station_mm_)));
        for (int i = 1; i <= steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            const double along = share * length;
            const double x = leaves.place.radius_mm + along * t.radial;
            const double y = along * t.around;
            const double radius = std::hypot(x, y);
            MeridianStation at = rim;
            if (i < steps) {
                at.arc_mm = leaves.arc_mm + share * (rim.arc_mm - leaves.arc_mm);
                at.place = meridian_.at(at.arc_mm);
            }
            const double psi = sign_ * at.place.slope_rad;
            const double radial = (t.radial * x + t.around * y) / radius;
            const double around = (t.around * x - t.radial * y) / radius;
            const double up = radial * std::sin(psi) + t.axial * std::cos(psi);
            const double out = radial * std::cos(psi) - t.axial * std::sin(psi);
            const double over_z = sign_ * (leaves.place.z_mm - at.place.z_mm) + along * t.axial;
            at.azimuth_rad = leaves.azimuth_rad + sign_ * std::atan2(y, x);
            at.angle_rad = std::atan2(around, up);
            at.s_mm = leaves.s_mm + sign_ * along;
            at.gap_mm = (radius - at.place.radius_mm) * std::cos(psi) - over_z * std::sin(psi);
            at.slope = sign_ * out / std::hypot(up, around);
            stations_.push_back(at);
        }
    }

    const Meridian& meridian_;
    double sign_;
    double station_mm_;
    std::vector<MeridianStation>& stations_;
    MeridianPlace end_;
};

}  // namespace

double rim_kink_rad(const Meridian& meridian, bool upper) {
    return upper ? -meridian.at(meridian.length_mm()).slope_rad : meridian.at(0.0).slope_rad;
}

RimLift lift_over_rim(const Meridian& meridian, bool upper, double station_mm,
                      std::vector<MeridianStation>& stations) {
    if (rim_kink_rad(meridian, upper) < kMinRimKink_rad) {
        return RimLift::OnWall;
    }
    WayOut way(meridian, upper, station_mm, stations);
    const bool lifted = way.lift();
    way.turn_back();
    return lifted ? RimLift::Straight : RimLift::NeverOnWall;
}

bool in_air(const MeridianPass& pass, std::size_t end) {
    return (end == 0 ? pass.stations.front() : pass.stations.back()).gap_mm > 0.0;
}

LaidPass lifted_over_rims(const Meridian& meridian, const MeridianPass& on_wall,
                          const LiftOptions& options) {
    LaidPass laid{on_wall, {}};
    for (std::size_t end = 0; end < 2 && laid.failure.empty(); ++end) {
        if ((end == 0 ? on_wall.lower : on_wall.upper) != MeridianStop::End) {
            continue;
        }
        const RimLift lift =
            lift_over_rim(meridian, end == 1, options.station_mm, laid.pass.stations);
        const double gap_mm =
            (end == 0 ? laid.pass.stations.front() : laid.pass.stations.back()).gap_mm;
        if (lift != RimLift::NeverOnWall && gap_mm <= options.most_gap_mm) {
            continue;
        }
        laid.failure = std::string("over the ") + (end == 0 ? "lower" : "upper") +
                       " rim, a hollow of " + degrees(rim_kink_rad(meridian, end == 1)) + ", ";
        laid.failure += lift == RimLift::NeverOnWall
                            ? "a fibre at " + degrees(options.angle_rad) +
                                  " is in the air all the way to the extension"
                            : "the fibre is in the air by " + fixed(gap_mm, 2) +
                                  " mm, and tows may bridge " + fixed(options.most_gap_mm, 2);
        laid.failure += "; a larger angle, or a straight end of the part, would do";
    }
    return laid;
}

std::vector<MeridianStation> tied_on_way(const Meridian& meridian, const MeridianPass& on_wall,
                                         const MeridianPass& laid, std::size_t from,
                                         double station_mm) {
    MeridianPass pass = on_wall;
    if (in_air(laid, 1 - from)) {
        (void)lift_over_rim(meridian, from == 0, station_mm, pass.stations);
    }
    if (from == 0) {
        return pass.stations;
    }
    std::vector<MeridianStation> back = way_back(pass);
    for (MeridianStation& station : back) {
        station.azimuth_rad += laid.stations.back().azimuth_rad - pass.stations.back().azimuth_rad;
    }
    return back;
}

double tied_on_beside_rad(const MeridianPass& on_wall, const MeridianPass& laid, std::size_t from) {
    return from == 0 ? on_wall.stations.front().azimuth_rad - laid.stations.front().azimuth_rad
                     : laid.stations.back().azimuth_rad - on_wall.stations.back().azimuth_rad;
}

}  // namespace meshwind
