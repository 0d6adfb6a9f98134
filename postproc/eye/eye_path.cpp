#include "postproc/eye/eye_path.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/text/text_number.h"
#include "postproc/eye/repeated_path.h"

namespace meshwind {
namespace {

constexpr std::size_t kPointChunk = 256;

// A station's height of the fibre over the wall, and the wall's normal.
struct OverWall {
    double gap_mm;
    Eigen::Vector3d normal;
};

// Under a bridge the fibre runs straight from the place that it leaves to the one that it meets,
// which may be on another piece: there the eye goes on along this line. What is free of it begins
// only where it meets the wall again, so much `ahead_mm` of each station.
void straighten_bridges(std::span<const OverWall> wall, EyePath& points,
                        std::vector<double>& ahead_mm) {
    for (std::size_t first = 1; first + 1 < points.size(); ++first) {
        if (wall[first].gap_mm <= 0.0) {
            continue;
        }
        std::size_t end = first;
        while (end + 1 < points.size() && wall[end].gap_mm > 0.0) {
            ++end;
        }
        const EyePoint& from = points[first - 1];
        const EyePoint& to = points[end];
        const Eigen::Vector3d chord = to.landing_mm - from.landing_mm;
        ahead_mm[first - 1] = chord.norm();
        for (std::size_t i = first; i < end; ++i) {
            const double share = (points[i].s_mm - from.s_mm) / (to.s_mm - from.s_mm);
            points[i].landing_mm = from.landing_mm + share * chord;
            points[i].tangent = chord.normalized();
            ahead_mm[i] = (1.0 - share) * chord.norm();
            points[i].binormal = wall[i].normal.cross(chord).normalized();
        }
        first = end;
    }
}

// Lengths for the points. Where the wish is free all along it is taken, which is what
// the windows would lead to. The rules are one per piece.
FreeLengths free_lengths(std::span<const EyePoint> path, std::span<const double> ahead_mm,
                         const RayQuery& obstacles, std::span<const FreeFibreRule> rules,
                         double wish_mm, LengthSearch search) {
    const auto normal = [](const EyePoint& point) -> Eigen::Vector3d {
        return point.tangent.cross(point.binormal).normalized();
    };
    const auto rule = [&](const EyePoint& point) -> const FreeFibreRule& {
        return rules[static_cast<std::size_t>(point.piece)];
    };
    std::vector<char> free(path.size());
    parallel_for(path.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            free[i] = wish_mm >= rule(path[i]).min_mm + ahead_mm[i] &&
                              is_free_length(obstacles, path[i].landing_mm, normal(path[i]),
                                             path[i].tangent, rule(path[i]), wish_mm)
                          ? 1
                          : 0;
            if (free[i] == 0) {
                return;
            }
        }
    });
    if (std::find(free.begin(), free.end(), 0) == free.end()) {
        const std::vector<double> wish(path.size(), wish_mm);
        return {wish, wish, {}};
    }
    std::vector<double> s_mm(path.size());
    std::transform(path.begin(), path.end(), s_mm.begin(),
                   [](const EyePoint& point) { return point.s_mm; });
    const auto choose = [&](bool longer_too) {
        std::vector<std::vector<FreeFibreWindow>> windows(path.size());
        parallel_for(path.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                FreeFibreRule at_station = rule(path[i]);
                at_station.min_mm += ahead_mm[i];
                at_station.preferred_mm = longer_too ? at_station.max_mm : at_station.preferred_mm;
                windows[i] = free_fibre_windows(obstacles, path[i].landing_mm, normal(path[i]),
                                                path[i].tangent, at_station);
            }
        });
        return choose_free_lengths(s_mm, windows, wish_mm);
    };
    FreeLengths lengths = choose(false);
    // Where only long fibre is clear, it may have to be long before, where the wish is clear, too.
    if (!lengths.blocked.empty() && search == LengthSearch::All) {
        FreeLengths longer = choose(true);
        if (longer.blocked.empty()) {
            return longer;
        }
    }
    return lengths;
}

// Puts the eyes on their places; returns the points that are blocked.
std::vector<std::size_t> put_lengths(EyePath& path, std::span<const double> ahead_mm,
                                     const RayQuery& obstacles,
                                     std::span<const FreeFibreRule> rules, double wish_mm,
                                     LengthSearch search) {
    FreeLengths lengths = free_lengths(path, ahead_mm, obstacles, rules, wish_mm, search);
    for (std::size_t i = 0; i < path.size(); ++i) {
        set_eye(path[i], std::min(lengths.high_mm[i], std::max(lengths.low_mm[i], wish_mm)));
    }
    return std::move(lengths.blocked);
}

