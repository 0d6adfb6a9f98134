#include "winding/turn/pin_turn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/roots.h"
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
constexpr double kMinLead_mm = 1.5;

// Largest angle around the extension of the lead: further on the fibre stands up too steeply.
constexpr double kMaxLead_rad = 1.0;

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
    const Changeover ends{.holds = kMinLead_mm, .fails = kMaxLead_rad * shape.radius_mm};
    const auto has_less_over = [&](double lead_mm) {
        shape.lead_mm = lead_mm;
        const Room room = room_of(shape, strand_mm, height_mm);
        return room.over_mm < room.under_mm;
    };
    return halve(ends, kHalvings, has_less_over).fails;
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

// An extension with pins, and how a fibre comes to them. Places around it count from there.
struct PinnedExtension {
    const Rim& rim;
    const RimCrossing& from;
    const PinTurnShape& shape;
    Vector3d x = rim_reference(rim);
    Vector3d y = rim.axis.cross(x);

    struct Frame {
        Vector3d radial, around;
    };

    // Of the first pin, and of the last.
    [[nodiscard]] double first_mm() const { return to_pin_mm(shape, shape.angle_rad); }
    [[nodiscard]] double last_mm() const { return first_mm() + shape.skip * shape.pitch_mm; }

    [[nodiscard]] double azimuth_rad(double around_mm) const {
        return from.azimuth_rad + from.sense * around_mm / rim.radius_mm;
    }
    [[nodiscard]] Frame frame(double around_mm) const {
        const double azimuth = azimuth_rad(around_mm);
        const Vector3d radial = std::cos(azimuth) * x + std::sin(azimuth) * y;
        return {radial, from.sense * rim.axis.cross(radial)};
    }
};

// The stations that are laid so far.
struct PinFibre {
    SurfacePath path;
    std::vector<FreeStart> starts;  // per station
    double s_mm = 0.0;
};

// Over a length, without its beginning.
std::vector<double> even_steps(double length, double longest) {
    const int steps = std::max(1, static_cast<int>(std::ceil(length / longest)));
    std::vector<double> at;
    for (int i = 1; i <= steps; ++i) {
        at.push_back(length * i / steps);
    }
    return at;
}

