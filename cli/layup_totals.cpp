#include "cli/layup_totals.h"

#include "core/units.h"

namespace meshwind {

LayupTotals layup_totals(std::span<const WoundLayer> layers) {
    const Setup& setup = layers.front().setup;
    const std::size_t faces = setup.mandrel.surface.face.size();
    LayupTotals totals{std::vector<double>(faces, 0.0), std::vector<double>(faces, 0.0),
                       std::vector<double>(faces, 0.0)};
    for (const WoundLayer& layer : layers) {
        const Plan& plan = layer.plan;
        for (std::size_t f = 0; f < plan.face_layers.size(); ++f) {
            totals.layers[f] += plan.face_layers[f];
            totals.thickness_mm[f] += plan.face_layers[f] * setup.job.tow.thickness_mm;
            const double angle_deg = deg_from_rad(plan.face_angle_rad[f]);
            const double share =
                totals.layers[f] > 0.0 ? plan.face_layers[f] / totals.layers[f] : 1.0;
            totals.angle_deg[f] += share * (angle_deg - totals.angle_deg[f]);
        }
    }
    return totals;
}

}  // namespace meshwind
