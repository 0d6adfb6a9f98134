/// The tow that is wound.
#pragma once

namespace meshwind {

struct Tow {
    double width_mm = 6.0;
    double thickness_mm = 0.25;
    double friction = 0.2;
    double bridging_tolerance_mm = 0.5;
};

}  // namespace meshwind
