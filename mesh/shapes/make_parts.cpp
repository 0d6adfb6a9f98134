#include "mesh/shapes/make_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Chords of a quarter.
constexpr int kTable = 512;

Vector3d centre_of(const TriangleSoup& soup, const VertexRow& row) {
    Vector3d sum = Vector3d::Zero();
    for (const std::int32_t id : row) {
        sum += soup.points_mm[at(id)];
    }
    return sum / static_cast<double>(row.size());
}

std::size_t nearest_in(const TriangleSoup& soup, const VertexRow& row, const Vector3d& point) {
    const auto distance = [&](std::int32_t id) {
        return (soup.points_mm[at(id)] - point).squaredNorm();
    };
    const auto nearest =
        std::min_element(row.begin(), row.end(),
                         [&](std::int32_t a, std::int32_t b) { return distance(a) < distance(b); });
    return static_cast<std::size_t>(nearest - row.begin());
}

}  // namespace

std::int32_t steps_of(double length_mm, double step_mm, std::int32_t least) {
    return std::max(least, static_cast<std::int32_t>(std::lround(length_mm / step_mm)));
}

QuarterLengths::QuarterLengths(const std::function<Vector3d(double)>& place_mm)
    : length_mm_(kTable + 1, 0.0) {
    Vector3d last = place_mm(0.0);
    for (int i = 1; i <= kTable; ++i) {
        const Vector3d next = place_mm(0.5 * kPi * i / kTable);
        length_mm_[at(i)] = length_mm_[at(i - 1)] + (next - last).norm();
        last = next;
    }
}

double QuarterLengths::parameter(double length_mm) const {
    const auto above = std::upper_bound(length_mm_.begin() + 1, length_mm_.end() - 1, length_mm);
    const double share = (length_mm - *(above - 1)) / (*above - *(above - 1));
    return 0.5 * kPi * (static_cast<double>(above - 1 - length_mm_.begin()) + share) / kTable;
}

double row_step_mm(double edge_mm) {
    return edge_mm * std::sqrt(0.75);
}

void stitch_open(TriangleSoup& soup, const VertexRow& lower, const VertexRow& upper) {
    const auto gap = [&](std::int32_t a, std::int32_t b) {
        return (soup.points_mm[at(a)] - soup.points_mm[at(b)]).squaredNorm();
    };
    std::size_t i = 0;
    std::size_t j = 0;
    while (i + 1 < lower.size() || j + 1 < upper.size()) {
        const bool along_lower =
            j + 1 == upper.size() ||
            (i + 1 < lower.size() && gap(lower[i + 1], upper[j]) <= gap(lower[i], upper[j + 1]));
        if (along_lower) {
            soup.faces.push_back({lower[i], lower[i + 1], upper[j]});
            ++i;
        } else {
            soup.faces.push_back({lower[i], upper[j + 1], upper[j]});
            ++j;
        }
    }
}

void stitch_rings(TriangleSoup& soup, const VertexRow& lower, VertexRow upper) {
    VertexRow closed = lower;
    if (closed.size() > 1) {
        closed.push_back(closed.front());
    }
    if (upper.size() > 1) {
        const std::size_t start = nearest_in(soup, upper, soup.points_mm[at(lower.front())]);
        std::rotate(upper.begin(), upper.begin() + static_cast<std::ptrdiff_t>(start), upper.end());
        upper.push_back(upper.front());
    }
    stitch_open(soup, closed, upper);
}

std::vector<VertexRow> boundary_loops(const TriangleSoup& soup) {
    std::set<std::pair<std::int32_t, std::int32_t>> halves;
    for (const auto& [a, b, c] : soup.faces) {
        halves.insert({{a, b}, {b, c}, {c, a}});
    }
    std::map<std::int32_t, std::int32_t> next;
    for (const auto& [a, b] : halves) {
        if (!halves.contains({b, a})) {
            next[a] = b;
        }
    }
    std::vector<VertexRow> loops;
    while (!next.empty()) {
        VertexRow loop;
        for (auto step = next.begin(); step != next.end(); step = next.find(loop.back())) {
            if (loop.empty()) {
                loop.push_back(step->first);
            }
            loop.push_back(step->second);
            next.erase(step);
        }
        loop.pop_back();
        loops.push_back(std::move(loop));
    }
    return loops;
}

TriangleSoup shell_between(const TriangleSoup& outer, const TriangleSoup& inner) {
    TriangleSoup soup = outer;
    const auto offset = static_cast<std::int32_t>(outer.points_mm.size());
    soup.points_mm.insert(soup.points_mm.end(), inner.points_mm.begin(), inner.points_mm.end());
    for (const auto& [a, b, c] : inner.faces) {
        soup.faces.push_back({a + offset, c + offset, b + offset});
    }
    std::vector<VertexRow> inner_loops = boundary_loops(inner);
    for (VertexRow& loop : inner_loops) {
        std::transform(loop.begin(), loop.end(), loop.begin(),
                       [&](std::int32_t id) { return id + offset; });
        std::reverse(loop.begin(), loop.end());
    }
    for (VertexRow rim : boundary_loops(outer)) {
        std::reverse(rim.begin(), rim.end());
        const Vector3d centre = centre_of(soup, rim);
        const auto distance = [&](const VertexRow& loop) {
            return (centre_of(soup, loop) - centre).squaredNorm();
        };
        const auto nearest = std::min_element(
            inner_loops.begin(), inner_loops.end(),
            [&](const VertexRow& a, const VertexRow& b) { return distance(a) < distance(b); });
        stitch_rings(soup, rim, *nearest);
    }
    return soup;
}

}  // namespace meshwind
