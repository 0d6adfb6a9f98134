#include "winding/turn/pin_turn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// While the fibre is swung past the next pin the landing point goes on by this; what it comes
// nearer to the wall meanwhile is counted.
constexpr double kPassing_mm = 0.5;

// And by this share of the lead while it is swung on to its direction.
constexpr double kSwingShare = 0.3;

// The landing point is at least so far behind the last pin when the eye swings.
constexpr double kLeastLead_mm = 1.5;

// Largest angle around the extension of the lead: further on the fibre stands up too steeply.
constexpr double kMostLead_rad = 1.0;

// Heights that are tried where none is given.
constexpr double kLowest_mm = 1.5;
constexpr double kHighest_mm = 20.0;
constexpr double kHeightStep_mm = 0.25;

constexpr int kHalvings = 50;
constexpr int kSwingSamples = 24;

// Stations: on straight stretches, on the hoop, on the stretch over which the eye comes down, and
// of the turning fibre.
constexpr double kHoopStation_mm = 2.0;
constexpr double kLoweredStation_mm = 0.5;
constexpr double kArcStation_rad = 2.5 * kPi / 180.0;

// What the fibre bends by about the last pin.
double swing_end_rad(const PinTurnShape& shape) {
    return 0.5 * kPi - shape.out_rad();
}

// Fibre from the rim to where it touches a pin.
double straight_mm(const PinTurnShape& shape, double angle_rad) {
    return (shape.offset_mm + shape.held_mm * std::sin(angle_rad)) / std::cos(angle_rad);
}

// The fibre's direction below the hoop from which on it is past the pin after the last.
double passed_rad(const PinTurnShape& shape) {
    return std::asin(std::min(1.0, 2.0 * shape.held_mm / shape.pitch_mm));
}

// Of the swing: where the landing point is, behind the last pin, and the fibre's direction.
struct Swing {
    double first_mm;   // it begins
    double passed_mm;  // it is past the next pin
    double last_mm;    // it is done
    double passed_rad;
    double end_rad;

    explicit Swing(const PinTurnShape& shape)
        : first_mm(shape.lead_mm),
          passed_mm(first_mm - kPassing_mm),
          last_mm(passed_mm - kSwingShare * first_mm),
          passed_rad(meshwind::passed_rad(shape)),
          end_rad(swing_end_rad(shape)) {}

    [[nodiscard]] double direction_rad(double behind_mm) const {
        if (behind_mm >= first_mm) {
            return 0.0;
        }
        if (behind_mm >= passed_mm) {
            return passed_rad * (first_mm - behind_mm) / (first_mm - passed_mm);
        }
        const double share = std::min(1.0, (passed_mm - behind_mm) / (passed_mm - last_mm));
        return passed_rad + share * (end_rad - passed_rad);
    }
};

// Height over the wall of the hoop's tangent, at an arc length ahead.
double tangent_height_mm(double radius_mm, double ahead_mm) {
    return radius_mm * (1.0 / std::cos(ahead_mm / radius_mm) - 1.0);
}

struct Room {
    double under_mm;  // to the top of the pin that takes hold
    double over_mm;   // over the next one
};

Room room_of(const PinTurnShape& shape, double strand_mm, double height_mm) {
    const Swing swing(shape);
    Room room{height_mm, 0.0};
    for (int i = 0; i <= 2 * kSwingSamples; ++i) {
        // Half of the samples in either part.
        const double share = static_cast<double>(i % kSwingSamples) / kSwingSamples;
        const double behind =
            i < kSwingSamples       ? swing.first_mm + share * (swing.passed_mm - swing.first_mm)
            : i < 2 * kSwingSamples ? swing.passed_mm + share * (swing.last_mm - swing.passed_mm)
                                    : swing.last_mm;
        const double top =
            tangent_height_mm(shape.radius_mm, behind) +
            std::tan(behind / shape.radius_mm) * shape.held_mm * swing.direction_rad(behind);
        room.under_mm = std::min(room.under_mm, height_mm - strand_mm - top);
    }
    const double next = swing.passed_mm + shape.pitch_mm - 0.5 * shape.diameter_mm;
    room.over_mm = tangent_height_mm(shape.radius_mm, next) - height_mm - strand_mm;
    return room;
}

