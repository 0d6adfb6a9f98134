#include "postproc/tables/landing_path.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "geodesic/field_walk.h"
#include "postproc/tables/smooth_course.h"
#include "postproc/tables/wall_place.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Rows nearer to the row before say nothing of a direction: tables have 4 decimals or fewer.
constexpr double kRepeated_mm = 0.1;

// Where the normals of two rows at one place differ by more, they are the two sides of an edge.
constexpr double kEdge_rad = 0.1;

// A normal that is given must be within this of the wall's: on the same side of a wall, facets and
// fits differ by far less.
constexpr double kNormalCosine = 0.5;

// Ends of stretches lie on edges and rims, where two faces are as near: the one is taken that is
// under a place so far, as a share of the way, towards the next point.
constexpr double kInward = 0.05;

// Furthest from the origin that a place is looked for: 1000 km.
constexpr double kFarAway_mm = 1e9;

// The cubic between two places whose tangents are as long as their chord.
struct Cubic {
    Vector3d from, chord, in, out;

    Cubic(const Vector3d& a, const Vector3d& a_tangent, const Vector3d& b,
          const Vector3d& b_tangent)
        : from(a),
          chord(b - a),
          in(chord.norm() * a_tangent - chord),
          out(chord - chord.norm() * b_tangent) {}

    [[nodiscard]] Vector3d place(double s) const {
        const double r = 1.0 - s;
        return from + s * chord + s * r * (r * in + s * out);
    }
    [[nodiscard]] Vector3d rate(double s) const {
        const double r = 1.0 - s;
        return chord + (r - s) * (r * in + s * out) + s * r * (out - in);
    }
    [[nodiscard]] double length_mm(double from_share, double to_share) const {
        const double middle = rate(0.5 * (from_share + to_share)).norm();
        return (to_share - from_share) *
               (rate(from_share).norm() + 4.0 * middle + rate(to_share).norm()) / 6.0;
    }
};

TriangleSoup facets_of(const Surface& wall) {
    return {wall.position_mm, wall.face};
}

}  // namespace

Vector3d parabola_tangent(const Vector3d& before, const Vector3d& here, const Vector3d& after) {
    const double d1 = (here - before).norm();
    const double d2 = (after - here).norm();
    return ((after - here) * (d1 / d2) + (here - before) * (d2 / d1)).normalized();
}

Vector3d parabola_end_tangent(const Vector3d& here, const Vector3d& next,
                              const Vector3d& after_next) {
    const double d1 = (next - here).norm();
    const double d2 = (after_next - next).norm();
    const Vector3d first = (next - here) / d1;
    const Vector3d second = (after_next - next) / d2;
    return (first - (d1 / (d1 + d2)) * (second - first)).normalized();
}

// A row on the wall.
struct LandingPaths::Landing {
    int line;
    Vector3d position_mm;
    double moved_mm;
    std::optional<Vector3d> normal;  // as given, mandrel frame, unit
    std::optional<Vector3d> tangent;
};

LandingPaths::LandingPaths(const Surface& wall, const LandingOptions& options)
    : wall_(wall), options_(options), facets_([&] {
          const TriangleSoup soup = facets_of(wall);
          return RayQuery({&soup, 1});
      }()) {}

void LandingPaths::fail(const char* code, int line, const std::string& words) const {
    throw InputError(code, options_.file + ":" + std::to_string(line), words);
}

LandingPaths::Landing LandingPaths::landing_of(const LandingRow& row) const {
    const Vector3d given = options_.mandrel_from_table * row.position;
    if (!(given.norm() < kFarAway_mm)) {
        fail("import.too_far", row.line, "the point lies beyond any part; give one near it");
    }
    const FieldWalker walker = wall_place(wall_, facets_, given);
    Landing landing{row.line, walker.position_mm(), (walker.position_mm() - given).norm(), {}, {}};
    if (landing.moved_mm > options_.farthest_mm) {
        fail("import.too_far", row.line,
             "the point is " + fixed(landing.moved_mm, 3) + " mm off the mandrel, more than " +
                 fixed(options_.farthest_mm, 3) +
                 " mm; is it this mandrel, and is --frame right? --within allows more");
    }
    const auto turned = [&](const Vector3d& direction) -> Vector3d {
        return (options_.mandrel_from_table.linear() * direction).normalized();
    };
    if (row.normal) {
        landing.normal = turned(*row.normal);
    }
    if (row.tangent) {
        landing.tangent = turned(*row.tangent);
    }
    return landing;
}

