#include "winding/families.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"

namespace meshwind {
namespace {

// Neighbours are no further apart than this, nor at a greater angle.
constexpr double kMostBands = 1.5;
constexpr double kMostAngle_rad = 10.0 * kPi / 180.0;
const auto kLeastCosine2 = static_cast<float>(std::cos(kMostAngle_rad) * std::cos(kMostAngle_rad));

// Of the places looked at on a course so large a share has the other course beside it.
constexpr double kBesideShare = 0.7;

// Distance of the points of a course, in bands: between two of them a course is at most 0.04 bands
// nearer than to either.
constexpr double kPointBands = 0.5;

// A point that is beside nothing.
constexpr float kFarOff_mm = 1e9F;

}  // namespace

CourseShape::CourseShape(const SurfacePath& path, double band_mm)
    : most_mm2_(static_cast<float>(kMostBands * band_mm * kMostBands * band_mm)) {
    for (std::size_t k = 0; k < kPlaces; ++k) {
        const PathPoint& point = path[(2 * k + 1) * path.size() / (2 * kPlaces)];
        place_mm_[k] = point.position_mm.cast<float>();
        tangent_[k] = point.tangent.cast<float>();
    }
    int lane = kLanes;
    double next_mm = path.front().s_mm;
    for (const PathPoint& point : path) {
        if (point.s_mm < next_mm && &point != &path.back()) {
            continue;
        }
        next_mm = point.s_mm + kPointBands * band_mm;
        if (lane == kLanes) {
            lane = 0;
            Block& block = points_.emplace_back();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.position_mm[axis].setConstant(kFarOff_mm);
                block.tangent[axis].setZero();
            }
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<Eigen::Index>(axis);
            points_.back().position_mm[axis](lane) = static_cast<float>(point.position_mm(k));
            points_.back().tangent[axis](lane) = static_cast<float>(point.tangent(k));
        }
        ++lane;
    }
}

bool CourseShape::passes(const Eigen::Vector3f& position_mm, const Eigen::Vector3f& tangent) const {
    return std::any_of(points_.begin(), points_.end(), [&](const Block& block) {
        const Lanes x = block.position_mm[0] - position_mm.x();
        const Lanes y = block.position_mm[1] - position_mm.y();
        const Lanes z = block.position_mm[2] - position_mm.z();
        const Lanes cosine = block.tangent[0] * tangent.x() + block.tangent[1] * tangent.y() +
                             block.tangent[2] * tangent.z();
        return (x * x + y * y + z * z <= most_mm2_ && cosine * cosine >= kLeastCosine2).any();
    });
}

bool CourseShape::runs_beside(const CourseShape& other) const {
    const auto least = static_cast<std::size_t>(std::ceil(kBesideShare * kPlaces));
    std::size_t beside = 0;
    for (std::size_t k = 0; k < kPlaces && beside + (kPlaces - k) >= least; ++k) {
        beside += other.passes(place_mm_[k], tangent_[k]) ? 1 : 0;
    }
    return beside >= least;
}

bool CourseShape::is_neighbour(const CourseShape& other) const {
    return runs_beside(other) && other.runs_beside(*this);
}

std::vector<char> Neighbourhood::beside(const CourseShape& shape) const {
    std::vector<char> row(shape_.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] = shape.is_neighbour(shape_[i]) ? 1 : 0;
    }
    return row;
}

void Neighbourhood::add(CourseShape shape, const std::vector<char>& row) {
    for (std::size_t i = 0; i < shape_.size(); ++i) {
        beside_[i].push_back(row[i]);
    }
    shape_.push_back(std::move(shape));
    beside_.push_back(row);
    beside_.back().push_back(0);
}

void Neighbourhood::replace(std::size_t course, CourseShape shape, const std::vector<char>& row) {
    shape_[course] = std::move(shape);
    beside_[course] = row;
    for (std::size_t i = 0; i < shape_.size(); ++i) {
        beside_[i][course] = row[i];
    }
    beside_[course][course] = 0;
}

void Neighbourhood::remove(std::size_t course) {
    const auto offset = static_cast<std::ptrdiff_t>(course);
    shape_.erase(shape_.begin() + offset);
    beside_.erase(beside_.begin() + offset);
    for (std::vector<char>& row : beside_) {
        row.erase(row.begin() + offset);
    }
}

std::vector<std::int32_t> Neighbourhood::families(std::optional<std::size_t> out,
                                                  const std::vector<char>* row) const {
    const std::size_t n = size();
    const auto are_neighbours = [&](std::size_t i, std::size_t j) {
        return i == n ? (*row)[j] != 0 : j == n ? (*row)[i] != 0 : beside_[i][j] != 0;
    };
    const std::size_t count = n + (row != nullptr ? 1 : 0);
    std::vector<std::int32_t> family(count, -1);
    std::vector<char> seen(count, 0);
    if (out) {
        seen[*out] = 1;
    }
    std::int32_t families = 0;
    std::vector<std::size_t> members;
    for (std::size_t first = 0; first < count; ++first) {
        if (seen[first] != 0) {
            continue;
        }
        seen[first] = 1;
        members.assign(1, first);
        for (std::size_t k = 0; k < members.size(); ++k) {
            for (std::size_t j = first + 1; j < count; ++j) {
                if (seen[j] == 0 && are_neighbours(members[k], j)) {
                    seen[j] = 1;
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

int Neighbourhood::without_family(std::optional<std::size_t> out,
                                  const std::vector<char>* row) const {
    const std::vector<std::int32_t> family = families(out, row);
    return static_cast<int>(std::count(family.begin(), family.end(), -1)) - (out ? 1 : 0);
}

std::vector<std::int32_t> families_of(std::span<const SurfacePath* const> courses, double band_mm) {
    Neighbourhood all;
    for (const SurfacePath* course : courses) {
        CourseShape shape(*course, band_mm);
        const std::vector<char> row = all.beside(shape);
        all.add(std::move(shape), row);
    }
    return all.families();
}

}  // namespace meshwind