// Between the pins: the free fibre that comes down beside the pin which it will bend about runs
// straight, and so comes nearer to the one before it the higher it is.
double entry_room_mm(const PinTurnShape& shape, double height_mm) {
    const double along = std::sqrt(height_mm * height_mm + 2.0 * shape.radius_mm * height_mm);
    const double nearer = along - shape.radius_mm * std::atan(along / shape.radius_mm);
    return (shape.pitch_mm - nearer) * std::cos(shape.angle_rad) - 2.0 * shape.held_mm;
}

// The lead at which both rooms are alike, or the least.
double even_lead_mm(PinTurnShape shape, double strand_mm, double height_mm) {
    double low = kLeastLead_mm;
    double high = kMostLead_rad * shape.radius_mm;
    for (int i = 0; i < kHalvings; ++i) {
        shape.lead_mm = 0.5 * (low + high);
        const Room room = room_of(shape, strand_mm, height_mm);
        (room.over_mm < room.under_mm ? low : high) = shape.lead_mm;
    }
    return high;
}

PinFit fit_at(PinTurnShape shape, double strand_mm, double height_mm) {
    PinFit fit;
    fit.height_mm = height_mm;
    fit.lead_mm = even_lead_mm(shape, strand_mm, height_mm);
    shape.lead_mm = fit.lead_mm;
    const Room room = room_of(shape, strand_mm, height_mm);
    fit.room_mm = std::min({room.under_mm, room.over_mm, entry_room_mm(shape, height_mm)});
    fit.least_skip = static_cast<int>(std::ceil(2.0 * fit.lead_mm / shape.pitch_mm));
    return fit;
}

// Lays the stations.
class PinPath {
public:
    PinPath(const Rim& rim, const RimCrossing& from, const PinTurnShape& shape)
        : rim_(rim),
          from_(from),
          shape_(shape),
          x_(rim_reference(rim)),
          y_(rim.axis.cross(x_)),
          in_rad_(0.5 * kPi - shape.angle_rad),
          out_rad_(swing_end_rad(shape)) {}

    // Of the first pin.
    [[nodiscard]] double azimuth_rad() const { return azimuth_rad(first_mm()); }

    void lay() {
        const double straight = straight_mm(shape_, shape_.angle_rad);
        const double last = first_mm() + shape_.skip * shape_.pitch_mm;
        for (const double s :
             even_steps(straight, std::min(kPatternStation_mm, kStationShare * rim_.radius_mm))) {
            run_in(s);
        }
        for (const double angle : even_steps(in_rad_, kArcStation_rad)) {
            s_mm_ = straight + shape_.held_mm * angle;
            bend(first_mm(), angle - in_rad_);
            starts.back().held = true;
        }
        const double begun = s_mm_;
        for (const double behind : hoop_stations()) {
            s_mm_ = begun + shape_.skip * shape_.pitch_mm - behind;
            behind_pins(last, behind);
        }
        leave(last);
    }

    SurfacePath path;
    std::vector<FreeStart> starts;

private:
    struct Frame {
        Vector3d radial, around;
    };

    // From the fibre's start, developed: around.
    [[nodiscard]] double first_mm() const { return to_pin_mm(shape_, shape_.angle_rad); }
    [[nodiscard]] double azimuth_rad(double around_mm) const {
        return from_.azimuth_rad + from_.sense * around_mm / rim_.radius_mm;
    }

    // Over a length, without its beginning.
    static std::vector<double> even_steps(double length, double longest) {
        const int steps = std::max(1, static_cast<int>(std::ceil(length / longest)));
        std::vector<double> at;
        for (int i = 1; i <= steps; ++i) {
            at.push_back(length * i / steps);
        }
        return at;
    }

    // How far behind the last pin, descending.
    [[nodiscard]] std::vector<double> hoop_stations() const {
        const Swing swing(shape_);
        const double run = shape_.skip * shape_.pitch_mm;
        std::vector<double> at;
        const auto down = [&](double from, double to, double step) {
            for (const double s : even_steps(from - to, step)) {
                at.push_back(from - s);
            }
        };
        const auto swinging = [](double from, double to, double angle) {
            return (from - to) * std::min(1.0, kArcStation_rad / angle);
        };
        down(run, swing.first_mm, kHoopStation_mm);
        down(swing.first_mm, swing.passed_mm,
             swinging(swing.first_mm, swing.passed_mm, swing.passed_rad));
        down(swing.passed_mm, swing.last_mm,
             swinging(swing.passed_mm, swing.last_mm, swing.end_rad - swing.passed_rad));
        down(swing.last_mm, 0.0, kLoweredStation_mm);
        return at;
    }

