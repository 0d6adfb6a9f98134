#include "winding/bound/fibre_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/linear_programme.h"
#include "core/parallel.h"
#include "core/units.h"
#include "mesh/nearest.h"

namespace meshwind {
namespace {

// Rows, each of a cell of samples. More take longer by their square.
constexpr std::size_t kMaxRows = 400;

// Columns that are added at a time, and rounds of that.
constexpr std::size_t kColumnsOfARound = 300;
constexpr int kMaxRounds = 60;

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

// FibreBoundFinder::State has members of these types, so they have its linkage.

// Cells of samples: rows of the programme.
struct BoundCells {
    struct Cell {
        double asked = 0.0;  // layers, on average
        double share = 0.0;  // of the samples, 1 on average
        double samples = 0.0;
    };
    std::vector<std::int32_t> of_sample;  // -1: none
    std::vector<Cell> cell;
    double asked = 0.0;  // layers of all cells
};

// A member in one direction.
struct BoundColumn {
    std::int32_t member = -1;
    bool backward = false;
    int number = -1;  // in the programme, once it is there
    bool open = true;
};

// What the programme is about.
struct BoundModel {
    BoundTask task;
    BoundCells cells;
    std::vector<std::vector<RowEntry>> covers;  // per member: layers on cells, on average
    std::vector<BoundColumn> columns;

