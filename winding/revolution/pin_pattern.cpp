#include "winding/revolution/pin_pattern.h"

#include <algorithm>
#include <cmath>

#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

// The pins that a turn runs behind follow from the circuits, and the circuits hardly from the turn:
// after so many rounds they agree or never will.
constexpr int kRounds = 6;

// Of a pin's pitch: rounding.
constexpr double kRounding = 1e-7;

}  // namespace

PinnedEnds::PinnedEnds(const PinConstraints& wish, const Tow& tow, double extension_mm)
    : wish_(wish),
      tow_width_mm_(tow.width_mm),
      strand_mm_(strand_radius_mm(tow.width_mm, tow.thickness_mm)),
      extension_mm_(extension_mm) {}

std::string PinnedEnds::add(const RimEnd& end) {
    PinTurnShape shape;
    shape.radius_mm = end.rim.radius_mm;
    shape.angle_rad = end.crossing.angle_rad;
    shape.diameter_mm = wish_.diameter_mm;
    shape.held_mm = 0.5 * wish_.diameter_mm + strand_mm_;
    shape.offset_mm = wish_.offset_mm > 0.0 ? wish_.offset_mm : tow_width_mm_ + wish_.diameter_mm;
    end_[end.end].emplace(End{end.rim, shape, {}, shape});
    return {};
}

std::string PinnedEnds::why_no_ends(double angle_rad) const {
    return "pins stand on the extension of a rim that the fibre runs over, and at " +
           degrees(angle_rad) +
           " it turns by itself at both ends; use \"friction\", or give the body a straight end";
}

double PinnedEnds::shortest_rad(std::size_t end) const {
    const PinTurnShape& shape = end_[end]->shortest;
    return pin_turn_around_mm(shape) / shape.radius_mm;
}

std::string PinnedEnds::fit(std::int64_t circuits) {
    count_ = wish_.count > 0 ? wish_.count : circuits;
    if (count_ % circuits != 0) {
        return "the pattern has " + std::to_string(circuits) + " circuits, and " +
               std::to_string(count_) +
               " pins are no multiple of that; each place needs its own pin, so ask for as many "
               "circuits (\"pattern\") or leave \"count\" out";
    }
    least_skip_ = 0;
    for (std::optional<End>& end : end_) {
        if (!end) {
            continue;
        }
        end->shortest.pitch_mm = 2.0 * kPi * end->shortest.radius_mm / static_cast<double>(count_);
        end->fit = fit_pins(end->shortest, strand_mm_, wish_.height_mm);
        if (!end->fit.failure.empty()) {
            return end->fit.failure;
        }
        least_skip_ = std::max(least_skip_, end->fit.least_skip);
    }
    if (wish_.skip > 0 && wish_.skip < least_skip_) {
        return "a turn must run behind " + std::to_string(least_skip_) +
               " pins, so that the last takes hold when the first has let go, and \"skip\" is " +
               std::to_string(wish_.skip);
    }
    return {};
}

FoundPattern PinnedEnds::find(const PatternConstraints& wish, const Find& find) {
    PatternConstraints with_pins = wish;
    FoundPattern found = find(with_pins);
    for (int round = 0; round < kRounds && found.pattern; ++round) {
        if (const std::string why = fit(found.pattern->circuits); !why.empty()) {
            return {std::nullopt, why};
        }
        const double pitch_rad = 2.0 * kPi / static_cast<double>(count_);
        const double least = pitch_rad * (wish_.skip > 0 ? wish_.skip : least_skip_);
        const double most = wish_.skip > 0 ? least + (1.0 - kRounding) * pitch_rad
                                           : wish.most_dwell_rad.value_or(2.0 * kPi + least);
        const double dwell = share() * found.pattern->dwell_rad;
        if (dwell >= least - kRounding * pitch_rad && dwell <= most + kRounding * pitch_rad) {
            return found;
        }
        with_pins.least_dwell_rad = std::max(wish.least_dwell_rad, least);
        with_pins.most_dwell_rad = std::max(most, with_pins.least_dwell_rad);
        found = find(with_pins);
    }
    if (found.pattern) {
        return {std::nullopt,
                "no pattern has circuits and pins that fit each other; ask for \"circuits\""};
    }
    return found;
}

std::string PinnedEnds::place(const Pattern& pattern, std::int64_t series) {
    if (series > 1) {
        return "the bands of a rib are set side by side by dwelling at a rim, and on pins the "
               "fibre dwells by whole pins; ask for one series";
    }
    const double pitch_rad = 2.0 * kPi / static_cast<double>(count_);
    const double pins = share() * pattern.dwell_rad / pitch_rad;
    const double whole = std::floor(pins + kRounding);
    for (std::optional<End>& end : end_) {
        if (!end) {
            continue;
        }
        PinTurnShape& shape = end->placed;
        shape = end->shortest;
        shape.skip = static_cast<int>(whole);
        shape.lead_mm = end->fit.lead_mm;
        shape.offset_mm += 0.5 * (pins - whole) * shape.pitch_mm / std::tan(shape.angle_rad);
        const double needed = shape.offset_mm + shape.held_mm + 0.5 * tow_width_mm_;
        if (needed > extension_mm_) {
            return "the turn on pins takes " + fixed(needed, 1) +
                   " mm of extension where there are " + fixed(extension_mm_, 1);
        }
    }
    return {};
}

LaidTurn PinnedEnds::turn(std::size_t end, const RimCrossing& from, const RimCrossing& /*to*/) {
    const Rim& rim = end_[end]->rim;
    PinTurnShape shape = end_[end]->placed;
    shape.angle_rad = from.angle_rad;
    if (std::none_of(rings_.begin(), rings_.end(),
                     [&](const PinRing& ring) { return ring.rim == rim.id; })) {
        rings_.push_back(ring_for(rim, from, shape));
        rings_.back().height_mm = end_[end]->fit.height_mm;
    }
    return turn_on_pins(rim, from, shape, tow_width_mm_);
}

std::unique_ptr<RimTurns> pin_turns(const PinConstraints& wish, const Tow& tow,
                                    double extension_mm) {
    return std::make_unique<PinnedEnds>(wish, tow, extension_mm);
}

}  // namespace meshwind