// A piece that stands for others keeps the most clearance that one of them asks for.
void share_clearance(const RepeatedPath& repeated, const EyePath& path,
                     std::span<FreeFibreRule> rules) {
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (i > 0 && path[i].piece == path[i - 1].piece) {
            continue;
        }
        const EyePoint& stands = repeated.few()[repeated.few_of(i)];
        double& clearance = rules[static_cast<std::size_t>(stands.piece)].clearance_mm;
        clearance =
            std::max(clearance, rules[static_cast<std::size_t>(path[i].piece)].clearance_mm);
    }
}

}  // namespace

LandingPoints landing_points(std::span<const Piece> pieces) {
    LandingPoints points;
    EyePath& path = points.path;
    std::vector<OverWall> wall;
    double laid_mm = 0.0;
    std::size_t stations = 0;
    for (const Piece& piece : pieces) {
        stations += piece.path.size();
    }
    path.reserve(stations);
    points.ahead_mm.reserve(stations);
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const Piece& piece = pieces[p];
        for (std::size_t i = 0; i < piece.path.size(); ++i) {
            const PathPoint& station = piece.path[i];
            EyePoint point;
            point.piece = static_cast<std::int32_t>(p);
            point.point = static_cast<std::int32_t>(i);
            point.s_mm = laid_mm + station.s_mm;
            point.landing_mm = station.position_mm;
            point.tangent = station.tangent;
            point.binormal = station.normal.cross(station.tangent);
            if (!piece.free_start.empty()) {
                const FreeStart& start = piece.free_start[i];
                point.landing_mm = start.from_mm;
                point.tangent = start.direction;
                point.binormal = station.normal.cross(start.direction).normalized();
                point.on_pins = true;
                point.held = start.held;
            }
            path.push_back(point);
            wall.push_back({piece.string.gap_mm[i], station.normal});
        }
        laid_mm += piece.path.back().s_mm;
    }
    points.ahead_mm.resize(path.size(), 0.0);
    straighten_bridges(wall, path, points.ahead_mm);
    return points;
}

void set_eye(EyePoint& point, double length_mm) {
    point.free_length_mm = length_mm;
    point.eye_mm = point.landing_mm + length_mm * point.tangent;
}

void measure_lengths(EyePathResult& result) {
    if (result.path.empty()) {
        return;
    }
    const auto [shortest, longest] = std::minmax_element(
        result.path.begin(), result.path.end(),
        [](const EyePoint& a, const EyePoint& b) { return a.free_length_mm < b.free_length_mm; });
    result.shortest_mm = shortest->free_length_mm;
    result.longest_mm = longest->free_length_mm;
}

EyePathResult adaptive_free_length(std::span<const Piece> pieces, const RayQuery& obstacles,
                                   const FreeFibreRule& rule,
                                   std::span<const double> more_clearance_mm, LengthSearch search) {
    EyePathResult result;
    EyePath& path = result.path;
    LandingPoints points = landing_points(pieces);
    path = std::move(points.path);
    // Long enough for every bridge, so that the length need not change for them.
    double bridge = 0.0;
    for (const double ahead : points.ahead_mm) {
        bridge = std::max(bridge, ahead);
    }
    const double wish = std::min(std::max(rule.preferred_mm, rule.min_mm + bridge), rule.max_mm);
    std::vector<FreeFibreRule> rules(pieces.size(), rule);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        rules[i].preferred_mm = wish;
        rules[i].clearance_mm += more_clearance_mm.empty() ? 0.0 : more_clearance_mm[i];
    }
    if (const std::optional<RepeatedPath> repeated = repetition_of(path, points.ahead_mm)) {
        EyePath few = repeated->few();
        share_clearance(*repeated, path, rules);
        const std::vector<std::size_t> blocked =
            put_lengths(few, repeated->few_ahead_mm(), obstacles, rules, wish, search);
        for (std::size_t i = 0; i < path.size() && !blocked.empty(); ++i) {
            if (std::binary_search(blocked.begin(), blocked.end(), repeated->few_of(i))) {
                result.blocked.push_back(i);
            }
        }
        path = repeated->all(std::move(path), few);
        for (EyePoint& point : path) {
            point.turn_rad = 0.0;  // yet to be chosen
        }
    } else {
        result.blocked = put_lengths(path, points.ahead_mm, obstacles, rules, wish, search);
    }
    if (!result.blocked.empty()) {
        result.words = "no free fibre length between " + fixed(rule.min_mm, 0) + " and " +
                       fixed(rule.max_mm, 0) + " mm is clear";
    }
    measure_lengths(result);
    result.ahead_mm = std::move(points.ahead_mm);
    return result;
}

std::vector<double> fibre_moved_mm(const EyePath& path) {
    std::vector<double> fibre_mm(path.size(), 0.0);
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double laid = path[i].s_mm - path[i - 1].s_mm;
        const double longer = path[i].free_length_mm - path[i - 1].free_length_mm;
        fibre_mm[i] = std::max(std::abs(laid), std::abs(laid + longer));
    }
    return fibre_mm;
}

}  // namespace meshwind
