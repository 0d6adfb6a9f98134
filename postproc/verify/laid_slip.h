/// Slip ratio along a laid fibre, which friction has to hold.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "postproc/verify/laydown.h"

namespace meshwind {

struct LaidSlipOptions {
    double tow_width_mm = 0.0;  ///< chords are at least as long: a band does not turn on less
    double friction = 0.0;      ///< available coefficient
    double aside_mm = 0.0;      ///< offset that counts as no slip
};

/// |kg| / kn at each laid station, as measured over chords of a tow width. Where the excess over
/// the friction would lead aside by less than `aside_mm` over them, chords of two and then four tow
/// widths decide. 0 within a tow width of bridges and pins, where friction does not hold the fibre,
/// and where longer chords that would have to decide reach beyond an end.
[[nodiscard]] std::vector<double> laid_slip(const Surface& wall, const LaidPath& laid,
                                            const LaidSlipOptions& options);

}  // namespace meshwind
