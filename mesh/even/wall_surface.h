/// The wall of a part as a frozen surface to project on, and the lines that bound and cross it.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/ray_query.h"
#include "mesh/smooth/smooth_shape.h"
#include "mesh/surface.h"

namespace meshwind {

/// \param kept per region: whether it is wall
/// \return frozen; its faces are those of the wall in the part's order
[[nodiscard]] Surface frozen_wall(const LabelledMesh& part, const std::vector<char>& kept);

/// Largest principal curvature per vertex, 1/mm, the median over a vertex and its neighbours: one
/// wrong fit has no effect.
[[nodiscard]] std::vector<double> vertex_curvatures_per_mm(const Surface& surface);

/// Points of a wall's smooth surface nearest to given ones. Thread-safe.
class WallProjection {
public:
    /// \pre `surface` outlives this
    explicit WallProjection(const Surface& surface);

    struct Foot {
        std::int32_t face = -1;
        Eigen::Vector3d bary = Eigen::Vector3d::Zero();
        Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  ///< on the smooth surface
    };
    [[nodiscard]] bool has(std::int32_t region) const { return part_.count(region) != 0; }
    /// \param region of the surface: only its faces count
    [[nodiscard]] Foot nearest(const Eigen::Vector3d& point, std::int32_t region) const;

    [[nodiscard]] const SmoothShape& shape() const { return shape_; }

private:
    struct Part {
        std::unique_ptr<RayQuery> query;
        std::vector<std::int32_t> face;  // of the surface
    };
    const Surface& surface_;
    SmoothShape shape_;
    std::map<std::int32_t, Part> part_;
    double reach_mm_ = 0.0;
};

/// A chain of edges along which a wall ends or has a crease, from corner to corner; a closed one
/// has its first vertex as corner. Positions are lengths along its chords.
class WallLine {
public:
    /// An edge of a face of the frozen wall.
    struct Step {
        std::int32_t face = 0;
        std::int32_t edge = 0;
        bool backward = false;  ///< the line runs from the edge's end to its start
        double length_mm = 0.0;
    };
    explicit WallLine(std::vector<Step> steps);

    [[nodiscard]] double length_mm() const { return begin_mm_.back(); }
    /// Point on the curve through the line's vertices. \param way_mm clamped to the line
    [[nodiscard]] Eigen::Vector3d at(const SmoothShape& shape, double way_mm) const;

private:
    std::vector<Step> steps_;
    std::vector<double> begin_mm_;  // n + 1
};

}  // namespace meshwind
