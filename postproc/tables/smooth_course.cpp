#include "postproc/tables/smooth_course.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "core/index.h"
#include "core/roots.h"
#include "postproc/tables/landing_path.h"
#include "postproc/tables/wall_place.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Sparse = Eigen::SparseMatrix<double>;

// The linear problem is solved again on the moved curve so often at most, or until no station moves
// by more.
constexpr int kMaxPasses = 8;
constexpr double kStill_mm = 1e-4;

// Weight of the points against the integral, 1 / mm^7 each: from none to where stations some mm
// apart stay on them; found to a hundredth of a decade.
constexpr double kMinWeight_log = -16.0;
constexpr double kMaxWeight_log = 2.0;
constexpr int kHalvings = 11;

// With fewer stations no curvature changes.
constexpr std::size_t kFewest = 5;

// The second derivative of what is sideways at station j, by its neighbours.
struct Second {
    double before = 0.0, here = 0.0, after = 0.0;

    Second(double h1, double h2)
        : before(2.0 / (h1 * (h1 + h2))), here(-2.0 / (h1 * h2)), after(2.0 / (h2 * (h1 + h2))) {}
};

double step_mm(const SurfacePath& path, std::size_t j) {
    return (path[j + 1].position_mm - path[j].position_mm).norm();
}

Vector3d side(const PathPoint& at) {
    return at.normal.cross(at.tangent);
}

// The change of the curvature from one inner station to the next, weighed.
struct CurvatureChange {
    Sparse rates;  // by the moves of the inner stations to their sides
    Eigen::VectorXd change;
};

CurvatureChange curvature_change(const SurfacePath& path) {
    const auto n = static_cast<Eigen::Index>(path.size() - 2);
    std::vector<Eigen::Triplet<double>> entries;
    CurvatureChange found{Sparse(n - 1, n), Eigen::VectorXd(n - 1)};
    std::vector<Second> second;
    std::vector<double> kg;
    for (std::size_t j = 1; j + 1 < path.size(); ++j) {
        const double h1 = step_mm(path, j - 1);
        const double h2 = step_mm(path, j);
        second.emplace_back(h1, h2);
        const Vector3d bent = second.back().before * path[j - 1].position_mm +
                              second.back().here * path[j].position_mm +
                              second.back().after * path[j + 1].position_mm;
        kg.push_back(bent.dot(side(path[j])));
    }
    for (Eigen::Index row = 0; row + 1 < n; ++row) {
        const Second& here = second[static_cast<std::size_t>(row)];
        const Second& next = second[static_cast<std::size_t>(row + 1)];
        const double weight = 1.0 / std::sqrt(step_mm(path, static_cast<std::size_t>(row + 1)));
        const auto add = [&](Eigen::Index column, double value) {
            if (column >= 0 && column < n) {  // the ends stay
                entries.emplace_back(row, column, weight * value);
            }
        };
        add(row - 1, -here.before);
        add(row, next.before - here.here);
        add(row + 1, next.here - here.after);
        add(row + 2, next.after);
        found.change[row] =
            weight * (kg[static_cast<std::size_t>(row + 1)] - kg[static_cast<std::size_t>(row)]);
    }
    found.rates.setFromTriplets(entries.begin(), entries.end());
    return found;
}

// Stations of the course that were given as points.
struct GivenPoints {
    std::span<const std::size_t> station;
    std::vector<Vector3d> point_mm{};  // on the wall
};

GivenPoints given_points(const SurfacePath& path, std::span<const std::size_t> stations) {
    GivenPoints given{stations};
    for (const std::size_t i : stations) {
        given.point_mm.push_back(path[i].position_mm);
    }
    return given;
}

// Per inner station.
struct PointOffsets {
    Eigen::VectorXd is_point;  // 1 or 0
    Eigen::VectorXd off_mm;    // to the side of its point
};

