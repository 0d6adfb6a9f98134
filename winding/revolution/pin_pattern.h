/// Pins and pattern together: how many pins a ring has, how many of them a turn runs behind, and
/// how far from the rim they stand, so that the circuits close.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "winding/revolution/pattern_wish.h"
#include "winding/turn/pin_turn.h"

namespace meshwind {

/// The ends of a body at which the fibre turns on pins. Each place of the pattern has its own pin,
/// so a ring has as many pins as the pattern circuits, or a multiple. What a turn is to be longer
/// than the shortest is made up by whole pins to run behind and, for what is left, by standing them
/// further from the rim: by z more, the turn is 2 z tan(alpha) longer.
class PinnedEnds {
public:
    /// \param tow_width_mm, tow_thickness_mm of which its strand follows
    PinnedEnds(const PinWish& wish, double tow_width_mm, double tow_thickness_mm,
               double extension_mm);

    /// \param radius_mm of the extension \param angle_rad between fibre and axis at the rim
    void add(std::size_t end, double radius_mm, double angle_rad);

    /// About the axis, of a turn at the least distance from the rim that runs behind no pins.
    [[nodiscard]] double shortest_rad(std::size_t end) const;

    using Find = std::function<FoundPattern(const PatternWish&)>;
    /// The pattern whose turns run behind enough pins for these to take hold one by one.
    /// \param find with the wish that it is given, whose least and most dwell are at each end
    [[nodiscard]] FoundPattern find(const PatternWish& wish, const Find& find);

    /// Sets pins and distances for the pattern that was found.
    /// \return empty, or in words why they cannot be
    [[nodiscard]] std::string place(const Pattern& pattern);

    /// After place(). \pre the end was added
    [[nodiscard]] const PinTurnShape& shape(std::size_t end) const { return end_[end]->placed; }
    /// Of the pins.
    [[nodiscard]] double height_mm(std::size_t end) const { return end_[end]->fit.height_mm; }

private:
    struct End {
        PinTurnShape shortest;
        PinFit fit;
        PinTurnShape placed;
    };
    [[nodiscard]] std::string fit(std::int64_t circuits);
    [[nodiscard]] double share() const { return end_[0] && end_[1] ? 0.5 : 1.0; }

    PinWish wish_;
    double tow_width_mm_;
    double strand_mm_;
    double extension_mm_;
    std::array<std::optional<End>, 2> end_;
    std::int64_t count_ = 0;
    int least_skip_ = 0;
};

}  // namespace meshwind
