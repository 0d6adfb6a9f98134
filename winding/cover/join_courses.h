/// Joins courses to few fibres by adding members of the library.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "winding/cover/placed_course.h"
#include "winding/cover/select_courses.h"
#include "winding/plan/course.h"
#include "winding/plan/course_fault.h"

namespace meshwind {

/// Input of the joining.
struct JoinTask {
    std::vector<LibraryCourse>& members;  ///< the library; the plan's courses are put behind it
    std::size_t first_placed = 0;         ///< where these begin
    std::span<const char> allowed;        ///< per member of the library
    std::size_t rims = 0;
    std::size_t samples = 0;
    const SelectOptions& select;
    int fibres = 1;       ///< that are needed
    int most_fibres = 1;  ///< that are taken where they cover more
    /// Puts a member of the library in its place and proves it. Thread-safe.
    std::function<CourseFault(const DirectedCourse&, PlacedCourse&)> place;
    /// Called with an allowed member that holds neither way.
    std::function<void(std::size_t member, CourseFault)> strike_off;
};

/// Puts the plan's courses behind those of the library.
void gather(std::span<const PlacedCourse> courses, std::size_t library_size,
            std::vector<LibraryCourse>& members);

/// Joins courses, and keeps proven ones for the next call.
class CourseJoiner {
public:
    /// Adds members that hold until as many courses arrive as depart, wherever there is a way
    /// (balance_courses.h); those that do not hold are noted in the library. \param courses the
    /// plan's
    void join(const JoinTask& task, std::vector<PlacedCourse>& courses);

private:
    void join_to(const JoinTask& task, int fibres, std::vector<PlacedCourse>& courses);
    [[nodiscard]] bool take_proven(const JoinTask& task, std::span<const DirectedCourse> laid,
                                   std::vector<PlacedCourse>& courses);

    std::map<DirectedCourse, PlacedCourse> proven_;
};

}  // namespace meshwind