PointOffsets point_offsets(const SurfacePath& path, const GivenPoints& given) {
    const auto n = static_cast<Eigen::Index>(path.size() - 2);
    PointOffsets offsets{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    for (std::size_t k = 0; k < given.station.size(); ++k) {
        const PathPoint& at = path[given.station[k]];
        const Eigen::Index row = static_cast<Eigen::Index>(given.station[k]) - 1;
        if (row >= 0 && row < n) {
            offsets.is_point[row] = 1.0;
            offsets.off_mm[row] = (at.position_mm - given.point_mm[k]).dot(side(at));
        }
    }
    return offsets;
}

// The moves to the side that make the curve smoothest for the least weight of the points that keeps
// all of them within the tolerance.
Eigen::VectorXd smoothest_mm(const CurvatureChange& curvature, const PointOffsets& offsets,
                             double tolerance_mm) {
    const Sparse& rates = curvature.rates;
    const Eigen::VectorXd& is_point = offsets.is_point;
    const Eigen::VectorXd& off_mm = offsets.off_mm;
    const Sparse smooth = rates.transpose() * rates;
    const Eigen::VectorXd wanted = rates.transpose() * curvature.change;
    Eigen::SimplicialLDLT<Sparse> solver;
    Sparse all = smooth;
    all.diagonal() += is_point;
    solver.analyzePattern(all);
    const auto solve = [&](double weight_log) {
        const double weight = std::pow(10.0, weight_log);
        all = smooth;
        all.diagonal() += weight * is_point;
        solver.factorize(all);
        return Eigen::VectorXd(solver.solve(-wanted - weight * is_point.cwiseProduct(off_mm)));
    };
    const auto furthest_mm = [&](const Eigen::VectorXd& u) {
        return is_point.cwiseProduct(off_mm + u).cwiseAbs().maxCoeff();
    };
    Eigen::VectorXd best = solve(kMaxWeight_log);
    const auto keeps_all = [&](double weight_log) {
        Eigen::VectorXd u = solve(weight_log);
        const bool kept = u.allFinite() && furthest_mm(u) <= tolerance_mm;
        if (kept) {
            best = std::move(u);
        }
        return kept;
    };
    halve({.holds = kMaxWeight_log, .fails = kMinWeight_log}, kHalvings, keeps_all);
    return best;
}

Vector3d in_wall(const PathPoint& at, const Vector3d& direction) {
    return (direction - direction.dot(at.normal) * at.normal).normalized();
}

// Of the circle that the chord and the turn between the tangents make.
double arc_mm(const PathPoint& from, const PathPoint& to) {
    const double chord_mm = (to.position_mm - from.position_mm).norm();
    const double half_rad = 0.5 * std::acos(std::clamp(from.tangent.dot(to.tangent), -1.0, 1.0));
    return half_rad > 1e-6 ? chord_mm * half_rad / std::sin(half_rad) : chord_mm;
}

// Moves the inner stations to their sides, over the wall.
void move_stations(const Surface& wall, const RayQuery& facets, const Eigen::VectorXd& sideways_mm,
                   SurfacePath& path) {
    std::vector<FieldWalker> places;
    for (std::size_t j = 1; j + 1 < path.size(); ++j) {
        const double u = sideways_mm[static_cast<Eigen::Index>(j) - 1];
        places.push_back(wall_place(wall, facets, path[j].position_mm + u * side(path[j])));
    }
    std::vector<Vector3d> at_mm{path.front().position_mm};
    for (const FieldWalker& place : places) {
        at_mm.push_back(place.position_mm());
    }
    at_mm.push_back(path.back().position_mm);
    const std::size_t last = at_mm.size() - 1;
    path.front().tangent =
        in_wall(path.front(), parabola_end_tangent(at_mm[0], at_mm[1], at_mm[2]));
    for (std::size_t j = 1; j < last; ++j) {
        path[j] = places[j - 1].station(parabola_tangent(at_mm[j - 1], at_mm[j], at_mm[j + 1]));
    }
    path.back().tangent =
        in_wall(path.back(), -parabola_end_tangent(at_mm[last], at_mm[last - 1], at_mm[last - 2]));
    for (std::size_t j = 1; j <= last; ++j) {
        path[j].s_mm = path[j - 1].s_mm + arc_mm(path[j - 1], path[j]);
    }
}

// How far the given points are off the course at most.
double worst_off_mm(const SurfacePath& path, const GivenPoints& given) {
    double worst_mm = 0.0;
    for (std::size_t k = 0; k < given.station.size(); ++k) {
        const PathPoint& at = path[given.station[k]];
        const Vector3d off = given.point_mm[k] - at.position_mm;
        worst_mm = std::max(worst_mm, (off - off.dot(at.tangent) * at.tangent).norm());
    }
    return worst_mm;
}

}  // namespace

double smooth_course(const Surface& wall, const RayQuery& facets,
                     std::span<const std::size_t> given, double tolerance_mm, SurfacePath& path) {
    const GivenPoints points = given_points(path, given);
    for (int pass = 0; pass < kMaxPasses && path.size() >= kFewest; ++pass) {
        const Eigen::VectorXd sideways_mm =
            smoothest_mm(curvature_change(path), point_offsets(path, points), tolerance_mm);
        move_stations(wall, facets, sideways_mm, path);
        if (sideways_mm.cwiseAbs().maxCoeff() <= kStill_mm) {
            break;
        }
    }
    return worst_off_mm(path, points);
}

}  // namespace meshwind
