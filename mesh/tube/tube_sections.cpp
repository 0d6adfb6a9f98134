#include "mesh/tube/tube_sections.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "mesh/tube/centre_line.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// First sections are this share of the radius apart: thick enough to hold vertices all around.
constexpr double kFirstSpacing = 0.5;

// How often the line is drawn anew, coarsely and then finely. Each time its error falls by more
// than ten.
constexpr int kCoarseRounds = 6;
constexpr int kFineRounds = 4;

// A fit reads vertices within so many spacings along the line, or more where there are fewer than
// kMinVertices.
constexpr double kReach = 2.5;
constexpr std::size_t kMinVertices = 36;
constexpr double kFarthest_mm = 1e6;

// A section moves by no more than this share of the radius at a time: what is no tube shall not
// throw the line far away.
constexpr double kMaxMove = 0.5;

// Nor does the line of a tube grow so much longer than that of its first guess.
constexpr double kMaxLonger = 3.0;

// Keeps fits solvable where vertices do not tell; of the diagonal.
constexpr double kRidge = 1e-9;

constexpr std::size_t kMinSections = 5;
constexpr std::size_t kMaxSections = 1000;
constexpr std::size_t kChunk = 8;

// Shortest ways over the edges from a rim.
std::vector<double> ways_from(const Rim& rim, const Surface& surface) {
    std::vector<std::vector<std::int32_t>> next(surface.position_mm.size());
    for (const auto& face : surface.face) {
        for (std::size_t e = 0; e < 3; ++e) {
            next[at(face[e])].push_back(face[(e + 1) % 3]);
            next[at(face[e])].push_back(face[(e + 2) % 3]);
        }
    }
    using Entry = std::pair<double, std::int32_t>;
    std::vector<double> way(next.size(), std::numeric_limits<double>::infinity());
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const std::int32_t v : rim.vertices) {
        way[at(v)] = 0.0;
        queue.emplace(0.0, v);
    }
    while (!queue.empty()) {
        const auto [reached, v] = queue.top();
        queue.pop();
        if (reached > way[at(v)]) {
            continue;
        }
        for (const std::int32_t w : next[at(v)]) {
            const double there =
                reached + (surface.position_mm[at(w)] - surface.position_mm[at(v)]).norm();
            if (there < way[at(w)]) {
                way[at(w)] = there;
                queue.emplace(there, w);
            }
        }
    }
    return way;
}

std::vector<Vector3d> vertex_normals(const Surface& surface) {
    std::vector<Vector3d> normal(surface.position_mm.size(), Vector3d::Zero());
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            normal[at(surface.face[f][e])] += surface.normal[at(surface.corner[f][e])];
        }
    }
    for (Vector3d& n : normal) {
        n.normalize();
    }
    return normal;
}

// Where the normals of vertices between two shares of the way from rim to rim come nearest to each
// other.
std::vector<Vector3d> first_centres(const Mandrel& mandrel) {
    const Surface& surface = mandrel.surface;
    const std::vector<double> from = ways_from(mandrel.rims[0], surface);
    const std::vector<double> to = ways_from(mandrel.rims[1], surface);
    const std::vector<Vector3d> normal = vertex_normals(surface);
    double length = 0.0;
    for (const std::int32_t v : mandrel.rims[1].vertices) {
        length += from[at(v)] / static_cast<double>(mandrel.rims[1].vertices.size());
    }
    const double spacing =
        std::max(kFirstSpacing * mandrel.rims[0].radius_mm, 2.0 * surface.mean_edge_mm);
    const auto slices = static_cast<std::size_t>(
        std::clamp(length / spacing, static_cast<double>(kMinSections), 1e3));
    std::vector<Eigen::Matrix3d> sum(slices, Eigen::Matrix3d::Zero());
    std::vector<Vector3d> right(slices, Vector3d::Zero());
    std::vector<std::size_t> count(slices, 0);
    for (std::size_t v = 0; v < from.size(); ++v) {
        const double way = from[v] + to[v];
        if (way == 0.0 || !std::isfinite(way)) {
            continue;  // rims that touch there, or parts that no edge connects
        }
        const double share = from[v] / way;
        const auto slice =
            std::min(slices - 1, static_cast<std::size_t>(share * static_cast<double>(slices)));
        const Eigen::Matrix3d aside =
            Eigen::Matrix3d::Identity() - normal[v] * normal[v].transpose();
        sum[slice] += aside;
        right[slice] += aside * surface.position_mm[v];
        ++count[slice];
    }
    std::vector<Vector3d> centres{mandrel.rims[0].centre_mm};
    for (std::size_t i = 0; i < slices; ++i) {
        if (count[i] >= kMinSections) {
            const Vector3d centre = sum[i].ldlt().solve(right[i]);
            if ((centre - centres.back()).norm() > 0.25 * spacing &&
                (centre - mandrel.rims[1].centre_mm).norm() > 0.25 * spacing) {
                centres.push_back(centre);
            }
        }
    }
    if (centres.size() == 1) {
        centres.push_back(0.5 * (mandrel.rims[0].centre_mm + mandrel.rims[1].centre_mm));
    }
    centres.push_back(mandrel.rims[1].centre_mm);
    return centres;
}

