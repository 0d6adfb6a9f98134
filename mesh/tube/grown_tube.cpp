#include "mesh/tube/grown_tube.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>

#include "core/text/text_number.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

struct Radii {
    double least_mm = std::numeric_limits<double>::infinity();
    double mean_mm = 0.0;
    double most_mm = 0.0;
};

Radii radii_of(const CentreLine& line, const Surface& surface) {
    Radii radii;
    for (const Vector3d& position : surface.position_mm) {
        const double radius = (position - line.foot(position).position_mm).norm();
        radii.least_mm = std::min(radii.least_mm, radius);
        radii.most_mm = std::max(radii.most_mm, radius);
        radii.mean_mm += radius / static_cast<double>(surface.position_mm.size());
    }
    return radii;
}

void set_ends(const Mandrel& grown, Tube& tube) {
    const Vector3d start = tube.line.nodes().front().position_mm;
    const auto& rims = grown.rims;
    const bool forward = (rims[0].centre_mm - start).norm() <= (rims[1].centre_mm - start).norm();
    for (std::size_t end = 0; end < 2; ++end) {
        const Rim& rim = rims[forward ? end : 1 - end];
        const Vector3d outward = end == 0 ? Vector3d(-tube.line.nodes().front().tangent)
                                          : tube.line.nodes().back().tangent;
        tube.rim[end] = rim.id;
        tube.lean_rad[end] = std::atan2(outward.cross(rim.axis).norm(), outward.dot(rim.axis));
    }
}

}  // namespace

TubeFinding grown_tube(const Tube& bare, const Mandrel& grown, double most_mm) {
    if (bare.radius.size() != 1) {
        return {std::nullopt, "the radius of the tube under the layers varies"};
    }
    if (grown.rims.size() != 2) {
        return {std::nullopt, "it has " + std::to_string(grown.rims.size()) +
                                  (grown.rims.size() == 1 ? " rim" : " rims") + ", a tube has two"};
    }
    const double bare_mm = bare.radius.front().radius_mm;
    const double limit_mm = std::min(kTubeResidualMm, kTubeResidualShare * bare_mm);
    const Radii radii = radii_of(bare.line, grown.surface);
    if (radii.least_mm < bare_mm - limit_mm || radii.most_mm > bare_mm + most_mm + limit_mm) {
        return {std::nullopt, "its vertices are " + fixed(radii.least_mm, 3) + " to " +
                                  fixed(radii.most_mm, 3) + " mm off the line of a tube of " +
                                  fixed(bare_mm, 3) + " mm with layers of up to " +
                                  fixed(most_mm, 3) + " mm on it"};
    }
    Tube tube = bare;
    tube.radius = {{0.0, radii.mean_mm}};
    tube.residual_mm = std::max(radii.most_mm - radii.mean_mm, radii.mean_mm - radii.least_mm);
    set_ends(grown, tube);
    return {std::move(tube), {}};
}

}  // namespace meshwind
