/// Turns on pins that close a pattern. Sets the number of pins in a ring, the number that a turn
/// runs behind, and their distance from the rim.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "winding/revolution/rim_turns.h"
#include "winding/turn/pin_turn.h"

namespace meshwind {

/// The ends of a body at which the fibre turns on pins. Each place of the pattern has its own pin,
/// so a ring has as many pins as the pattern circuits, or a multiple. The length of a turn beyond
/// the shortest is made up by whole pins to run behind and, for the rest, by setting them further
/// from the rim: by z more, the turn is 2 z tan(alpha) longer.
class PinnedEnds final : public RimTurns {
public:
    /// \param tow of whose width and thickness its strand follows
    PinnedEnds(const PinConstraints& wish, const Tow& tow, double extension_mm);

    [[nodiscard]] bool lifts_over_hollow_rims() const override { return false; }

    /// Always empty.
    [[nodiscard]] std::string add(const RimEnd& end) override;
    [[nodiscard]] std::string why_no_ends(double angle_rad) const override;

    /// Angle of a turn at the least distance from the rim that runs behind no pins.
    [[nodiscard]] double shortest_rad(std::size_t end) const override;
    [[nodiscard]] double least_dwell_rad() const override { return 0.0; }

    /// The pattern whose turns run behind enough pins for these to take hold one by one.
    [[nodiscard]] FoundPattern find(const PatternConstraints& wish, const Find& find) override;

    /// Sets pins and distances.
    [[nodiscard]] std::string place(const Pattern& pattern, std::int64_t series) override;

    /// \pre placed. The first one at a rim says where the ring stands.
    [[nodiscard]] LaidTurn turn(std::size_t end, const RimCrossing& from,
                                const RimCrossing& to) override;
    [[nodiscard]] std::vector<PinRing> pins() const override { return rings_; }

private:
    struct End {
        const Rim& rim;
        PinTurnShape shortest;
        PinFit fit;
        PinTurnShape placed;
    };
    [[nodiscard]] std::string fit(std::int64_t circuits);
    [[nodiscard]] double share() const { return end_[0] && end_[1] ? 0.5 : 1.0; }

    PinConstraints wish_;
    double tow_width_mm_;
    double strand_mm_;
    double extension_mm_;
    std::array<std::optional<End>, 2> end_;
    std::int64_t count_ = 0;
    int least_skip_ = 0;
    std::vector<PinRing> rings_;
};

/// Makes turns on pins, for a planner.
[[nodiscard]] std::unique_ptr<RimTurns> pin_turns(const PinConstraints& wish, const Tow& tow,
                                                  double extension_mm);

}  // namespace meshwind
