#include "winding/plan/piece.h"

#include <cmath>

#include <Eigen/Geometry>

namespace meshwind {
namespace {

// The cubic between two stations may turn from those left out by so much sideways, 0.03 deg: a
// tenth of what the laid fibre may.
constexpr double kTurned_rad = 5e-4;

// Whether the cubic between two stations runs along the wall as all stations between them do.
bool runs_along(const Piece& piece, std::size_t first, std::size_t last) {
    const PathPoint& a = piece.path[first];
    const PathPoint& b = piece.path[last];
    for (std::size_t i = first + 1; i < last; ++i) {
        const PathPoint& here = piece.path[i];
        const Eigen::Vector3d tangent =
            beside(a.position_mm, a.tangent, b.position_mm, b.tangent, here.position_mm).tangent;
        if (piece.string.gap_mm[i] == 0.0 &&
            std::abs(tangent.dot(here.normal.cross(here.tangent))) > kTurned_rad) {
            return false;
        }
    }
    return true;
}

}  // namespace

void thin_out(Piece& piece, double step_mm) {
    std::vector<std::size_t> kept{0};
    const std::size_t last = piece.path.size() - 1;
    for (std::size_t i = 1; i <= last; ++i) {
        if (!runs_along(piece, kept.back(), i)) {
            kept.push_back(i - 1);
        }
        const double s = piece.path[i].s_mm;
        const bool crease =
            s <= piece.path[i - 1].s_mm || (i < last && piece.path[i + 1].s_mm <= s);
        const bool lifted = piece.string.gap_mm[i] > 0.0;
        const bool contact = lifted != (piece.string.gap_mm[i - 1] > 0.0) ||
                             (i < last && lifted != (piece.string.gap_mm[i + 1] > 0.0));
        const bool room = piece.path[last].s_mm - s >= step_mm;
        if (i == last || crease || contact ||
            (room && s - piece.path[kept.back()].s_mm >= step_mm)) {
            kept.push_back(i);
        }
    }
    for (std::size_t k = 0; k < kept.size(); ++k) {
        piece.path[k] = piece.path[kept[k]];
        piece.slip[k] = piece.slip[kept[k]];
        piece.string.gap_mm[k] = piece.string.gap_mm[kept[k]];
        piece.string.slope[k] = piece.string.slope[kept[k]];
    }
    piece.path.resize(kept.size());
    piece.slip.resize(kept.size());
    piece.string.gap_mm.resize(kept.size());
    piece.string.slope.resize(kept.size());
}

std::vector<std::size_t> courses_of(std::span<const Piece> pieces) {
    std::vector<std::size_t> courses;
    std::size_t begun = 0;
    for (const Piece& piece : pieces) {
        begun += piece.kind == PieceKind::Course ? 1 : 0;
        courses.push_back(begun - 1);
    }
    return courses;
}

std::vector<std::span<const Piece>> fibres_of(std::span<const Piece> pieces) {
    std::vector<std::span<const Piece>> fibres;
    for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
        end = begin + 1;
        while (end < pieces.size() && !pieces[end].starts_fibre) {
            ++end;
        }
        fibres.push_back(pieces.subspan(begin, end - begin));
    }
    return fibres;
}

}  // namespace meshwind
