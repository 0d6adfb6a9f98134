/// Leads a fibre from one pattern to the next on a body of revolution by steered passes. They run
/// from end to end, each turning a little nearer to where the next pattern turns.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "winding/revolution/meridian_path.h"

namespace meshwind {

/// Goal of the fibre at an end of the body.
struct ConnectingGoal {
    enum class Kind {
        None,      ///< turn by itself and go on to the other end
        Parallel,  ///< run along a parallel
        Rim        ///< leave over the rim so that it can be turned there
    };
    Kind kind = Kind::None;
    double arc_mm = 0.0;  ///< of the parallel
};

/// The lower end of a body is 0, the upper 1.
struct ConnectingRequest {
    double from_arc_mm = 0.0;  ///< the parallel along which the fibre runs
    std::array<ConnectingGoal, 2> goal;
    double friction = 0.0;  ///< largest |slip ratio|
    /// Whether a fibre that leaves over the rim of an end so can be turned there.
    std::function<bool(std::size_t end, const MeridianStation& leaving)> can_turn;
    double station_mm = 4.0;
};

struct ConnectingPasses {
    /// In order of travel, azimuth growing, each from where the one before ends; at azimuth 0 to
    /// begin with. Empty where the fibre is already where it should be.
    std::vector<std::vector<MeridianStation>> passes;
    std::size_t end = 0;    ///< where they arrive
    std::string failure{};  ///< empty, or in words how near they come
};

/// Each pass has one constant slip ratio, found by halving, with which it arrives exactly; where
/// the friction is too little for that, the pass takes all of it towards the goal, and another pass
/// follows.
/// Accuracy: arrives within 1e-9 mm of the parallel
/// (tests/winding/revolution/connecting_passes_test.cpp). \pre from_arc_mm is between the ends
[[nodiscard]] ConnectingPasses connecting_passes(const Meridian& meridian,
                                                 const ConnectingRequest& request);

/// The same passes reversed: from their end to their beginning, azimuth growing from 0.
[[nodiscard]] std::vector<std::vector<MeridianStation>> other_way_round(
    const ConnectingPasses& way);

}  // namespace meshwind
