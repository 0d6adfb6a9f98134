#include "mesh/distance_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/parallel.h"

namespace meshwind {
namespace {

// Of a table with longer cells (mandrels of metres) what is interpolated close to the wall is not
// used: in a cell that the wall runs through it tells up to half a cell too much, which for shorter
// cells is less than heads are kept off.
constexpr double kLongCell_mm = 8.0;

// A place is no further from the nearest corner of its cell than so many of its edges.
constexpr double kHalfDiagonal = 0.8660254037844387;

// Room around the Z axis is known for needs in such steps.
constexpr double kNeedStep_mm = 5.0;

// What rounding may take from an interpolated distance.
constexpr double kTableRounding_mm = 1e-3;

// Lengths in single precision are good to this share of the scene's size, with room to spare.
constexpr double kSingle = 1e-6;

}  // namespace

bool DistanceTable::is_coarse() const {
    return cell_mm > kLongCell_mm;
}

double DistanceTable::at_most_mm(const Eigen::Vector3d& query) const {
    const std::optional<Near> near = complete ? nearest_node(query) : std::nullopt;
    if (!near || near->there_mm >= cap_mm) {
        return std::numeric_limits<double>::infinity();
    }
    // Embree's boxes and points are in single precision.
    return near->there_mm + near->off_mm + kSingle * (parts.diagonal().norm() + query.norm());
}

bool DistanceTable::is_beyond(const Eigen::Vector3d& query, double distance) const {
    if (distance_mm.empty()) {
        return false;
    }
    const Eigen::Vector3d scaled = (query - origin) / cell_mm;
    if ((scaled.array() < 0.0).any() || (scaled.array() >= (nodes - 1).cast<double>()).any()) {
        return false;
    }
    const Eigen::Array3i cell = scaled.array().cast<int>();
    const Eigen::Array3d low = cell_mm * (scaled.array() - cell.cast<double>());
    const Eigen::Array3d low_mm2 = low.square();
    const Eigen::Array3d high_mm2 = (cell_mm - low).square();
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Array3i up(corner & 1, corner >> 1 & 1, corner >> 2);
        const double room_mm = static_cast<double>(distance_mm[index(cell + up)]) - distance;
        const double off_mm2 = (up > 0).select(high_mm2, low_mm2).sum();
        if (room_mm >= 0.0 && room_mm * room_mm >= off_mm2) {
            return true;
        }
    }
    return false;
}

double DistanceTable::room_beyond_mm(double z_mm, double need_mm) const {
    const auto need = static_cast<std::size_t>(
        std::ceil((std::max(need_mm, 0.0) + kTableRounding_mm) / kNeedStep_mm));
    if (need >= needs) {
        return std::numeric_limits<double>::infinity();
    }
    // As distance_estimate_mm() finds the cells; beyond the table all is further than its reach.
    const double layer = (z_mm - origin.z()) / cell_mm;
    if (!(layer >= 0.0 && layer < nodes.z() - 1)) {
        return 0.0;
    }
    return room_from_mm[static_cast<std::size_t>(layer) * needs + need];
}

double DistanceTable::least_mm(const Eigen::Array3i& cell) const {
    double least = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Array3i node = cell + Eigen::Array3i(corner & 1, corner >> 1 & 1, corner >> 2);
        least = std::min(least, static_cast<double>(distance_mm[index(node)]));
    }
    return is_coarse() ? std::max(0.0, least - kHalfDiagonal * cell_mm) : least;
}

void DistanceTable::find_room(double reach_mm) {
    needs = static_cast<std::size_t>(std::floor(reach_mm / kNeedStep_mm));
    const auto layers = static_cast<std::size_t>(nodes.z() - 1);
    room_from_mm.assign(layers * needs, 0.0);
    parallel_for(layers, 1, [&](std::size_t layer, std::size_t) {
        const std::span<double> room(room_from_mm.data() + layer * needs, needs);
        Eigen::Array3i cell(0, 0, static_cast<int>(layer));
        for (; cell.y() < nodes.y() - 1; ++cell.y()) {
            for (cell.x() = 0; cell.x() < nodes.x() - 1; ++cell.x()) {
                // The least need that it does not give.
                const auto need =
                    static_cast<std::size_t>(std::floor(least_mm(cell) / kNeedStep_mm)) + 1;
                if (need < needs) {
                    const int x = cell.x();
                    const int y = cell.y();
                    room[need] = std::max({room[need], radius_mm(x, y), radius_mm(x + 1, y),
                                           radius_mm(x, y + 1), radius_mm(x + 1, y + 1)});
                }
            }
        }
        for (std::size_t need = 1; need < needs; ++need) {
            room[need] = std::max(room[need], room[need - 1]);
        }
    });
}

}  // namespace meshwind
