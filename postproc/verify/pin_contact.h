/// Which pin holds the free fibre while a program is wound again.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "winding/turn/pin.h"

namespace meshwind {

/// Follows the fibre from its landing point to the eye past pins. At any time one pin at most holds
/// it: that about which it bends most. A fibre that is swept against the flank of a pin below its
/// top is caught; where it is straight again the pin lets go of it; above the top it is not held.
class PinContact {
public:
    /// \param pins must outlive this
    explicit PinContact(std::span<const Pin> pins) : pins_(pins) {}

    [[nodiscard]] bool holds() const { return held_.has_value(); }

    /// The fibre from a place to the eye, where a pin holds it and it bears on its flank.
    [[nodiscard]] std::optional<PinString> string(const Eigen::Vector3d& place_mm,
                                                  const Eigen::Vector3d& eye_mm) const;

    /// From a place into the direction of the fibre, as long as it is up to the eye.
    [[nodiscard]] Eigen::Vector3d pull(const Eigen::Vector3d& place_mm,
                                       const Eigen::Vector3d& eye_mm) const;

    /// Catches, changes and lets go.
    /// \return empty, or in words what cannot be: the fibre slips off a pin's top, or bends about
    /// two pins
    [[nodiscard]] std::string update(const Eigen::Vector3d& landing_mm,
                                     const Eigen::Vector3d& eye_mm);

    /// Whether a place of the wall is at the flank of a pin: where that says how the fibre runs.
    [[nodiscard]] bool at_pin(const Eigen::Vector3d& place_mm) const;

    /// A step along the fibre about the pin that holds it is no longer.
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
