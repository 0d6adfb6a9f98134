/// Contact of the free fibre with pins while a program is wound again.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "winding/turn/pin.h"

namespace meshwind {

/// Follows the fibre from its landing point to the eye past pins. At any time at most one pin holds
/// it: the one about which it bends most. A fibre that is swept against the flank of a pin below
/// its top is caught; where it is straight again the pin lets go of it; above the top it is not
/// held.
class PinContact {
public:
    /// \param pins must outlive this
    explicit PinContact(std::span<const Pin> pins) : pins_(pins) {}

    [[nodiscard]] bool holds() const { return held_.has_value(); }

    /// The fibre from a place to the eye, where a pin holds it and it bears on its flank.
    [[nodiscard]] std::optional<PinString> string(const Eigen::Vector3d& place_mm,
                                                  const Eigen::Vector3d& eye_mm) const;

    /// Vector from a place along the fibre, of its length up to the eye.
    [[nodiscard]] Eigen::Vector3d pull(const Eigen::Vector3d& place_mm,
                                       const Eigen::Vector3d& eye_mm) const;

    /// Catches, changes and lets go.
    /// \return empty, or the fault in words: the fibre slips off a pin's top, or bends about two
    /// pins
    [[nodiscard]] std::string update(const Eigen::Vector3d& landing_mm,
                                     const Eigen::Vector3d& eye_mm);

    /// Whether a place of the wall is at the flank of a pin, which sets the fibre's course there.
    [[nodiscard]] bool at_pin(const Eigen::Vector3d& place_mm) const;

    /// Longest step along the fibre about the pin that holds it.
    [[nodiscard]] double step_mm() const;

private:
    struct Held {
        std::size_t pin;
        PinSide side;
    };
    [[nodiscard]] std::optional<Held> caught(const Eigen::Vector3d& from_mm,
                                             const Eigen::Vector3d& eye_mm, double& bend) const;

    std::span<const Pin> pins_;
    std::optional<Held> held_;
};

}  // namespace meshwind
