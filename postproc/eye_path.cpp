#include "postproc/eye_path.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "winding/library.h"

namespace meshwind {
namespace {

constexpr std::size_t kPointChunk = 256;

EyePath landing_points(std::span<const Piece> pieces) {
    EyePath path;
    double laid_mm = 0.0;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const Piece& piece = pieces[p];
        for (std::size_t i = 0; i < piece.path.size(); ++i) {
            const PathPoint& station = piece.path[i];
            const StringPoint fibre =
                string_point(station, piece.string.gap_mm[i], piece.string.slope[i]);
            EyePoint point;
            point.piece = static_cast<std::int32_t>(p);
            point.point = static_cast<std::int32_t>(i);
            point.s_mm = laid_mm + station.s_mm;
            point.landing_mm = fibre.position_mm;
            point.tangent = fibre.tangent;
            point.binormal = station.normal.cross(station.tangent);
            path.push_back(point);
        }
        laid_mm += piece.path.back().s_mm;
    }
    return path;
}

// Lowers `value` (raises it for `sign` -1) until it changes by at most kFreeLengthRate per mm of
// fibre. Where a new fibre is tied on, the length is free to jump.
void limit_rate(const EyePath& path, std::span<const Piece> pieces, std::vector<double>& value,
                double sign) {
    const auto tied_on = [&](std::size_t i) {
        return path[i].point == 0 && pieces[static_cast<std::size_t>(path[i].piece)].starts_fibre;
    };
    const auto pull = [&](std::size_t from, std::size_t to) {
        const double reach =
            value[from] + sign * kFreeLengthRate * std::abs(path[to].s_mm - path[from].s_mm);
        if (sign * value[to] > sign * reach) {
            value[to] = reach;
        }
    };
    for (std::size_t i = 1; i < path.size(); ++i) {
        if (!tied_on(i)) {
            pull(i - 1, i);
        }
    }
    for (std::size_t i = path.size(); i-- > 1;) {
        if (!tied_on(i)) {
            pull(i, i - 1);
        }
    }
}

}  // namespace

EyePathResult equal_free_length(std::span<const Piece> pieces, const RayQuery& obstacles,
                                const FreeFibreRule& rule) {
    EyePathResult result;
    EyePath& path = result.path;
    path = landing_points(pieces);
    const double wish = std::clamp(rule.preferred_mm, rule.min_mm, rule.max_mm);
    std::vector<double> low(path.size(), rule.min_mm);
    std::vector<double> high(path.size(), rule.max_mm);
    std::vector<char> blocked(path.size(), 0);
    parallel_for(path.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector3d normal = path[i].tangent.cross(path[i].binormal).normalized();
            const FreeFibreWindow window =
                free_fibre_window(obstacles, path[i].landing_mm, normal, path[i].tangent, rule);
            blocked[i] = window.empty() ? 1 : 0;
            if (!window.empty()) {
                low[i] = window.low_mm;
                high[i] = window.high_mm;
            }
        }
    });
    limit_rate(path, pieces, low, -1.0);
    limit_rate(path, pieces, high, 1.0);
    for (std::size_t i = 0; i < path.size(); ++i) {
        EyePoint& point = path[i];
        if (low[i] > high[i]) {
            blocked[i] = 1;
        }
        point.free_length_mm = std::min(high[i], std::max(low[i], wish));
        point.eye_mm = point.landing_mm + point.free_length_mm * point.tangent;
        result.shortest_mm =
            i == 0 ? point.free_length_mm : std::min(result.shortest_mm, point.free_length_mm);
        result.longest_mm = std::max(result.longest_mm, point.free_length_mm);
        if (blocked[i] != 0) {
            result.blocked.push_back(i);
        }
    }
    return result;
}

}  // namespace meshwind