// How far behind the last pin, descending.
std::vector<double> hoop_stations_mm(const PinTurnShape& shape) {
    const Swing swing(shape);
    const double run = shape.skip * shape.pitch_mm;
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

// A place on the developed extension with the fibre's direction there.
struct DevelopedPlace {
    double around_mm;
    double z_mm;
    double below_rad;  // the fibre's direction below the hoop
    double bend_per_mm = 0.0;
};

void add_station(const PinnedExtension& pins, const DevelopedPlace& place, PinFibre& fibre) {
    const Rim& rim = pins.rim;
    const PinnedExtension::Frame f = pins.frame(place.around_mm);
    const double below_rad = place.below_rad;
    PathPoint point;
    point.position_mm = rim.centre_mm + place.z_mm * rim.axis + rim.radius_mm * f.radial;
    point.normal = f.radial;
    point.tangent = std::cos(below_rad) * f.around - std::sin(below_rad) * rim.axis;
    point.kn_per_mm = std::cos(below_rad) * std::cos(below_rad) / rim.radius_mm;
    point.kg_per_mm = -pins.from.sense * place.bend_per_mm;
    point.s_mm = fibre.s_mm;
    fibre.path.push_back(point);
    fibre.starts.push_back({point.position_mm, point.tangent, false});
}

// About a pin.
DevelopedPlace about_pin(const PinTurnShape& shape, double pin_mm, double below_rad) {
    return {pin_mm + shape.held_mm * std::sin(below_rad),
            shape.offset_mm + shape.held_mm * std::cos(below_rad), below_rad, 1.0 / shape.held_mm};
}

// How the free fibre leaves a pin's flank: in a direction below the hoop, from a height over the
// wall at a direction before that and at a slope.
struct PinHold {
    double pin_mm;
    double below_rad;
    double from_rad;
    double from_height_mm;
    double slope;
};

FreeStart free_start_at(const PinnedExtension& pins, const PinHold& hold) {
    const Rim& rim = pins.rim;
    const PinTurnShape& shape = pins.shape;
    const PinnedExtension::Frame f = pins.frame(hold.pin_mm);
    const double below_rad = hold.below_rad;
    const double height =
        hold.from_height_mm + hold.slope * shape.held_mm * (below_rad - hold.from_rad);
    FreeStart start;
    start.from_mm = rim.centre_mm + (rim.radius_mm + height) * f.radial +
                    shape.held_mm * std::sin(below_rad) * f.around +
                    (shape.offset_mm + shape.held_mm * std::cos(below_rad)) * rim.axis;
    start.direction =
        (std::cos(below_rad) * f.around - std::sin(below_rad) * rim.axis + hold.slope * f.radial)
            .normalized();
    start.held = true;
    return start;
}

// On the way to the first pin, and about it.
void lay_to_first_pin(const PinnedExtension& pins, PinFibre& fibre) {
    const PinTurnShape& shape = pins.shape;
    const double in_rad = 0.5 * kPi - shape.angle_rad;  // what it bends by about the pin
    const double straight = straight_mm(shape, shape.angle_rad);
    for (const double s :
         even_steps(straight, std::min(kPatternStation_mm, kStationShare * pins.rim.radius_mm))) {
        if (fibre.path.empty()) {
            add_station(pins, {0.0, 0.0, -in_rad}, fibre);
        }
        fibre.s_mm = s;
        add_station(pins, {s * std::sin(shape.angle_rad), s * std::cos(shape.angle_rad), -in_rad},
                    fibre);
    }
    for (const double angle : even_steps(in_rad, kArcStation_rad)) {
        fibre.s_mm = straight + shape.held_mm * angle;
        add_station(pins, about_pin(shape, pins.first_mm(), angle - in_rad), fibre);
        fibre.starts.back().held = true;
    }
}

// A station on the hoop. The free fibre begins ever further ahead, and at last on the pin that has
// taken hold of it.
void lay_behind_pins(const PinnedExtension& pins, double behind, PinFibre& fibre) {
    const PinTurnShape& shape = pins.shape;
    const double radius_mm = pins.rim.radius_mm;
    const Swing swing(shape);
    add_station(pins, {pins.last_mm() - behind, shape.offset_mm + shape.held_mm, 0.0}, fibre);
    const double turned = behind / radius_mm;
    if (behind >= swing.first_mm) {
        const double run = shape.skip * shape.pitch_mm;
        const double share = (run - behind) / (run - swing.first_mm);
        const double most = radius_mm * std::tan(swing.first_mm / radius_mm);
        fibre.starts.back().from_mm += share * most * fibre.path.back().tangent;
        return;
    }
    fibre.starts.back() =
        free_start_at(pins, {pins.last_mm(), swing.direction_rad(behind), 0.0,
                             tangent_height_mm(radius_mm, behind), std::tan(turned)});
}

// About the last pin. The eye sinks, but never rises again: the rest of the bend is laid at once.
// Returns the slope at which it is lowest.
double lay_about_last_pin(const PinnedExtension& pins, PinFibre& fibre) {
    const PinTurnShape& shape = pins.shape;
    const double radius_mm = pins.rim.radius_mm;
    const double out_rad = swing_end_rad(shape);
    const double begun = fibre.s_mm;
    double slope = 0.0;
    FreeStart lowest = fibre.starts.back();
    for (const double angle : even_steps(out_rad, kArcStation_rad)) {
        fibre.s_mm = begun + shape.held_mm * angle;
        add_station(pins, about_pin(shape, pins.last_mm(), angle), fibre);
        const double turned = shape.held_mm * std::sin(angle) / radius_mm;
        const double sinks = -std::cos(angle) * std::tan(turned);
        if (sinks < slope) {
            slope = sinks;
            lowest = free_start_at(pins, {pins.last_mm(), out_rad, angle,
                                          radius_mm * (std::cos(turned) - 1.0), slope});
        }
        fibre.starts.back() = lowest;
    }
    return slope;
}

// From the last pin to the rim. The first of the straight is laid at once, too.
// \param slope of the fibre as it leaves the pin
void lay_away(const PinnedExtension& pins, double slope, PinFibre& fibre) {
    const PinTurnShape& shape = pins.shape;
    const double out_rad = swing_end_rad(shape);
    const FreeStart lowest = fibre.starts.back();
    const double bent = fibre.s_mm;
    const double around = pins.last_mm() + shape.held_mm * std::sin(out_rad);
    const double z = shape.offset_mm + shape.held_mm * std::cos(out_rad);
    for (const double s : even_steps(straight_mm(shape, shape.out_rad()), kHoopStation_mm)) {
        fibre.s_mm = bent + s;
        add_station(pins, {around + s * std::cos(out_rad), z - s * std::sin(out_rad), out_rad},
                    fibre);
        const double turned =
            (shape.held_mm * std::sin(out_rad) + s * std::cos(out_rad)) / pins.rim.radius_mm;
        if (-std::cos(out_rad) * std::tan(turned) > slope) {
            fibre.starts.back() = {lowest.from_mm + s * lowest.direction, lowest.direction, true};
        }
    }
}

// From the rim about the first pin, along the pins, about the last and back to the rim.
PinFibre fibre_on_pins(const PinnedExtension& pins) {
    const PinTurnShape& shape = pins.shape;
    PinFibre fibre;
    lay_to_first_pin(pins, fibre);
    const double begun = fibre.s_mm;
    for (const double behind : hoop_stations_mm(shape)) {
        fibre.s_mm = begun + shape.skip * shape.pitch_mm - behind;
        lay_behind_pins(pins, behind, fibre);
    }
    const double slope = lay_about_last_pin(pins, fibre);
    lay_away(pins, slope, fibre);
    return fibre;
}

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
    if (best.room_mm < kMinPinRoom_mm) {
        best.failure = "pins of " + fixed(shape.diameter_mm, 2) + " x " + fixed(best.height_mm, 2) +
                       " mm, " + fixed(shape.pitch_mm, 2) + " mm apart, leave the free fibre " +
                       fixed(best.room_mm, 2) + " mm to take one and pass the next where " +
                       fixed(kMinPinRoom_mm, 2) +
                       " mm are needed; thinner pins or fewer circuits leave more";
    }
    return best;
}

LaidTurn turn_on_pins(const Rim& rim, const RimCrossing& from, const PinTurnShape& shape,
                      double band_mm) {
    PinFibre laid = fibre_on_pins({rim, from, shape});
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
    const PinnedExtension pins{rim, from, shape};
    PinRing ring;
    ring.rim = rim.id;
    ring.count = static_cast<int>(std::lround(2.0 * kPi * rim.radius_mm / shape.pitch_mm));
    ring.diameter_mm = shape.diameter_mm;
    ring.strand_mm = shape.held_mm - 0.5 * shape.diameter_mm;
    ring.offset_mm = shape.offset_mm;
    ring.azimuth_rad = pins.azimuth_rad(pins.first_mm());
    ring.skip = shape.skip;
    return ring;
}

}  // namespace meshwind
