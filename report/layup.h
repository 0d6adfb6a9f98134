/// The lay-up of a run on the triangles of its bare mandrel, measured once for all files that use
/// it.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "pipeline/wind.h"
#include "winding/laminate/plies.h"

namespace meshwind {

/// A ply in its triangle's frame.
struct LayupPly {
    std::size_t layer = 0;
    std::size_t fibre = 0;
    std::size_t course = 0;
    double share = 0.0;                 ///< of the triangle that is under the band, 0 .. 1
    double angle_rad = 0.0;             ///< from the triangle's axis, above -pi/2 up to pi/2
    double angle_to_spindle_rad = 0.0;  ///< 0 .. pi/2
};

/// Values per triangle, of one layer or of all.
struct LayupArrays {
    explicit LayupArrays(std::size_t faces)
        : layers(faces),
          thickness_mm(faces),
          spindle_deg(faces),
          winding_deg(faces),
          area_mm2(faces),
          covered(faces) {}

    std::vector<double> layers;
    std::vector<double> thickness_mm;
    std::vector<double> spindle_deg;  ///< mean angle of the plies to the spindle, 0 .. 90
    std::vector<double> winding_deg;  ///< and to the triangle's axis
    std::vector<double> area_mm2;
    std::vector<double> covered;        ///< share under any band
    std::vector<std::int32_t> samples;  ///< of coverage; of one layer only
};

/// The walls of a run, per triangle of the bare mandrel; empty where the job asks for none.
struct WallArrays {
    std::vector<double> asked_layers;
    std::vector<double> laid_layers;  ///< of all their stages
};

/// Lay-up of all layers.
class Layup {
public:
    /// \param run must outlive this; each of its layers has a plan
    explicit Layup(const Run& run);

    [[nodiscard]] const LayupArrays& all() const { return all_; }
    [[nodiscard]] const std::vector<LayupArrays>& each() const { return each_; }
    [[nodiscard]] const WallArrays& walls() const { return walls_; }

    /// Per triangle: its material axis 1, unit (winding/laminate/material_axes.h).
    [[nodiscard]] const std::vector<Eigen::Vector3d>& axes() const { return axes_; }

    /// Unit normal of a triangle of the bare mandrel, outward.
    [[nodiscard]] Eigen::Vector3d normal(std::size_t face) const;

    /// The plies of a triangle from the bottom to the top.
    [[nodiscard]] std::vector<LayupPly> plies(std::size_t face) const;

private:
    struct OfLayer {
        const Surface* surface;
        Plies plies;
        std::vector<std::pair<std::size_t, std::size_t>> place;  // per piece: fibre, course
    };

    [[nodiscard]] std::vector<LayupPly> plies_of_layer(std::size_t layer, std::size_t face) const;
    [[nodiscard]] LayupArrays arrays_of(const WoundLayer& layer, std::size_t number) const;
    void add_wall(const WoundWall& wall);
    void set_angles(std::size_t first, std::size_t last, LayupArrays& arrays) const;

    std::vector<Eigen::Vector3d> axes_;
    std::vector<OfLayer> layers_;
    LayupArrays all_;
    std::vector<LayupArrays> each_;
    WallArrays walls_;
};

}  // namespace meshwind
