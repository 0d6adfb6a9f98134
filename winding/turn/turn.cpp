#include "winding/turn/turn.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/margins.h"
#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Steeper than this the run onto the extension circles the mandrel more than twice before it is
// hoop.
constexpr double kMaxTurnAngle_rad = 84.0 * kPi / 180.0;

// Longer than any machine: a turn that takes more is told as one that no extension makes. Without
// friction the run is infinite.
constexpr double kLongestExtension_mm = 1e5;

// Stretches in the air are drawn by at least so many steps.
constexpr int kMinAirSteps = 2;

double usable_run_mm(const TurnRule& rule) {
    return rule.extension_mm - 0.5 * rule.band_mm;
}

// Height at which both ends of a turn are hoop: each is steered with the slip that makes it so.
double hoop_height_mm(const Rim& rim, const RimCrossing& a, const RimCrossing& b,
                      const TurnRule& rule) {
    const auto easy = [&](const RimCrossing& end) {
        return landing_mm(rim, end) +
               turn_run_mm(rim.radius_mm, end.angle_rad, rule.friction.share(margin::kEasyTurn));
    };
    return std::min(std::max(easy(a), easy(b)), usable_run_mm(rule));
}

double slip_for(const Rim& rim, const RimCrossing& crossing, double hoop_mm) {
    return rim.radius_mm * (1.0 / std::sin(crossing.angle_rad) - 1.0) /
           (hoop_mm - landing_mm(rim, crossing));
}

// Fibre from the rim to hoop, in the air and on the extension.
double to_hoop_mm(const Rim& rim, const RimCrossing& crossing, double hoop_mm) {
    const double in_air_mm =
        rim.radius_mm * std::tan(crossing.ahead_rad) / std::sin(crossing.angle_rad);
    return in_air_mm +
           rim.radius_mm / (slip_for(rim, crossing, hoop_mm) * std::tan(crossing.angle_rad));
}

double positive_angle(double rad) {
    const double turn = 2.0 * kPi;
    const double rest = std::fmod(rad, turn);
    const double positive = rest < 0.0 ? rest + turn : rest;
    return positive < turn ? positive : 0.0;  // a tiny negative rest rounds up to the whole turn
}

class TurnPath {
public:
    TurnPath(const Rim& rim, int sense, double step_mm)
        : rim_(rim),
          sense_(sense),
          step_mm_(step_mm),
          x_(rim_reference(rim)),
          y_(rim.axis.cross(x_)) {}

    // A station at height z over the rim; beta in (0, pi), over pi / 2 on the way back. In the air
    // the fibre is over it by a gap, at a slope.
    void add(double azimuth, double z, double beta, double kg_over_kn, double gap_mm = 0.0,
             double slope = 0.0) {
        const Vector3d radial = std::cos(azimuth) * x_ + std::sin(azimuth) * y_;
        const Vector3d around = sense_ * rim_.axis.cross(radial);
        PathPoint point;
        point.position_mm = rim_.centre_mm + z * rim_.axis + rim_.radius_mm * radial;
        point.normal = radial;
        point.tangent = std::sin(beta) * around + std::cos(beta) * rim_.axis;
        point.kn_per_mm = std::sin(beta) * std::sin(beta) / rim_.radius_mm;
        point.kg_per_mm = kg_over_kn * point.kn_per_mm;
        point.s_mm = s_mm_;
        path_.push_back(point);
        string_.gap_mm.push_back(gap_mm);
        string_.slope.push_back(slope);
        if (gap_mm > string_.worst_gap_mm) {
            string_.worst_gap_mm = gap_mm;
            string_.worst_station = path_.size() - 1;
        }
    }

    // Straight through the air from the rim to where the fibre touches the extension, or from there
    // to the rim. Seen from where it touches, it is at the angle q along the hoop.
    void fly(const RimCrossing& at, double slip, bool back) {
        if (at.ahead_rad <= 0.0) {
            return;
        }
        const double sine = std::sin(at.angle_rad);
        const double cosine = std::cos(at.angle_rad);
        const double length = rim_.radius_mm * std::tan(at.ahead_rad) / sine;
        const int steps = std::max(kMinAirSteps, static_cast<int>(std::ceil(length / step_mm_)));
        const double s0 = s_mm_;
        for (int i = back ? 1 : 0; i <= steps; ++i) {
            const double to_touch = length * (back ? i : steps - i) / steps;
            const double q = std::atan2(to_touch * sine, rim_.radius_mm);
            const double beta = std::atan2(sine * std::cos(q), cosine);
            const double sinks = sine * std::sin(q) / std::hypot(sine * std::cos(q), cosine);
            const double from_rim = sense_ * (at.ahead_rad - q);
            s_mm_ = s0 + length * i / steps;
            add(at.azimuth_rad + (back ? -from_rim : from_rim),
                landing_mm(rim_, at) - to_touch * cosine, back ? kPi - beta : beta,
                to_touch > 0.0 ? 0.0 : -sense_ * slip, rim_.radius_mm * (1.0 / std::cos(q) - 1.0),
                back ? sinks : -sinks);
        }
    }

