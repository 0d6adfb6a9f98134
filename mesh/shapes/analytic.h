/// Nearest points on the ideal shapes, the references for made meshes and traced paths.
#pragma once

#include <Eigen/Core>

#include "mesh/shapes/shapes.h"

namespace meshwind {

/// The smooth piece a point belongs to.
enum class ShapePart { Run, Branch, Blend, Cylinder, Cone, Dome, Leg, Bend };

/// Nearest point of an ideal surface. The surface is taken without its ends: cylinders are
/// infinite.
struct ShapeFoot {
    Eigen::Vector3d point_mm;
    Eigen::Vector3d normal;    ///< unit, outward
    double distance_mm = 0.0;  ///< of the asked point, > 0 outside
    ShapePart part = ShapePart::Run;
};

/// Transforms a place into the frame of a tee's branch, and back: x along the branch's axis, y
/// across, z towards its lean. Without a lean both change nothing. \pre |lean| < pi / 2
[[nodiscard]] Eigen::Vector3d seen_from_branch(const TeeShape& shape, const Eigen::Vector3d& p);
[[nodiscard]] Eigen::Vector3d seen_from_run(const TeeShape& shape, const Eigen::Vector3d& p);

/// Centre of the blend's ball at angle `psi_rad` around the branch axis, from the direction of its
/// lean (+z) to +y. \pre shape is valid
[[nodiscard]] Eigen::Vector3d tee_spine_mm(const TeeShape& shape, double psi_rad);

/// Cross section of the blend on the ball there: from `to_run`, where it touches the run, to
/// `to_branch`; unit, seen from its centre.
struct BlendArc {
    Eigen::Vector3d centre_mm;
    Eigen::Vector3d to_run;
    Eigen::Vector3d to_branch;

    /// \param share of the way from the run to the branch
    [[nodiscard]] Eigen::Vector3d direction(double share) const {
        return ((1.0 - share) * to_run + share * to_branch).normalized();
    }
};
[[nodiscard]] BlendArc blend_arc(const TeeShape& shape, double psi_rad);

/// Nearest point of the tee's surface to `point_mm`.
/// \pre shape is valid; the point is nearer to the surface than half the smallest radius (farther
/// away another piece may be nearer). Accuracy: 1e-9 mm on parts of some 100 mm;
/// tests/mesh/shapes/make_tee_test.cpp.
[[nodiscard]] ShapeFoot tee_foot(const TeeShape& shape, const Eigen::Vector3d& point_mm);

/// The same for a wye and a cross; the stem and one half of the run are the Run, the other pipes
/// Branches; tests/mesh/shapes/make_star_test.cpp.
[[nodiscard]] ShapeFoot wye_foot(const WyeShape& shape, const Eigen::Vector3d& point_mm);
[[nodiscard]] ShapeFoot cross_foot(const CrossShape& shape, const Eigen::Vector3d& point_mm);

/// Nearest point of the other shapes. Two pieces equally near (on a bisector of a sharp ring): the
/// lower. \pre shape is valid; the point is not on the axis or a centre line Accuracy: 1e-9 mm in
/// distance on parts of some 100 mm; tests/mesh/shapes/analytic_test.cpp.
[[nodiscard]] ShapeFoot cylinder_foot(const CylinderShape& shape, const Eigen::Vector3d& point_mm);
[[nodiscard]] ShapeFoot cone_foot(const ConeShape& shape, const Eigen::Vector3d& point_mm);
[[nodiscard]] ShapeFoot vessel_foot(const VesselShape& shape, const Eigen::Vector3d& point_mm);
[[nodiscard]] ShapeFoot isotensoid_foot(const IsotensoidShape& shape,
                                        const Eigen::Vector3d& point_mm);
[[nodiscard]] ShapeFoot combination_foot(const CombinationShape& shape,
                                         const Eigen::Vector3d& point_mm);
[[nodiscard]] ShapeFoot ellipsoid_foot(const EllipsoidShape& shape,
                                       const Eigen::Vector3d& point_mm);
[[nodiscard]] ShapeFoot elbow_foot(const ElbowShape& shape, const Eigen::Vector3d& point_mm);
[[nodiscard]] ShapeFoot torus_foot(const TorusShape& shape, const Eigen::Vector3d& point_mm);

}  // namespace meshwind
