#include "winding/cover/rim_joints.h"

#include <algorithm>
#include <numeric>

#include "winding/cover/balance_courses.h"

namespace meshwind {

RimJoints::RimJoints(std::size_t nodes, std::span<const PlacedCourse> courses)
    : nodes_(nodes), courses_(nodes * nodes, 0) {
    for (const PlacedCourse& course : courses) {
        add(course.member, course.backward, 1);
    }
}

void RimJoints::add(const LibraryCourse& member, bool backward, int times) {
    const auto [from, to] = nodes_of(member, backward);
    courses_[from * nodes_ + to] += times;
}

int RimJoints::excess(std::size_t node) const {
    int excess = 0;
    for (std::size_t other = 0; other < nodes_; ++other) {
        excess += courses_[other * nodes_ + node] - courses_[node * nodes_ + other];
    }
    return excess;
}

bool RimJoints::evener_backward(const LibraryCourse& member) const {
    // A course takes one from the excess of where it departs and adds one where it arrives.
    const auto unevener = [&](bool backward) {
        const auto [from, to] = nodes_of(member, backward);
        return excess(to) - excess(from);
    };
    return !member.windable_forward ||
           (member.windable_backward && unevener(true) < unevener(false));
}

std::vector<std::size_t> RimJoints::part_of() const {
    std::vector<std::size_t> part(nodes_);
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < nodes_; ++i) {
            for (std::size_t j = 0; j < nodes_; ++j) {
                if (courses_[i * nodes_ + j] > 0 && part[i] != part[j]) {
                    part[i] = part[j] = std::min(part[i], part[j]);
                    changed = true;
                }
            }
        }
    }
    return part;
}

bool RimJoints::has_courses(std::size_t node) const {
    for (std::size_t other = 0; other < nodes_; ++other) {
        if (courses_[other * nodes_ + node] + courses_[node * nodes_ + other] > 0) {
            return true;
        }
    }
    return false;
}

std::vector<int> RimJoints::starts(const std::vector<std::size_t>& part) const {
    std::vector<int> starts(nodes_, 0);
    for (std::size_t node = 0; node < nodes_; ++node) {
        starts[part[node]] += std::max(0, excess(node));
    }
    return starts;
}

int RimJoints::fibres() const {
    const std::vector<std::size_t> part = part_of();
    const std::vector<int> starting = starts(part);
    int fibres = 0;
    for (std::size_t node = 0; node < nodes_; ++node) {
        fibres += part[node] == node && has_courses(node) ? std::max(1, starting[node]) : 0;
    }
    return fibres;
}

}  // namespace meshwind