    // From beta0 to hoop (or from hoop to beta0 when `back`): z(beta) and azimuth(beta) in closed
    // form, from where the fibre lies on the extension.
    void steer(const RimCrossing& at, double slip, bool back) {
        const double azimuth0 = at.azimuth_rad + (back ? -sense_ : sense_) * at.ahead_rad;
        const double beta0 = at.angle_rad;
        const double z0 = landing_mm(rim_, at);
        const double length = rim_.radius_mm / (slip * std::tan(beta0));
        const int steps = std::max(2, static_cast<int>(std::ceil(length / step_mm_)));
        // kg turns the tangent away from the axis: to the right for a counter-clockwise fibre.
        const double kg_over_kn = -sense_ * slip;
        const double s0 = s_mm_;
        for (int i = 0; i <= steps; ++i) {
            if (i == 0 && !path_.empty()) {
                continue;
            }
            const double share = static_cast<double>(back ? steps - i : i) / steps;
            // Fibre length from beta0: (R / slip)(cot beta0 - cot beta).
            const double beta = std::atan2(1.0, (1.0 - share) / std::tan(beta0));
            const double z =
                z0 + (rim_.radius_mm / slip) * (1.0 / std::sin(beta0) - 1.0 / std::sin(beta));
            const double angle = turn_angle_rad(beta0, slip) - turn_angle_rad(beta, slip);
            s_mm_ = s0 + length * (back ? 1.0 - share : share);
            add(azimuth0 + sense_ * (back ? -angle : angle), z, back ? kPi - beta : beta,
                kg_over_kn);
        }
    }

    // From where it touches the extension on, as a helix.
    void go_on(const RimCrossing& at, double length) {
        const int steps = std::max(1, static_cast<int>(std::ceil(length / step_mm_)));
        const double s0 = s_mm_;
        for (int i = 1; i <= steps; ++i) {
            const double along = length * i / steps;
            const double around = at.ahead_rad + along * std::sin(at.angle_rad) / rim_.radius_mm;
            s_mm_ = s0 + along;
            add(at.azimuth_rad + sense_ * around,
                landing_mm(rim_, at) + along * std::cos(at.angle_rad), at.angle_rad, 0.0);
        }
    }

    void dwell(double azimuth0, double z, double angle) {
        const double length = angle * rim_.radius_mm;
        const int steps = static_cast<int>(std::ceil(length / step_mm_));
        const double s0 = s_mm_;
        for (int i = 1; i <= steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            s_mm_ = s0 + share * length;
            add(azimuth0 + sense_ * share * angle, z, 0.5 * kPi, 0.0);
        }
    }

    void take(Turn& turn) {
        turn.path = std::move(path_);
        turn.string = std::move(string_);
    }

private:
    const Rim& rim_;
    double sense_;
    double step_mm_;
    Vector3d x_;
    Vector3d y_;
    SurfacePath path_;
    TautString string_;
    double s_mm_ = 0.0;
};

}  // namespace

Vector3d rim_reference(const Rim& rim) {
    return rim.axis.unitOrthogonal();
}

RimCrossing crossing_at(const Rim& rim, const Vector3d& position_mm, const Vector3d& outward) {
    const Vector3d x = rim_reference(rim);
    const Vector3d y = rim.axis.cross(x);
    const Vector3d d = position_mm - rim.centre_mm;
    RimCrossing crossing;
    crossing.rim = rim.id;
    crossing.azimuth_rad = std::atan2(d.dot(y), d.dot(x));
    const Vector3d around = rim.axis.cross(d).normalized();
    const double turning = outward.dot(around);
    // Onto the extension the fibre runs as over a crease: the angle to the rim stays.
    const double axial = outward.dot(rim.axis);
    const double across = std::hypot(axial, outward.dot(d.normalized()));
    crossing.angle_rad = std::atan2(std::abs(turning), std::copysign(across, axial));
    crossing.sense = turning >= 0.0 ? 1 : -1;
    return crossing;
}

RimCrossing crossing_in_air(const Rim& rim, const Vector3d& position_mm, const Vector3d& outward) {
    RimCrossing crossing = crossing_at(rim, position_mm, outward);
    const Vector3d d = position_mm - rim.centre_mm;
    const Vector3d radial = (d - rim.axis * rim.axis.dot(d)).normalized();
    const double turning = outward.dot(rim.axis.cross(radial));
    const double inward = -outward.dot(radial);
    crossing.angle_rad = std::atan2(std::hypot(turning, inward), outward.dot(rim.axis));
    crossing.ahead_rad = std::max(0.0, std::atan2(inward, std::abs(turning)));
    return crossing;
}

double landing_mm(const Rim& rim, const RimCrossing& crossing) {
    return rim.radius_mm * std::tan(crossing.ahead_rad) / std::tan(crossing.angle_rad);
}

double turn_run_mm(double radius_mm, double angle_rad, double slip) {
    return radius_mm / slip * (1.0 / std::sin(angle_rad) - 1.0);
}

