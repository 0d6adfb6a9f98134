#include "geodesic/slip_and_bridging.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/small_linear.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Chords seen along one normal: over a turn of a rad to either side their angle is wrong by about
// a^2 / 6 of itself, here 4 %, half of what steering leaves free below the friction.
constexpr double kWindowTurn_rad = 0.5;

// Share of the friction that the scatter of the positions may add to a slip ratio: chords are made
// as long as that takes.
constexpr double kSlipScatter = 0.05;

// Shortest chords that are asked for and that count, in mean edges: in a fraction of an edge the
// scatter is that of the crossings themselves.
constexpr double kMinWindowEdges = 1.0;
constexpr double kMinChordEdges = 0.5;

// Sideways scatter of a traced path's positions over one edge, as a share of the edge (chordal sag
// is normal to the surface and does not count). Measured on irregular tori and cylinders of edges
// of r / 5 to r / 20: the walk stays below 2e-3, the tracer on patches below 2e-5.
double scatter_share(TraceMethod method) {
    return method == TraceMethod::Walk ? 2e-3 : 2e-5;
}

// Half length of chords that scatter by no more than the share of what friction holds.
double wanted_window_mm(double scatter_mm, double friction, double kn_per_mm, double edge_mm) {
    const double wanted =
        std::sqrt(4.0 * scatter_mm / (kSlipScatter * friction * std::abs(kn_per_mm)));
    return std::max(wanted, kMinWindowEdges * edge_mm);
}

// Height of the path over the straight line, and its slope after each station.
struct Profile {
    std::vector<double> height_mm;
    std::vector<double> slope;  // of the path at the station
};

Profile profile_of(const SurfacePath& path) {
    Profile profile{{0.0}, {0.0}};
    double slope = 0.0;
    double height = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double ds = path[i].s_mm - path[i - 1].s_mm;
        if (ds <= 0.0) {
            // A feature edge: the same place with the tangent of the other side.
            slope += path[i].tangent.dot(path[i - 1].normal);
        } else {
            const double k0 = path[i - 1].kn_per_mm;
            const double k1 = path[i].kn_per_mm;
            height += slope * ds - ds * ds * (2.0 * k0 + k1) / 6.0;
            slope -= 0.5 * (k0 + k1) * ds;
        }
        profile.height_mm.push_back(height);
        profile.slope.push_back(slope);
    }
    return profile;
}

// Indices of the upper hull of (s, height), first and last included.
std::vector<std::size_t> upper_hull(const SurfacePath& path, const std::vector<double>& height) {
    std::vector<std::size_t> hull;
    for (std::size_t i = 0; i < path.size(); ++i) {
        while (hull.size() >= 2) {
            const std::size_t a = hull[hull.size() - 2];
            const std::size_t b = hull.back();
            const double cross = (path[b].s_mm - path[a].s_mm) * (height[i] - height[a]) -
                                 (height[b] - height[a]) * (path[i].s_mm - path[a].s_mm);
            if (cross < 0.0) {
                break;
            }
            hull.pop_back();
        }
        hull.push_back(i);
    }
    return hull;
}

// A path rolled flat at its feature edges: what comes after an edge is turned about the crossing
// until the normals of both sides agree. A string pulled over the edge runs straight across it
// then.
struct UnfoldedPath {
    std::vector<Vector3d> position_mm;
    std::vector<Vector3d> tangent;
    std::vector<Vector3d> normal;
};

UnfoldedPath unfold(const SurfacePath& path) {
    UnfoldedPath flat;
    Eigen::Affine3d moved = Eigen::Affine3d::Identity();
    for (std::size_t i = 0; i < path.size(); ++i) {
        const PathPoint& point = path[i];
        if (i > 0 && point.s_mm <= path[i - 1].s_mm) {
            const Eigen::Quaterniond back = shortest_turn(point.normal, path[i - 1].normal);
            moved = moved * Eigen::Translation3d(point.position_mm) * back *
                    Eigen::Translation3d(-point.position_mm);
        }
        flat.position_mm.push_back(moved * point.position_mm);
        flat.tangent.push_back(moved.linear() * point.tangent);
        flat.normal.push_back(moved.linear() * point.normal);
    }
    return flat;
}

// Integral of |kn| over s up to each station.
std::vector<double> total_turn(const SurfacePath& path) {
    std::vector<double> total(path.size(), 0.0);
    for (std::size_t i = 1; i < path.size(); ++i) {
        total[i] =
            total[i - 1] + 0.5 * (std::abs(path[i - 1].kn_per_mm) + std::abs(path[i].kn_per_mm)) *
                               (path[i].s_mm - path[i - 1].s_mm);
    }
    return total;
}

// A place between two stations.
struct Between {
    std::size_t before;
    double share;
    double span_mm;
};

Between place_at(const SurfacePath& path, double s_mm) {
    const auto after = std::upper_bound(path.begin() + 1, path.end() - 1, s_mm,
                                        [](double s, const PathPoint& p) { return s < p.s_mm; });
    const auto i = static_cast<std::size_t>(after - path.begin());
    const double span = path[i].s_mm - path[i - 1].s_mm;
    const double share = span > 0.0 ? std::clamp((s_mm - path[i - 1].s_mm) / span, 0.0, 1.0) : 0.0;
    return {i - 1, share, span};
}

double linear(const std::vector<double>& values, const Between& at) {
    return values[at.before] + at.share * (values[at.before + 1] - values[at.before]);
}

// The cubic through values and slopes of the two stations.
template <typename Value>
Value cubic(const std::vector<Value>& values, const std::vector<Value>& slopes, const Between& at) {
    const double s = at.share;
    const double r = 1.0 - s;
    const Value chord = values[at.before + 1] - values[at.before];
    const Value bulge = r * (at.span_mm * slopes[at.before] - chord) +
                        s * (chord - at.span_mm * slopes[at.before + 1]);
    return values[at.before] + s * chord + s * r * bulge;
}

