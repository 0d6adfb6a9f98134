/// Pieces of a plan's fibre: courses, and the transitions between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geodesic/surface_path.h"

namespace meshwind {

enum class PieceKind { Course, Transition };

/// Start of the straight free fibre that leads to the eye, where that is not the place where the
/// fibre is laid but the flank of a pin ahead (pin_turn.h).
struct FreeStart {
    Eigen::Vector3d from_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
    bool held = false;  ///< a pin says where the fibre is laid, not the eye
};

/// A stretch of the fibre in winding order. Stations are in the direction of travel, mandrel frame.
struct Piece {
    PieceKind kind = PieceKind::Course;
    SurfacePath path;
    TautString string;  ///< where the fibre is over the path
    std::vector<double>
        slip;  ///< per station, |kg / kn|: measured on courses, exact on transitions
    double worst_slip = 0.0;
    std::vector<FreeStart> free_start{};  ///< per station of a turn on pins; else empty
    std::int32_t start_rim = -1;
    std::int32_t end_rim = -1;
    bool starts_fibre = false;  ///< tied on before this piece
};

/// Removes stations: those left are at least `step_mm` apart, or as many as give the direction in
/// between to 0.03 deg. Kept are both ends, both sides of a feature edge, and the stations on
/// either side of a place where the fibre leaves the wall or meets it again.
void thin_out(Piece& piece, double step_mm);

/// Per piece the number of its course in winding order: its own, or of the one before the turn.
[[nodiscard]] std::vector<std::size_t> courses_of(std::span<const Piece> pieces);

/// The pieces of each fibre, in order.
[[nodiscard]] std::vector<std::span<const Piece>> fibres_of(std::span<const Piece> pieces);

}  // namespace meshwind
