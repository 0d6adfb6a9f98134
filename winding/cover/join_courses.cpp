#include "winding/cover/join_courses.h"

#include <algorithm>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "winding/cover/balance_courses.h"
#include "winding/laminate/coverage.h"

namespace meshwind {
namespace {

// Times that courses are added to join the others, each time some that the machine refuses.
constexpr int kMaxJoins = 200;

// Share of the wall for which a further fibre is tied on.
constexpr double kWorthAFibre = 0.002;

}  // namespace

void gather(std::span<const PlacedCourse> courses, std::size_t library_size,
            std::vector<LibraryCourse>& members) {
    members.resize(library_size);
    for (const PlacedCourse& course : courses) {
        members.push_back(course.member);
    }
}

void CourseJoiner::join(const JoinTask& task, std::vector<PlacedCourse>& courses) {
    const auto covered = [&] {
        return measure_coverage(layers_of(courses, task.samples)).fraction;
    };
    std::vector<PlacedCourse> before = courses;
    const double covered_before = covered();
    join_to(task, task.fibres, courses);
    if (task.fibres < task.most_fibres && covered() + kWorthAFibre < covered_before) {
        courses = std::move(before);
        join_to(task, task.most_fibres, courses);
    }
}

void CourseJoiner::join_to(const JoinTask& task, int fibres, std::vector<PlacedCourse>& courses) {
    for (int attempt = 0; attempt < kMaxJoins; ++attempt) {
        gather(courses, task.first_placed, task.members);
        std::vector<char> allowed(task.allowed.begin(), task.allowed.end());
        allowed.resize(task.members.size(), 0);
        Selection selection;
        selection.layers = layers_of(courses, task.samples);
        for (std::size_t i = task.first_placed; i < task.members.size(); ++i) {
            selection.chosen.push_back(static_cast<std::int32_t>(i));
        }
        const std::vector<DirectedCourse> laid =
            balance_courses(task.members, allowed, task.rims, task.select, fibres, selection);
        if (take_proven(task, laid, courses)) {
            return;
        }
    }
}

// The courses become what is laid, if all that is new holds.
bool CourseJoiner::take_proven(const JoinTask& task, std::span<const DirectedCourse> laid,
                               std::vector<PlacedCourse>& courses) {
    std::vector<PlacedCourse> taken(laid.size());
    std::vector<CourseFault> found(laid.size(), CourseFault::None);
    parallel_for(laid.size(), 1, [&](std::size_t i, std::size_t) {
        const std::size_t member = at(laid[i].member);
        if (member >= task.first_placed) {
            taken[i] = courses[member - task.first_placed];
        } else if (const auto before = proven_.find(laid[i]); before != proven_.end()) {
            taken[i] = before->second;
        } else {
            found[i] = task.place(laid[i], taken[i]);
        }
    });
    for (std::size_t i = 0; i < laid.size(); ++i) {
        const std::size_t number = at(laid[i].member);
        if (number >= task.first_placed) {
            continue;
        }
        if (found[i] == CourseFault::None) {
            proven_.try_emplace(laid[i], taken[i]);
            continue;
        }
        LibraryCourse& member = task.members[number];
        (laid[i].backward ? member.windable_backward : member.windable_forward) = false;
        if (!is_windable(member) && task.allowed[number] != 0) {
            task.strike_off(number, found[i]);
        }
    }
    const bool all = std::all_of(found.begin(), found.end(),
                                 [](CourseFault r) { return r == CourseFault::None; });
    if (all) {
        courses = std::move(taken);
    }
    return all;
}

}  // namespace meshwind
