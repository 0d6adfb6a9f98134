#include "winding/turn/course_turns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/turn/laid_turn.h"

namespace meshwind {
namespace {

// Pins stand as far apart as so many bands, unless the job says how many there are, or farther by
// this factor each time until fibre at enough of an angle passes between them. Farther apart they
// ask courses to move more.
constexpr double kPitchBands = 1.25;
constexpr double kFartherApart = 1.25;
constexpr double kEnough_rad = 55.0 * kPi / 180.0;
constexpr int kFewestPins = 3;

// The widest angle to the axis at which fibre passes between pins is looked for in these steps.
constexpr double kAngleStep_rad = kPi / 180.0;
constexpr double kWidest_rad = 80.0 * kAngleStep_rad;
constexpr double kMinWidest_rad = 30.0 * kAngleStep_rad;  // under it hardly a course ends

// Courses end at pins but for some thousandths of a mm. So that pins take hold of all of them, they
// end by this farther on, around the rim, than where the fibre would only touch a pin.
constexpr double kPressed_mm = 0.012;

const PinStand* stand_at(const Rim& rim, const CourseTurns& turns) {
    return turns.pins.empty() ? nullptr : &turns.pins[static_cast<std::size_t>(rim.id)];
}

// Around the rim, the way that the fibre circles, from the ring's first pin to the one that the
// fibre would bend about if there were one.
double from_first_pin_mm(const Rim& rim, const RimCrossing& crossing, const PinStand& stand) {
    return crossing.sense * rim.radius_mm * (crossing.azimuth_rad - stand.ring.azimuth_rad) +
           to_pin_mm(stand.shape, crossing.angle_rad);
}

// The turn from one course to another on the nearest pins.
PinTurnShape shape_between(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                           const PinStand& stand) {
    PinTurnShape shape = stand.shape;
    shape.angle_rad = from.angle_rad;
    shape.back_rad = to.angle_rad;
    // The fibre that comes back circles the other way, seen along its own course from the rim.
    const double hoop_mm = -from_first_pin_mm(rim, to, stand) - from_first_pin_mm(rim, from, stand);
    const int count = stand.ring.count;
    int skip = static_cast<int>(std::lround(hoop_mm / shape.pitch_mm)) % count;
    skip += skip < 0 ? count : 0;
    skip += skip < stand.ring.skip ? count : 0;
    const double around_mm = 2.0 * kPi * rim.radius_mm;
    const double turns = std::round((skip * shape.pitch_mm - hoop_mm) / around_mm);
    shape.skip = skip;
    shape.pitch_mm = (hoop_mm + turns * around_mm) / skip;  // both ends meet their courses
    return shape;
}

// A turn of least length that leaves and comes back at the same angle.
PinTurnShape shortest(const RimCrossing& crossing, const PinStand& stand) {
    PinTurnShape shape = stand.shape;
    shape.angle_rad = crossing.angle_rad;
    shape.skip = stand.ring.skip;
    return shape;
}

Piece part_of(const Piece& piece, std::size_t first, std::size_t last) {
    const auto cut = [&](const auto& all) {
        return std::decay_t<decltype(all)>(all.begin() + static_cast<std::ptrdiff_t>(first),
                                           all.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    };
    Piece part;
    part.kind = piece.kind;
    part.path = cut(piece.path);
    part.string.gap_mm = cut(piece.string.gap_mm);
    part.string.slope = cut(piece.string.slope);
    part.slip = cut(piece.slip);
    part.free_start = cut(piece.free_start);
    part.start_rim = piece.start_rim;
    part.end_rim = piece.end_rim;
    const double begin_mm = part.path.front().s_mm;
    for (PathPoint& point : part.path) {
        point.s_mm -= begin_mm;
    }
    return part;
}

// Cut in the middle of the hoop.
std::array<Piece, 2> halves(const Rim& rim, const RimCrossing& from, const PinStand& stand,
                            double band_mm) {
    const PinTurnShape shape = shortest(from, stand);
    const Piece turn = turn_on_pins(rim, from, shape, band_mm).piece;
    const double middle_mm = 0.5 * pin_turn_length_mm(shape);
    std::size_t middle = 1;
    while (middle + 2 < turn.path.size() && turn.path[middle].s_mm < middle_mm) {
        ++middle;
    }
    return {part_of(turn, 0, middle), part_of(turn, middle, turn.path.size() - 1)};
}

// The widest fibre that passes between so many pins, and what pins that let it pass are like.
PinStand stand_of(int count, const Rim& rim, const PinConstraints& wish, const Tow& tow,
                  std::string& failure) {
    PinStand stand;
    PinTurnShape& shape = stand.shape;
    const double strand_mm = strand_radius_mm(tow.width_mm, tow.thickness_mm);
    shape.radius_mm = rim.radius_mm;
    shape.diameter_mm = wish.diameter_mm;
    shape.held_mm = 0.5 * wish.diameter_mm + strand_mm;
    shape.offset_mm = wish.offset_mm > 0.0 ? wish.offset_mm : tow.width_mm + wish.diameter_mm;
    shape.pitch_mm = 2.0 * kPi * rim.radius_mm / count;
    PinFit fit;
    for (double angle = kWidest_rad; angle >= kMinWidest_rad; angle -= kAngleStep_rad) {
        shape.angle_rad = angle;
        shape.back_rad = 0.0;  // the fibre that bends most when it leaves
        fit = fit_pins(shape, strand_mm, wish.height_mm);
        if (fit.failure.empty()) {
            stand.widest_rad = angle;
            break;
        }
    }
    failure = fit.failure;
    shape.back_rad.reset();
    shape.lead_mm = fit.lead_mm;
    stand.ring.count = count;
    stand.ring.rim = rim.id;
    stand.ring.diameter_mm = wish.diameter_mm;
    stand.ring.height_mm = fit.height_mm;
    stand.ring.strand_mm = strand_mm;
    stand.ring.offset_mm = shape.offset_mm;
    stand.ring.skip = std::max({1, wish.skip, fit.least_skip});
    return stand;
}

// As many pins as are wanted; else the most between which enough passes, or those that let pass
// most.
PinStand choose_stand(const Rim& rim, const PinConstraints& wish, const Tow& tow,
                      std::string& failure) {
    if (wish.count > 0) {
        return stand_of(wish.count, rim, wish, tow, failure);
    }
    const auto pins_at = [&](double bands) {
        const double pitch_mm = bands * tow.width_mm;
        return std::max(kFewestPins, static_cast<int>(2.0 * kPi * rim.radius_mm / pitch_mm));
    };
    double bands = kPitchBands;
    PinStand best = stand_of(pins_at(bands), rim, wish, tow, failure);
    for (int count = best.ring.count; best.widest_rad < kEnough_rad && count > kFewestPins;) {
        bands *= kFartherApart;
        count = pins_at(bands);
        std::string why;
        const PinStand stand = stand_of(count, rim, wish, tow, why);
        if (stand.widest_rad > best.widest_rad) {
            best = stand;
            failure = std::move(why);
        }
    }
    return best;
}

}  // namespace

std::vector<PinStand> stand_pins(std::span<const Rim> rims, const PinConstraints& wish,
                                 const Tow& tow, double extension_mm, std::string& failure) {
    std::vector<PinStand> stands;
    for (const Rim& rim : rims) {
        stands.push_back(choose_stand(rim, wish, tow, failure));
        const double needed_mm = pin_extension_mm(stands.back().ring, tow.width_mm);
        if (failure.empty() && needed_mm > extension_mm) {
            failure = "the turn on pins takes " + fixed(needed_mm, 1) +
                      " mm of extension where there are " + fixed(extension_mm, 1);
        }
        if (!failure.empty()) {
            failure.insert(0, "rim " + std::to_string(rim.id) + ": ");
            return {};
        }
    }
    return stands;
}

bool can_turn(const Rim& rim, const RimCrossing& crossing, const CourseTurns& turns) {
    const PinStand* stand = stand_at(rim, turns);
    return stand != nullptr ? crossing.angle_rad <= stand->widest_rad
                            : can_turn(rim, crossing, turns.rule);
}

double half_turn_mm(const Rim& rim, const RimCrossing& crossing, const CourseTurns& turns) {
    const PinStand* stand = stand_at(rim, turns);
    return stand != nullptr ? 0.5 * pin_turn_length_mm(shortest(crossing, *stand))
                            : half_turn_mm(rim, crossing, turns.rule);
}

double turn_mm(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
               const CourseTurns& turns) {
    const PinStand* stand = stand_at(rim, turns);
    return stand != nullptr ? pin_turn_length_mm(shape_between(rim, from, to, *stand))
                            : turn_mm(rim, from, to, turns.rule);
}

double off_pins_mm(const Rim& rim, const RimCrossing& crossing, const CourseTurns& turns) {
    const PinStand* stand = stand_at(rim, turns);
    return stand != nullptr
               ? -std::remainder(from_first_pin_mm(rim, crossing, *stand) - kPressed_mm,
                                 stand->shape.pitch_mm)
               : 0.0;
}

double off_pins_mm_per_rad(const Rim& rim, const RimCrossing& crossing, const CourseTurns& turns) {
    const PinStand* stand = stand_at(rim, turns);
    if (stand == nullptr) {
        return 0.0;
    }
    const double cosine = std::cos(crossing.angle_rad);
    return -(stand->shape.offset_mm + stand->shape.held_mm * std::sin(crossing.angle_rad)) /
           (cosine * cosine);
}

LaidTurn turn_between(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                      const CourseTurns& turns, double station_mm) {
    if (const PinStand* stand = stand_at(rim, turns)) {
        return turn_on_pins(rim, from, shape_between(rim, from, to, *stand), turns.rule.band_mm);
    }
    Turn turn = make_turn(rim, from, to, turns.rule, station_mm);
    const TurnsAtRim asks{1, turn.run_mm + 0.5 * turns.rule.band_mm, turn.dwell_rad};
    return {piece_of_turn(std::move(turn), rim.id), asks, rim.id};
}

Piece half_turn_from(const Rim& rim, const RimCrossing& end, const CourseTurns& turns,
                     double station_mm) {
    if (const PinStand* stand = stand_at(rim, turns)) {
        return halves(rim, end, *stand, turns.rule.band_mm)[0];
    }
    return piece_of_turn(half_turn(rim, end, turns.rule, station_mm), rim.id);
}

Piece half_turn_to(const Rim& rim, const RimCrossing& start, const CourseTurns& turns,
                   double station_mm) {
    if (const PinStand* stand = stand_at(rim, turns)) {
        // Where a turn to there begins that leaves as it comes back.
        RimCrossing from = start;
        from.sense = -start.sense;
        from.azimuth_rad +=
            start.sense * pin_turn_around_mm(shortest(start, *stand)) / rim.radius_mm;
        return halves(rim, from, *stand, turns.rule.band_mm)[1];
    }
    Turn before = half_turn(rim, start, turns.rule, station_mm);
    before.path = reversed(before.path);
    return piece_of_turn(std::move(before), rim.id);
}

std::vector<PinRing> rings_of(std::span<const PinStand> stands) {
    std::vector<PinRing> rings;
    for (const PinStand& stand : stands) {
        rings.push_back(stand.ring);
    }
    return rings;
}

}  // namespace meshwind
