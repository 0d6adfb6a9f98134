#include "postproc/tables/smooth_course.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "core/index.h"
#include "postproc/tables/landing_path.h"
#include "postproc/tables/wall_place.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Sparse = Eigen::SparseMatrix<double>;

// The linear problem is solved again on the moved curve so often at most, or until no station moves
// by more.
constexpr int kMostPasses = 8;
constexpr double kStill_mm = 1e-4;

// Weight of the points against the integral, 1 / mm^7 each: from none to where stations some mm
// apart stay on them; found to a hundredth of a decade.
constexpr double kLeastWeight_log = -16.0;
constexpr double kMostWeight_log = 2.0;
constexpr int kHalvings = 11;

// With fewer stations no curvature changes.
constexpr std::size_t kFewest = 5;

// The second derivative of what is sideways at station j, by its neighbours.
struct Second {
    double before = 0.0, here = 0.0, after = 0.0;

    Second(double h1, double h2)
        : before(2.0 / (h1 * (h1 + h2))), here(-2.0 / (h1 * h2)), after(2.0 / (h2 * (h1 + h2))) {}
};

class Smoothing {
public:
    Smoothing(const Surface& wall, const RayQuery& facets, std::span<const std::size_t> given,
              double tolerance_mm, SurfacePath& path)
        : wall_(wall), facets_(facets), given_(given), tolerance_mm_(tolerance_mm), path_(path) {
        for (const std::size_t i : given) {
            point_mm_.push_back(path[i].position_mm);
        }
    }

    double run() {
        for (int pass = 0; pass < kMostPasses && path_.size() >= kFewest; ++pass) {
            if (move(sideways()) <= kStill_mm) {
                break;
            }
        }
        double worst_mm = 0.0;
        for (std::size_t k = 0; k < given_.size(); ++k) {
            const PathPoint& at = path_[given_[k]];
            const Vector3d off = point_mm_[k] - at.position_mm;
            worst_mm = std::max(worst_mm, (off - off.dot(at.tangent) * at.tangent).norm());
        }
        return worst_mm;
    }

private:
    [[nodiscard]] double step_mm(std::size_t j) const {
        return (path_[j + 1].position_mm - path_[j].position_mm).norm();
    }
    [[nodiscard]] Vector3d side(std::size_t j) const {
        return path_[j].normal.cross(path_[j].tangent);
    }

    // The move of each inner station that makes the curve smoothest within the tolerance.
    [[nodiscard]] Eigen::VectorXd sideways() const {
        const auto n = static_cast<Eigen::Index>(path_.size() - 2);
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::VectorXd change(n - 1);  // of the curvature from one station to the next, weighed
        std::vector<Second> second;
        std::vector<double> kg;
        for (std::size_t j = 1; j + 1 < path_.size(); ++j) {
            const double h1 = step_mm(j - 1);
            const double h2 = step_mm(j);
            second.emplace_back(h1, h2);
            const Vector3d bent = second.back().before * path_[j - 1].position_mm +
                                  second.back().here * path_[j].position_mm +
                                  second.back().after * path_[j + 1].position_mm;
            kg.push_back(bent.dot(side(j)));
        }
        for (Eigen::Index row = 0; row + 1 < n; ++row) {
            const Second& here = second[static_cast<std::size_t>(row)];
            const Second& next = second[static_cast<std::size_t>(row + 1)];
            const double weight = 1.0 / std::sqrt(step_mm(static_cast<std::size_t>(row + 1)));
            const auto add = [&](Eigen::Index column, double value) {
                if (column >= 0 && column < n) {  // the ends stay
                    entries.emplace_back(row, column, weight * value);
                }
            };
            add(row - 1, -here.before);
            add(row, next.before - here.here);
            add(row + 1, next.here - here.after);
            add(row + 2, next.after);
            change[row] = weight * (kg[static_cast<std::size_t>(row + 1)] -
                                    kg[static_cast<std::size_t>(row)]);
        }
        Sparse rates(n - 1, n);
        rates.setFromTriplets(entries.begin(), entries.end());
        return within_tolerance(rates, change);
    }

