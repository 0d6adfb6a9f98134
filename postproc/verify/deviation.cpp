#include "postproc/verify/deviation.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Stations of the plan closer together than this have no direction between them: the joint of two
// pieces, the two sides of a feature edge.
constexpr double kOneStation_mm = 0.01;

// How far ahead of the present planned station a laid one is looked for. A laid fibre that is
// further away has left the plan.
constexpr double kAhead_mm = 50.0;

// The planned fibre at a laid station.
struct Matched {
    Vector3d position_mm, normal, tangent;
};

// The cubic between two stations at the place beside `x`.
Matched between(const PlannedStation& a, const PlannedStation& b, const Vector3d& x) {
    const CubicPlace place = beside(a.position_mm, a.tangent, b.position_mm, b.tangent, x);
    const Vector3d normal = (1.0 - place.share) * a.normal + place.share * b.normal;
    return {place.position_mm, (normal - place.tangent * place.tangent.dot(normal)).normalized(),
            place.tangent};
}

// How many stations from the first on are where that is.
template <class Station>
std::size_t stations_at_one_place(Station first, Station last) {
    const auto apart = std::find_if(first, last, [&](const PathPoint& station) {
        return !((station.position_mm - first->position_mm).norm() < kOneStation_mm);
    });
    return static_cast<std::size_t>(apart - first);
}

// Takes short swings for no angle.
// \param angle_rad per station
void forget_swings(const SurfacePath& path, const LaydownTolerance& tolerance,
                   std::vector<double>& angle_rad) {
    for (std::size_t first = 0, end = 0; first < path.size(); first = end + 1) {
        double most_rad = 0.0;
        for (end = first; end < path.size() && angle_rad[end] > tolerance.angle_rad; ++end) {
            most_rad = std::max(most_rad, angle_rad[end]);
        }
        const std::size_t before = first > 0 ? first - 1 : 0;
        const std::size_t after = std::min(end, path.size() - 1);
        if (most_rad * (path[after].s_mm - path[before].s_mm) <=
            kUnnoticed * tolerance.deviation_mm) {
            std::fill(angle_rad.begin() + static_cast<std::ptrdiff_t>(first),
                      angle_rad.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
        }
    }
}

// The first station behind one that is at another place.
std::size_t next_apart(const PlannedFibre& planned, std::size_t i) {
    std::size_t next = i + 1;
    while (next < planned.size() &&
           (planned[next].position_mm - planned[i].position_mm).norm() < kOneStation_mm) {
        ++next;
    }
    return next;
}

// Per laid station the planned one before it: it is between that and the next apart from it.
std::vector<std::size_t> stations_before(const SurfacePath& laid, const PlannedFibre& planned) {
    std::vector<std::size_t> before;
    std::size_t j = 0;
    for (const PathPoint& station : laid) {
        std::size_t next = next_apart(planned, j);
        while (next < planned.size() &&
               (station.position_mm - planned[next].position_mm).dot(planned[next].tangent) > 0.0 &&
               (station.position_mm - planned[next].position_mm).norm() < kAhead_mm) {
            j = next;
            next = next_apart(planned, j);
        }
        before.push_back(j);
    }
    return before;
}

// Where the fibre begins and ends on the edge of a rim, stations lie on either side of it; the
// wall's is that beside the fibre.
class RimStations {
public:
    explicit RimStations(const SurfacePath& laid)
        : begin_(stations_at_one_place(laid.begin(), laid.end())),
          end_(laid.size() - stations_at_one_place(laid.rbegin(), laid.rend())) {}

    [[nodiscard]] bool beyond(std::size_t i) const { return i + 1 < begin_ || i > end_; }

private:
    std::size_t begin_, end_;
};

// Whether planned stations are the two sides of a feature edge close by: over it the fibre swings
// on the spot, and any direction may be found there.
bool swings(const PlannedFibre& planned, std::size_t first, std::size_t end, const Vector3d& at,
            double within_mm) {
    return end - first > 1 && (planned[first].position_mm - at).norm() <= within_mm;
}

// Per laid station. Both are zero where nothing is compared.
struct StationOffsets {
    std::vector<double> sideways_mm;
    std::vector<double> angle_rad;
};

StationOffsets offsets_from_plan(const LaidPath& laid, const PlannedFibre& planned,
                                 const std::vector<std::size_t>& before, double within_mm) {
    const RimStations rim(laid.path);
    StationOffsets offsets{std::vector<double>(laid.path.size(), 0.0),
                           std::vector<double>(laid.path.size(), 0.0)};
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        const PathPoint& station = laid.path[i];
        const std::size_t j = before[i];
        const std::size_t next = next_apart(planned, j);
        if (laid.at[i].lifted || next >= planned.size() || planned[j].lifted ||
            planned[next].lifted) {
            continue;
        }
        // Of several stations at one place the last leads on.
        const Matched match = between(planned[next - 1], planned[next], station.position_mm);
        const Vector3d across = match.normal.cross(match.tangent);
        offsets.sideways_mm[i] = std::abs((station.position_mm - match.position_mm).dot(across));
        // About a pin the fibre has the pin's direction, wherever it came from.
        const bool at_pin = laid.at[i].held || planned[j].held || planned[next].held;
        const bool on_the_spot =
            at_pin || rim.beyond(i) || swings(planned, j, next, station.position_mm, within_mm) ||
            swings(planned, next, next_apart(planned, next), station.position_mm, within_mm);
        offsets.angle_rad[i] = on_the_spot
                                   ? 0.0
                                   : std::abs(std::atan2(station.tangent.dot(across),
                                                         station.tangent.dot(match.tangent)));
    }
    return offsets;
}

}  // namespace

PlannedFibre planned_fibre(std::span<const Piece> pieces) {
    PlannedFibre fibre;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const SurfacePath& path = pieces[p].path;
        for (std::size_t i = 0; i < path.size(); ++i) {
            fibre.push_back({static_cast<std::int32_t>(p), static_cast<std::int32_t>(i),
                             path[i].position_mm, path[i].normal, path[i].tangent,
                             pieces[p].string.gap_mm[i] > 0.0,
                             !pieces[p].free_start.empty() && pieces[p].free_start[i].held});
        }
    }
    return fibre;
}

Deviation compare(const LaidPath& laid, const PlannedFibre& planned,
                  const LaydownTolerance& tolerance) {
    Deviation deviation;
    deviation.planned = stations_before(laid.path, planned);
    StationOffsets offsets =
        offsets_from_plan(laid, planned, deviation.planned, tolerance.deviation_mm);
    forget_swings(laid.path, tolerance, offsets.angle_rad);
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        const double sideways_mm = offsets.sideways_mm[i];
        const double angle_rad = offsets.angle_rad[i];
        if (sideways_mm > deviation.max_mm) {
            deviation.max_mm = sideways_mm;
            deviation.max_at = i;
        }
        if (angle_rad > deviation.max_angle_rad) {
            deviation.max_angle_rad = angle_rad;
            deviation.max_angle_at = i;
        }
        if (sideways_mm > tolerance.deviation_mm || angle_rad > tolerance.angle_rad) {
            deviation.wrong.push_back(i);
        }
    }
    deviation.end_gap_mm = (laid.path.back().position_mm - planned.back().position_mm).norm();
    return deviation;
}

}  // namespace meshwind
