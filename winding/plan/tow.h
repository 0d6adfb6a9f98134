/// The tow that is wound.
#pragma once

#include "winding/plan/friction.h"

namespace meshwind {

struct Tow {
    double width_mm = 6.0;
    double thickness_mm = 0.25;
    Friction friction = 0.2;
    double bridging_tolerance_mm = 0.5;
};

}  // namespace meshwind
