#include "report/picture/preview_bands.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/units.h"
#include "report/picture/preview_colours.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Bands are drawn with so many stretches across, and stations at least this share of a width apart.
constexpr int kAcross = 4;
constexpr double kAlong = 0.2;

// Of the wall across the fibre, > 0 convex; no band is bent by more than a right angle.
double curvature_per_mm(const Surface& surface, const PathPoint& station, const Vector3d& side,
                        double width_mm) {
    const std::size_t face = at(station.at.face);
    if (face >= surface.face.size()) {
        return 0.0;
    }
    double curvature = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Matrix3d& shape = surface.shape_operator_per_mm[at(surface.corner[face][i])];
        curvature += station.at.bary[static_cast<Eigen::Index>(i)] * side.dot(shape * side);
    }
    const double most = kPi / width_mm;
    return std::clamp(curvature, -most, most);
}

// A row of vertices across the band, on the circle that the wall curves in there.
void add_station(const Surface& surface, const PathPoint& station, double gap_mm, double width_mm,
                 const Vector3f& colour, PreviewMesh& bands) {
    const Vector3d side = station.normal.cross(station.tangent);
    const double curvature =
        gap_mm > 0.0 ? 0.0 : curvature_per_mm(surface, station, side, width_mm);
    for (int k = 0; k <= kAcross; ++k) {
        const double across = 2.0 * k / kAcross - 1.0;
        const double u = 0.5 * width_mm * across;
        const double turn = curvature * u;
        // (sin, 1 - cos) / curvature, also where it is 0.
        const double half = 0.5 * turn;
        const double sinc = std::abs(half) > 1e-6 ? std::sin(half) / half : 1.0;
        const double out = u * sinc * std::cos(half);
        const double down = u * sinc * std::sin(half);
        bands.position_mm.emplace_back(
            (station.position_mm + (gap_mm - down) * station.normal + out * side).cast<float>());
        bands.normal.emplace_back(
            (std::cos(turn) * station.normal + std::sin(turn) * side).cast<float>());
        bands.colour.push_back(colour);
        bands.across.push_back(static_cast<float>(across));
    }
}

void join_stations(PreviewMesh& bands) {
    constexpr std::int32_t kRow = kAcross + 1;
    const auto end = static_cast<std::int32_t>(bands.position_mm.size());
    for (std::int32_t k = 0; k < kAcross; ++k) {
        const std::int32_t here = end - kRow + k;
        const std::int32_t there = here - kRow;
        bands.face.push_back({there, here, here + 1});
        bands.face.push_back({there, here + 1, there + 1});
    }
}

// \param colour_at of a station of the piece
void add_band(const Surface& surface, const Piece& piece, double width_mm,
              const std::function<Vector3f(std::size_t)>& colour_at, PreviewMesh& bands) {
    std::size_t before = 0;
    bool begun = false;
    for (std::size_t i = 0; i < piece.path.size(); ++i) {
        const PathPoint& station = piece.path[i];
        const bool last = i + 1 == piece.path.size();
        if (begun && !last && station.s_mm - piece.path[before].s_mm < kAlong * width_mm) {
            continue;
        }
        add_station(surface, station, piece.string.gap_mm[i], width_mm, colour_at(i), bands);
        if (begun) {
            join_stations(bands);
        }
        before = i;
        begun = true;
    }
}

Vector3f slip_colour(const WoundLayer& layer, const Piece& piece, std::size_t i) {
    return scale_colour(piece.slip[i] / std::max(1e-9, layer.setup.friction.holds()));
}

Vector3f angle_colour(const Piece& piece, std::size_t i) {
    const double axial = std::min(1.0, std::abs(piece.path[i].tangent.z()));
    return scale_colour(std::acos(axial) / (0.5 * kPi));
}

// Turns are paler.
Vector3f piece_colour(std::size_t course, PieceKind kind) {
    Vector3f colour = course_colour(course);
    if (kind == PieceKind::Transition) {
        colour = 0.55F * colour + 0.45F * linear_colour(0xC8C8C8);
    }
    return colour;
}

void add_bands(const WoundLayer& layer, double width_mm, PreviewColour colour, PreviewMesh& bands) {
    const std::vector<std::size_t> course = courses_of(layer.plan.pieces);
    for (std::size_t p = 0; p < layer.plan.pieces.size(); ++p) {
        const Piece& piece = layer.plan.pieces[p];
        const Vector3f one_colour = piece_colour(course[p], piece.kind);
        const auto colour_at = [&](std::size_t i) -> Vector3f {
            return colour == PreviewColour::Course ? one_colour
                   : colour == PreviewColour::Slip ? slip_colour(layer, piece, i)
                                                   : angle_colour(piece, i);
        };
        add_band(layer.setup.wall->surface(), piece, width_mm, colour_at, bands);
    }
}

}  // namespace

PreviewMesh preview_bands(std::span<const WoundLayer> layers, PreviewColour colour) {
    PreviewMesh bands;
    const double width_mm = layers.front().setup.job.tow.width_mm;
    for (const WoundLayer& layer : layers) {
        add_bands(layer, width_mm, colour, bands);
    }
    return bands;
}

}  // namespace meshwind
