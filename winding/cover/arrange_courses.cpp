#include "winding/cover/arrange_courses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "core/index.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Turns' fibre that a lateness of 1 is worth, moved over the whole plan, as an angle about the rim.
constexpr double kWorth_rad = 6.0 * kPi;

// Gains below this are rounding.
constexpr double kMinGain_rad = 1e-9;

class Arranger {
public:
    Arranger(std::span<const Rim> rims, std::span<const LibraryCourse> members,
             const CourseTurns& turns, std::span<const double> lateness,
             std::span<OrderedCourse> fibre, const ClosedTurns& closed)
        : members_(members), costs_(rims, members, turns, closed), fibre_(fibre), late_sum_{0.0} {
        std::partial_sum(lateness.begin(), lateness.end(), std::back_inserter(late_sum_));
        late_.assign(lateness.begin(), lateness.end());
    }

    void run() {
        // Each exchange gains something, so there is an end; the bound is against rounding.
        const std::size_t most = fibre_.size() * fibre_.size();
        for (std::size_t i = 0; i < most && exchange_best(); ++i) {
        }
    }

private:
    [[nodiscard]] const LibraryCourse& member(std::size_t i) const {
        return members_[at(fibre_[i].course.member)];
    }
    [[nodiscard]] const RimCrossing& start(std::size_t i) const {
        return start_of(member(i), fibre_[i].course.backward);
    }
    [[nodiscard]] const RimCrossing& end(std::size_t i) const {
        return end_of(member(i), fibre_[i].course.backward);
    }
    // Where the fibre is before course i; behind the last one for i = n.
    [[nodiscard]] std::size_t node(std::size_t i) const {
        return i < fibre_.size() ? departure_node(start(i)) : arrival_node(end(i - 1));
    }
    [[nodiscard]] double cost(std::size_t from, std::size_t to) {
        return costs_.rad(fibre_[from].course, fibre_[to].course);
    }

    // What it gains, as an angle of turning, that the courses i .. j - 1 and j .. k - 1 change
    // places.
    [[nodiscard]] double gain(std::size_t i, std::size_t j, std::size_t k) {
        const auto first = static_cast<double>(j - i);
        const auto second = static_cast<double>(k - j);
        const double later = (late_sum_[j] - late_sum_[i]) * second;
        const double earlier = (late_sum_[k] - late_sum_[j]) * first;
        const auto all = static_cast<double>(fibre_.size());
        double costs = cost(j - 1, j) - cost(k - 1, i);
        if (i > 0) {
            costs += cost(i - 1, i) - cost(i - 1, j);
        }
        if (k < fibre_.size()) {
            costs += cost(k - 1, k) - cost(j - 1, k);
        }
        return kWorth_rad * (later - earlier) / all + costs;
    }

    bool exchange_best() {
        const std::size_t n = fibre_.size();
        double most = kMinGain_rad;
        std::array<std::size_t, 3> best{};
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = i + 1; j < n; ++j) {
                for (std::size_t k = j + 1; node(i) == node(j) && k <= n; ++k) {
                    if (node(k) != node(i)) {
                        continue;
                    }
                    const double value = gain(i, j, k);
                    if (value > most) {
                        most = value;
                        best = {i, j, k};
                    }
                }
            }
        }
        const auto [i, j, k] = best;
        if (k == 0) {
            return false;
        }
        const auto turn = [](auto begin, std::size_t a, std::size_t b, std::size_t c) {
            const auto step = [&](std::size_t x) { return begin + static_cast<std::ptrdiff_t>(x); };
            std::rotate(step(a), step(b), step(c));
        };
        turn(fibre_.begin(), i, j, k);
        turn(late_.begin(), i, j, k);
        std::partial_sum(late_.begin(), late_.end(), late_sum_.begin() + 1);
        return true;
    }

    std::span<const LibraryCourse> members_;
    TurnCosts costs_;
    std::span<OrderedCourse> fibre_;
    std::vector<double> late_;
    std::vector<double> late_sum_;  // before each course, and behind the last
};

}  // namespace

void arrange(std::span<const Rim> rims, std::span<const LibraryCourse> members,
             const CourseTurns& turns, std::span<const double> lateness,
             std::vector<OrderedCourse>& order, const ClosedTurns& closed) {
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        end = begin + 1;
        while (end < order.size() && !order[end - 1].cut_after) {
            ++end;
        }
        const std::span<OrderedCourse> fibre = std::span(order).subspan(begin, end - begin);
        Arranger(rims, members, turns, lateness.subspan(begin, end - begin), fibre, closed).run();
        for (OrderedCourse& course : fibre) {
            course.cut_after = false;
        }
        fibre.back().cut_after = true;
    }
}

}  // namespace meshwind
