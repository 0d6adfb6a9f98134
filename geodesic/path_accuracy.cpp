#include "geodesic/path_accuracy.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/units.h"
#include "geodesic/trace.h"
#include "mesh/smooth/corner_fit.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// In mean edges: longer paths cost more than half a second on fine meshes and tell no more.
constexpr double kMaxEdges = 500.0;

// In mean edges: a path cut shorter by rims has no drift to speak of.
constexpr double kMinEdges = 3.0;

// Rings of the wider fits, and how far paths on them are from paths on the usual ones, in errors
// that the usual fits cause: twice to seven times was measured on tori and cylinders.
constexpr int kWideRings = 3;
constexpr double kWideExcess = 3.0;

// On exact faces: how far the terms of degree 4 that patches of degree 3 lack lead paths aside, in
// errors of those that patches of degree 4 lack, beyond their ratio. Of an elbow and a torus:
// stated and true drift are as 0.6 and 2.7 to one with it, as 1.6 and 8 without.
constexpr double kQuarticExcess = 3.0;

// In mean edges: steps of a fourth-order scheme at which its error is below a percent of that of
// steps from edge to edge.
constexpr double kShortStep = 0.15;

// Faces across so many edges from a path get wider fits too, as paths on them go elsewhere.
constexpr int kMarginFaces = 2;

// Steps of a path: three times what one of kMaxEdges takes by short steps. Over triangles that are
// far smaller than the mean one a path ends after these, and is as long as it came.
constexpr int kMaxSteps = 10'000;

struct Start {
    SurfacePoint at;
    Vector3d direction;
};

// Fraction whose digits in `base` are those of `i`, mirrored: evenly spread for i = 1, 2, ...
double mirrored(int i, int base) {
    double value = 0.0;
    for (double digit = 1.0 / base; i > 0; i /= base, digit /= base) {
        value += digit * (i % base);
    }
    return value;
}

std::vector<Start> even_starts(const Surface& surface, int count) {
    std::vector<double> area_up_to(surface.face.size());
    double area = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const auto point = [&](std::size_t c) {
            return surface.position_mm[static_cast<std::size_t>(surface.face[f][c])];
        };
        area += (point(1) - point(0)).cross(point(2) - point(0)).norm();
        area_up_to[f] = area;
    }
    std::vector<Start> starts;
    for (int i = 1; i <= count; ++i) {
        const auto above =
            std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, area * (i - 0.5) / count);
        double u = mirrored(i, 3);
        double v = mirrored(i, 5);
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        Start start;
        start.at = {static_cast<std::int32_t>(above - area_up_to.begin()), {1.0 - u - v, u, v}};
        const double angle = 2.0 * kPi * mirrored(i, 2);
        const Vector3d normal = smooth_normal(surface, start.at);
        const Vector3d ahead = normal.unitOrthogonal();
        start.direction = std::cos(angle) * ahead + std::sin(angle) * normal.cross(ahead);
        starts.push_back(start);
    }
    return starts;
}

// A geodesic's end.
PathPoint end_of(const Surface& surface, const Start& start, const TraceOptions& options) {
    return trace(surface, start.at, start.direction, {}, options).path.back();
}

// Corners of the faces where the paths come, in order.
std::vector<std::int32_t> corners_near(const Surface& surface,
                                       const std::vector<TraceResult>& paths) {
    std::vector<char> marked(surface.face.size(), 0);
    std::vector<std::int32_t> near;
    const auto mark = [&](std::int32_t face) {
        if (face != kNoFace && marked[static_cast<std::size_t>(face)] == 0) {
            marked[static_cast<std::size_t>(face)] = 1;
            near.push_back(face);
        }
    };
    for (const TraceResult& traced : paths) {
        for (const PathPoint& point : traced.path) {
            mark(point.at.face);
        }
    }
    std::size_t begin = 0;
    for (int step = 0; step < kMarginFaces; ++step) {
        const std::size_t end = near.size();
        for (; begin < end; ++begin) {
            for (const std::int32_t next :
                 surface.neighbour[static_cast<std::size_t>(near[begin])]) {
                mark(next);
            }
        }
    }
    std::vector<std::int32_t> corners;
    for (const std::int32_t face : near) {
        const auto& of_face = surface.corner[static_cast<std::size_t>(face)];
        corners.insert(corners.end(), of_face.begin(), of_face.end());
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
}

Surface with_wider_fits(const Surface& surface, const std::vector<std::int32_t>& corners) {
    const std::vector<Jet> jets = fit_corners(surface, corners, kWideRings);
    Surface wide = surface;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        wide.jet[static_cast<std::size_t>(corners[i])] = jets[i].height;
        wide.normal[static_cast<std::size_t>(corners[i])] = jets[i].normal;
    }
    return wide;
}

