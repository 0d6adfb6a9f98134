/// Makes pieces of a plan on the mandrel's mesh from paths by the meridian.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/mandrel.h"
#include "mesh/revolution/revolution.h"
#include "winding/plan/assemble.h"
#include "winding/plan/plan.h"
#include "winding/revolution/meridian_path.h"
#include "winding/revolution/mesh_projection.h"
#include "winding/turn/turn.h"

namespace meshwind {

/// The lower end of a body is 0, the upper 1. Const functions are thread-safe.
class RevolutionPieces {
public:
    /// All are kept by reference. \param rule pieces are judged by its friction
    RevolutionPieces(const Mandrel& mandrel, const BodyOfRevolution& body, const TurnRule& rule);

    /// A course of stations, turned about +Z, with the faces under them: they stay on the body that
    /// the meridian sweeps, from which the mesh is off by BodyOfRevolution::residual_mm. Slip is
    /// measured, where the fibre is on the wall.
    [[nodiscard]] Piece course(const std::vector<MeridianStation>& stations, double turn_rad) const;

    /// The turn over the rim of an end, from where a course leaves it to where the next one comes
    /// back.
    /// \pre both can be turned (can_turn)
    [[nodiscard]] LaidTurn turn(std::size_t end, const RimCrossing& from,
                                const RimCrossing& to) const;

    /// The end of a fibre behind a hollow rim, `length_mm` on along the extension (turn.h).
    [[nodiscard]] LaidTurn run_out(std::size_t end, const RimCrossing& from,
                                   double length_mm) const;

    /// Distance of the stations of passes: by the radius of the body, or of a rim that is no
    /// opening of a dome, where that is less.
    [[nodiscard]] double station_mm() const { return station_mm_; }

    /// The rim of an end; null at a pole.
    [[nodiscard]] const Rim* rim_of(std::size_t end) const;

    /// The crossing of a path over an end's rim. \param place its first or last station; seen
    /// backwards where the path comes from there
    [[nodiscard]] RimCrossing crossing_of(std::size_t end, const MeridianStation& place,
                                          double turn_rad) const;

private:
    [[nodiscard]] Piece with_ends_in_air(const std::vector<MeridianStation>& stations,
                                         const SurfacePath& path, std::size_t begin,
                                         std::size_t end) const;

    const Mandrel& mandrel_;
    const BodyOfRevolution& body_;
    const TurnRule& rule_;
    MeshProjection projection_;
    double station_mm_ = kPatternStation_mm;
};

}  // namespace meshwind
