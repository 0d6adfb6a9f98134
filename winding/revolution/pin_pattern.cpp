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

PinnedEnds::PinnedEnds(const PinWish& wish, double tow_width_mm, double tow_thickness_mm,
                       double extension_mm)
    : wish_(wish),
      tow_width_mm_(tow_width_mm),
      strand_mm_(strand_radius_mm(tow_width_mm, tow_thickness_mm)),
      extension_mm_(extension_mm) {}

void PinnedEnds::add(std::size_t end, double radius_mm, double angle_rad) {
    PinTurnShape shape;
    shape.radius_mm = radius_mm;
    shape.angle_rad = angle_rad;
    shape.diameter_mm = wish_.diameter_mm;
    shape.held_mm = 0.5 * wish_.diameter_mm + strand_mm_;
    shape.offset_mm = wish_.offset_mm > 0.0 ? wish_.offset_mm : tow_width_mm_ + wish_.diameter_mm;
    end_[end] = End{shape, {}, shape};
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

FoundPattern PinnedEnds::find(const PatternWish& wish, const Find& find) {
    PatternWish with_pins = wish;
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

std::string PinnedEnds::place(const Pattern& pattern) {
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

}  // namespace meshwind
