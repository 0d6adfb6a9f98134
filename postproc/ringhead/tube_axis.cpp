#include "postproc/ringhead/tube_axis.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Arcs as short as this are those of a fit; stations nearer would be one point.
constexpr double kShortestStep_mm = 1e-3;
// Inside the end of a bend: at the end itself the line has the next stretch's curvature.
constexpr double kInside_mm = 1e-6;

double weight_of(const TubePart& part) {
    return part.kind == TubePartKind::Straight ? 0.0 : 1.0;
}

// Arc lengths of the stations, ascending.
std::vector<double> station_places(const CentreLine& line) {
    std::vector<double> places = {0.0};
    double start_mm = 0.0;
    for (const CentreArc& arc : line.arcs()) {
        const double turn = arc.length_mm * arc.curvature_per_mm.norm();
        const int steps = std::max(1, static_cast<int>(std::ceil(turn / kTubeStation_rad)));
        for (int i = 1; i <= steps; ++i) {
            const double place = start_mm + arc.length_mm * i / steps;
            if (place - places.back() > kShortestStep_mm) {
                places.push_back(place);
            }
        }
        start_mm += arc.length_mm;
    }
    places.back() = line.length_mm();
    return places;
}

double turn_before(const Tube& tube, double arc_mm, double bend_turn_rad) {
    double turn_rad = 0.0;
    for (const TubePart& part : tube.parts) {
        const double length = part.to_mm - part.from_mm;
        if (length > 0.0) {
            turn_rad += weight_of(part) * bend_turn_rad *
                        std::clamp((arc_mm - part.from_mm) / length, 0.0, 1.0);
        }
    }
    return turn_rad;
}

// Towards the inside of the first bend from the start, square to the axis there.
Vector3d towards_bend(const Tube& tube, const Vector3d& tangent, bool from_the_end) {
    std::vector<TubePart> parts = tube.parts;
    if (from_the_end) {
        std::reverse(parts.begin(), parts.end());
    }
    for (const TubePart& part : parts) {
        if (part.kind != TubePartKind::Straight) {
            const double place = from_the_end ? part.to_mm - kInside_mm : part.from_mm + kInside_mm;
            const Vector3d inside = tube.line.at(place).curvature_per_mm;
            const Vector3d square = inside - inside.dot(tangent) * tangent;
            if (square.norm() > 0.0) {
                return square.normalized();
            }
        }
    }
    Eigen::Index least = 0;
    tangent.cwiseAbs().minCoeff(&least);
    const Vector3d axis = Vector3d::Unit(least);
    return (axis - axis.dot(tangent) * tangent).normalized();
}

}  // namespace

TubeAxis axis_of_tube(const Tube& tube, const TubeAxisOptions& options) {
    const double length_mm = tube.line.length_mm();
    const double sense = options.from_the_end ? -1.0 : 1.0;
    std::vector<double> places = station_places(tube.line);
    if (options.from_the_end) {
        std::reverse(places.begin(), places.end());
    }
    const CentrePlace start = tube.line.at(places.front());
    const Vector3d z = sense * start.tangent;
    const Vector3d x = towards_bend(tube, z, options.from_the_end);
    Isometry3d in_mandrel = Isometry3d::Identity();
    in_mandrel.linear().col(0) = x;
    in_mandrel.linear().col(1) = z.cross(x);
    in_mandrel.linear().col(2) = z;
    in_mandrel.translation() = start.position_mm;
    const Isometry3d to_frame = in_mandrel.inverse();
    const double all_rad = turn_before(tube, length_mm, options.bend_turn_rad);
    std::vector<AxisStation> stations;
    for (const double place : places) {
        const CentrePlace at = tube.line.at(place);
        AxisStation station;
        station.point_mm = to_frame * at.position_mm;
        station.tangent = (to_frame.linear() * (sense * at.tangent)).normalized();
        const double turn = turn_before(tube, place, options.bend_turn_rad);
        station.turn_rad = options.from_the_end ? all_rad - turn : turn;
        station.reference =
            stations.empty()
                ? Vector3d::UnitY()
                : carried_reference(stations.back().point_mm, stations.back().tangent,
                                    station.point_mm, station.tangent, stations.back().reference);
        stations.push_back(station);
    }
    const auto [least, most] = std::minmax_element(
        tube.radius.begin(), tube.radius.end(),
        [](const TubeRadius& a, const TubeRadius& b) { return a.radius_mm < b.radius_mm; });
    const double radius_mm = 0.5 * (least->radius_mm + most->radius_mm);
    return {FrameAxis(std::move(stations)), in_mandrel, radius_mm,
            most->radius_mm - least->radius_mm};
}

}  // namespace meshwind
