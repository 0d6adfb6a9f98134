/// Random restarts for a search of joints that found nothing.
#pragma once

#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include "machines/machine.h"

namespace meshwind {

struct DrawnStartsOptions {
    std::size_t first = 0;  ///< joints before this one are kept
    /// > 0: how far from the joint at hand a linear axis is drawn on a side where it has no end;
    /// rotary axes half a turn.
    double endless_mm = 1000.0;
};

/// Starts drawn evenly from the travel of each axis, by a fixed seed: each object draws the same.
class DrawnStarts {
public:
    /// \param machine must outlive the object
    explicit DrawnStarts(const Machine& machine, const DrawnStartsOptions& options = {});

    /// \param at_hand joints of the machine from its first on, not necessarily all
    /// \return as many joints, those from `first` on drawn
    [[nodiscard]] std::vector<double> next(std::span<const double> at_hand);

private:
    const Machine& machine_;
    DrawnStartsOptions options_;
    std::mt19937 engine_;
};

}  // namespace meshwind
