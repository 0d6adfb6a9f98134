#include "winding/bound/fibre_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "core/index.h"
#include "core/linear_programme.h"
#include "core/parallel.h"
#include "core/units.h"
#include "mesh/nearest.h"

namespace meshwind {
namespace {

// Rows, each of a cell of samples. More take longer by their square.
constexpr std::size_t kMostRows = 400;

// Columns that are added at a time, and rounds of that.
constexpr std::size_t kColumnsOfARound = 300;
constexpr int kMostRounds = 60;

// A column pays where it is worth more than it costs by this share of that: not by rounding.
constexpr double kPays = 1e-7;

// The bound is good enough within this share of what has been found.
constexpr double kGoodEnough = 0.01;

// A layer that lacks beyond the share allowed costs so many times the fibre that it would be.
constexpr double kLacks = 50.0;

// Like courses are those between the same nodes whose first ends are at angles in one of these
// steps: they stand in the order of their azimuths.
constexpr double kLikeAngle_rad = 10.0 * kPi / 180.0;

}  // namespace

struct FibreBoundFinder::State {
    explicit State(const BoundTask& task) : task_(task), row_(task.asked.size(), -1) {
        choose_rows();
        fill_columns();
        if (!rows_.empty()) {
            programme_.emplace(row_bounds());
            add_lacking();
            add_first();
        }
    }

    FibreBound run() {
        FibreBound bound;
        bound.forward.assign(task_.members.size(), 0.0);
        bound.backward.assign(task_.members.size(), 0.0);
        if (rows_.empty()) {
            return bound;
        }
        LinearProgramme::Solution solution;
        for (int round = 0; round < kMostRounds; ++round) {
            solution = programme_->solve();
            if (!solution.feasible) {
                break;
            }
            const std::vector<double> price = feasible(solution.price);
            const std::vector<double> reduced = reduced_costs(price);
            bound.least_mm = std::max(bound.least_mm, bound_of(price, reduced));
            if (!solution.optimal || bound.least_mm >= (1.0 - kGoodEnough) * solution.cost ||
                !add_best(reduced)) {
                break;
            }
        }
        if (solution.feasible) {
            take(solution, bound);
        }
        return bound;
    }

    void strike_off(std::int32_t member) {
        for (Column& column : columns_) {
            if (column.member == member) {
                column.open = false;
                if (column.number >= 0) {
                    programme_->close(column.number);
                }
            }
        }
    }

private:
    // A cell of samples.
    struct Row {
        double asked = 0.0;  // layers, on average
        double share = 0.0;  // of the samples, 1 on average
        double samples = 0.0;
    };

    // A member in one direction.
    struct Column {
        std::int32_t member = -1;
        bool backward = false;
        int number = -1;  // in the programme, once it is there
        bool open = true;
    };

    void choose_rows() {
        std::vector<std::size_t> asking;
        for (std::size_t i = 0; i < task_.asked.size(); ++i) {
            if (task_.reached[i] != 0 && task_.asked[i] > 0) {
                asking.push_back(i);
            }
        }
        const std::size_t n = std::min(kMostRows, asking.size());
        std::vector<std::size_t> centres;
        centres.reserve(n);
        for (std::size_t k = 0; k < n; ++k) {
            centres.push_back(asking[k * asking.size() / n]);
        }
        if (task_.position_mm.empty() || n == asking.size()) {
            asking = centres;
            for (std::size_t k = 0; k < n; ++k) {
                row_[asking[k]] = static_cast<std::int32_t>(k);
            }
        } else {
            std::vector<Eigen::Vector3d> centres_mm;
            centres_mm.reserve(n);
            for (const std::size_t sample : centres) {
                centres_mm.push_back(task_.position_mm[sample]);
            }
            const NearestPoints cells(centres_mm);
            for (const std::size_t sample : asking) {
                row_[sample] = cells.nearest(task_.position_mm[sample]);
            }
        }
        rows_.resize(n);
        for (const std::size_t sample : asking) {
            Row& row = rows_[at(row_[sample])];
            row.samples += 1.0;
            row.asked += task_.asked[sample];
        }
        for (Row& row : rows_) {
            row.share = row.samples * static_cast<double>(n) / static_cast<double>(asking.size());
            row.asked /= row.samples;
            asked_ += row.share * row.asked;
        }
    }