// The course between sharp edges, each stretch without repeats.
std::vector<std::vector<LandingPaths::Landing>> LandingPaths::stretches_of(
    const LandingCourse& course) {
    std::vector<std::vector<Landing>> stretches{{}};
    for (const LandingRow& row : course.rows) {
        Landing landing = landing_of(row);
        ++moves_.points;
        moves_.sum_mm += landing.moved_mm;
        if (landing.moved_mm > moves_.worst_mm || moves_.worst_line == 0) {
            moves_.worst_mm = landing.moved_mm;
            moves_.worst_line = row.line;
        }
        std::vector<Landing>& stretch = stretches.back();
        if (stretch.empty() ||
            (landing.position_mm - stretch.back().position_mm).norm() >= kRepeated_mm) {
            stretch.push_back(std::move(landing));
        } else if (landing.normal && stretch.back().normal &&
                   landing.normal->dot(*stretch.back().normal) < std::cos(kEdge_rad)) {
            stretches.push_back({std::move(landing)});
        } else {
            ++moves_.repeated;
        }
    }
    for (const std::vector<Landing>& stretch : stretches) {
        if (stretch.size() < 2) {
            fail("import.empty", stretch.front().line,
                 "course " + course.name +
                     " has no second point at another place here; give two at least");
        }
    }
    return stretches;
}

// Directions of travel at the points of a stretch.
std::vector<Vector3d> LandingPaths::tangents_of(const std::vector<Landing>& stretch) const {
    const std::size_t n = stretch.size();
    const auto p = [&](std::size_t k) -> const Vector3d& { return stretch[k].position_mm; };
    if (n == 2) {
        return std::vector<Vector3d>(2, (p(1) - p(0)).normalized());
    }
    std::vector<Vector3d> tangents{parabola_end_tangent(p(0), p(1), p(2))};
    for (std::size_t i = 1; i + 1 < n; ++i) {
        tangents.push_back(parabola_tangent(p(i - 1), p(i), p(i + 1)));
    }
    tangents.emplace_back(-parabola_end_tangent(p(n - 1), p(n - 2), p(n - 3)));
    check_turns(stretch, tangents);
    for (std::size_t i = 0; i < n; ++i) {
        if (const auto& given = stretch[i].tangent) {
            const double off_rad = std::acos(std::clamp(given->dot(tangents[i]), -1.0, 1.0));
            if (off_rad > kTangentOff_rad) {
                fail("import.tangent", stretch[i].line,
                     "the tangent is " + fixed(deg_from_rad(off_rad), 1) +
                         " deg from the way that the points take; give directions of travel in "
                         "the frame of the points, or leave them out");
            }
            tangents[i] = *given;
        }
    }
    return tangents;
}

void LandingPaths::check_turns(const std::vector<Landing>& stretch,
                               const std::vector<Vector3d>& tangents) const {
    const std::size_t n = stretch.size();
    for (std::size_t i = 1; i < n; ++i) {
        const double turn = std::acos(std::clamp(tangents[i - 1].dot(tangents[i]), -1.0, 1.0));
        if (turn > kMaxLandingTurn_rad) {
            fail("import.sparse", stretch[i].line,
                 "the fibre turns by " + fixed(deg_from_rad(turn), 1) +
                     " deg since the point before, more than " +
                     fixed(deg_from_rad(kMaxLandingTurn_rad), 1) +
                     " deg; give the points in order and closer together");
        }
    }
}

// On an edge the wall has two normals: that of the station counts.
void LandingPaths::check_normal(const Landing& landing, const Vector3d& normal) const {
    if (!landing.normal || landing.normal->dot(normal) >= kNormalCosine) {
        return;
    }
    const double off_rad = std::acos(std::clamp(landing.normal->dot(normal), -1.0, 1.0));
    fail("import.normal", landing.line,
         "the normal is " + fixed(deg_from_rad(off_rad), 1) +
             " deg from that of the mandrel there; give outward normals of this mandrel, or leave "
             "them out");
}

