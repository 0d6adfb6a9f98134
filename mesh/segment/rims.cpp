#include "mesh/segment/rims.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

#include "core/index.h"
#include "core/small_linear.h"
#include "mesh/edge_table.h"

namespace meshwind {
namespace {

struct Loop {
    std::vector<std::int32_t> vertices;
    std::vector<std::array<std::int32_t, 2>> edges;  // face and edge from vertex i to the next
};

// Loops against the faces' own direction, so that they turn left around what is outside.
std::vector<Loop> loops_of(const TriangleSoup& soup) {
    const auto neighbours = face_neighbours(soup.faces);
    std::vector<std::array<std::int32_t, 2>> ending_at(soup.points_mm.size(), {-1, -1});
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (neighbours[f][e] < 0) {
                ending_at[at(soup.faces[f][(e + 1) % 3])] = {static_cast<std::int32_t>(f),
                                                             static_cast<std::int32_t>(e)};
            }
        }
    }
    std::vector<char> used(soup.points_mm.size(), 0);
    std::vector<Loop> loops;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            std::int32_t v = soup.faces[f][(e + 1) % 3];
            if (neighbours[f][e] >= 0 || used[at(v)] != 0) {
                continue;
            }
            Loop loop;
            while (used[at(v)] == 0 && ending_at[at(v)][0] >= 0) {
                used[at(v)] = 1;
                loop.vertices.push_back(v);
                loop.edges.push_back(ending_at[at(v)]);
                v = soup.faces[at(ending_at[at(v)][0])][at(ending_at[at(v)][1])];
            }
            loops.push_back(std::move(loop));
        }
    }
    return loops;
}

struct Circle {
    Eigen::Vector2d centre;
    double radius = 0.0;
};

// Algebraic start (Kasa), then Gauss-Newton on the distances.
Circle fit_circle(const std::vector<Eigen::Vector2d>& points, const std::vector<double>& weights) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3d row(points[i].x(), points[i].y(), 1.0);
        normal += weights[i] * row * row.transpose();
        right += weights[i] * points[i].squaredNorm() * row;
    }
    const Eigen::Vector3d start = normal.ldlt().solve(right);
    Circle circle{start.head<2>() / 2.0, 0.0};
    circle.radius = std::sqrt(std::max(0.0, start[2] + circle.centre.squaredNorm()));
    for (int round = 0; round < 4; ++round) {
        normal.setZero();
        right.setZero();
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Eigen::Vector2d out = points[i] - circle.centre;
            const double distance = out.norm();
            if (distance > 0.0) {
                const Eigen::Vector3d row(out.x() / distance, out.y() / distance, 1.0);
                normal += weights[i] * row * row.transpose();
                right += weights[i] * (distance - circle.radius) * row;
            }
        }
        const Eigen::Vector3d step = normal.ldlt().solve(right);
        if (!step.allFinite()) {
            break;
        }
        circle.centre += step.head<2>();
        circle.radius += step[2];
    }
    return circle;
}

struct LoopPoints {
    std::vector<Eigen::Vector3d> points;
    std::vector<double> weights;  // half the boundary length on both sides
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
};

LoopPoints points_of(const TriangleSoup& soup, const std::vector<std::int32_t>& vertices) {
    LoopPoints loop;
    const std::size_t n = vertices.size();
    loop.weights.assign(n, 0.0);
    for (const std::int32_t v : vertices) {
        loop.points.push_back(soup.points_mm[at(v)]);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d& from = loop.points[i];
        const Eigen::Vector3d& to = loop.points[(i + 1) % n];
        const double edge = (to - from).norm();
        loop.weights[i] += edge / 2.0;
        loop.weights[(i + 1) % n] += edge / 2.0;
        loop.area += 0.5 * (from - loop.points[0]).cross(to - loop.points[0]);
    }
    return loop;
}

// Circle in the plane of the weighted points, its axis on the side of `outward`.
void fit(const LoopPoints& loop, const std::vector<double>& weights, Rim& rim) {
    const std::size_t n = loop.points.size();
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double total = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        middle += weights[i] * loop.points[i];
        total += weights[i];
    }
    middle /= total;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d arm = loop.points[i] - middle;
        spread += weights[i] * arm * arm.transpose();
    }
    rim.axis = principal_axes(spread).vectors.col(0);
    rim.axis *= rim.axis.dot(loop.area) < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d u = rim.axis.unitOrthogonal();
    const Eigen::Vector3d v = rim.axis.cross(u);
    std::vector<Eigen::Vector2d> flat(n);
    for (std::size_t i = 0; i < n; ++i) {
        flat[i] = {u.dot(loop.points[i] - middle), v.dot(loop.points[i] - middle)};
    }
    const Circle circle = fit_circle(flat, weights);
    rim.centre_mm = middle + circle.centre.x() * u + circle.centre.y() * v;
    rim.radius_mm = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        rim.radius_mm += weights[i] * (flat[i] - circle.centre).norm() / total;
    }
}

