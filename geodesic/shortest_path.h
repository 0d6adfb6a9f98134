/// Exact shortest paths over the flat facets from one source to many targets (CGAL).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"

namespace meshwind {

/// A shortest way over the facets, which may bend at vertices of negative curvature and at rims.
struct PolyhedralPath {
    std::vector<Eigen::Vector3d> points_mm;  ///< n >= 2: source, every edge crossing, target
    double length_mm = 0.0;                  ///< sum of the n - 1 chords
};

/// The tree of shortest ways from one source, built once: superlinear in the number of triangles
/// and with much memory (bench/connect_bench.cpp), then a target costs next to nothing.
class ShortestPaths {
public:
    /// \pre source.face is a face of `surface`, bary >= 0; `surface` outlives the tree
    ShortestPaths(const Surface& surface, const SurfacePoint& source);
    ~ShortestPaths();
    ShortestPaths(ShortestPaths&&) noexcept;
    ShortestPaths& operator=(ShortestPaths&&) noexcept;

    /// Shortest way to `target`; one of them where several are equally short; none where the
    /// target lies on another piece of the surface. \pre target.face is a face of the surface
    /// Accuracy: exact to rounding (tests/geodesic/connect_order_test.cpp), but for a source on an
    /// edge, which is moved by 1e-6 of the edge: CGAL's ways from rims were up to 8 % too long.
    /// Source: xin_2009_exact_geodesics.
    [[nodiscard]] std::optional<PolyhedralPath> to(const SurfacePoint& target);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace meshwind