    void fill_columns() {
        covers_.resize(task_.members.size());
        for (std::size_t i = 0; i < task_.members.size(); ++i) {
            const Member& member = task_.members[i];
            if (task_.allowed[i] == 0) {
                continue;
            }
            std::vector<std::int32_t> rows;
            for (const std::int32_t sample : member.footprint) {
                if (row_[at(sample)] >= 0) {
                    rows.push_back(row_[at(sample)]);
                }
            }
            std::sort(rows.begin(), rows.end());
            for (const std::int32_t row : rows) {
                if (covers_[i].empty() || covers_[i].back().row != row) {
                    covers_[i].push_back({row, 0.0});
                }
                covers_[i].back().value += 1.0 / rows_[at(row)].samples;
            }
            if (member.windable_forward) {
                columns_.push_back({static_cast<std::int32_t>(i), false});
            }
            if (member.windable_backward) {
                columns_.push_back({static_cast<std::int32_t>(i), true});
            }
        }
    }

    [[nodiscard]] std::vector<LinearProgramme::Row> row_bounds() const {
        constexpr double kNoEnd = std::numeric_limits<double>::infinity();
        std::vector<LinearProgramme::Row> bounds;
        for (const Row& row : rows_) {
            bounds.push_back({row.asked, kNoEnd});
        }
        bounds.resize(rows_.size() + task_.nodes, {0.0, 0.0});
        bounds.push_back({-kNoEnd, task_.most_below * asked_});
        return bounds;
    }

    [[nodiscard]] int budget_row() const { return static_cast<int>(rows_.size() + task_.nodes); }

    // What may lack, and what lacks beyond that, so that there is a solution from the first.
    void add_lacking() {
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            const std::array<RowEntry, 2> entries{RowEntry{static_cast<int>(r), 1.0},
                                                  RowEntry{budget_row(), rows_[r].share}};
            programme_->add_column(0.0, rows_[r].asked, entries);
        }
        const std::array<RowEntry, 1> beyond{RowEntry{budget_row(), -1.0}};
        programme_->add_column(kLacks * fibre_of_a_row_mm(),
                               std::numeric_limits<double>::infinity(), beyond);
    }

    // Fibre that covers what a row stands for, on average over the library.
    [[nodiscard]] double fibre_of_a_row_mm() const {
        double length_mm = 0.0;
        double covered = 0.0;
        for (const Column& column : columns_) {
            length_mm += task_.members[at(column.member)].length_mm;
            for (const RowEntry& cell : covers_[at(column.member)]) {
                covered += cell.value;
            }
        }
        return length_mm / std::max(1.0, covered);
    }

    [[nodiscard]] double cost(const Column& column) const {
        const Member& member = task_.members[at(column.member)];
        return member.length_mm + member.turn_mm + task_.off_angle_cost * member.off_angle_mm;
    }

    void add(Column& column) {
        std::vector<RowEntry> entries = covers_[at(column.member)];
        const auto [from, to] = nodes_of(task_.members[at(column.member)], column.backward);
        if (from != to) {
            entries.push_back({static_cast<int>(rows_.size() + from), -1.0});
            entries.push_back({static_cast<int>(rows_.size() + to), 1.0});
        }
        column.number =
            programme_->add_column(cost(column), std::numeric_limits<double>::infinity(), entries);
    }

    // Some of all, evenly.
    void add_first() {
        const std::size_t n = std::min(columns_.size(), 2 * kColumnsOfARound);
        for (std::size_t k = 0; k < n; ++k) {
            add(columns_[k * columns_.size() / n]);
        }
    }

