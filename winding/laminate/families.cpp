#include "winding/laminate/families.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "core/parallel.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Neighbours are no further apart than this, nor at a greater angle.
constexpr double kMaxBands = 1.5;
constexpr double kMaxAngle_rad = 10.0 * kPi / 180.0;
const auto kMinCosine2 = static_cast<float>(std::cos(kMaxAngle_rad) * std::cos(kMaxAngle_rad));

// Of the places looked at on a course so large a share has the other course beside it.
constexpr double kBesideShare = 0.7;

// Distance of the points of a course, in bands: between two of them a course is at most 0.04 bands
// nearer than to either.
constexpr double kPointBands = 0.5;

// What lies within reach of points is counted this much larger, for rounding: by a share of the
// reach and of the coordinates.
constexpr float kReachRounding = 1e-3F;
constexpr float kSingleRounding = 1e-6F;

// A point that is beside nothing.
constexpr float kFarOff_mm = 1e9F;

}  // namespace

CourseShape::CourseShape(const SurfacePath& path, double band_mm)
    : most_mm2_(static_cast<float>(kMaxBands * band_mm * kMaxBands * band_mm)) {
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
        points_.back().near_mm.extend(point.position_mm.cast<float>());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<Eigen::Index>(axis);
            points_.back().position_mm[axis](lane) = static_cast<float>(point.position_mm(k));
            points_.back().tangent[axis](lane) = static_cast<float>(point.tangent(k));
        }
        ++lane;
    }
    for (Block& block : points_) {
        const Eigen::Vector3f& low = block.near_mm.min();
        const Eigen::Vector3f& high = block.near_mm.max();
        const float largest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
        const Eigen::Vector3f reach = Eigen::Vector3f::Constant(
            (1.0F + kReachRounding) * std::sqrt(most_mm2_) + kSingleRounding * largest);
        block.near_mm = {low - reach, high + reach};
        near_mm_.extend(block.near_mm);
    }
}

bool CourseShape::passes(const Block& block, const Eigen::Vector3f& position_mm,
                         const Eigen::Vector3f& tangent) const {
    if (!block.near_mm.contains(position_mm)) {
        return false;
    }
    const Lanes x = block.position_mm[0] - position_mm.x();
    const Lanes y = block.position_mm[1] - position_mm.y();
    const Lanes z = block.position_mm[2] - position_mm.z();
    const Lanes cosine = block.tangent[0] * tangent.x() + block.tangent[1] * tangent.y() +
                         block.tangent[2] * tangent.z();
    return (x * x + y * y + z * z <= most_mm2_ && cosine * cosine >= kMinCosine2).any();
}

bool CourseShape::passes(const Eigen::Vector3f& position_mm, const Eigen::Vector3f& tangent,
                         std::size_t& hint) const {
    if (passes(points_[hint], position_mm, tangent)) {
        return true;
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (passes(points_[i], position_mm, tangent)) {
            hint = i;
            return true;
        }
    }
    return false;
}

