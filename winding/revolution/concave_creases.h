/// Concave creases of a meridian, over which a fibre runs through the air.
#pragma once

#include <vector>

#include "mesh/revolution/meridian.h"

namespace meshwind {

/// Where fibre is in the air it has no friction, so nothing can be steered there.
class ConcaveCreases {
public:
    explicit ConcaveCreases(const Meridian& meridian);

    /// Whether a fibre is near the bridge over one of them. With the kink k, half of what it
    /// bridges is k cos(a) / (2 kn) long, and 1.5 times as much counts: the taut string of two
    /// circles of curvature kn that meet at the angle k cos(a).
    /// \param place at `arc_mm` \param angle_rad winding angle there \param times as near as that
    [[nodiscard]] bool near_bridge(const MeridianPlace& place, double arc_mm, double angle_rad,
                                   double times) const;

private:
    struct Edge {
        double arc_mm;
        double kink_rad;
    };
    std::vector<Edge> edges_;
};

}  // namespace meshwind
