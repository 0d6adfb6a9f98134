#include "mesh/height_jet.h"

namespace meshwind {

JetHeight height_at(const HeightJet& jet, double x, double y) {
    const auto& c = jet.coefficient;
    const double y1 = c[1] + x * (c[3] + x * (c[6] + x * c[10]));
    const double y2 = c[4] + x * (c[7] + x * c[11]);
    const double y3 = c[8] + x * c[12];
    JetHeight h;
    h.value = x * (c[0] + x * (c[2] + x * (c[5] + x * c[9]))) +
              y * (y1 + y * (y2 + y * (y3 + y * c[13])));
    h.by_x =
        c[0] + x * (2.0 * c[2] + x * (3.0 * c[5] + x * 4.0 * c[9])) +
        y * (c[3] + x * (2.0 * c[6] + x * 3.0 * c[10]) + y * (c[7] + x * 2.0 * c[11] + y * c[12]));
    h.by_y = y1 + y * (2.0 * y2 + y * (3.0 * y3 + y * 4.0 * c[13]));
    h.by_xx = 2.0 * c[2] + x * (6.0 * c[5] + x * 12.0 * c[9]) +
              y * (2.0 * c[6] + x * 6.0 * c[10] + y * 2.0 * c[11]);
    h.by_xy = c[3] + x * (2.0 * c[6] + x * 3.0 * c[10]) +
              y * (2.0 * c[7] + x * 4.0 * c[11] + y * 3.0 * c[12]);
    h.by_yy = 2.0 * y2 + y * (6.0 * y3 + y * 12.0 * c[13]);
    return h;
}

}  // namespace meshwind
