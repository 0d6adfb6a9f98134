/// Arrivals, departures and connected parts of the rims' nodes, joined by the courses of a plan.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "winding/cover/library.h"

namespace meshwind {

/// Numbers of courses that lead from node to node (see balance_courses.h).
class RimJoints {
public:
    explicit RimJoints(std::size_t nodes, std::span<const PlacedCourse> courses = {});

    void add(const LibraryCourse& member, bool backward, int times);

    /// Arrivals less departures.
    [[nodiscard]] int excess(std::size_t node) const;

    /// True when a windable member, of the ways it can be wound, leaves arrivals and departures
    /// more even wound backward.
    [[nodiscard]] bool evener_backward(const LibraryCourse& member) const;

    /// Per node the lowest node that courses connect it to; its own number where there are none.
    [[nodiscard]] std::vector<std::size_t> part_of() const;

    [[nodiscard]] bool has_courses(std::size_t node) const;

    /// Per node that part_of() names: fibres that start in its part for want of an arrival.
    [[nodiscard]] std::vector<int> starts(const std::vector<std::size_t>& part) const;

    /// Continuous fibres that the courses make: in each part as many as start there, at least one.
    [[nodiscard]] int fibres() const;

private:
    std::size_t nodes_;
    std::vector<int> courses_;
};

}  // namespace meshwind