SurfacePath LandingPaths::path_of(const std::vector<Landing>& stretch, double start_mm) {
    const std::vector<Vector3d> tangents = tangents_of(stretch);
    SurfacePath path;
    std::vector<std::size_t> rows{0};  // their stations
    double s_mm = start_mm;
    const auto add = [&](const FieldWalker& place, const Vector3d& tangent) {
        path.push_back(place.station(tangent));
        path.back().s_mm = s_mm;
    };
    const auto at = [&](const Vector3d& place_mm) { return wall_place(wall_, facets_, place_mm); };
    const auto at_row = [&](std::size_t i) {
        FieldWalker best = at(stretch[i].position_mm);
        for (const std::size_t neighbour : {i - 1, i + 1}) {
            const Vector3d& here_mm = stretch[i].position_mm;
            FieldWalker side = at(here_mm + kInward * (stretch[neighbour].position_mm - here_mm));
            if (stretch[i].normal && side.move_under(here_mm) &&
                side.normal().dot(*stretch[i].normal) > best.normal().dot(*stretch[i].normal)) {
                best = side;
            }
        }
        return best;
    };
    const auto add_end = [&](const Landing& end, const Landing& next, const Vector3d& tangent) {
        const FieldWalker inside =
            at(end.position_mm + kInward * (next.position_mm - end.position_mm));
        FieldWalker here = inside;
        const bool same_side = here.move_under(end.position_mm) &&
                               here.normal().dot(inside.normal()) > std::cos(kEdge_rad);
        add(same_side ? here : inside, tangent);
        path.back().position_mm = end.position_mm;
        check_normal(end, path.back().normal);
    };
    add_end(stretch[0], stretch[1], tangents[0]);
    for (std::size_t i = 1; i < stretch.size(); ++i) {
        const Cubic cubic(stretch[i - 1].position_mm, tangents[i - 1], stretch[i].position_mm,
                          tangents[i]);
        const double row_mm = s_mm;
        const double whole_mm = cubic.length_mm(0.0, 1.0);
        const int parts = std::max(1, static_cast<int>(whole_mm / kLandingStation_mm));
        for (int k = 1; k < parts; ++k) {
            const double share = static_cast<double>(k) / parts;
            s_mm = row_mm + cubic.length_mm(0.0, share);
            add(at(cubic.place(share)), cubic.rate(share));
        }
        s_mm = row_mm + whole_mm;
        if (i + 1 < stretch.size()) {
            add(at_row(i), tangents[i]);
            check_normal(stretch[i], path.back().normal);
        } else {
            add_end(stretch[i], stretch[i - 1], tangents[i]);
        }
        rows.push_back(path.size() - 1);
    }
    if (options_.smooth_mm > 0.0) {
        const double off_mm = smooth_course(wall_, facets_, rows, options_.smooth_mm, path);
        moves_.smoothed_mm = std::max(moves_.smoothed_mm, off_mm);
    }
    return path;
}

SurfacePath LandingPaths::through(const LandingCourse& course) {
    SurfacePath path;
    for (const std::vector<Landing>& stretch : stretches_of(course)) {
        const SurfacePath next = path_of(stretch, path.empty() ? 0.0 : path.back().s_mm);
        path.insert(path.end(), next.begin(), next.end());
    }
    return path;
}

TautString LandingPaths::string_over(const SurfacePath& path) const {
    SurfacePath dense;
    std::vector<std::size_t> station;  // of the path, by station of the dense one
    for (std::size_t i = 0; i < path.size(); ++i) {
        const double before_mm = i > 0 ? path[i - 1].s_mm : path[i].s_mm;
        const double whole_mm = path[i].s_mm - before_mm;
        const int parts = std::max(1, static_cast<int>(std::ceil(whole_mm / kStringStation_mm)));
        for (int k = 1; k < parts; ++k) {
            const Cubic cubic(path[i - 1].position_mm, path[i - 1].tangent, path[i].position_mm,
                              path[i].tangent);
            const double share = static_cast<double>(k) / parts;
            dense.push_back(
                wall_place(wall_, facets_, cubic.place(share)).station(cubic.rate(share)));
            dense.back().s_mm = before_mm + share * whole_mm;
            station.push_back(i);
        }
        dense.push_back(path[i]);
        station.push_back(i);
    }
    const TautString all = taut_string(dense);
    TautString string;
    string.worst_gap_mm = all.worst_gap_mm;
    string.worst_station = station[all.worst_station];
    for (std::size_t k = 0; k < dense.size(); ++k) {
        if (k + 1 == dense.size() || station[k] != station[k + 1]) {
            string.gap_mm.push_back(all.gap_mm[k]);
            string.slope.push_back(all.slope[k]);
        }
    }
    return string;
}

}  // namespace meshwind
