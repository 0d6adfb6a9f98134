#include "postproc/motion/mend_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/margins.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Clearance is added so far to either side.
constexpr double kNear_mm = 20.0;

// Fibre to either side whose motion may change: in it the axes come from their speed to rest and
// back.
constexpr double kMendReach_mm = 100.0;

// And about a place where the first motion is put back, with lengths perhaps 200 mm longer.
constexpr double kPutBackReach_mm = 400.0;

// Fibre that lies wrong was pulled there over about so much.
constexpr double kPulledReach_mm = 100.0;

// Places of a mending: about the stations themselves.
constexpr double kMendingKnot_mm = 3.0;

}  // namespace

MotionImprover::MotionImprover(const Machine& machine, const RayQuery& obstacles,
                               const FreeFibreRule& rule, double fibre_speed_mm_s,
                               bool fixed_lengths, EyePath safe, std::vector<double> ahead_mm)
    : machine_(machine),
      obstacles_(obstacles),
      rule_(rule),
      fibre_speed_mm_s_(fibre_speed_mm_s),
      fixed_lengths_(fixed_lengths),
      safe_(std::move(safe)),
      path_(safe_),
      ahead_mm_(std::move(ahead_mm)),
      more_mm_(safe_.size(), margin::kFirstMotion_mm),
      tries_(safe_.size(), 0),
      given_up_(safe_.size(), 0) {}

void MotionImprover::choose() {
    optimise({}, false);
    changed_ = {{0, path_.size() - 1}};
}

void MotionImprover::optimise(std::span<const char> free, bool mending) {
    path_ = optimal_motion({.machine = machine_,
                            .obstacles = obstacles_,
                            .path = path_,
                            .ahead_mm = ahead_mm_,
                            .rule = rule_,
                            .more_mm = more_mm_,
                            .free = free,
                            .fibre_speed_mm_s = fibre_speed_mm_s_,
                            .knot_mm = mending ? kMendingKnot_mm : kKnot_mm,
                            .from_given = mending,
                            .fixed_lengths = fixed_lengths_});
}

MotionImprover::Range MotionImprover::about(std::size_t station, double reach_mm) const {
    const double s_mm = path_[station].s_mm;
    Range range{station, station};
    while (range.first > 0 && s_mm - path_[range.first - 1].s_mm <= reach_mm) {
        --range.first;
    }
    while (range.second + 1 < path_.size() && path_[range.second + 1].s_mm - s_mm <= reach_mm) {
        ++range.second;
    }
    return range;
}

void MotionImprover::mark(std::size_t station, double reach_mm, std::vector<char>& marks) const {
    const auto [first, last] = about(station, reach_mm);
    std::fill(marks.begin() + static_cast<std::ptrdiff_t>(first),
              marks.begin() + static_cast<std::ptrdiff_t>(last) + 1, 1);
}

bool MotionImprover::mark_back(std::size_t station, double reach_mm,
                               std::vector<char>& marks) const {
    const double path_mm = path_.back().s_mm - path_.front().s_mm;
    for (double reach = reach_mm; reach < 2.0 * path_mm; reach *= 2.0) {
        mark(station, reach, marks);
        const auto [first, last] = about(station, reach);
        const auto given_up = given_up_.begin() + static_cast<std::ptrdiff_t>(first);
        if (std::find(given_up, given_up_.begin() + static_cast<std::ptrdiff_t>(last) + 1, 0) !=
            given_up_.begin() + static_cast<std::ptrdiff_t>(last) + 1) {
            return true;
        }
    }
    return false;
}

bool MotionImprover::mend(std::span<const std::size_t> stations) {
    std::vector<char> near(path_.size(), 0);
    std::vector<char> free(path_.size(), 0);
    std::vector<char> back(path_.size(), 0);
    bool any_back = false;
    for (const std::size_t station : stations) {
        mark(station, kNear_mm, near);
        mark(station, kMendReach_mm, free);
        if (given_up_[station] != 0 || tries_[station] >= kMendings) {
            any_back = true;
            if (!mark_back(station, kNear_mm, back)) {
                return false;
            }
        }
    }
    for (std::size_t i = 0; i < path_.size(); ++i) {
        more_mm_[i] += near[i] != 0 ? margin::kMended_mm : 0.0;
        tries_[i] += near[i] != 0 ? 1 : 0;
    }
    std::vector<char> changed = free;
    if (any_back) {
        put_back(back, changed);
    }
    for (std::size_t i = 0; i < path_.size(); ++i) {
        free[i] = static_cast<char>(free[i] != 0 && given_up_[i] == 0);
    }
    optimise(free, true);
    note_changes(changed);
    return true;
}

bool MotionImprover::give_up(std::span<const std::size_t> stations) {
    std::vector<char> back(path_.size(), 0);
    for (const std::size_t station : stations) {
        if (!mark_back(station, kPulledReach_mm, back)) {
            return false;
        }
    }
    std::vector<char> changed(path_.size(), 0);
    put_back(back, changed);
    note_changes(changed);
    return true;
}

// Turned on by whole turns to where the present motion is; what is to either side comes there and
// goes from there by the grid.
void MotionImprover::put_back(const std::vector<char>& marks, std::vector<char>& changed) {
    std::vector<char> free(path_.size(), 0);
    for (std::size_t i = 0; i < path_.size(); ++i) {
        if (marks[i] == 0) {
            continue;
        }
        const double whole_rad =
            2.0 * kPi * std::round((path_[i].turn_rad - safe_[i].turn_rad) / (2.0 * kPi));
        path_[i] = safe_[i];
        path_[i].turn_rad += whole_rad;
        given_up_[i] = 1;
        if (i == 0 || i + 1 == marks.size() || marks[i - 1] == 0 || marks[i + 1] == 0) {
            mark(i, kPutBackReach_mm, free);
        }
    }
    for (std::size_t i = 0; i < path_.size(); ++i) {
        changed[i] = static_cast<char>(changed[i] != 0 || free[i] != 0 || marks[i] != 0);
        free[i] = static_cast<char>(free[i] != 0 && given_up_[i] == 0);
    }
    optimise(free, false);
}

void MotionImprover::note_changes(const std::vector<char>& changed) {
    changed_.clear();
    for (std::size_t i = 0; i < path_.size(); ++i) {
        if (changed[i] == 0) {
            continue;
        }
        if (!changed_.empty() && changed_.back().second + 1 == i) {
            changed_.back().second = i;
        } else {
            changed_.emplace_back(i, i);
        }
    }
}

}  // namespace meshwind