    [[nodiscard]] std::vector<double> reduced_costs(std::span<const double> price) const {
        std::vector<double> reduced(columns_.size());
        constexpr std::size_t kChunk = 512;
        parallel_for(columns_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const Column& column = columns_[k];
                double worth = 0.0;
                for (const RowEntry& cell : covers_[at(column.member)]) {
                    worth += cell.value * price[at(cell.row)];
                }
                const auto [from, to] = nodes_of(task_.members[at(column.member)], column.backward);
                worth += price[rows_.size() + to] - price[rows_.size() + from];
                reduced[k] = cost(column) - worth;
            }
        });
        return reduced;
    }

    // The prices as the dual programme wants them, whatever rounding says: no layer is worth less
    // than nothing, and what may lack is worth something.
    [[nodiscard]] std::vector<double> feasible(std::vector<double> price) const {
        double& budget = price[static_cast<std::size_t>(budget_row())];
        budget = std::min(0.0, budget);
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            price[r] = std::max(0.0, price[r]);
        }
        return price;
    }

    // Value of feasible prices once they are made small enough for every column to be worth no more
    // than it costs.
    [[nodiscard]] double bound_of(std::span<const double> price,
                                  std::span<const double> reduced) const {
        double scale = 1.0;
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            if (columns_[k].open && reduced[k] < 0.0) {
                const double costs = cost(columns_[k]);
                scale = std::min(scale, costs / (costs - reduced[k]));
            }
        }
        // A layer that lacks is bought for the budget's price: it counts no more than that.
        const double lack = -price[static_cast<std::size_t>(budget_row())];
        double value = -lack * task_.most_below * asked_;
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            value += rows_[r].asked * std::min(price[r], lack * rows_[r].share);
        }
        return scale * value;
    }

    // The columns that gain most. \return whether there are any
    bool add_best(std::span<const double> reduced) {
        std::vector<std::size_t> paying;
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            if (columns_[k].open && columns_[k].number < 0 &&
                reduced[k] < -kPays * cost(columns_[k])) {
                paying.push_back(k);
            }
        }
        const auto better = [&](std::size_t a, std::size_t b) {
            const double gain_a = reduced[a] / cost(columns_[a]);
            const double gain_b = reduced[b] / cost(columns_[b]);
            return gain_a != gain_b ? gain_a < gain_b : a < b;
        };
        const std::size_t n = std::min(kColumnsOfARound, paying.size());
        std::partial_sort(paying.begin(), paying.begin() + static_cast<std::ptrdiff_t>(n),
                          paying.end(), better);
        for (std::size_t k = 0; k < n; ++k) {
            add(columns_[paying[k]]);
        }
        return n > 0;
    }

    void take(const LinearProgramme::Solution& solution, FibreBound& bound) const {
        for (const Column& column : columns_) {
            if (column.number < 0 || !column.open) {
                continue;
            }
            const double x = solution.x[static_cast<std::size_t>(column.number)];
            (column.backward ? bound.backward : bound.forward)[at(column.member)] = x;
            bound.solved_mm += x * cost(column);
            bound.turns_mm += x * task_.members[at(column.member)].turn_mm;
        }
    }

    const BoundTask task_;
    std::vector<std::int32_t> row_;              // per sample, -1: none
    std::vector<Row> rows_;                      // cells
    double asked_ = 0.0;                         // layers of all rows
    std::vector<std::vector<RowEntry>> covers_;  // per member: layers on cells, on average
    std::vector<Column> columns_;
    std::optional<LinearProgramme> programme_;
};

FibreBoundFinder::FibreBoundFinder(const BoundTask& task) : state_(std::make_unique<State>(task)) {}

FibreBoundFinder::~FibreBoundFinder() = default;

FibreBound FibreBoundFinder::find() {
    return state_->run();
}

void FibreBoundFinder::strike_off(std::int32_t member) {
    state_->strike_off(member);
}

FibreBound bound_fibre(const BoundTask& task) {
    return FibreBoundFinder(task).find();
}

std::vector<LaidCourse> whole_courses(const FibreBound& bound, std::span<const Member> members,
                                      double share) {
    struct Laid {
        NodePair nodes;
        long step;
        double azimuth_rad;
        LaidCourse course;
        double times;

        bool operator<(const Laid& other) const {
            return std::tie(nodes, step, azimuth_rad, course) <
                   std::tie(other.nodes, other.step, other.azimuth_rad, other.course);
        }
    };
    std::vector<Laid> laid;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const RimCrossing& end = members[i].end[0];
        for (const bool backward : {false, true}) {
            const double times = share * (backward ? bound.backward : bound.forward)[i];
            if (times > 0.0) {
                laid.push_back({nodes_of(members[i], backward),
                                std::lround(end.angle_rad / kLikeAngle_rad),
                                std::remainder(end.azimuth_rad, 2.0 * kPi),
                                {static_cast<std::int32_t>(i), backward},
                                times});
            }
        }
    }
    std::sort(laid.begin(), laid.end());
    std::vector<LaidCourse> courses;
    double carried = 0.5;
    for (const Laid& like : laid) {
        carried += like.times;
        for (; carried >= 1.0; carried -= 1.0) {
            courses.push_back(like.course);
        }
    }
    return courses;
}

}  // namespace meshwind