bool CourseShape::runs_beside(const CourseShape& other) const {
    const auto least = static_cast<std::size_t>(std::ceil(kBesideShare * kPlaces));
    const auto within =
        std::count_if(place_mm_.begin(), place_mm_.end(),
                      [&](const Eigen::Vector3f& place) { return other.near_mm_.contains(place); });
    if (static_cast<std::size_t>(within) < least) {
        return false;
    }
    std::size_t beside = 0;
    std::size_t hint = 0;
    for (std::size_t k = 0; k < kPlaces && beside + (kPlaces - k) >= least; ++k) {
        beside += other.passes(place_mm_[k], tangent_[k], hint) ? 1 : 0;
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
        if (members.size() >= kMinFamily) {
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

// The places of all courses in a grid, for points of a course to find those that they are beside:
// by the same arithmetic as CourseShape::is_neighbour.
class CourseIndex {
public:
    CourseIndex(std::span<const SurfacePath* const> courses, double band_mm)
        : cell_mm_(kCellSlack * kMaxBands * band_mm) {
        shape_.reserve(courses.size());
        for (const SurfacePath* course : courses) {
            shape_.emplace_back(*course, band_mm);
        }
        for (std::size_t i = 0; i < shape_.size() * kPlaces; ++i) {
            const Cell middle = cell_of(place_mm(i));
            for (std::int32_t x = -1; x <= 1; ++x) {
                for (std::int32_t y = -1; y <= 1; ++y) {
                    for (std::int32_t z = -1; z <= 1; ++z) {
                        places_[key({middle[0] + x, middle[1] + y, middle[2] + z})].push_back(
                            static_cast<std::int32_t>(i));
                    }
                }
            }
        }
    }

    // Per course its neighbours, ascending.
    [[nodiscard]] std::vector<std::vector<std::int32_t>> neighbours() const {
        // Who runs beside each course, and who of them has it beside them, too.
        std::vector<std::vector<std::int32_t>> beside(shape_.size());
        parallel_for(shape_.size(), kCourseChunk, [&](std::size_t begin, std::size_t end) {
            Marks marks(shape_.size());
            for (std::size_t course = begin; course < end; ++course) {
                beside[course] = running_beside(course, marks);
            }
        });
        std::vector<std::vector<std::int32_t>> mutual(shape_.size());
        for (std::size_t a = 0; a < beside.size(); ++a) {
            std::copy_if(beside[a].begin(), beside[a].end(), std::back_inserter(mutual[a]),
                         [&](std::int32_t b) {
                             return std::binary_search(beside[static_cast<std::size_t>(b)].begin(),
                                                       beside[static_cast<std::size_t>(b)].end(),
                                                       static_cast<std::int32_t>(a));
                         });
        }
        return mutual;
    }

private:
    static constexpr std::size_t kPlaces = CourseShape::kPlaces;
    static constexpr std::size_t kCourseChunk = 16;
    // Cells are wider than what is looked for by more than single precision loses.
    static constexpr double kCellSlack = 1.001;

    using Cell = std::array<std::int32_t, 3>;

    struct Marks {
        explicit Marks(std::size_t courses) : seen(courses * kPlaces, -1), count(courses, 0) {}
        std::vector<std::int32_t> seen;   // per place: the course that passed it last
        std::vector<std::int32_t> count;  // per course: of its places
    };

    [[nodiscard]] const Eigen::Vector3f& place_mm(std::size_t i) const {
        return shape_[i / kPlaces].place_mm_[i % kPlaces];
    }

    [[nodiscard]] Cell cell_of(const Eigen::Vector3f& position_mm) const {
        Cell cell{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cell[axis] = static_cast<std::int32_t>(std::floor(
                static_cast<double>(position_mm(static_cast<Eigen::Index>(axis))) / cell_mm_));
        }
        return cell;
    }

    // Cells that share a key cost time, nothing else.
    static std::uint64_t key(const Cell& cell) {
        std::uint64_t hash = 0;
        for (const std::int32_t x : cell) {
            hash = (hash << 21) ^ (hash >> 43) ^ static_cast<std::uint32_t>(x);
        }
        return hash;
    }

    // Courses that most of their places are beside this one of, ascending.
    [[nodiscard]] std::vector<std::int32_t> running_beside(std::size_t course, Marks& marks) const {
        const CourseShape& shape = shape_[course];
        std::vector<std::int32_t> met;
        for (const CourseShape::Block& block : shape.points_) {
            for (Eigen::Index lane = 0; lane < CourseShape::kLanes; ++lane) {
                const Eigen::Vector3f at(block.position_mm[0](lane), block.position_mm[1](lane),
                                         block.position_mm[2](lane));
                if (at.x() == kFarOff_mm) {
                    continue;
                }
                const Eigen::Vector3f tangent(block.tangent[0](lane), block.tangent[1](lane),
                                              block.tangent[2](lane));
                pass(course, at, tangent, marks, met);
            }
        }
        const auto least =
            static_cast<std::int32_t>(std::ceil(kBesideShare * static_cast<double>(kPlaces)));
        std::vector<std::int32_t> found;
        for (const std::int32_t other : met) {
            std::int32_t& count = marks.count[static_cast<std::size_t>(other)];
            if (count >= least && static_cast<std::size_t>(other) != course) {
                found.push_back(other);
            }
            count = 0;
        }
        std::sort(found.begin(), found.end());
        return found;
    }

    // Counts the places about a point of the course, each once.
    void pass(std::size_t course, const Eigen::Vector3f& at, const Eigen::Vector3f& tangent,
              Marks& marks, std::vector<std::int32_t>& met) const {
        const auto near = places_.find(key(cell_of(at)));
        if (near == places_.end()) {
            return;
        }
        for (const std::int32_t place : near->second) {
            const auto i = static_cast<std::size_t>(place);
            if (marks.seen[i] == static_cast<std::int32_t>(course)) {
                continue;
            }
            const CourseShape& other = shape_[i / kPlaces];
            const Eigen::Vector3f& along = other.tangent_[i % kPlaces];
            const float x = at.x() - place_mm(i).x();
            const float y = at.y() - place_mm(i).y();
            const float z = at.z() - place_mm(i).z();
            const float cosine =
                tangent.x() * along.x() + tangent.y() * along.y() + tangent.z() * along.z();
            if (x * x + y * y + z * z <= shape_[course].most_mm2_ &&
                cosine * cosine >= kMinCosine2) {
                marks.seen[i] = static_cast<std::int32_t>(course);
                std::int32_t& count = marks.count[i / kPlaces];
                if (count++ == 0) {
                    met.push_back(static_cast<std::int32_t>(i / kPlaces));
                }
            }
        }
    }

    double cell_mm_;
    std::vector<CourseShape> shape_;
    std::unordered_map<std::uint64_t, std::vector<std::int32_t>> places_;  // per cell
};

std::vector<std::int32_t> families_of(std::span<const SurfacePath* const> courses, double band_mm) {
    const std::vector<std::vector<std::int32_t>> neighbours =
        CourseIndex(courses, band_mm).neighbours();
    std::vector<std::int32_t> family(courses.size(), -1);
    std::vector<char> seen(courses.size(), 0);
    std::int32_t families = 0;
    for (std::size_t first = 0; first < courses.size(); ++first) {
        if (seen[first] != 0) {
            continue;
        }
        seen[first] = 1;
        std::vector<std::size_t> members{first};
        for (std::size_t k = 0; k < members.size(); ++k) {
            for (const std::int32_t other : neighbours[members[k]]) {
                const auto next = static_cast<std::size_t>(other);
                if (seen[next] == 0) {
                    seen[next] = 1;
                    members.push_back(next);
                }
            }
        }
        if (members.size() >= kMinFamily) {
            for (const std::size_t member : members) {
                family[member] = families;
            }
            ++families;
        }
    }
    return family;
}

}  // namespace meshwind
