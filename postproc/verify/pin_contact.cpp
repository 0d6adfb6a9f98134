#include "postproc/verify/pin_contact.h"

#include <algorithm>

#include "core/text/text_number.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A pin that bends the fibre by less than this is only brushed: over the 20 mm to the landing point
// that is 0.1 mm of what a program may lay beside its plan.
constexpr double kTouch_rad = 0.005;

// A fibre that bends by more than this about two pins at once is not followed.
constexpr double kChain_rad = 0.1;

// Share of the distance from the pin's axis: steps along an arc.
constexpr double kStepShare = 0.1;

// At the flank of the pin that holds it are places up to so many times as far from the axis as the
// fibre on the flank; at those of others, places as near to it as fibre is laid to its plan.
constexpr double kAtPin = 2.0;
constexpr double kOnFlank_mm = 0.2;

}  // namespace

std::optional<PinString> PinContact::string(const Vector3d& place, const Vector3d& eye) const {
    if (!held_) {
        return std::nullopt;
    }
    const PinString string = string_about(pins_[held_->pin], held_->side, place, eye);
    return string.bend_rad > 0.0 ? std::optional(string) : std::nullopt;
}

Vector3d PinContact::pull(const Vector3d& place, const Vector3d& eye) const {
    const std::optional<PinString> bent = string(place, eye);
    return bent ? Vector3d(bent->length_mm * bent->direction) : Vector3d(eye - place);
}

bool PinContact::at_pin(const Vector3d& place) const {
    const auto near = [&](const Pin& pin, double reach_mm) {
        const Vector3d off = place - pin.base_mm;
        return off.squaredNorm() < reach_mm * reach_mm;  // on the wall
    };
    return (held_ && near(pins_[held_->pin], kAtPin * pins_[held_->pin].held_mm())) ||
           std::any_of(pins_.begin(), pins_.end(),
                       [&](const Pin& pin) { return near(pin, pin.held_mm() + kOnFlank_mm); });
}

double PinContact::step_mm() const {
    return kStepShare * pins_[held_->pin].held_mm();
}

std::optional<PinContact::Held> PinContact::caught(const Vector3d& from, const Vector3d& eye,
                                                   double& bend) const {
    std::optional<Held> found;
    bend = kTouch_rad;
    for (std::size_t i = 0; i < pins_.size(); ++i) {
        const std::optional<PinSide> side = side_touched(pins_[i], from, eye);
        if (!side || (held_ && held_->pin == i)) {
            continue;
        }
        const double bent = string_about(pins_[i], *side, from, eye).bend_rad;
        if (bent > bend) {
            bend = bent;
            found = {i, *side};
        }
    }
    return found;
}

std::string PinContact::update(const Vector3d& landing, const Vector3d& eye) {
    const std::optional<PinString> bent = string(landing, eye);
    if (!bent) {
        held_.reset();
    } else if (bent->top_mm > pins_[held_->pin].height_mm) {
        return "the fibre slips off the top of a pin, at " + fixed(bent->top_mm, 2) + " of " +
               fixed(pins_[held_->pin].height_mm, 2) + " mm,";
    }
    double bend = 0.0;
    const std::optional<Held> next = caught(bent ? bent->out_mm : landing, eye, bend);
    if (next && bent && std::min(bend, bent->bend_rad) > kChain_rad) {
        return "the fibre bends about two pins at once, which cannot be followed,";
    }
    if (next && (!bent || bend > bent->bend_rad)) {
        held_ = next;
    }
    return {};
}

}  // namespace meshwind
