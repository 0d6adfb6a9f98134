#include "winding/revolution/rim_turns.h"

#include <array>
#include <cassert>
#include <cmath>
#include <optional>

#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/turn/laid_turn.h"
#include "winding/turn/turn.h"

namespace meshwind {
namespace {

double positive_angle(double angle_rad) {
    const double rest = std::fmod(angle_rad, 2.0 * kPi);
    return rest < 0.0 ? rest + 2.0 * kPi : rest;
}

class FrictionTurns final : public RimTurns {
public:
    FrictionTurns(const Tow& tow, double extension_mm)
        : rule_{tow.friction, extension_mm, tow.width_mm} {}

    std::string add(const RimEnd& end) override {
        end_[end.end].emplace(end);
        return can_turn(end.rim, end.crossing, rule_)
                   ? std::string()
                   : why_no_turn("the " + end.name() + " rim", end.rim, end.crossing, rule_);
    }

    double shortest_rad(std::size_t end) const override {
        const RimCrossing& crossing = end_[end]->crossing;
        RimCrossing back = crossing;
        back.sense = -crossing.sense;
        return positive_angle(-dwell_rad(end_[end]->rim, crossing, back, rule_));
    }

    double least_dwell_rad() const override { return kMinDwell_rad; }

    LaidTurn turn(std::size_t end, const RimCrossing& from, const RimCrossing& to) override {
        return turn_over(end_[end]->rim, from, to, rule_);
    }

private:
    TurnRule rule_;
    std::array<std::optional<RimEnd>, 2> end_;
};

class NoRimTurns final : public RimTurns {
public:
    std::string add(const RimEnd& end) override {
        return "a fibre at " + degrees(end.angle_rad) + " crosses the " + end.name() + " rim at " +
               degrees(end.crossing.angle_rad) +
               " to the axis and turns about no pole there; give a larger angle, or \"turn\": "
               "\"friction\"";
    }

    // No end is ever added.
    double shortest_rad(std::size_t /*end*/) const override {
        assert(false);
        return 0.0;
    }

    double least_dwell_rad() const override { return 0.0; }

    LaidTurn turn(std::size_t /*end*/, const RimCrossing& /*from*/,
                  const RimCrossing& /*to*/) override {
        assert(false);
        return {};
    }
};

}  // namespace

std::string RimTurns::why_no_ends(double /*angle_rad*/) const {
    return {};
}

FoundPattern RimTurns::find(const PatternConstraints& wish, const Find& find) {
    return find(wish);
}

std::string RimTurns::place(const Pattern& /*pattern*/, std::int64_t /*series*/) {
    return {};
}

std::unique_ptr<RimTurns> friction_turns(const Tow& tow, double extension_mm) {
    return std::make_unique<FrictionTurns>(tow, extension_mm);
}

std::unique_ptr<RimTurns> no_rim_turns() {
    return std::make_unique<NoRimTurns>();
}

}  // namespace meshwind
