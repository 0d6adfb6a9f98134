/// What friction has to hold along a laid fibre.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "postproc/verify/laydown.h"

namespace meshwind {

struct LaidSlipOptions {
    double tow_width_mm = 0.0;  ///< chords are at least as long: a band does not turn on less
    double friction = 0.0;      ///< what holds
    double aside_mm = 0.0;      ///< by which a fibre may go aside unnoticed
};

/// |kg| / kn at each laid station. 0 within a tow width of bridges and pins, where friction does
/// not hold the fibre. Where it is over the friction by so little, or over so short a way, that it
/// would lead aside by less than `aside_mm` over its chords, chords of twice and four times the
/// length tell; what counts over none of them is not over the friction.
[[nodiscard]] std::vector<double> laid_slip(const Surface& wall, const LaidPath& laid,
                                            const LaidSlipOptions& options);

}  // namespace meshwind
