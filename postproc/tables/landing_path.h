/// Lays paths on the wall through landing points made elsewhere.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "geodesic/slip_and_bridging.h"
#include "geodesic/surface_path.h"
#include "mesh/ray_query.h"
#include "postproc/tables/landing_csv.h"

namespace meshwind {

struct LandingOptions {
    /// Transform of the table in its units to the mandrel frame in mm.
    Eigen::Affine3d mandrel_from_table = Eigen::Affine3d::Identity();
    /// > 0; points further off the wall are refused: they belong to another part or frame.
    double farthest_mm = 1.0;
    /// Each course is made as smooth as curves within this of its points are (smooth_course.h); 0:
    /// it passes through them.
    double smooth_mm = 0.0;
    std::string file;  ///< name for messages
};

/// Distances by which points were moved onto the wall.
struct LandingMoves {
    std::size_t points = 0;    ///< rows that were looked at, repeated ones among them
    std::size_t repeated = 0;  ///< rows left out: the same place as the row before
    double worst_mm = 0.0;
    double sum_mm = 0.0;       ///< over the points
    int worst_line = 0;        ///< of the file
    double smoothed_mm = 0.0;  ///< largest distance of a point on the wall from its course
};

/// Puts landing points on the curved patches of a wall and lays paths through them.
///
/// Each point goes to the nearest place of the wall. Its tangent is that of the parabola through
/// it and its two neighbours, (P3 - P2) d1 / d2 + (P2 - P1) d2 / d1 with the distances d1 and d2,
/// laid into the wall: second order at any spacing, where fu_2009_post_processing, sec. 1, takes
/// chords. At both ends it is that of the parabola through the three last points. Tangents of the
/// table take their place, for their source knows the path between the points; they must agree with
/// the parabola's within kTangentOff_rad. Two points that are twice kLandingStation_mm apart or
/// more get stations between them, on the cubic with their tangents, laid on the wall: all are less
/// than that apart, and a table of stations is left as it is. Normals and kn are the wall's, kg is
/// left at 0.
class LandingPaths {
public:
    /// \param wall outlives this
    LandingPaths(const Surface& wall, const LandingOptions& options);

    /// \throws InputError import.too_far, import.sparse, import.normal, import.tangent,
    /// import.empty, each with the line of the file
    [[nodiscard]] SurfacePath through(const LandingCourse& course);

    /// The taut string over a path from `through`, computed with stations kStringStation_mm apart:
    /// bridges begin and end between the path's stations, and the hollows that make them are seen
    /// there alone.
    /// \return one entry per station of the path; the worst gap is that of the dense path
    [[nodiscard]] TautString string_over(const SurfacePath& path) const;

    [[nodiscard]] const LandingMoves& moves() const { return moves_; }

private:
    struct Landing;

    [[nodiscard]] Landing landing_of(const LandingRow& row) const;
    [[nodiscard]] std::vector<std::vector<Landing>> stretches_of(const LandingCourse& course);
    [[nodiscard]] std::vector<Eigen::Vector3d> tangents_of(
        const std::vector<Landing>& stretch) const;
    void check_turns(const std::vector<Landing>& stretch,
                     const std::vector<Eigen::Vector3d>& tangents) const;
    void check_normal(const Landing& landing, const Eigen::Vector3d& normal) const;
    [[nodiscard]] SurfacePath path_of(const std::vector<Landing>& stretch, double start_mm);
    [[noreturn]] void fail(const char* code, int line, const std::string& words) const;

    const Surface& wall_;
    LandingOptions options_;
    RayQuery facets_;
    LandingMoves moves_;
};

/// Least distance of stations that are put between points: the distance to which planned courses
/// are thinned out, whose stations are apart by this plus up to a tracer's step.
inline constexpr double kLandingStation_mm = 4.0;

/// Distance of stations at which bridges are looked for: half of what a traced course has on the
/// faces of a fillet.
inline constexpr double kStringStation_mm = 1.0;

/// Largest turn of a fibre from point to point: through fewer points no curve is known.
inline constexpr double kMaxLandingTurn_rad = 0.8;

inline constexpr double kTangentOff_rad = 0.3;

/// Direction of travel at the middle of three points by the parabola through them, unit.
/// \pre neighbours differ
[[nodiscard]] Eigen::Vector3d parabola_tangent(const Eigen::Vector3d& before,
                                               const Eigen::Vector3d& here,
                                               const Eigen::Vector3d& after);

/// The same at the first of three points.
[[nodiscard]] Eigen::Vector3d parabola_end_tangent(const Eigen::Vector3d& here,
                                                   const Eigen::Vector3d& next,
                                                   const Eigen::Vector3d& after_next);

}  // namespace meshwind