    // The row of what may lack, behind those of cells and nodes.
    [[nodiscard]] int budget_row() const {
        return static_cast<int>(cells.cell.size() + task.nodes);
    }
    [[nodiscard]] double cost(const BoundColumn& column) const {
        const LibraryCourse& member = task.members[at(column.member)];
        return member.length_mm + member.turn_mm + task.off_angle_cost * member.off_angle_mm;
    }
};

namespace {

std::vector<std::size_t> asking_samples(const BoundTask& task) {
    std::vector<std::size_t> asking;
    for (std::size_t i = 0; i < task.asked.size(); ++i) {
        if (task.reached[i] != 0 && task.asked[i] > 0) {
            asking.push_back(i);
        }
    }
    return asking;
}

// Gives each sample that asks the cell whose centre is nearest; where there are no places, the
// centres are all that ask from then on. Fills in `of_sample`.
void share_out(const BoundTask& task, std::vector<std::size_t>& asking,
               const std::vector<std::size_t>& centres, std::vector<std::int32_t>& of_sample) {
    if (task.position_mm.empty() || centres.size() == asking.size()) {
        asking = centres;
        for (std::size_t k = 0; k < centres.size(); ++k) {
            of_sample[asking[k]] = static_cast<std::int32_t>(k);
        }
        return;
    }
    std::vector<Eigen::Vector3d> centres_mm;
    centres_mm.reserve(centres.size());
    for (const std::size_t sample : centres) {
        centres_mm.push_back(task.position_mm[sample]);
    }
    const NearestPoints cells(centres_mm);
    for (const std::size_t sample : asking) {
        of_sample[sample] = cells.nearest(task.position_mm[sample]);
    }
}

BoundCells cells_of(const BoundTask& task) {
    BoundCells cells;
    cells.of_sample.assign(task.asked.size(), -1);
    std::vector<std::size_t> asking = asking_samples(task);
    const std::size_t n = std::min(kMaxRows, asking.size());
    std::vector<std::size_t> centres;
    centres.reserve(n);
    for (std::size_t k = 0; k < n; ++k) {
        centres.push_back(asking[k * asking.size() / n]);
    }
    share_out(task, asking, centres, cells.of_sample);
    cells.cell.resize(n);
    for (const std::size_t sample : asking) {
        BoundCells::Cell& cell = cells.cell[at(cells.of_sample[sample])];
        cell.samples += 1.0;
        cell.asked += task.asked[sample];
    }
    for (BoundCells::Cell& cell : cells.cell) {
        cell.share = cell.samples * static_cast<double>(n) / static_cast<double>(asking.size());
        cell.asked /= cell.samples;
        cells.asked += cell.share * cell.asked;
    }
    return cells;
}

// Layers that each allowed member lays on cells, on average.
std::vector<std::vector<RowEntry>> covers_of(const BoundTask& task, const BoundCells& cells) {
    std::vector<std::vector<RowEntry>> covers(task.members.size());
    for (std::size_t i = 0; i < task.members.size(); ++i) {
        if (task.allowed[i] == 0) {
            continue;
        }
        std::vector<std::int32_t> rows;
        for (const std::int32_t sample : task.members[i].footprint) {
            if (cells.of_sample[at(sample)] >= 0) {
                rows.push_back(cells.of_sample[at(sample)]);
            }
        }
        std::sort(rows.begin(), rows.end());
        for (const std::int32_t row : rows) {
            if (covers[i].empty() || covers[i].back().row != row) {
                covers[i].push_back({row, 0.0});
            }
            covers[i].back().value += 1.0 / cells.cell[at(row)].samples;
        }
    }
    return covers;
}

std::vector<BoundColumn> columns_of(const BoundTask& task) {
    std::vector<BoundColumn> columns;
    for (std::size_t i = 0; i < task.members.size(); ++i) {
        if (task.allowed[i] == 0) {
            continue;
        }
        if (task.members[i].windable_forward) {
            columns.push_back({static_cast<std::int32_t>(i), false});
        }
        if (task.members[i].windable_backward) {
            columns.push_back({static_cast<std::int32_t>(i), true});
        }
    }
    return columns;
}

BoundModel model_of(const BoundTask& task) {
    BoundModel model{task, cells_of(task), {}, columns_of(task)};
    model.covers = covers_of(task, model.cells);
    return model;
}

std::vector<LinearProgramme::Row> row_bounds(const BoundModel& model) {
    constexpr double kNoEnd = std::numeric_limits<double>::infinity();
    std::vector<LinearProgramme::Row> bounds;
    for (const BoundCells::Cell& cell : model.cells.cell) {
        bounds.push_back({cell.asked, kNoEnd});
    }
    bounds.resize(model.cells.cell.size() + model.task.nodes, {0.0, 0.0});
    bounds.push_back({-kNoEnd, model.task.most_below * model.cells.asked});
    return bounds;
}

// Fibre that covers what a row stands for, on average over the library.
double fibre_of_a_row_mm(const BoundModel& model) {
    double length_mm = 0.0;
    double covered = 0.0;
    for (const BoundColumn& column : model.columns) {
        length_mm += model.task.members[at(column.member)].length_mm;
        for (const RowEntry& cell : model.covers[at(column.member)]) {
            covered += cell.value;
        }
    }
    return length_mm / std::max(1.0, covered);
}

// What may lack, and what lacks beyond that, so that there is a solution from the first.
void add_lacking(const BoundModel& model, LinearProgramme& programme) {
    const std::vector<BoundCells::Cell>& cells = model.cells.cell;
    for (std::size_t r = 0; r < cells.size(); ++r) {
        const std::array<RowEntry, 2> entries{RowEntry{static_cast<int>(r), 1.0},
                                              RowEntry{model.budget_row(), cells[r].share}};
        programme.add_column(0.0, cells[r].asked, entries);
    }
    const std::array<RowEntry, 1> beyond{RowEntry{model.budget_row(), -1.0}};
    programme.add_column(kLacks * fibre_of_a_row_mm(model), std::numeric_limits<double>::infinity(),
                         beyond);
}

void add_column(BoundModel& model, std::size_t k, LinearProgramme& programme) {
    BoundColumn& column = model.columns[k];
    std::vector<RowEntry> entries = model.covers[at(column.member)];
    const auto [from, to] = nodes_of(model.task.members[at(column.member)], column.backward);
    if (from != to) {
        entries.push_back({static_cast<int>(model.cells.cell.size() + from), -1.0});
        entries.push_back({static_cast<int>(model.cells.cell.size() + to), 1.0});
    }
    column.number =
        programme.add_column(model.cost(column), std::numeric_limits<double>::infinity(), entries);
}

// Some of all, evenly.
void add_first(BoundModel& model, LinearProgramme& programme) {
    const std::size_t n = std::min(model.columns.size(), 2 * kColumnsOfARound);
    for (std::size_t k = 0; k < n; ++k) {
        add_column(model, k * model.columns.size() / n, programme);
    }
}

std::vector<double> reduced_costs(const BoundModel& model, std::span<const double> price) {
    const std::size_t cells = model.cells.cell.size();
    std::vector<double> reduced(model.columns.size());
    constexpr std::size_t kChunk = 512;
    parallel_for(model.columns.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const BoundColumn& column = model.columns[k];
            double worth = 0.0;
            for (const RowEntry& cell : model.covers[at(column.member)]) {
                worth += cell.value * price[at(cell.row)];
            }
            const auto [from, to] =
                nodes_of(model.task.members[at(column.member)], column.backward);
            worth += price[cells + to] - price[cells + from];
            reduced[k] = model.cost(column) - worth;
        }
    });
    return reduced;
}

// The prices as the dual programme wants them, whatever rounding says: no layer is worth less
// than nothing, and what may lack is worth something.
std::vector<double> feasible(const BoundModel& model, std::vector<double> price) {
    double& budget = price[static_cast<std::size_t>(model.budget_row())];
    budget = std::min(0.0, budget);
    for (std::size_t r = 0; r < model.cells.cell.size(); ++r) {
        price[r] = std::max(0.0, price[r]);
    }
    return price;
}

// Value of feasible prices once they are made small enough for every column to be worth no more
// than it costs.
double bound_of(const BoundModel& model, std::span<const double> price,
                std::span<const double> reduced) {
    double scale = 1.0;
    for (std::size_t k = 0; k < model.columns.size(); ++k) {
        if (model.columns[k].open && reduced[k] < 0.0) {
            const double costs = model.cost(model.columns[k]);
            scale = std::min(scale, costs / (costs - reduced[k]));
        }
    }
    // A layer that lacks is bought for the budget's price: it counts no more than that.
    const double lack = -price[static_cast<std::size_t>(model.budget_row())];
    double value = -lack * model.task.most_below * model.cells.asked;
    for (std::size_t r = 0; r < model.cells.cell.size(); ++r) {
        const BoundCells::Cell& cell = model.cells.cell[r];
        value += cell.asked * std::min(price[r], lack * cell.share);
    }
    return scale * value;
}

// The columns that gain most. \return whether there are any
bool add_best(BoundModel& model, std::span<const double> reduced, LinearProgramme& programme) {
    const std::vector<BoundColumn>& columns = model.columns;
    std::vector<std::size_t> paying;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        if (columns[k].open && columns[k].number < 0 &&
            reduced[k] < -kPays * model.cost(columns[k])) {
            paying.push_back(k);
        }
    }
    const auto better = [&](std::size_t a, std::size_t b) {
        const double gain_a = reduced[a] / model.cost(columns[a]);
        const double gain_b = reduced[b] / model.cost(columns[b]);
        return gain_a != gain_b ? gain_a < gain_b : a < b;
    };
    const std::size_t n = std::min(kColumnsOfARound, paying.size());
    std::partial_sort(paying.begin(), paying.begin() + static_cast<std::ptrdiff_t>(n), paying.end(),
                      better);
    for (std::size_t k = 0; k < n; ++k) {
        add_column(model, paying[k], programme);
    }
    return n > 0;
}

