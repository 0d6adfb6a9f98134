#include "postproc/nc/repeats.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/interrupt.h"

namespace meshwind {
namespace {

// F carries six digits.
constexpr double kDurationDigits = 5e-6;
// Places with the same linear positions that are tried as the circuit's end: a circuit may pass
// through its first position several times.
constexpr int kEndsTried = 8;
// Comparisons of two blocks, per block of the list. Real programs take less than ten; the bound
// keeps the search linear whatever the list is.
constexpr std::size_t kComparisonsPerBlock = 100;

// Blocks start + 1 .. start + count * length are `count` equal circuits.
struct Run {
    std::size_t start = 0;
    std::size_t length = 0;
    std::size_t count = 0;

    [[nodiscard]] std::size_t saved() const { return count == 0 ? 0 : (count - 1) * length; }
};

class Finder {
public:
    explicit Finder(const BlockList& list)
        : list_(list), comparisons_(kComparisonsPerBlock * list.blocks.size()) {
        find_next();
    }

    // The run that begins at block `start` and saves most, if any repeats often enough.
    std::optional<Run> run_at(std::size_t start) {
        Run best;
        std::size_t end = next_[start + 1];
        for (int i = 0; i < kEndsTried && end > 0; ++i, end = next_[end]) {
            const std::size_t length = end - (start + 1);
            const std::size_t equal = equal_until(start + 1, length) - (start + 1);
            const Run run{start, length, equal / length + 1};
            if (run.count >= kMinCircuits && run.saved() >= kMinLinesSaved &&
                run.saved() > best.saved() && moves(run)) {
                best = run;
            }
        }
        return best.count > 0 ? std::optional<Run>(best) : std::nullopt;
    }

private:
    // For each block the next one with the same linear move from the same place; 0 is none.
    void find_next() {
        std::unordered_map<std::uint64_t, std::size_t> latest;
        next_.assign(list_.blocks.size() + 1, 0);
        for (std::size_t i = list_.blocks.size() - 1; i >= 1; --i) {
            const auto [found, is_new] = latest.try_emplace(key(i), i);
            if (!is_new) {
                next_[i] = same_linear_move(i, found->second) ? found->second : 0;
                found->second = i;
            }
        }
    }

    [[nodiscard]] std::uint64_t key(std::size_t block) const {
        std::uint64_t hash = 14695981039346656037ull;  // FNV-1a over whole numbers
        for (std::size_t a = 0; a < list_.axes.size(); ++a) {
            if (list_.axes[a].type == AxisType::Linear) {
                for (const std::size_t b : {block - 1, block}) {
                    hash = (hash ^ static_cast<std::uint64_t>(list_.row(b)[a])) * 1099511628211ull;
                    hash ^= hash >> 29;
                }
            }
        }
        return hash;
    }