double least_run_mm(double radius_mm, Friction friction) {
    return turn_run_mm(radius_mm, kMaxTurnAngle_rad, friction.share(margin::kFullTurn));
}

double turn_angle_rad(double angle_rad, double slip) {
    return -std::log(std::tan(0.5 * angle_rad)) / slip;
}

double half_turn_mm(const Rim& rim, const RimCrossing& crossing, const TurnRule& rule) {
    return to_hoop_mm(rim, crossing, hoop_height_mm(rim, crossing, crossing, rule));
}

double turn_mm(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
               const TurnRule& rule) {
    const double hoop_mm = hoop_height_mm(rim, from, to, rule);
    return to_hoop_mm(rim, from, hoop_mm) + rim.radius_mm * dwell_rad(rim, from, to, rule) +
           to_hoop_mm(rim, to, hoop_mm);
}

bool can_turn(const Rim& rim, const RimCrossing& crossing, const TurnRule& rule) {
    return crossing.angle_rad > 0.0 && crossing.angle_rad <= kMaxTurnAngle_rad &&
           landing_mm(rim, crossing) + turn_run_mm(rim.radius_mm, crossing.angle_rad,
                                                   rule.friction.share(margin::kFullTurn)) <=
               usable_run_mm(rule);
}

std::string why_no_turn(const std::string& rim_words, const Rim& rim, const RimCrossing& crossing,
                        const TurnRule& rule) {
    const std::string begin = "over " + rim_words + " the fibre runs at " +
                              degrees(crossing.angle_rad) + " to the axis, ";
    if (crossing.angle_rad <= 0.0 || crossing.angle_rad > kMaxTurnAngle_rad) {
        return begin + "and a turn begins between 0 and " + degrees(kMaxTurnAngle_rad);
    }
    const double needed_mm =
        landing_mm(rim, crossing) +
        turn_run_mm(rim.radius_mm, crossing.angle_rad, rule.friction.share(margin::kFullTurn)) +
        0.5 * rule.band_mm;
    const std::string by =
        begin + "and to turn it by a friction of " + fixed(rule.friction.holds(), 3);
    const std::string mend = ", or \"turn\" by \"pins\" or about a \"pole\" would do";
    if (!(needed_mm <= kLongestExtension_mm)) {
        return by + " no extension is long enough; a larger angle, more friction" + mend;
    }
    return by + " takes " + fixed(needed_mm, 1) + " mm of extension where there are " +
           fixed(rule.extension_mm, 1) + "; a larger angle, more friction, a longer extension" +
           mend;
}

double dwell_rad(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                 const TurnRule& rule) {
    const double hoop_mm = hoop_height_mm(rim, from, to, rule);
    const double steering = from.ahead_rad +
                            turn_angle_rad(from.angle_rad, slip_for(rim, from, hoop_mm)) +
                            turn_angle_rad(to.angle_rad, slip_for(rim, to, hoop_mm)) + to.ahead_rad;
    return positive_angle(from.sense * (to.azimuth_rad - from.azimuth_rad) - steering);
}

Turn half_turn(const Rim& rim, const RimCrossing& from, const TurnRule& rule, double step_mm) {
    Turn turn;
    turn.run_mm = hoop_height_mm(rim, from, from, rule);
    turn.slip = slip_for(rim, from, turn.run_mm);
    TurnPath path(rim, from.sense, step_mm);
    path.fly(from, turn.slip, false);
    path.steer(from, turn.slip, false);
    path.take(turn);
    return turn;
}

Turn make_turn(const Rim& rim, const RimCrossing& from, const RimCrossing& to, const TurnRule& rule,
               double step_mm) {
    Turn turn;
    turn.run_mm = hoop_height_mm(rim, from, to, rule);
    turn.dwell_rad = dwell_rad(rim, from, to, rule);
    const double slip_in = slip_for(rim, from, turn.run_mm);
    const double slip_out = slip_for(rim, to, turn.run_mm);
    turn.slip = std::max(slip_in, slip_out);
    TurnPath path(rim, from.sense, step_mm);
    path.fly(from, slip_in, false);
    path.steer(from, slip_in, false);
    const double hoop =
        from.azimuth_rad + from.sense * (from.ahead_rad + turn_angle_rad(from.angle_rad, slip_in));
    path.dwell(hoop, turn.run_mm, turn.dwell_rad);
    RimCrossing end = to;
    end.azimuth_rad = hoop + from.sense * (turn.dwell_rad + turn_angle_rad(to.angle_rad, slip_out) +
                                           to.ahead_rad);
    path.steer(end, slip_out, true);
    path.fly(end, slip_out, true);
    path.take(turn);
    return turn;
}

Turn run_out(const Rim& rim, const RimCrossing& from, double length_mm, double step_mm) {
    Turn turn;
    turn.run_mm = landing_mm(rim, from) + length_mm * std::cos(from.angle_rad);
    TurnPath path(rim, from.sense, step_mm);
    path.fly(from, 0.0, false);
    path.go_on(from, length_mm);
    path.take(turn);
    return turn;
}

}  // namespace meshwind
