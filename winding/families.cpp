#include "winding/families.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Neighbours are no further apart than this, nor at a greater angle.
constexpr double kMostBands = 1.5;
constexpr double kMostAngle_rad = 10.0 * kPi / 180.0;

// Of the places looked at on a course so large a share has the other course beside it.
constexpr double kBesideShare = 0.7;
constexpr std::size_t kPlaces = 24;

// Share of a course's places that have another beside them.
double share_beside(const SurfacePath& course, const SurfacePath& other, double most_mm) {
    const double cosine = std::cos(kMostAngle_rad);
    std::size_t beside = 0;
    for (std::size_t k = 0; k < kPlaces; ++k) {
        const PathPoint& place = course[(2 * k + 1) * course.size() / (2 * kPlaces)];
        double nearest = std::numeric_limits<double>::infinity();
        const PathPoint* at = nullptr;
        for (const PathPoint& point : other) {
            const double distance = (point.position_mm - place.position_mm).squaredNorm();
            if (distance < nearest) {
                nearest = distance;
                at = &point;
            }
        }
        beside += at != nullptr && nearest <= most_mm * most_mm &&
                          std::abs(at->tangent.dot(place.tangent)) >= cosine
                      ? 1
                      : 0;
    }
    return static_cast<double>(beside) / static_cast<double>(kPlaces);
}

}  // namespace

std::vector<std::int32_t> families_of(std::span<const SurfacePath* const> courses, double band_mm) {
    const std::size_t n = courses.size();
    std::vector<char> beside(n * n, 0);
    parallel_for(n, 1, [&](std::size_t i, std::size_t) {
        for (std::size_t j = 0; j < n; ++j) {
            beside[i * n + j] = i != j && share_beside(*courses[i], *courses[j],
                                                       kMostBands * band_mm) >= kBesideShare
                                    ? 1
                                    : 0;
        }
    });
    std::vector<std::int32_t> family(n, -1);
    std::int32_t families = 0;
    for (std::size_t first = 0; first < n; ++first) {
        std::vector<std::size_t> members{first};
        std::vector<char> taken(n, 0);
        taken[first] = 1;
        for (std::size_t k = 0; family[first] < 0 && k < members.size(); ++k) {
            for (std::size_t j = 0; j < n; ++j) {
                if (taken[j] == 0 && beside[members[k] * n + j] != 0 &&
                    beside[j * n + members[k]] != 0) {
                    taken[j] = 1;
                    members.push_back(j);
                }
            }
        }
        if (members.size() >= kLeastFamily) {
            for (const std::size_t member : members) {
                family[member] = families;
            }
            ++families;
        }
    }
    return family;
}

}  // namespace meshwind
