/// Winds a wall to a wanted thickness in stages: the demand on each, and the result after the last.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "mesh/mandrel.h"
#include "pipeline/job/job.h"
#include "postproc/verify/check.h"
#include "winding/laminate/stage_ask.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// A region of the mandrel with its missing thickness.
struct ThinRegion {
    std::int32_t region = -1;
    double below_share = 0.0;                         ///< of the region's wall in reach
    double most_lacking_mm = 0.0;                     ///< at its thinnest place
    Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  ///< that place, on the bare mandrel
};

/// Figures of the laid wall against the wanted one. Ratios are those of a place's layers to the
/// layers asked for there; all are shares of the wall.
struct WallFigures {
    double asked_layers = 0.0;  ///< on average
    double reachable = 0.0;     ///< share that some course passes
    double below_share = 0.0;   ///< of the reachable wall, with a ratio below 1
    double mean_ratio = 0.0;
    double cv = 0.0;            ///< standard deviation of the ratio over its mean
    double p1_ratio = 0.0;      ///< 99 % of the reachable wall has at least this ratio
    double fibre_mm = 0.0;      ///< turns included
    double turn_share = 0.0;    ///< of the fibre
    double fibre_factor = 0.0;  ///< the fibre over that of the asked layers without gap and overlap
    double least_factor = 0.0;  ///< no plan of single courses has less (winding/bound/); 0: unknown
    int stages = 0;
    std::vector<ThinRegion> thin;  ///< by region, the largest lack first
};

/// Places spread evenly over the bare wall, with the layers asked for and laid at each.
struct WallPlaces {
    std::vector<SurfacePoint> at;
    std::vector<std::int32_t> asked;
    std::vector<std::int32_t> laid;
};

class WallStages {
public:
    /// \param bare mandrel under the wall \param index of a layer of kind Wall
    /// \throws InputError job.wall_thin, job.no_region, job.no_rim, job.wall_place with the place
    /// in the job
    WallStages(const Mandrel& bare, const Job& job, std::size_t index, std::uint64_t seed,
               const std::filesystem::path& job_file);

    /// Whether as many stages are laid as the thickness takes; later ones fill thin places.
    [[nodiscard]] bool laid() const { return stages_ >= planned_stages_; }

    [[nodiscard]] int stages() const { return stages_; }

    /// Layers asked of the stages so far, where most is asked for.
    [[nodiscard]] double layers_so_far() const {
        return static_cast<double>(most_asked_) * stages_ / planned_stages_;
    }

    /// Whether no more is asked for, or further stages would not help.
    [[nodiscard]] bool done() const;

    /// Demand on the next stage. \pre !done()
    [[nodiscard]] StageAsk next() const;

    /// Records a laid stage. \param surface under it, with the triangles of the bare one
    void enter(const Surface& surface, const Plan& plan);

    [[nodiscard]] WallFigures figures() const;

    /// Per triangle of the bare wall: layers asked for at its middle.
    [[nodiscard]] const std::vector<std::int32_t>& asked_of_faces() const {
        return asked_of_faces_;
    }

private:
    [[nodiscard]] AskedPlaces asked_of(const WallPlaces& places) const;
    [[nodiscard]] bool in_reach(std::size_t judged) const {
        return reached_[static_cast<std::size_t>(nearest_[judged])] != 0;
    }
    void note_reach(const Plan& plan);
    [[nodiscard]] double below_share() const;
    [[nodiscard]] std::vector<ThinRegion> thin_regions() const;

    std::vector<std::int32_t> asked_of_faces_;
    std::vector<std::int32_t> region_;          // per judged place
    std::vector<Eigen::Vector3d> position_mm_;  // per judged place, on the bare wall
    double tow_width_mm_;
    double tow_thickness_mm_;
    double most_below_;
    double area_mm2_;
    WallPlaces measured_;
    WallPlaces weighed_;
    WallPlaces judged_;  // further ones, so that figures are not taken where the plan was made
    std::vector<char> reached_;          // per measured place
    std::vector<std::int32_t> nearest_;  // per judged place: the measured one that is nearest
    std::int32_t most_asked_ = 1;
    int planned_stages_ = 1;
    int stages_ = 0;
    bool in_vain_ = false;  // the last stage brought no place to its wanted layers
    double fibre_mm_ = 0.0;
    double turns_mm_ = 0.0;
    double least_mm_ = 0.0;
};

/// Checks that a layer of kind Wall is possible on its mandrel. \throws as WallStages does
void require_wall(const Mandrel& bare, const Job& job, std::size_t index,
                  const std::filesystem::path& job_file);

/// Check "wall": at most a share of the reachable wall is below the wanted layers.
[[nodiscard]] Check wall_check(const WallFigures& figures, double most_below);

}  // namespace meshwind