// The surface without the terms from `first` on of these corners' polynomials.
Surface without_terms(Surface surface, const std::vector<std::int32_t>& corners,
                      std::size_t first) {
    for (const std::int32_t corner : corners) {
        auto& terms = surface.jet[static_cast<std::size_t>(corner)].coefficient;
        std::fill(terms.begin() + static_cast<std::ptrdiff_t>(first), terms.end(), 0.0);
    }
    return surface;
}

// Squares of drifts and lengths of paths.
struct Sum {
    double drift_mm2 = 0.0;
    double length_mm2 = 0.0;
    int paths = 0;

    Sum operator+(const Sum& other) const {
        return {drift_mm2 + other.drift_mm2, length_mm2 + other.length_mm2, paths + other.paths};
    }
    [[nodiscard]] double mm_per_m() const {
        return length_mm2 > 0.0 ? 1e3 * std::sqrt(drift_mm2 / length_mm2) : 0.0;
    }
};

template <typename Body>
void for_each_start(const std::vector<Start>& starts, const Body& body) {
    parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            body(i);
        }
    });
}

// Paths by patches: others are held against them.
struct BestPaths {
    const Surface& surface;
    std::vector<Start> starts;
    TraceOptions options;
    std::vector<TraceResult> traced;  // per start
};

BestPaths best_paths(const Surface& surface, int count, const TraceOptions& options) {
    BestPaths best{surface, even_starts(surface, count), options, {}};
    best.traced.resize(best.starts.size());
    for_each_start(best.starts, [&](std::size_t i) {
        best.traced[i] = trace(surface, best.starts[i].at, best.starts[i].direction, {}, options);
    });
    return best;
}

// Of the same paths on another surface or by other options.
Sum drifts(const BestPaths& best, const Surface& other_surface, const TraceOptions& options) {
    std::vector<Sum> sums(best.starts.size());
    for_each_start(best.starts, [&](std::size_t i) {
        PathPoint a = best.traced[i].path.back();
        TraceOptions same = options;
        same.max_length_mm = a.s_mm;
        const PathPoint b = end_of(other_surface, best.starts[i], same);
        if (b.s_mm < kMinEdges * best.surface.mean_edge_mm) {
            return;
        }
        if (b.s_mm < a.s_mm) {  // the other met a rim first
            TraceOptions shorter = best.options;
            shorter.max_length_mm = b.s_mm;
            a = end_of(best.surface, best.starts[i], shorter);
        }
        const Vector3d apart = b.position_mm - a.position_mm;
        sums[i] = {(apart - a.normal * a.normal.dot(apart)).squaredNorm(), a.s_mm * a.s_mm, 1};
    });
    return std::accumulate(sums.begin(), sums.end(), Sum{});
}

// What the terms that patches lack on exact faces lead paths aside by, from what those of degree 4
// and of degree 3 do.
double known_mm_per_m(const BestPaths& best, const std::vector<std::int32_t>& exact) {
    const Surface& surface = best.surface;
    const double cubic =
        drifts(best, without_terms(surface, exact, kJetX4), best.options).mm_per_m();
    const double square =
        drifts(best, without_terms(surface, exact, kJetX3), best.options).mm_per_m();
    const double quartic = square > 0.0 ? cubic * std::min(1.0, cubic / square) : 0.0;
    return quartic / kQuarticExcess;
}

}  // namespace

PathAccuracy estimate_path_accuracy(const Surface& surface, int count) {
    PathAccuracy accuracy;
    if (surface.face.empty()) {
        return accuracy;
    }
    accuracy.length_mm =
        std::min(diagonal_mm(surface.position_mm), kMaxEdges * surface.mean_edge_mm);
    const TraceOptions patches{.max_length_mm = accuracy.length_mm,
                               .max_faces = kMaxSteps,
                               .method = TraceMethod::Patches};
    const BestPaths best = best_paths(surface, count, patches);
    const Sum walk = drifts(best, surface, {.max_faces = kMaxSteps, .method = TraceMethod::Walk});
    std::vector<std::int32_t> fitted = corners_near(surface, best.traced);
    const auto known = std::stable_partition(
        fitted.begin(), fitted.end(),
        [&](std::int32_t corner) { return surface.exact[static_cast<std::size_t>(corner)] == 0; });
    const std::vector<std::int32_t> exact(known, fitted.end());
    fitted.erase(known, fitted.end());
    const Sum wide = drifts(best, with_wider_fits(surface, fitted), patches);
    TraceOptions short_steps = patches;
    short_steps.max_step_mm = kShortStep * surface.mean_edge_mm;
    const Sum steps = drifts(best, surface, short_steps);
    accuracy.paths = walk.paths;
    accuracy.walk_mm_per_m = walk.mm_per_m();
    accuracy.patches_mm_per_m = std::hypot(wide.mm_per_m() / kWideExcess, steps.mm_per_m());
    if (!exact.empty()) {
        accuracy.patches_mm_per_m =
            std::hypot(accuracy.patches_mm_per_m, known_mm_per_m(best, exact));
    }
    return accuracy;
}

}  // namespace meshwind
