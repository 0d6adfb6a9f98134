/// Finds families of parallel courses, which make a plan readable and a winding even.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geodesic/surface_path.h"

namespace meshwind {

/// Least number of members of a family.
inline constexpr std::size_t kMinFamily = 3;

/// Shape of a course for finding neighbours: some places spread over it, and points close together.
class CourseShape {
public:
    /// \param path at least two points \param band_mm > 0
    CourseShape(const SurfacePath& path, double band_mm);

    /// True when each runs beside the other over most of its length: within one and a half bands,
    /// in nearly the same direction or against it.
    [[nodiscard]] bool is_neighbour(const CourseShape& other) const;

private:
    friend class CourseIndex;

    static constexpr int kLanes = 8;
    static constexpr std::size_t kPlaces = 24;
    using Lanes = Eigen::Array<float, kLanes, 1>;

    // Points and tangents that are tested at once, and what lies within reach of them. Single
    // precision is good to 0.1 um.
    struct Block {
        std::array<Lanes, 3> position_mm;
        std::array<Lanes, 3> tangent;
        Eigen::AlignedBox3f near_mm;
    };

    [[nodiscard]] bool runs_beside(const CourseShape& other) const;
    // The points that are tested first are those of block `hint`: where the place before passed.
    [[nodiscard]] bool passes(const Eigen::Vector3f& position_mm, const Eigen::Vector3f& tangent,
                              std::size_t& hint) const;
    [[nodiscard]] bool passes(const Block& block, const Eigen::Vector3f& position_mm,
                              const Eigen::Vector3f& tangent) const;

    std::array<Eigen::Vector3f, kPlaces> place_mm_;
    std::array<Eigen::Vector3f, kPlaces> tangent_;
    std::vector<Block> points_;
    Eigen::AlignedBox3f near_mm_;  // what lies within reach of any
    float most_mm2_;
};

/// Courses and which of them are neighbours.
class Neighbourhood {
public:
    [[nodiscard]] std::size_t size() const { return shape_.size(); }

    /// Per course: 1 where it and `shape` are neighbours.
    [[nodiscard]] std::vector<char> beside(const CourseShape& shape) const;

    /// \param row answer of beside() for the shape
    void add(CourseShape shape, const std::vector<char>& row);
    void replace(std::size_t course, CourseShape shape, const std::vector<char>& row);
    void remove(std::size_t course);

    /// Per course its family, numbered by their first members; -1 where it belongs to none.
    [[nodiscard]] std::vector<std::int32_t> families() const { return families({}, nullptr); }
    /// Number of courses without a family, with one taken out and one with `row` put in.
    [[nodiscard]] int without_family(std::optional<std::size_t> out = {},
                                     const std::vector<char>* row = nullptr) const;

private:
    [[nodiscard]] std::vector<std::int32_t> families(std::optional<std::size_t> out,
                                                     const std::vector<char>* row) const;

    std::vector<CourseShape> shape_;
    std::vector<std::vector<char>> beside_;
};

/// The family of every course, -1 where it belongs to none; numbered by their first members. A
/// family is joined by neighbours. Time grows with the courses' length and the number of those near
/// each other, not with their number squared.
/// \param courses in winding order \param band_mm > 0
[[nodiscard]] std::vector<std::int32_t> families_of(std::span<const SurfacePath* const> courses,
                                                    double band_mm);

}  // namespace meshwind
