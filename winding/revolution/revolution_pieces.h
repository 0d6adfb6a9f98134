/// Stations of a meridian's path as pieces of a plan on the mandrel's mesh.
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
    /// All are kept by reference. \param rule its friction is what pieces are judged by
    RevolutionPieces(const Mandrel& mandrel, const BodyOfRevolution& body, const TurnRule& rule);

    /// The stations, turned about +Z, with the faces under them: they stay on the body that the
    /// meridian sweeps, from which the mesh is off by BodyOfRevolution::residual_mm. Slip is
    /// measured, where the fibre is on the wall.
    [[nodiscard]] Piece course(const std::vector<MeridianStation>& stations, double turn_rad) const;

    /// Over the rim of an end, from where a course leaves it to where the next one comes back.
    /// \pre both can be turned (can_turn)
    [[nodiscard]] LaidTurn turn(std::size_t end, const RimCrossing& from,
                                const RimCrossing& to) const;

    /// The end of a fibre behind a hollow rim, so far on along the extension (turn.h).
    [[nodiscard]] LaidTurn run_out(std::size_t end, const RimCrossing& from,
                                   double length_mm) const;

    /// Distance of the stations of passes: by the radius of the body, or of a rim that is no
    /// opening of a dome, where that is less.
    [[nodiscard]] double station_mm() const { return station_mm_; }

    /// Of an end; none at a pole.
    [[nodiscard]] const Rim* rim_of(std::size_t end) const;

    /// How a path over an end's rim crosses it. \param place its first or last station; seen
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
