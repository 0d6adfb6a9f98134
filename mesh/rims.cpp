#include "mesh/rims.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "mesh/edge_table.h"

namespace meshwind {
namespace {

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

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

void measure(const TriangleSoup& soup, Rim& rim) {
    const std::size_t n = rim.vertices.size();
    const auto point = [&](std::size_t i) -> const Eigen::Vector3d& {
        return soup.points_mm[at(rim.vertices[i % n])];
    };
    std::vector<double> weights(n, 0.0);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double length = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double edge = (point(i + 1) - point(i)).norm();
        weights[i] += edge / 2.0;
        weights[(i + 1) % n] += edge / 2.0;
        middle += edge * 0.5 * (point(i) + point(i + 1));
        length += edge;
    }
    middle /= length;
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
        area += 0.5 * (point(i) - middle).cross(point(i + 1) - middle);
    }
    rim.axis = area.norm() > 0.0 ? Eigen::Vector3d(area.normalized()) : Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d u = rim.axis.unitOrthogonal();
    const Eigen::Vector3d v = rim.axis.cross(u);
    std::vector<Eigen::Vector2d> flat(n);
    for (std::size_t i = 0; i < n; ++i) {
        flat[i] = {u.dot(point(i) - middle), v.dot(point(i) - middle)};
    }
    const Circle circle = fit_circle(flat, weights);
    rim.centre_mm = middle + circle.centre.x() * u + circle.centre.y() * v;
    rim.radius_mm = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        rim.radius_mm += weights[i] * (flat[i] - circle.centre).norm() / length;
    }
    for (std::size_t i = 0; i < n; ++i) {
        const double across = (flat[i] - circle.centre).norm() - rim.radius_mm;
        const double along = rim.axis.dot(point(i) - middle);
        rim.circularity_mm = std::max(rim.circularity_mm, std::hypot(across, along));
    }
}

}  // namespace

Rims find_rims(const TriangleSoup& soup) {
    Rims result;
    result.of_edge.assign(soup.faces.size(), {-1, -1, -1});
    const std::vector<Loop> loops = loops_of(soup);
    std::vector<Rim> candidates;
    double largest = 0.0;
    for (const Loop& loop : loops) {
        Rim rim;
        rim.vertices = loop.vertices;
        measure(soup, rim);
        largest = std::max(largest, rim.radius_mm);
        candidates.push_back(std::move(rim));
    }
    for (std::size_t i = 0; i < loops.size(); ++i) {
        if (loops[i].vertices.size() < 3 || candidates[i].radius_mm < kRimRadiusShare * largest) {
            ++result.holes;
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