    [[nodiscard]] Frame frame(double around_mm) const {
        const double azimuth = azimuth_rad(around_mm);
        const Vector3d radial = std::cos(azimuth) * x_ + std::sin(azimuth) * y_;
        return {radial, from_.sense * rim_.axis.cross(radial)};
    }

    // A station with the fibre's direction below the hoop.
    void add(double around_mm, double z_mm, double below_rad, double bend_per_mm) {
        const Frame f = frame(around_mm);
        PathPoint point;
        point.position_mm = rim_.centre_mm + z_mm * rim_.axis + rim_.radius_mm * f.radial;
        point.normal = f.radial;
        point.tangent = std::cos(below_rad) * f.around - std::sin(below_rad) * rim_.axis;
        point.kn_per_mm = std::cos(below_rad) * std::cos(below_rad) / rim_.radius_mm;
        point.kg_per_mm = -from_.sense * bend_per_mm;
        point.s_mm = s_mm_;
        path.push_back(point);
        starts.push_back({point.position_mm, point.tangent, false});
    }

    // On the way to the first pin.
    void run_in(double s) {
        if (path.empty()) {
            add(0.0, 0.0, -in_rad_, 0.0);
        }
        s_mm_ = s;
        add(s * std::sin(shape_.angle_rad), s * std::cos(shape_.angle_rad), -in_rad_, 0.0);
    }

    // About a pin.
    void bend(double pin_mm, double below_rad) {
        add(pin_mm + shape_.held_mm * std::sin(below_rad),
            shape_.offset_mm + shape_.held_mm * std::cos(below_rad), below_rad,
            1.0 / shape_.held_mm);
    }

    // Along the hoop. The free fibre begins ever further ahead, and at last on the pin that has
    // taken hold of it.
    void behind_pins(double last_mm, double behind) {
        const Swing swing(shape_);
        add(last_mm - behind, shape_.offset_mm + shape_.held_mm, 0.0, 0.0);
        const double turned = behind / rim_.radius_mm;
        if (behind >= swing.first_mm) {
            const double run = shape_.skip * shape_.pitch_mm;
            const double share = (run - behind) / (run - swing.first_mm);
            const double most = rim_.radius_mm * std::tan(swing.first_mm / rim_.radius_mm);
            starts.back().from_mm += share * most * path.back().tangent;
            return;
        }
        hold(last_mm, swing.direction_rad(behind), 0.0, tangent_height_mm(rim_.radius_mm, behind),
             std::tan(turned));
    }

    // The free fibre leaves a pin's flank in a direction below the hoop, from a height over the
    // wall at a direction before that and at a slope.
    void hold(double pin_mm, double below_rad, double from_rad, double from_height, double slope) {
        const Frame f = frame(pin_mm);
        const double height = from_height + slope * shape_.held_mm * (below_rad - from_rad);
        FreeStart& start = starts.back();
        start.from_mm = rim_.centre_mm + (rim_.radius_mm + height) * f.radial +
                        shape_.held_mm * std::sin(below_rad) * f.around +
                        (shape_.offset_mm + shape_.held_mm * std::cos(below_rad)) * rim_.axis;
        start.direction =
            (std::cos(below_rad) * f.around - std::sin(below_rad) * rim_.axis + slope * f.radial)
                .normalized();
        start.held = true;
    }

    // About the last pin and away. To lay the fibre down the eye sinks, but never rises again: the
    // rest of the bend, and the first of the straight, are laid at once.
    void leave(double last_mm) {
        const double begun = s_mm_;
        double slope = 0.0;
        FreeStart lowest = starts.back();
        for (const double angle : even_steps(out_rad_, kArcStation_rad)) {
            s_mm_ = begun + shape_.held_mm * angle;
            bend(last_mm, angle);
            const double turned = shape_.held_mm * std::sin(angle) / rim_.radius_mm;
            const double sinks = -std::cos(angle) * std::tan(turned);
            if (sinks < slope) {
                slope = sinks;
                hold(last_mm, out_rad_, angle, rim_.radius_mm * (std::cos(turned) - 1.0), slope);
                lowest = starts.back();
            }
            starts.back() = lowest;
        }
        const double bent = s_mm_;
        const double around = last_mm + shape_.held_mm * std::sin(out_rad_);
        const double z = shape_.offset_mm + shape_.held_mm * std::cos(out_rad_);
        for (const double s : even_steps(straight_mm(shape_, shape_.out_rad()), kHoopStation_mm)) {
            s_mm_ = bent + s;
            add(around + s * std::cos(out_rad_), z - s * std::sin(out_rad_), out_rad_, 0.0);
            const double turned =
                (shape_.held_mm * std::sin(out_rad_) + s * std::cos(out_rad_)) / rim_.radius_mm;
            if (-std::cos(out_rad_) * std::tan(turned) > slope) {
                starts.back() = {lowest.from_mm + s * lowest.direction, lowest.direction, true};
            }
        }
    }

