#include "geodesic/biarc.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "geodesic/connect.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Steps of the unknowns for the slopes, as shares of a turn by one rad and of the length.
constexpr double kSlopeStep = 1e-4;

// A step of Newton's method changes the direction of a stretch by no more than this.
constexpr double kMaxTurn_rad = 0.7;

// And it is halved so many times where it does not lead nearer.
constexpr int kHalvings = 12;

// The unknowns: turn of the first and of the second stretch in rad against the geodesic, if the
// surface were curved everywhere as on the mean along it, and the length as a share of its.
class BiarcSearch {
public:
    BiarcSearch(const Surface& surface, const PathPoint& from, const PathPoint& to,
                const BiarcOptions& options)
        : surface_(surface), from_(from), to_(to), options_(options) {}

    Biarc run() {
        ConnectOptions straight;
        straight.trace = {.max_length_mm = options_.longest_mm, .method = TraceMethod::Patches};
        const ConnectResult geodesic = connect(surface_, from_.at, to_.at, 0.0, straight);
        if (geodesic.path.size() < 2) {
            return best_;
        }
        Vector3d x = guess(geodesic);
        Vector3d residual = residual_of(x, best_);
        for (int i = 0; i < options_.max_iterations && !within(residual); ++i) {
            Matrix3d slopes;
            for (int k = 0; k < 3; ++k) {
                Biarc probe;
                slopes.col(k) =
                    (residual_of(x + kSlopeStep * Vector3d::Unit(k), probe) - residual) /
                    kSlopeStep;
            }
            Vector3d step = -slopes.fullPivLu().solve(residual);
            if (!step.allFinite()) {
                break;
            }
            step *= std::min(1.0, kMaxTurn_rad / step.cwiseAbs().maxCoeff());
            if (!advance(x, residual, step)) {
                break;
            }
        }
        best_.found = within(residual);
        return best_;
    }

private:
    // In the plane a start turned by alpha and an end turned by beta against the chord take the
    // turns -(3 alpha + beta) / 2 and (alpha + 3 beta) / 2 of the two halves.
    Vector3d guess(const ConnectResult& geodesic) {
        length_mm_ = geodesic.length_mm;
        double curved = 0.0;
        for (std::size_t i = 1; i < geodesic.path.size(); ++i) {
            curved += std::max(0.0, geodesic.path[i].kn_per_mm) *
                      (geodesic.path[i].s_mm - geodesic.path[i - 1].s_mm);
        }
        turn_rad_ = std::max(0.5 * curved, kSlopeStep);
        const double alpha = angle(geodesic.path.front(), from_.tangent);
        const double beta = angle(geodesic.path.back(), to_.tangent);
        return {-0.5 * (3.0 * alpha + beta), 0.5 * (alpha + 3.0 * beta), 1.0};
    }

    // From a station's tangent to a direction, counter-clockwise seen from outside.
    static double angle(const PathPoint& station, const Vector3d& direction) {
        return std::atan2(station.normal.cross(station.tangent).dot(direction),
                          station.tangent.dot(direction));
    }

    // Traces both stretches: what is missing at the end, along, across and in direction, as shares
    // of the length and in rad.
    Vector3d residual_of(const Vector3d& x, Biarc& path) {
        path = {};
        path.slip_ratio = x[0] / turn_rad_;
        path.slip_ratio_2 = x[1] / turn_rad_;
        const double half_mm = 0.5 * length_mm_ * std::max(x[2], kSlopeStep);
        const auto stretch = [&](const PathPoint& start, double ratio) {
            return trace(surface_, start.at, start.tangent, {ratio, ratio},
                         {.max_length_mm = half_mm,
                          .method = TraceMethod::Patches,
                          .max_step_mm = options_.max_step_mm});
        };
        TraceResult first = stretch(from_, path.slip_ratio);
        const TraceResult second = stretch(first.path.back(), path.slip_ratio_2);
        path.path = std::move(first.path);
        const double before_mm = path.path.back().s_mm;
        for (std::size_t i = 1; i < second.path.size(); ++i) {
            path.path.push_back(second.path[i]);
            path.path.back().s_mm += before_mm;
        }
        const PathPoint& end = path.path.back();
        const Vector3d off = to_.position_mm - end.position_mm;
        path.miss_mm = off.norm();
        path.miss_rad = std::abs(angle(end, to_.tangent));
        return {off.dot(to_.tangent) / length_mm_,
                off.dot(to_.normal.cross(to_.tangent)) / length_mm_, angle(end, to_.tangent)};
    }

    [[nodiscard]] bool within(const Vector3d& residual) const {
        return residual.head<2>().norm() * length_mm_ <= options_.tolerance_mm &&
               std::abs(residual[2]) <= options_.tolerance_rad &&
               best_.miss_mm <= options_.tolerance_mm + height_mm();
    }

    // The end lies on a patch, the target perhaps on a facet.
    [[nodiscard]] double height_mm() const {
        return best_.path.empty()
                   ? 0.0
                   : std::abs(to_.normal.dot(to_.position_mm - best_.path.back().position_mm));
    }

    bool advance(Vector3d& x, Vector3d& residual, Vector3d step) {
        for (int k = 0; k < kHalvings; ++k, step *= 0.5) {
            Biarc tried;
            const Vector3d found = residual_of(x + step, tried);
            if (found.norm() < residual.norm()) {
                x += step;
                residual = found;
                best_ = std::move(tried);
                return true;
            }
        }
        return false;
    }

    const Surface& surface_;
    const PathPoint& from_;
    const PathPoint& to_;
    const BiarcOptions& options_;
    double length_mm_ = 0.0;  // of the geodesic
    double turn_rad_ = 1.0;   // by which a ratio of 1 turns a stretch, about
    Biarc best_;
};

}  // namespace

Biarc biarc(const Surface& surface, const PathPoint& from, const PathPoint& to,
            const BiarcOptions& options) {
    return BiarcSearch(surface, from, to, options).run();
}

}  // namespace meshwind
