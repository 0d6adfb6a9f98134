#include "winding/revolution/aim_pass.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "core/roots.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/revolution/steered_pass.h"

namespace meshwind {
namespace {

// Parts that lean more towards the axis close the body, others lead along it.
constexpr double kSteep_rad = rad_from_deg(45.0);

// What runs to a rim is steered to be flatter: layers are 1 / cos(angle), 2.9 here. All the way
// where the friction allows it; else a corner is crossed at up to the second one, where they are 11
// on a narrow ring.
constexpr double kRim_rad = rad_from_deg(70.0);
constexpr double kCorner_rad = rad_from_deg(85.0);

// Halvings of a slip, and of the angle that would do.
constexpr int kHalvings = 50;

// Friction that no fibre has: what more would take is not told.
constexpr double kNoFriction = 1.0;

// Sines are the same but for rounding.
constexpr double kSameSine = 1e-9;

// From the widest place to one end.
class Half {
public:
    Half(const BodyOfRevolution& body, std::size_t end, const AimTask& task)
        : meridian_(body.meridian),
          upper_(end == 1),
          rim_(body.end[end].kind == MeridianEnd::Kind::Rim),
          widest_mm_(meridian_.widest_mm()),
          end_mm_(upper_ ? meridian_.length_mm() : 0.0),
          cap_mm_(cap_mm(body, end)),
          task_(task),
          touching_mm_(task.touching_mm[end]) {}

    [[nodiscard]] std::string name() const { return upper_ ? "upper" : "lower"; }

    // With a slip that leads towards the end where it is above 0.
    [[nodiscard]] SteeredEnd follow(double slip, double angle_rad) const {
        const double c_mm = meridian_.at(widest_mm_).radius_mm * std::sin(angle_rad);
        return steer_from(meridian_, widest_mm_, c_mm, upper_ ? slip : -slip, end_mm_);
    }

    // \param corner_rad how steep it may be on its way to a rim
    [[nodiscard]] bool reached(const SteeredEnd& at, double corner_rad) const {
        if (at.turned) {
            return cap_mm_ != end_mm_ && (upper_ ? at.arc_mm >= cap_mm_ : at.arc_mm <= cap_mm_);
        }
        const auto flatter = [this](double sine, double most_rad) {
            return sine <= std::sin(std::max(most_rad, task_.angle_rad)) ||
                   sine <= std::sin(task_.angle_rad) + kSameSine;
        };
        return cap_mm_ != end_mm_ ||
               (flatter(at.turning_mm / meridian_.at(end_mm_).radius_mm, kRim_rad) &&
                flatter(at.most_sine, corner_rad));
    }

    [[nodiscard]] bool reaches(double slip, double angle_rad,
                               double corner_rad = kCorner_rad) const {
        return reached(follow(slip, angle_rad), corner_rad);
    }

    // The least slip for which something holds that more slip does not undo.
    [[nodiscard]] static double least(double most, const std::function<bool(double)>& holds) {
        return halve({.holds = most, .fails = 0.0}, kHalvings, holds).holds;
    }

    [[nodiscard]] double slip() const {
        const auto flat = [this](double slip) { return reaches(slip, task_.angle_rad, kRim_rad); };
        if (flat(0.0)) {
            return 0.0;
        }
        if (cap_mm_ == end_mm_) {
            return flat(task_.most_slip) ? least(task_.most_slip, flat) : task_.most_slip;
        }
        // It turns ever nearer to the axis.
        const auto touches = [this](double slip) {
            const SteeredEnd at = follow(slip, task_.angle_rad);
            return !at.turned || at.turning_mm <= touching_mm_;
        };
        return touches(task_.most_slip) ? least(task_.most_slip, touches) : task_.most_slip;
    }

    // With all of the friction; up to the angle asked for.
    [[nodiscard]] std::optional<double> steepest_rad() const {
        if (reaches(task_.most_slip, task_.angle_rad)) {
            return task_.angle_rad;
        }
        if (!reaches(task_.most_slip, 0.0)) {
            return std::nullopt;
        }
        return halve({.holds = 0.0, .fails = task_.angle_rad}, kHalvings,
                     [this](double angle_rad) { return reaches(task_.most_slip, angle_rad); })
            .holds;
    }