    const Rim& rim_;
    RimCrossing from_;
    PinTurnShape shape_;
    Vector3d x_;
    Vector3d y_;
    double in_rad_;  // what the fibre bends by about the first pin
    double out_rad_;
    double s_mm_ = 0.0;
};

}  // namespace

double to_pin_mm(const PinTurnShape& shape, double angle_rad) {
    return shape.offset_mm * std::tan(angle_rad) + shape.held_mm / std::cos(angle_rad);
}

double pin_turn_around_mm(const PinTurnShape& shape) {
    return shape.skip * shape.pitch_mm + to_pin_mm(shape, shape.angle_rad) +
           to_pin_mm(shape, shape.out_rad());
}

double pin_turn_length_mm(const PinTurnShape& shape) {
    const auto to_hoop = [&](double angle_rad) {
        return straight_mm(shape, angle_rad) + (0.5 * kPi - angle_rad) * shape.held_mm;
    };
    return shape.skip * shape.pitch_mm + to_hoop(shape.angle_rad) + to_hoop(shape.out_rad());
}

PinFit fit_pins(const PinTurnShape& shape, double strand_mm, std::optional<double> height_mm) {
    PinFit best;
    if (2.0 * shape.held_mm >= shape.pitch_mm * std::cos(shape.angle_rad)) {
        best.failure = "pins of " + fixed(shape.diameter_mm, 2) + " mm, " +
                       fixed(shape.pitch_mm, 2) + " mm apart, leave no gap for a strand of " +
                       fixed(2.0 * strand_mm, 2) +
                       " mm; thinner pins, fewer circuits or a larger body would";
        return best;
    }
    best.room_mm = -std::numeric_limits<double>::infinity();
    for (double height = height_mm.value_or(kLowest_mm); height <= height_mm.value_or(kHighest_mm);
         height += kHeightStep_mm) {
        const PinFit fit = fit_at(shape, strand_mm, height);
        if (fit.room_mm > best.room_mm) {
            best = fit;
        }
    }
    if (best.room_mm < kLeastPinRoom_mm) {
        best.failure = "pins of " + fixed(shape.diameter_mm, 2) + " x " + fixed(best.height_mm, 2) +
                       " mm, " + fixed(shape.pitch_mm, 2) + " mm apart, leave the free fibre " +
                       fixed(best.room_mm, 2) + " mm to take one and pass the next where " +
                       fixed(kLeastPinRoom_mm, 2) +
                       " mm are needed; thinner pins or fewer circuits leave more";
    }
    return best;
}

LaidTurn turn_on_pins(const Rim& rim, const RimCrossing& from, const PinTurnShape& shape,
                      double band_mm) {
    PinPath laid(rim, from, shape);
    laid.lay();
    LaidTurn turn;
    turn.rim = rim.id;
    turn.asks = {1, shape.offset_mm + shape.held_mm + 0.5 * band_mm,
                 shape.skip * shape.pitch_mm / rim.radius_mm};
    Piece& piece = turn.piece;
    piece.kind = PieceKind::Transition;
    piece.string.gap_mm.assign(laid.path.size(), 0.0);
    piece.string.slope.assign(laid.path.size(), 0.0);
    piece.slip.assign(laid.path.size(), 0.0);
    piece.path = std::move(laid.path);
    piece.free_start = std::move(laid.starts);
    piece.start_rim = rim.id;
    piece.end_rim = rim.id;
    return turn;
}

PinRing ring_for(const Rim& rim, const RimCrossing& from, const PinTurnShape& shape) {
    PinRing ring;
    ring.rim = rim.id;
    ring.count = static_cast<int>(std::lround(2.0 * kPi * rim.radius_mm / shape.pitch_mm));
    ring.diameter_mm = shape.diameter_mm;
    ring.strand_mm = shape.held_mm - 0.5 * shape.diameter_mm;
    ring.offset_mm = shape.offset_mm;
    ring.azimuth_rad = PinPath(rim, from, shape).azimuth_rad();
    ring.skip = shape.skip;
    return ring;
}

}  // namespace meshwind
