/// Curved patches over triangles: the smooth surface that the mesh approximates.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mesh/surface.h"

namespace meshwind {

/// A place on a patch with the derivatives that a path needs.
struct PatchPlace {
    Eigen::Vector3d position_mm;
    Eigen::Vector3d along_u;  ///< derivative by u, mm
    Eigen::Vector3d along_v;  ///< derivative by v, mm
    Eigen::Vector3d second_uu;
    Eigen::Vector3d second_uv;
    Eigen::Vector3d second_vv;

    /// Unit, outward.
    [[nodiscard]] Eigen::Vector3d normal() const { return along_u.cross(along_v).normalized(); }

    /// First and second derivative along given rates of u and v.
    [[nodiscard]] Eigen::Vector3d along(const Eigen::Vector2d& rates) const {
        return rates.x() * along_u + rates.y() * along_v;
    }
    [[nodiscard]] Eigen::Vector3d second(const Eigen::Vector2d& rates) const {
        return rates.x() * rates.x() * second_uu + 2.0 * rates.x() * rates.y() * second_uv +
               rates.y() * rates.y() * second_vv;
    }
};

/// Each corner's height polynomial lifts the facet's point onto the surface about that corner; the
/// three lifted points are averaged with the barycentric coordinates (1 - u - v, u, v) as weights.
/// Both triangles of an edge see the same two corners there: patches meet without a gap, and with
/// the same normal up to the error of the fits. On a feature edge, where the two sides have
/// different polynomials, both follow the cubic between the crease's tangents at its two ends, of
/// sixth order on a circle; where that would close a corner between two creases, the chord. Where
/// both sides are exact and have the same normals, as at borders of CAD faces, they are left as
/// they are. A face that lies on a known cylinder, and is bent to no feature edge, is that
/// cylinder: the facet's point is moved square to the axis. Accuracy against the smooth surface,
/// for fits of degree four: position fifth order, normal fourth, curvature third in the edge length
/// (tests/mesh/smooth/patch_test.cpp).
class Patch {
public:
    /// \pre face is a face of `surface`, which outlives the patch
    Patch(const Surface& surface, std::int32_t face);

    /// \param uv barycentric coordinates of the second and the third corner
    [[nodiscard]] PatchPlace at(const Eigen::Vector2d& uv) const;

    /// Whether a normal is plausible over this triangle: within 60 deg of the facet's. Fits on far
    /// too coarse a mesh may turn a patch over. False for NaN.
    [[nodiscard]] bool holds(const Eigen::Vector3d& normal) const;

    /// Whether the surface is known at its corners, not fitted.
    [[nodiscard]] bool is_exact() const { return exact_; }

    /// Largest curvature of the fits at the corners, 1/mm.
    [[nodiscard]] double curvature_per_mm() const;

    /// Chord of the shortest feature edge to which the patch is bent; infinite where there is none.
    [[nodiscard]] double shortest_crease_mm() const;

private:
    // The facet seen from a corner's frame: place = origin + u along_u + v along_v.
    struct Corner {
        const HeightJet* jet;
        Eigen::Vector3d origin_mm, along_u, along_v;
    };
    // A feature edge from corner `from` to corner `to`: its tangents at both ends, chord long.
    struct Crease {
        std::size_t from, to;
        Eigen::Vector3d tangent_from, tangent_to;
    };
    struct EdgeCurve;

    [[nodiscard]] PatchPlace on_cylinder(const Eigen::Vector2d& uv) const;
    void add_crease(const Surface& surface, std::int32_t face, std::size_t edge);
    [[nodiscard]] EdgeCurve gap_at(const Crease& crease, double share) const;
    void bend_to_crease(const Crease& crease, const Eigen::Vector2d& uv, PatchPlace& place) const;

    std::array<Eigen::Vector3d, 3> position_mm_;
    std::array<Corner, 3> corner_;
    std::array<Crease, 3> crease_;
    std::size_t creases_ = 0;
    bool exact_ = true;
    const KnownCylinder* cylinder_ = nullptr;  ///< none: the corners' polynomials
};

/// The point of the patch over a facet's point.
[[nodiscard]] PatchPlace on_patch(const Surface& surface, std::int32_t face,
                                  const Eigen::Vector3d& bary);

}  // namespace meshwind