    [[nodiscard]] std::string failure() const {
        const SteeredEnd at = follow(task_.most_slip, task_.angle_rad);
        if (reached(at, kCorner_rad)) {
            return {};
        }
        const std::string how = "a fibre at " + degrees(task_.angle_rad, 1) +
                                ", steered with all of the friction of " +
                                fixed(task_.most_slip, 3) + ", ";
        const MeridianPlace place = meridian_.at(at.arc_mm);
        const std::string where =
            at.turned
                ? "turns at radius " + fixed(place.radius_mm, 1) + " mm, z " +
                      fixed(place.z_mm, 1) + " mm, before the " + name() + (rim_ ? " rim" : " end")
                : "runs to the " + name() + " rim at up to " +
                      degrees(std::asin(std::min(1.0, at.most_sine))) + " and comes there at " +
                      degrees(std::asin(std::min(1.0, at.turning_mm / place.radius_mm))) +
                      ", more than " + degrees(std::max(kCorner_rad, task_.angle_rad), 1) +
                      " and " + degrees(std::max(kRim_rad, task_.angle_rad), 1);
        return how + where + "; " + what_would();
    }

private:
    [[nodiscard]] std::string what_would() const {
        std::string words;
        if (reaches(kNoFriction, task_.angle_rad)) {
            const double friction =
                least(kNoFriction, [this](double slip) { return reaches(slip, task_.angle_rad); });
            words = "a friction of " + fixed(friction, 3) + " would do";
        }
        if (const std::optional<double> angle = steepest_rad()) {
            words += (words.empty() ? "an angle of " : ", or an angle of ") + degrees(*angle, 1) +
                     (words.empty() ? " would do" : "");
        }
        return words.empty() ? "no angle and no friction would do" : words;
    }

    const Meridian& meridian_;
    bool upper_;
    bool rim_;
    double widest_mm_;
    double end_mm_;
    double cap_mm_;
    const AimTask& task_;
    double touching_mm_;
};

}  // namespace

double cap_mm(const BodyOfRevolution& body, std::size_t end) {
    const bool upper = end == 1;
    const double end_mm = upper ? body.meridian.length_mm() : 0.0;
    const auto narrowing = [upper](double slope_rad) { return upper ? -slope_rad : slope_rad; };
    const auto steep = [&](const MeridianPart& part) {
        return part.kind == MeridianPartKind::Cone && narrowing(part.slope_rad) >= kSteep_rad;
    };
    const MeridianPlace last = body.meridian.at(end_mm);
    const MeridianPart& outmost = upper ? body.parts.back() : body.parts.front();
    const bool closed = body.end[end].kind == MeridianEnd::Kind::Pole;
    // An isotensoid is hollow just before it turns back; fibre that turns on it stays clear of
    // there.
    const MeridianPlace middle = body.meridian.at(0.5 * (outmost.from_mm + outmost.to_mm));
    const bool convex = std::max(last.curvature_per_mm, middle.curvature_per_mm) > 0.0;
    const bool dome =
        outmost.kind == MeridianPartKind::Dome && convex && narrowing(last.slope_rad) > 0.0;
    if (!closed && !dome && !steep(outmost)) {
        return end_mm;
    }
    double from_mm = upper ? outmost.from_mm : outmost.to_mm;
    const auto add = [&](const MeridianPart& part) {
        if (part.kind != MeridianPartKind::Dome && !steep(part)) {
            return false;
        }
        from_mm = upper ? part.from_mm : part.to_mm;
        return true;
    };
    if (upper) {
        for (auto part = body.parts.rbegin() + 1; part != body.parts.rend() && add(*part); ++part) {
        }
    } else {
        for (auto part = body.parts.begin() + 1; part != body.parts.end() && add(*part); ++part) {
        }
    }
    return from_mm;
}

PassAim aim_at_ends(const BodyOfRevolution& body, const AimTask& task) {
    PassAim aim;
    const Half below(body, 0, task);
    const Half above(body, 1, task);
    for (const Half* half : {&below, &above}) {
        aim.failure = half->failure();
        if (!aim.failure.empty()) {
            return aim;
        }
    }
    aim.slip = {-below.slip(), above.slip()};
    return aim;
}

}  // namespace meshwind