// What curvatures are measured on.
struct MeasuredPath {
    UnfoldedPath flat;
    std::vector<double> turned_rad;  // integral of |kn|, per station
    Profile fibre;                   // of the string
};

MeasuredPath measured_path(const SurfacePath& path, const TautString& string) {
    MeasuredPath measured{unfold(path), total_turn(path), profile_of(path)};
    for (std::size_t i = 0; i < path.size(); ++i) {
        measured.fibre.height_mm[i] += string.gap_mm[i];
        measured.fibre.slope[i] += string.slope[i];
    }
    return measured;
}

// The window at a station: as wide as wanted, but for the path's ends and what it turns by.
double window_mm_at(const SurfacePath& path, const std::vector<double>& turned_rad, std::size_t i,
                    double wanted_mm) {
    const double s = path[i].s_mm;
    const double widest = std::min({s, path.back().s_mm - s, wanted_mm});
    const double turn_rad = 0.5 * (linear(turned_rad, place_at(path, s + widest)) -
                                   linear(turned_rad, place_at(path, s - widest)));
    return widest * std::min(1.0, kWindowTurn_rad / turn_rad);
}

// Two places a window behind a station and ahead of it.
struct Window {
    double mm;
    Between behind;
    Between ahead;
};

// Geodesic curvature by the turn from chord to chord.
double chord_kg_per_mm(const UnfoldedPath& flat, std::size_t i, const Window& window) {
    const Vector3d& here = flat.position_mm[i];
    const Vector3d in = here - cubic(flat.position_mm, flat.tangent, window.behind);
    const Vector3d out = cubic(flat.position_mm, flat.tangent, window.ahead) - here;
    const Vector3d& n = flat.normal[i];
    const Vector3d flat_in = in - n * n.dot(in);
    const Vector3d flat_out = out - n * n.dot(out);
    const double turn = std::atan2(n.dot(flat_in.cross(flat_out)), flat_in.dot(flat_out));
    return turn / window.mm;
}

// Over the same chords as kg, with the same weights.
double chord_kn_per_mm(const Profile& fibre, std::size_t i, const Window& window) {
    return (2.0 * fibre.height_mm[i] - cubic(fibre.height_mm, fibre.slope, window.behind) -
            cubic(fibre.height_mm, fibre.slope, window.ahead)) /
           (window.mm * window.mm);
}

}  // namespace

TautString taut_string(const SurfacePath& path) {
    TautString string;
    string.gap_mm.assign(path.size(), 0.0);
    string.slope.assign(path.size(), 0.0);
    const Profile profile = profile_of(path);
    const std::vector<std::size_t> hull = upper_hull(path, profile.height_mm);
    for (std::size_t h = 0; h + 1 < hull.size(); ++h) {
        const std::size_t a = hull[h];
        const std::size_t b = hull[h + 1];
        if (b == a + 1) {
            continue;
        }
        const double rise =
            (profile.height_mm[b] - profile.height_mm[a]) / (path[b].s_mm - path[a].s_mm);
        for (std::size_t i = a + 1; i < b; ++i) {
            const double line = profile.height_mm[a] + rise * (path[i].s_mm - path[a].s_mm);
            string.gap_mm[i] = std::max(0.0, line - profile.height_mm[i]);
            string.slope[i] = rise - profile.slope[i];
            if (string.gap_mm[i] > string.worst_gap_mm) {
                string.worst_gap_mm = string.gap_mm[i];
                string.worst_station = i;
            }
        }
    }
    return string;
}

SlipMeasure measure_slip(const Surface& surface, const SurfacePath& path, const TautString& string,
                         const SlipOptions& options) {
    SlipMeasure measure;
    measure.slip.assign(path.size(), 0.0);
    measure.kg_per_mm.assign(path.size(), 0.0);
    measure.error.assign(path.size(), std::numeric_limits<double>::infinity());
    if (path.size() < 2) {
        return measure;
    }
    const double edge = surface.mean_edge_mm;
    const double scatter_mm = scatter_share(options.method) * edge;
    const double friction = std::max(options.friction, 1e-3);
    const MeasuredPath measured = measured_path(path, string);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const double s = path[i].s_mm;
        const double wanted = options.window_mm > 0.0
                                  ? options.window_mm
                                  : wanted_window_mm(scatter_mm, friction, path[i].kn_per_mm, edge);
        const double window = window_mm_at(path, measured.turned_rad, i, wanted);
        if (!(window > kMinChordEdges * edge)) {
            continue;
        }
        const Window around{window, place_at(path, s - window), place_at(path, s + window)};
        const double kg = chord_kg_per_mm(measured.flat, i, around);
        measure.kg_per_mm[i] = kg;
        if (string.gap_mm[i] > 0.0) {
            continue;  // lifted: nothing to slip on
        }
        const double kn = chord_kn_per_mm(measured.fibre, i, around);
        // Sideways scatter e at three points a window apart reads as a curvature of 4 e / window^2.
        const double noise_per_mm = 4.0 * scatter_mm / (window * window);
        const double straight_kn_per_mm = noise_per_mm / friction;
        measure.error[i] = noise_per_mm / std::max(kn, straight_kn_per_mm);
        if (kn < straight_kn_per_mm && std::abs(kg) <= noise_per_mm) {
            continue;
        }
        const double slip = std::abs(kg) / std::max(kn, straight_kn_per_mm);
        measure.slip[i] = slip;
        if (slip > measure.worst) {
            measure.worst = slip;
            measure.worst_station = i;
        }
    }
    return measure;
}

}  // namespace meshwind