// Points of a notch would pull the circle: those far off compared with the others are left out.
void measure(const TriangleSoup& soup, Rim& rim) {
    constexpr int kRounds = 8;
    constexpr double kFarOff = 4.0;       // times the median distance from the circle
    constexpr double kRoundShare = 1e-3;  // of the radius: a loop this good keeps all its points
    // In radii: the edge of a hexagon. A longer one stands for no arc: a loop with such edges is as
    // far off its circle as their middles are.
    constexpr double kLongestEdge = 1.001;
    const LoopPoints loop = points_of(soup, rim.vertices);
    std::vector<double> weights = loop.weights;
    std::vector<double> off(loop.points.size());
    fit(loop, weights, rim);
    for (int round = 0; round < kRounds; ++round) {
        std::transform(loop.points.begin(), loop.points.end(), off.begin(),
                       [&](const Eigen::Vector3d& p) { return off_circle_mm(rim, p); });
        // The median by length: many short edges in a notch must not outvote the circle.
        std::vector<std::size_t> order(off.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return off[a] < off[b]; });
        const double total = std::accumulate(loop.weights.begin(), loop.weights.end(), 0.0);
        double length = 0.0;
        std::size_t middle = 0;
        while (middle + 1 < order.size() && 2.0 * (length + loop.weights[order[middle]]) < total) {
            length += loop.weights[order[middle++]];
        }
        const double limit = std::max(kFarOff * off[order[middle]], kRoundShare * rim.radius_mm);
        std::vector<double> trimmed = loop.weights;
        for (std::size_t i = 0; i < off.size(); ++i) {
            trimmed[i] = off[i] > limit ? 0.0 : trimmed[i];
        }
        if (trimmed == weights) {
            break;
        }
        weights = std::move(trimmed);
        fit(loop, weights, rim);
    }
    rim.circularity_mm = 0.0;
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
        const Eigen::Vector3d& p = loop.points[i];
        const Eigen::Vector3d& next = loop.points[(i + 1) % loop.points.size()];
        rim.circularity_mm = std::max(rim.circularity_mm, off_circle_mm(rim, p));
        if ((next - p).norm() > kLongestEdge * rim.radius_mm) {
            rim.circularity_mm = std::max(rim.circularity_mm, off_circle_mm(rim, 0.5 * (p + next)));
        }
    }
}

}  // namespace

double off_circle_mm(const Rim& rim, const Eigen::Vector3d& point) {
    const Eigen::Vector3d arm = point - rim.centre_mm;
    const double along = rim.axis.dot(arm);
    return std::hypot((arm - along * rim.axis).norm() - rim.radius_mm, along);
}

Rim rim_through(const TriangleSoup& soup, std::vector<std::int32_t> loop) {
    Rim rim;
    rim.vertices = std::move(loop);
    measure(soup, rim);
    return rim;
}

Rims find_rims(const TriangleSoup& soup) {
    Rims result;
    result.of_edge.assign(soup.faces.size(), {-1, -1, -1});
    const std::vector<Loop> loops = loops_of(soup);
    std::vector<Rim> candidates;
    double largest = 0.0;
    for (const Loop& loop : loops) {
        Rim rim = rim_through(soup, loop.vertices);
        largest = std::max(largest, rim.radius_mm);
        candidates.push_back(std::move(rim));
    }
    for (std::size_t i = 0; i < loops.size(); ++i) {
        if (loops[i].vertices.size() < 3 || candidates[i].radius_mm < kRimRadiusShare * largest) {
            result.holes_mm.push_back(candidates[i].centre_mm);
            continue;
        }
        candidates[i].id = static_cast<std::int32_t>(result.rims.size());
        for (const auto& [f, e] : loops[i].edges) {
            result.of_edge[at(f)][at(e)] = candidates[i].id;
        }
        result.rims.push_back(std::move(candidates[i]));
    }
    return result;
}

}  // namespace meshwind