// Enters a solution into the bound.
void enter(const BoundModel& model, const LinearProgramme::Solution& solution, FibreBound& bound) {
    for (const BoundColumn& column : model.columns) {
        if (column.number < 0 || !column.open) {
            continue;
        }
        const double x = solution.x[static_cast<std::size_t>(column.number)];
        (column.backward ? bound.backward : bound.forward)[at(column.member)] = x;
        bound.solved_mm += x * model.cost(column);
        bound.turns_mm += x * model.task.members[at(column.member)].turn_mm;
    }
}

// Solves, and adds columns as long as some pay.
FibreBound solved(BoundModel& model, LinearProgramme& programme, FibreBound bound) {
    LinearProgramme::Solution solution;
    for (int round = 0; round < kMaxRounds; ++round) {
        solution = programme.solve();
        if (!solution.feasible) {
            break;
        }
        const std::vector<double> price = feasible(model, solution.price);
        const std::vector<double> reduced = reduced_costs(model, price);
        bound.least_mm = std::max(bound.least_mm, bound_of(model, price, reduced));
        if (!solution.optimal || bound.least_mm >= (1.0 - kGoodEnough) * solution.cost ||
            !add_best(model, reduced, programme)) {
            break;
        }
    }
    if (solution.feasible) {
        enter(model, solution, bound);
    }
    return bound;
}

}  // namespace

struct FibreBoundFinder::State {
    explicit State(const BoundTask& task) : model(model_of(task)) {
        if (!model.cells.cell.empty()) {
            programme.emplace(row_bounds(model));
            add_lacking(model, *programme);
            add_first(model, *programme);
        }
    }

    BoundModel model;
    std::optional<LinearProgramme> programme;  // none where no sample asks for layers
};

FibreBoundFinder::FibreBoundFinder(const BoundTask& task) : state_(std::make_unique<State>(task)) {}

FibreBoundFinder::~FibreBoundFinder() = default;

FibreBound FibreBoundFinder::find() {
    FibreBound bound;
    bound.forward.assign(state_->model.task.members.size(), 0.0);
    bound.backward.assign(state_->model.task.members.size(), 0.0);
    return state_->programme ? solved(state_->model, *state_->programme, std::move(bound)) : bound;
}

void FibreBoundFinder::strike_off(std::int32_t member) {
    for (BoundColumn& column : state_->model.columns) {
        if (column.member == member) {
            column.open = false;
            if (column.number >= 0) {
                state_->programme->close(column.number);
            }
        }
    }
}

FibreBound bound_fibre(const BoundTask& task) {
    return FibreBoundFinder(task).find();
}

std::vector<DirectedCourse> whole_courses(const FibreBound& bound,
                                          std::span<const LibraryCourse> members, double share) {
    struct Laid {
        NodePair nodes;
        long step;
        double azimuth_rad;
        DirectedCourse course;
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
    std::vector<DirectedCourse> courses;
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
