#include "postproc/nc/program_flow.h"

#include <algorithm>
#include <set>

#include "core/error.h"

namespace meshwind {
namespace {

[[noreturn]] void fail(const std::string& code, const std::string& file, std::int32_t line,
                       const std::string& words) {
    throw InputError(code, file + ":" + std::to_string(line), words);
}

// Finds, without running anything, how many lines a program runs and how deep its calls go.
class Measure {
public:
    Measure(const ProgramFlow& flow, const std::string& file) : flow_(flow), file_(file) {}

    void check() { (void)extent_of(flow_.main, 1); }

private:
    struct Extent {
        std::int64_t lines = 0;
        std::size_t levels = 1;
    };
    struct Known {
        Extent extent;
        bool done = false;
    };

    // No sum or product of two numbers within the limit overflows.
    void add(Extent& to, std::int64_t times, std::int64_t lines, std::int32_t line) const {
        const bool fits = lines == 0 || times <= kMaxLinesRun / lines;
        if (!fits || to.lines + times * lines > kMaxLinesRun) {
            fail("nc.too_many_lines", file_, line,
                 "with all repetitions the program runs more than " + std::to_string(kMaxLinesRun) +
                     " lines; split it");
        }
        to.lines += times * lines;
    }

    Extent extent_of(const std::vector<FlowStep>& steps, std::size_t level) {
        Extent extent;
        for (const FlowStep& step : steps) {
            if (step.kind == FlowStep::Kind::Lines || step.kind == FlowStep::Kind::Label) {
                add(extent, 1, step.last - step.first + 1, step.first);
            } else if (step.kind == FlowStep::Kind::Repeat) {
                const Extent body = extent_of(step.body, level);
                add(extent, step.times, body.lines + 2, step.first);
                extent.levels = std::max(extent.levels, body.levels);
            } else if (step.kind == FlowStep::Kind::Call) {
                const Extent called = extent_of_call(step, level);
                add(extent, 1, 1, step.first);
                add(extent, step.times, called.lines + 2, step.first);
                extent.levels = std::max(extent.levels, called.levels + 1);
            }
        }
        return extent;
    }

    Extent extent_of_call(const FlowStep& call, std::size_t level) {
        const auto found = flow_.subprograms.find(call.name);
        if (found == flow_.subprograms.end()) {
            fail("nc.no_subprogram", file_, call.first,
                 "subprogram " + call.name + " is not in the file; add it or correct the number");
        }
        const auto [known, first_time] = known_.try_emplace(call.name);
        if (!first_time && !known->second.done) {
            fail("nc.recursion", file_, call.first,
                 "subprogram " + call.name + " calls itself; it would never end");
        }
        if (level + std::max<std::size_t>(known->second.extent.levels, 1) > flow_.levels) {
            fail("nc.nesting", file_, call.first,
                 "calls go deeper than the " + std::to_string(flow_.levels) +
                     " levels of the controller, the main program being the first");
        }
        if (first_time) {
            const Extent extent = extent_of(found->second.body, level + 1);
            known->second = {extent, true};
        }
        return known->second.extent;
    }

    const ProgramFlow& flow_;
    const std::string& file_;
    std::map<std::string, Known> known_;
};

class Runner {
public:
    Runner(const ProgramFlow& flow, const std::string& file,
           const std::function<bool(std::int32_t, FlowLine)>& visit)
        : flow_(flow), file_(file), visit_(visit) {}

    bool run(const std::vector<FlowStep>& steps) {
        return std::all_of(steps.begin(), steps.end(),
                           [this](const FlowStep& step) { return run(step); });
    }

private:
    // False when the program has ended.
    bool run(const FlowStep& step) {
        switch (step.kind) {
            case FlowStep::Kind::Lines:
                for (std::int32_t line = step.first; line <= step.last; ++line) {
                    if (!visit_(line, FlowLine::Code)) {
                        return false;
                    }
                }
                return true;
            case FlowStep::Kind::Repeat:
                return repeat(step, step.first, step.last, step.body);
            case FlowStep::Kind::Call:
                return call(step, flow_.subprograms.at(step.name));
            case FlowStep::Kind::Label:
                return visit_(step.first, FlowLine::Control);
            case FlowStep::Kind::Definition:
                if (!known_.insert(step.name).second) {
                    fail("nc.subprogram_place", file_, step.first,
                         "the program has called subprogram " + step.name +
                             " and now runs into it; move it to the head or behind the end");
                }
                return true;
        }
        return true;
    }

    bool call(const FlowStep& step, const Subprogram& sub) {
        if (known_.insert(step.name).second && flow_.searches_forward && sub.first < step.first) {
            fail("nc.subprogram_place", file_, step.first,
                 "the controller looks for subprogram " + step.name +
                     " only behind this line; move it there");
        }
        return visit_(step.first, FlowLine::Control) && repeat(step, sub.first, sub.last, sub.body);
    }

    bool repeat(const FlowStep& step, std::int32_t first, std::int32_t last,
                const std::vector<FlowStep>& body) {
        for (std::int64_t i = 0; i < step.times; ++i) {
            if (!visit_(first, FlowLine::Control) || !run(body) ||
                !visit_(last, FlowLine::Control)) {
                return false;
            }
        }
        return true;
    }

    const ProgramFlow& flow_;
    const std::string& file_;
    const std::function<bool(std::int32_t, FlowLine)>& visit_;
    std::set<std::string> known_;  // to the controller
};

}  // namespace

void run_flow(const ProgramFlow& flow, const std::string& file,
              const std::function<bool(std::int32_t line, FlowLine kind)>& visit) {
    Measure(flow, file).check();
    Runner(flow, file, visit).run(flow.main);
}

}  // namespace meshwind
