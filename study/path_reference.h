/// Reference paths for traced ones: fibre paths of constant slip ratio on a surface known
/// otherwise.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "geodesic/trace.h"
#include "mesh/ray_query.h"
#include "mesh/shapes/make_kinds.h"

namespace meshwind {

/// A point of a curve. Mandrel frame; the direction is unit.
struct CurveState {
    Eigen::Vector3d position_mm;
    Eigen::Vector3d tangent;
};

/// A curve as points with directions by arc length, cubic (Hermite) between them.
struct ReferencePath {
    std::vector<double> s_mm;  ///< ascending from 0, n >= 2
    std::vector<CurveState> states;

    [[nodiscard]] double length_mm() const { return s_mm.back(); }
    /// \pre 0 <= s <= length_mm()
    [[nodiscard]] CurveState at(double s) const;
};

/// The surface point nearest to a point near the surface, and its unit outward normal.
struct SurfaceFoot {
    Eigen::Vector3d point_mm;
    Eigen::Vector3d normal;
};

/// A surface and its fibre paths with kg = slip_ratio kn.
class PathReference {
public:
    PathReference() = default;
    virtual ~PathReference() = default;
    PathReference(const PathReference&) = delete;
    PathReference& operator=(const PathReference&) = delete;

    [[nodiscard]] virtual SurfaceFoot foot(const Eigen::Vector3d& near_mm) const = 0;

    /// \param start on the surface, its tangent in the surface
    /// \return the path up to `length_mm`, or to a rim before that
    [[nodiscard]] virtual ReferencePath follow(const CurveState& start, double slip_ratio,
                                               double length_mm) const = 0;
};

/// Closed form on an endless cylinder around z: along a path of constant slip ratio the cotangent
/// of the winding angle is linear in arc length. Source: andrianov_2022_machine_path.
[[nodiscard]] std::unique_ptr<PathReference> cylinder_reference(double radius_mm);

/// Runge-Kutta-Fehlberg 7(8) with exact normals and curvatures: torus and spheroid around z.
/// Accuracy: 1e-10 of the length; tests/study/path_reference_test.cpp.
[[nodiscard]] std::unique_ptr<PathReference> torus_reference(const TorusShape& shape);
[[nodiscard]] std::unique_ptr<PathReference> ellipsoid_reference(const EllipsoidShape& shape);

/// The same on any kind of `meshwind make`: normals of mandrel_foot, curvature by differences of
/// them. Accuracy: 1e-6 of the length, on a surface whose curvature jumps too (the tee);
/// tests/study/path_reference_test.cpp.
[[nodiscard]] std::unique_ptr<PathReference> made_reference(std::string kind, MakeValues values);

/// Traces on a mesh, for surfaces without a better reference.
/// \param surface must outlive the reference
[[nodiscard]] std::unique_ptr<PathReference> mesh_reference(const Surface& surface,
                                                            const TraceOptions& options);

/// The triangles of a surface for queries, and the surface point nearest to a point near it.
[[nodiscard]] RayQuery query_of(const Surface& surface);
[[nodiscard]] SurfacePoint nearest_point(const RayQuery& query, const Eigen::Vector3d& near_mm);

/// Start of a trace that begins at a point of the ideal surface: the facet's point nearest to it
/// for TraceMethod::Walk, the one whose patch lies there for TraceMethod::Patches (to 1e-9 of an
/// edge; the nearest one is off by the third order in the edge length).
[[nodiscard]] SurfacePoint start_at(const Surface& surface, const RayQuery& query,
                                    const Eigen::Vector3d& point_mm, TraceMethod method);

}  // namespace meshwind
