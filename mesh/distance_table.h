/// Distances tabulated on a regular grid. Included by ray_query.cpp only.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace meshwind {

/// Distances on a regular grid of nodes around the parts.
struct DistanceTable {
    Eigen::AlignedBox3d parts;  ///< bounding box of all triangles
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    double cell_mm = 0.0;
    Eigen::Array3i nodes = Eigen::Array3i::Zero();
    std::vector<float> distance_mm;
    /// Per layer of cells and need: radius about the Z axis that encloses all cells with a node
    /// whose distance is less than the need.
    std::size_t needs = 0;
    std::vector<double> room_from_mm;
    double cap_mm = 0.0;    ///< distances are capped at this value
    bool complete = false;  ///< all nodes have their distance

    /// Whether cells are too coarse for interpolation close to the wall.
    [[nodiscard]] bool is_coarse() const;

    [[nodiscard]] std::size_t index(const Eigen::Array3i& node) const {
        return (static_cast<std::size_t>(node.z()) * static_cast<std::size_t>(nodes.y()) +
                static_cast<std::size_t>(node.y())) *
                   static_cast<std::size_t>(nodes.x()) +
               static_cast<std::size_t>(node.x());
    }

    /// Distance at the node nearest to a place, and how far off that node is; none outside the
    /// table.
    struct Near {
        double there_mm;
        double off_mm;
    };
    [[nodiscard]] std::optional<Near> nearest_node(const Eigen::Vector3d& query) const {
        const Eigen::Vector3d scaled = (query - origin) / cell_mm;
        const Eigen::Array3i node = scaled.array().round().cast<int>();
        if ((node < 0).any() || (node >= nodes).any()) {
            return std::nullopt;
        }
        return Near{static_cast<double>(distance_mm[index(node)]),
                    (scaled - node.cast<double>().matrix()).norm() * cell_mm};
    }

    /// Upper bound of the distance to the nearest triangle; infinite where none is known.
    [[nodiscard]] double at_most_mm(const Eigen::Vector3d& query) const;

    /// True where a corner of the cell around a place proves that all triangles are further from
    /// it.
    [[nodiscard]] bool is_beyond(const Eigen::Vector3d& query, double distance) const;

    /// Radius about the Z axis beyond which, at this height, cells hold at least `need_mm`.
    /// Infinite where none is known.
    [[nodiscard]] double room_beyond_mm(double z_mm, double need_mm) const;

    /// Fills `room_from_mm`. \pre complete
    void find_room(double reach_mm);

private:
    [[nodiscard]] double radius_mm(int x, int y) const {
        return std::hypot(origin.x() + cell_mm * x, origin.y() + cell_mm * y);
    }
    /// Least distance within a cell, given by its node nearest to the origin of the table.
    [[nodiscard]] double least_mm(const Eigen::Array3i& cell) const;
};

}  // namespace meshwind
