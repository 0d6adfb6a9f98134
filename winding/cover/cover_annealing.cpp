#include "winding/cover/cover_annealing.h"

#include <cmath>

namespace meshwind {
namespace {

// Proposals at an effort of 1, and where a few courses had to be given up.
constexpr double kProposals = 30'000.0;
constexpr std::int64_t kMendingProposals = 4'000;

// What a fibre too many costs where courses lead on to a stage from which none leads back: then it
// cannot be mended by joining.
constexpr double kDearFibre = 6.0;

// What a layer short of the target costs, of AnnealOptions: in the last stage of a wall, and in
// those whose thin places are filled later.
constexpr double kLastBare = 2.0;
constexpr double kEarlyBare = 0.3;

// Courses that come of the bound are moved, but not thrown about, and keep short turns: values of
// AnnealOptions. Its own are for a wanted winding angle, which takes other courses.
constexpr double kStartedHot = 0.02;
constexpr double kStartedTurnShare = 6.0;

}  // namespace

AnnealOptions annealing_of(const CoverAnnealing& cover) {
    AnnealOptions annealing;
    const double bare = cover.last_stage ? kLastBare : kEarlyBare;
    annealing.bare_hot *= bare;
    annealing.bare_cold *= bare;
    if (!cover.angle_wanted) {
        annealing.hot = kStartedHot;
        annealing.turn_share = kStartedTurnShare;
    }
    annealing.fibre_share = cover.spare_fibres ? kDearFibre : annealing.fibre_share;
    annealing.proposals =
        cover.mending ? kMendingProposals : std::llround(cover.effort * kProposals);
    if (cover.mending) {
        annealing.hot = annealing.cold;
        annealing.bare_hot = annealing.bare_cold;
    }
    return annealing;
}

}  // namespace meshwind