    [[nodiscard]] bool same_linear_move(std::size_t i, std::size_t j) const {
        for (std::size_t a = 0; a < list_.axes.size(); ++a) {
            if (list_.axes[a].type == AxisType::Linear &&
                (list_.row(i)[a] != list_.row(j)[a] ||
                 list_.row(i - 1)[a] != list_.row(j - 1)[a])) {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] bool equal(std::size_t i, std::size_t j) const {
        const double duration = list_.blocks[i].duration_s;
        if (std::abs(duration - list_.blocks[j].duration_s) > kDurationDigits * duration) {
            return false;
        }
        for (std::size_t a = 0; a < list_.axes.size(); ++a) {
            const std::int64_t one = list_.row(i)[a] - list_.row(i - 1)[a];
            const std::int64_t other = list_.row(j)[a] - list_.row(j - 1)[a];
            if (std::abs(one - other) > list_.axes[a].resolution_nano) {
                return false;
            }
        }
        return true;
    }

    // The first block from `from` on that differs from the one `length` later.
    std::size_t equal_until(std::size_t from, std::size_t length) {
        const auto known = equal_.find(length);
        if (known != equal_.end() && from >= known->second.first && from <= known->second.second) {
            return known->second.second;
        }
        std::size_t to = from;
        while (to + length < list_.blocks.size() && comparisons_ > 0 && equal(to, to + length)) {
            --comparisons_;
            ++to;
        }
        equal_[length] = {from, to};
        return to;
    }

    [[nodiscard]] bool moves(const Run& run) const {
        for (std::size_t i = run.start + 1; i < run.start + run.length; ++i) {
            for (std::size_t a = 0; a < list_.axes.size(); ++a) {
                if (list_.axes[a].type == AxisType::Linear &&
                    list_.row(i)[a] != list_.row(run.start)[a]) {
                    return true;
                }
            }
        }
        return false;
    }

    const BlockList& list_;
    std::size_t comparisons_;
    std::vector<std::size_t> next_;
    std::unordered_map<std::size_t, std::pair<std::size_t, std::size_t>> equal_;  // by length
};

// The blocks as they are planned, and how far repetition may take each axis from them.
struct PlannedBlocks {
    const BlockList& list;
    std::vector<std::int64_t> tolerance_nano{};
};

PlannedBlocks planned_blocks(const BlockList& list, const RepeatTolerance& tolerance) {
    PlannedBlocks planned{list};
    for (const BlockAxis& axis : list.axes) {
        const double given =
            axis.type == AxisType::Rotary ? tolerance.rotary_deg : tolerance.linear_mm;
        planned.tolerance_nano.push_back(
            std::max(std::llround(given * static_cast<double>(kNanoPerUnit)),
                     static_cast<long long>(axis.resolution_nano)));
    }
    return planned;
}

// Offsets from the circuit's start: the mean over all circuits, in whole steps.
struct ClosedCircuit {
    std::size_t length = 0;  // in blocks
    std::size_t axes = 0;
    std::vector<std::int64_t> offset_nano{};  // blocks x axes

    // \param j block of the circuit, from 1
    [[nodiscard]] std::int64_t offset(std::size_t j, std::size_t axis) const {
        return offset_nano[(j - 1) * axes + axis];
    }
};

ClosedCircuit close_circuit(const BlockList& planned, const Run& run) {
    ClosedCircuit circuit{run.length, planned.axes.size()};
    for (std::size_t j = 1; j <= run.length; ++j) {
        for (std::size_t a = 0; a < planned.axes.size(); ++a) {
            const auto at = [&](std::size_t k) {
                const std::size_t begin = run.start + k * run.length;
                return planned.row(begin + j)[a] - planned.row(begin)[a];
            };
            std::int64_t more = 0;  // than the first circuit, in steps
            for (std::size_t k = 1; k < run.count; ++k) {
                more += (at(k) - at(0)) / planned.axes[a].resolution_nano;
            }
            circuit.offset_nano.push_back(
                at(0) + std::llround(static_cast<double>(more) / static_cast<double>(run.count)) *
                            planned.axes[a].resolution_nano);
        }
    }
    return circuit;
}

// Whether the circuit behind block `start`, begun at `base`, stays within the tolerance.
bool within(const PlannedBlocks& planned, const ClosedCircuit& circuit, std::size_t start,
            const std::vector<std::int64_t>& base) {
    for (std::size_t j = 1; j <= circuit.length; ++j) {
        const auto row = planned.list.row(start + j);
        for (std::size_t a = 0; a < base.size(); ++a) {
            if (std::abs(base[a] + circuit.offset(j, a) - row[a]) > planned.tolerance_nano[a]) {
                return false;
            }
        }
    }
    return true;
}

// Behind a run that ends the program no block leads back to the plan.
bool ends_list(const BlockList& planned, const Run& run) {
    return run.start + run.count * run.length + 1 == planned.blocks.size();
}

// Where the last circuit must begin for the program to end exactly where it is planned to.
std::vector<std::int64_t> begin_of_last(const BlockList& planned, const ClosedCircuit& circuit) {
    const auto end = planned.row(planned.blocks.size() - 1);
    std::vector<std::int64_t> begin(end.begin(), end.end());
    for (std::size_t a = 0; a < begin.size(); ++a) {
        begin[a] -= circuit.offset(circuit.length, a);
    }
    return begin;
}

// A run of circuits that are the same each time.
struct FoldedRun {
    Run run;
    std::vector<std::size_t> groups;  // circuits that begin at their planned place
    std::vector<std::int64_t> rows;   // positions of its blocks: blocks x axes
};

// None when the circuits of the run are not as equal as their blocks; then it stays as it is.
// \param written the blocks as they are with the runs before
std::optional<FoldedRun> fold_run(const PlannedBlocks& planned, Run run, const BlockList& written) {
    const ClosedCircuit circuit = close_circuit(planned.list, run);
    const auto start_of = [&](std::size_t k) { return run.start + k * run.length; };
    if (ends_list(planned.list, run) &&
        !within(planned, circuit, start_of(run.count - 1), begin_of_last(planned.list, circuit))) {
        --run.count;  // the last circuit is written out
    }
    FoldedRun folded{run, {}, {}};
    std::vector<std::int64_t> base;
    for (std::size_t k = 0; k < run.count; ++k) {
        const bool last = k + 1 == run.count && ends_list(planned.list, run);
        if (k == 0 || !within(planned, circuit, start_of(k), base) ||
            (last && base != begin_of_last(planned.list, circuit))) {
            // Right behind another run the first circuit begins where that one has led.
            const BlockList& from = k == 0 ? written : planned.list;
            const auto place = from.row(start_of(k));
            base.assign(place.begin(), place.end());
            if (last) {
                base = begin_of_last(planned.list, circuit);
            }
            folded.groups.push_back(k);
            if (!within(planned, circuit, start_of(k), base)) {
                return {};
            }
        }
        for (std::size_t j = 1; j <= run.length; ++j) {
            for (std::size_t a = 0; a < base.size(); ++a) {
                folded.rows.push_back(base[a] + circuit.offset(j, a));
            }
        }
        base.assign(folded.rows.end() - static_cast<std::ptrdiff_t>(base.size()),
                    folded.rows.end());
    }
    return folded;
}

// Puts the run's positions and durations into the list.
void take(const BlockList& planned, const FoldedRun& folded, FoldedProgram& program) {
    const Run& run = folded.run;
    const std::vector<std::int64_t>& rows = folded.rows;
    const std::size_t axes = planned.axes.size();
    const std::size_t begin = (run.start + 1) * axes;
    std::copy(rows.begin(), rows.end(),
              program.list.nano.begin() + static_cast<std::ptrdiff_t>(begin));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::int64_t& drift = program.layout.drift_nano[i % axes];
        drift = std::max(drift, std::abs(rows[i] - planned.nano[begin + i]));
    }
    for (std::size_t i = 0; i < run.count * run.length; ++i) {
        program.list.blocks[run.start + 1 + i].duration_s =
            planned.blocks[run.start + 1 + i % run.length].duration_s;
    }
}

void add_blocks(std::size_t first, std::size_t last, std::vector<ProgramPart>& to) {
    if (first <= last) {
        to.push_back({.kind = ProgramPart::Kind::Blocks, .first = first, .last = last});
    }
}

void add_call(std::size_t subprogram, std::size_t times, std::size_t first,
              std::vector<ProgramPart>& to) {
    if (times > 0) {
        to.push_back({.kind = ProgramPart::Kind::Call,
                      .first = first,
                      .subprogram = subprogram,
                      .times = static_cast<std::int64_t>(times)});
    }
}

// \param written last block that is laid out before the run
void lay_out(const FoldedRun& folded, std::size_t written, ProgramLayout& layout) {
    const Run& run = folded.run;
    const std::vector<std::size_t>& groups = folded.groups;
    const std::size_t circuit = layout.subprograms.size();
    const std::size_t rest = circuit + 1;
    add_blocks(written + 1, run.start, layout.main);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const std::size_t first = run.start + groups[g] * run.length + 1;
        const std::size_t end = g + 1 < groups.size() ? groups[g + 1] : run.count;
        if (g == 0) {
            add_call(circuit, end, first, layout.main);
        } else {
            add_blocks(first, first, layout.main);
            add_call(rest, 1, first + 1, layout.main);
            add_call(circuit, end - groups[g] - 1, first + run.length, layout.main);
        }
    }
    std::vector<ProgramPart> body;
    if (groups.size() == 1) {
        add_blocks(run.start + 1, run.start + run.length, body);
        layout.subprograms.push_back(body);
    } else {
        add_blocks(run.start + 1, run.start + 1, body);
        add_call(rest, 1, run.start + 2, body);
        layout.subprograms.push_back(body);
        body.clear();
        add_blocks(run.start + 2, run.start + run.length, body);
        layout.subprograms.push_back(body);
    }
}

// Folds all runs of a list.
FoldedProgram fold_runs(const BlockList& list, const RepeatTolerance& tolerance) {
    Finder finder(list);
    const PlannedBlocks planned = planned_blocks(list, tolerance);
    FoldedProgram program{list, {}};
    program.layout.drift_nano.assign(list.axes.size(), 0);
    std::size_t written = 0;  // last block that is laid out
    for (std::size_t start = 0; start + 1 < list.blocks.size();) {
        check_interrupt();
        const std::optional<Run> run = finder.run_at(start);
        const std::optional<FoldedRun> folded =
            run ? fold_run(planned, *run, program.list) : std::nullopt;
        if (folded) {
            take(list, *folded, program);
            lay_out(*folded, written, program.layout);
            written = folded->run.start + folded->run.count * folded->run.length;
        }
        // A run that cannot be folded is left behind as well: its later circuits are no better.
        start += run ? run->count * run->length : 1;
    }
    add_blocks(written + 1, list.blocks.size() - 1, program.layout.main);
    return program;
}

std::size_t lines_of(const std::vector<ProgramPart>& parts) {
    std::size_t lines = 0;
    for (const ProgramPart& part : parts) {
        lines += part.kind == ProgramPart::Kind::Call ? 1 : part.last - part.first + 1;
    }
    return lines;
}

// What the folding is for, and that no block has lost its motion to a rounding.
bool pays(const FoldedProgram& program) {
    if (program.layout.subprograms.empty()) {
        return false;
    }
    std::size_t lines = lines_of(program.layout.main);
    for (const auto& body : program.layout.subprograms) {
        lines += lines_of(body) + 2;
    }
    const BlockList& list = program.list;
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        if (std::equal(list.row(i).begin(), list.row(i).end(), list.row(i - 1).begin())) {
            return false;
        }
    }
    return static_cast<double>(lines) <= kFoldedShare * static_cast<double>(list.blocks.size() - 1);
}

}  // namespace

std::size_t ProgramLayout::calls() const {
    const auto is_call = [](const ProgramPart& p) { return p.kind == ProgramPart::Kind::Call; };
    auto count = std::count_if(main.begin(), main.end(), is_call);
    for (const auto& body : subprograms) {
        count += std::count_if(body.begin(), body.end(), is_call);
    }
    return static_cast<std::size_t>(count);
}

FoldedProgram fold_repeats(BlockList list, const RepeatTolerance& tolerance) {
    if (list.blocks.size() > kMinCircuits) {
        FoldedProgram folded = fold_runs(list, tolerance);
        if (pays(folded)) {
            return folded;
        }
    }
    return {std::move(list), {}};
}

}  // namespace meshwind
