#include "mesh/repair/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "mesh/edge_table.h"

namespace meshwind {
namespace {

using Key = std::array<std::int64_t, 3>;

struct KeyHash {
    std::size_t operator()(const Key& key) const {
        std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
        for (const std::int64_t part : key) {
            hash = (hash ^ static_cast<std::uint64_t>(part)) * 0xff51afd7ed558ccdULL;
            hash ^= hash >> 32;
        }
        return hash;
    }
};

Key bits_of(const Eigen::Vector3d& point) {
    Key key;
    for (int i = 0; i < 3; ++i) {
        // Adding zero turns -0 into +0.
        key[static_cast<std::size_t>(i)] = std::bit_cast<std::int64_t>(point[i] + 0.0);
    }
    return key;
}

int weld_equal(TriangleSoup& soup) {
    std::unordered_map<Key, std::int32_t, KeyHash> known;
    known.reserve(soup.points_mm.size() / 2);
    std::vector<Eigen::Vector3d> points;
    std::vector<std::int32_t> renumbered(soup.points_mm.size(), -1);
    int used = 0;
    for (auto& face : soup.faces) {
        for (std::int32_t& v : face) {
            std::int32_t& target = renumbered[static_cast<std::size_t>(v)];
            if (target < 0) {
                ++used;
                const Eigen::Vector3d& point = soup.points_mm[static_cast<std::size_t>(v)];
                const auto next = static_cast<std::int32_t>(points.size());
                const auto [entry, is_new] = known.try_emplace(bits_of(point), next);
                target = entry->second;
                if (is_new) {
                    points.push_back(point);
                }
            }
            v = target;
        }
    }
    soup.points_mm = std::move(points);
    return used - static_cast<int>(soup.points_mm.size());
}

std::vector<std::array<std::int32_t, 2>> open_edges(const TriangleSoup& soup) {
    const std::vector<EdgeUse> uses = edge_uses(soup.faces);
    std::vector<std::array<std::int32_t, 2>> open;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const auto same = [&](std::size_t j) {
            return uses[j].low == uses[i].low && uses[j].high == uses[i].high;
        };
        if (uses[i].low != uses[i].high && (i == 0 || !same(i - 1)) &&
            (i + 1 == uses.size() || !same(i + 1))) {
            open.push_back({uses[i].low, uses[i].high});
        }
    }
    return open;
}

struct NearPair {
    double distance = 0.0;
    std::int32_t low = 0;
    std::int32_t high = 0;
};

std::vector<NearPair> near_pairs(const std::vector<Eigen::Vector3d>& points,
                                 const std::vector<std::int32_t>& candidates, double tolerance) {
    const auto cell_of = [&](const Eigen::Vector3d& point) {
        Key cell;
        for (int i = 0; i < 3; ++i) {
            cell[static_cast<std::size_t>(i)] =
                static_cast<std::int64_t>(std::floor(point[i] / tolerance));
        }
        return cell;
    };
    std::unordered_map<Key, std::vector<std::int32_t>, KeyHash> grid;
    std::vector<NearPair> pairs;
    for (const std::int32_t v : candidates) {
        const Eigen::Vector3d& point = points[static_cast<std::size_t>(v)];
        const Key cell = cell_of(point);
        for (int n = 0; n < 27; ++n) {
            const auto found =
                grid.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
            for (const std::int32_t u :
                 found == grid.end() ? std::vector<std::int32_t>{} : found->second) {
                const double distance = (points[static_cast<std::size_t>(u)] - point).norm();
                if (distance <= tolerance) {
                    pairs.push_back({distance, std::min(u, v), std::max(u, v)});
                }
            }
        }
        grid[cell].push_back(v);
    }
    std::sort(pairs.begin(), pairs.end(), [](const NearPair& a, const NearPair& b) {
        return std::tie(a.distance, a.low, a.high) < std::tie(b.distance, b.low, b.high);
    });
    return pairs;
}

// Joins sets of points, but never two that some face holds both of.
class PointSets {
public:
    PointSets(const TriangleSoup& soup, const std::vector<std::int32_t>& candidates)
        : faces_(soup.faces), parent_(soup.points_mm.size()) {
        std::iota(parent_.begin(), parent_.end(), 0);
        for (const std::int32_t v : candidates) {
            faces_of_[v];
        }
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            for (const std::int32_t v : faces_[f]) {
                if (const auto entry = faces_of_.find(v); entry != faces_of_.end()) {
                    entry->second.push_back(static_cast<std::int32_t>(f));
                }
            }
        }
    }

    [[nodiscard]] std::int32_t root(std::int32_t v) const {
        while (parent_[static_cast<std::size_t>(v)] != v) {
            v = parent_[static_cast<std::size_t>(v)];
        }
        return v;
    }

    bool join(std::int32_t a, std::int32_t b) {
        a = root(a);
        b = root(b);
        if (a == b) {
            return false;
        }
        const auto& [low, high] = std::minmax(a, b);
        for (const std::int32_t f : faces_of_.at(high)) {
            for (const std::int32_t v : faces_[static_cast<std::size_t>(f)]) {
                if (root(v) == low) {
                    return false;
                }
            }
        }
        parent_[static_cast<std::size_t>(high)] = low;
        auto& kept = faces_of_.at(low);
        kept.insert(kept.end(), faces_of_.at(high).begin(), faces_of_.at(high).end());
        return true;
    }

private:
    const std::vector<std::array<std::int32_t, 3>>& faces_;
    std::vector<std::int32_t> parent_;
    std::unordered_map<std::int32_t, std::vector<std::int32_t>> faces_of_;
};

}  // namespace

WeldReport weld(TriangleSoup& soup) {
    WeldReport report;
    report.welded_points = weld_equal(soup);
    const auto open = open_edges(soup);
    if (open.empty()) {
        return report;
    }
    std::vector<std::int32_t> border;
    for (const auto& edge : open) {
        border.insert(border.end(), edge.begin(), edge.end());
    }
    std::sort(border.begin(), border.end());
    border.erase(std::unique(border.begin(), border.end()), border.end());
    const double tolerance = kBorderWeldShare * diagonal_mm(soup);
    const std::vector<NearPair> pairs =
        tolerance > 0.0 ? near_pairs(soup.points_mm, border, tolerance) : std::vector<NearPair>{};
    if (pairs.empty()) {
        return report;
    }
    PointSets sets(soup, border);
    for (const NearPair& pair : pairs) {
        report.welded_points += sets.join(pair.low, pair.high) ? 1 : 0;
    }
    for (auto& face : soup.faces) {
        for (std::int32_t& v : face) {
            v = sets.root(v);
        }
    }
    weld_equal(soup);  // drops the points that lost their faces
    report.edges_stitched = static_cast<int>((open.size() - open_edges(soup).size()) / 2);
    return report;
}

}  // namespace meshwind