    // Solves for the least weight of the points that keeps all of them within the tolerance.
    [[nodiscard]] Eigen::VectorXd within_tolerance(const Sparse& rates,
                                                   const Eigen::VectorXd& change) const {
        const Eigen::Index n = rates.cols();
        Eigen::VectorXd is_point = Eigen::VectorXd::Zero(n);
        Eigen::VectorXd off_mm = Eigen::VectorXd::Zero(n);
        for (std::size_t k = 0; k < given_.size(); ++k) {
            const Eigen::Index row = static_cast<Eigen::Index>(given_[k]) - 1;
            if (row >= 0 && row < n) {
                is_point[row] = 1.0;
                off_mm[row] = (path_[given_[k]].position_mm - point_mm_[k]).dot(side(given_[k]));
            }
        }
        const Sparse smooth = rates.transpose() * rates;
        const Eigen::VectorXd wanted = rates.transpose() * change;
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
        double low = kLeastWeight_log;
        double high = kMostWeight_log;
        Eigen::VectorXd best = solve(high);
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (low + high);
            Eigen::VectorXd u = solve(middle);
            if (u.allFinite() && furthest_mm(u) <= tolerance_mm_) {
                best = std::move(u);
                high = middle;
            } else {
                low = middle;
            }
        }
        return best;
    }

    // Moves the inner stations; by how much the furthest.
    double move(const Eigen::VectorXd& sideways_mm) {
        std::vector<FieldWalker> places;
        for (std::size_t j = 1; j + 1 < path_.size(); ++j) {
            const double u = sideways_mm[static_cast<Eigen::Index>(j) - 1];
            places.push_back(wall_place(wall_, facets_, path_[j].position_mm + u * side(j)));
        }
        std::vector<Vector3d> at_mm{path_.front().position_mm};
        for (const FieldWalker& place : places) {
            at_mm.push_back(place.position_mm());
        }
        at_mm.push_back(path_.back().position_mm);
        const std::size_t last = at_mm.size() - 1;
        path_.front().tangent =
            in_wall(path_.front(), parabola_end_tangent(at_mm[0], at_mm[1], at_mm[2]));
        for (std::size_t j = 1; j < last; ++j) {
            path_[j] =
                places[j - 1].station(parabola_tangent(at_mm[j - 1], at_mm[j], at_mm[j + 1]));
        }
        path_.back().tangent = in_wall(
            path_.back(), -parabola_end_tangent(at_mm[last], at_mm[last - 1], at_mm[last - 2]));
        for (std::size_t j = 1; j <= last; ++j) {
            path_[j].s_mm = path_[j - 1].s_mm + arc_mm(path_[j - 1], path_[j]);
        }
        return sideways_mm.cwiseAbs().maxCoeff();
    }

    static Vector3d in_wall(const PathPoint& at, const Vector3d& direction) {
        return (direction - direction.dot(at.normal) * at.normal).normalized();
    }

    // Of the circle that the chord and the turn between the tangents make.
    static double arc_mm(const PathPoint& from, const PathPoint& to) {
        const double chord_mm = (to.position_mm - from.position_mm).norm();
        const double half_rad =
            0.5 * std::acos(std::clamp(from.tangent.dot(to.tangent), -1.0, 1.0));
        return half_rad > 1e-6 ? chord_mm * half_rad / std::sin(half_rad) : chord_mm;
    }

    const Surface& wall_;
    const RayQuery& facets_;
    std::span<const std::size_t> given_;
    double tolerance_mm_;
    SurfacePath& path_;
    std::vector<Vector3d> point_mm_;  // of the given stations, on the wall
};

}  // namespace

double smooth_course(const Surface& wall, const RayQuery& facets,
                     std::span<const std::size_t> given, double tolerance_mm, SurfacePath& path) {
    return Smoothing(wall, facets, given, tolerance_mm, path).run();
}

}  // namespace meshwind