// A vertex as the line sees it.
struct Seen {
    double arc_mm;
    Eigen::Vector2d aside_mm;  // along reference and across
};

std::vector<Seen> seen_from(const CentreLine& line, const Surface& surface) {
    std::vector<Seen> seen(surface.position_mm.size());
    parallel_for(seen.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const CentrePlace foot = line.foot(surface.position_mm[v]);
            const Vector3d d = surface.position_mm[v] - foot.position_mm;
            seen[v] = {foot.arc_mm, {d.dot(foot.reference), d.dot(foot.across())}};
        }
    });
    std::sort(seen.begin(), seen.end(),
              [](const Seen& a, const Seen& b) { return a.arc_mm < b.arc_mm; });
    return seen;
}

struct Fit {
    Eigen::Vector2d off_mm;
    double radius_mm;
};

// Least squares of distance = r + a cos(phi) + b sin(phi), each of r, a, b quadratic along the
// line, with Tukey's weights.
Fit fit_section(std::span<const Seen> seen, double arc_mm, double reach_mm) {
    std::span<const Seen> near;
    for (;; reach_mm *= 1.5) {
        const auto low = std::lower_bound(seen.begin(), seen.end(), arc_mm - reach_mm,
                                          [](const Seen& s, double arc) { return s.arc_mm < arc; });
        const auto high =
            std::upper_bound(low, seen.end(), arc_mm + reach_mm,
                             [](double arc, const Seen& s) { return arc < s.arc_mm; });
        near = {low, high};
        if (near.size() >= std::min(kMinVertices, seen.size()) || !(reach_mm < kFarthest_mm)) {
            break;
        }
    }
    Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
    Eigen::Matrix<double, 9, 1> right = Eigen::Matrix<double, 9, 1>::Zero();
    for (const Seen& s : near) {
        const double t = (s.arc_mm - arc_mm) / reach_mm;
        const double distance = s.aside_mm.norm();
        const double weight = std::pow(std::max(0.0, 1.0 - t * t), 2);
        const Vector3d around(1.0, s.aside_mm.x() / distance, s.aside_mm.y() / distance);
        Eigen::Matrix<double, 9, 1> row;
        row << around, t * around, t * t * around;
        normal += weight * row * row.transpose();
        right += weight * distance * row;
    }
    for (int i = 0; i < 9; ++i) {
        normal(i, i) *= 1.0 + kRidge;
        normal(i, i) += kRidge;
    }
    const Eigen::Matrix<double, 9, 1> found = normal.ldlt().solve(right);
    Eigen::Vector2d off(found[1], found[2]);
    off *= std::min(1.0, kMaxMove * std::abs(found[0]) /
                             std::max(off.norm(), std::numeric_limits<double>::min()));
    return {off, found[0]};
}

std::vector<TubeSection> sections_along(const CentreLine& line, const Mandrel& mandrel,
                                        double spacing_mm, double most_mm) {
    const double first = line.foot(mandrel.rims[0].centre_mm).arc_mm;
    const double length = line.foot(mandrel.rims[1].centre_mm).arc_mm - first;
    if (!(length > 0.0 && length < most_mm)) {
        return {};
    }
    const auto intervals = static_cast<std::size_t>(
        std::clamp(std::ceil(length / spacing_mm), static_cast<double>(kMinSections - 1),
                   static_cast<double>(kMaxSections)));
    const std::vector<Seen> seen = seen_from(line, mandrel.surface);
    const double step = length / static_cast<double>(intervals);
    const double reach = kReach * std::max(step, mandrel.surface.mean_edge_mm);
    std::vector<TubeSection> sections(intervals + 1);
    parallel_for(sections.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const CentrePlace place = line.at(first + step * static_cast<double>(i));
            const Fit fit = fit_section(seen, place.arc_mm, reach);
            sections[i] = {place.position_mm + fit.off_mm.x() * place.reference +
                               fit.off_mm.y() * place.across(),
                           fit.radius_mm};
        }
    });
    return sections;
}

bool is_lost(const TubeSection& section) {
    return !section.centre_mm.allFinite() || !(section.radius_mm > 0.0);
}

CentreLine line_of(const std::vector<TubeSection>& sections) {
    std::vector<Vector3d> centres;
    centres.reserve(sections.size());
    for (const TubeSection& section : sections) {
        centres.push_back(section.centre_mm);
    }
    return line_through(centres);
}

}  // namespace

std::vector<TubeSection> tube_sections(const Mandrel& mandrel, double spacing_mm) {
    CentreLine line = line_through(first_centres(mandrel));
    const double coarse = std::max(spacing_mm, kFirstSpacing * mandrel.rims[0].radius_mm);
    const double most = kMaxLonger * line.length_mm();
    std::vector<TubeSection> sections;
    for (int round = 0; round < kCoarseRounds + kFineRounds; ++round) {
        sections = sections_along(line, mandrel, round < kCoarseRounds ? coarse : spacing_mm, most);
        if (sections.empty() || std::any_of(sections.begin(), sections.end(), is_lost)) {
            return {};
        }
        line = line_of(sections);
    }
    return sections;
}

}  // namespace meshwind
