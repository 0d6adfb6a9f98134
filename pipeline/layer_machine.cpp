#include "pipeline/layer_machine.h"

#include <algorithm>
#include <map>
#include <utility>

#include "pipeline/code_digest.h"
#include "pipeline/pattern_checks.h"
#include "pipeline/run_names.h"

namespace meshwind {
namespace {

CourseFault first_of(const std::map<std::size_t, CourseFault>& refused) {
    return refused.empty() ? CourseFault::None : refused.begin()->second;
}

// The commonest reason, and what the first check that failed says.
std::string why_refused(std::span<const FibreProgram> programs) {
    std::map<CourseFault, int> count;
    std::string words;
    for (const FibreProgram& program : programs) {
        for (const auto& [piece, reason] : program.made.refused) {
            ++count[reason];
        }
        for (const Check& check : program.made.verification.checks) {
            words = words.empty() && !check.ok ? " (" + check.words + ")" : words;
        }
    }
    const auto most =
        std::max_element(count.begin(), count.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == count.end() ? words : name_of(most->first) + words;
}

}  // namespace

CourseFault LayerMachine::follow(std::span<const Piece> pieces) const {
    return first_of(refused_by_machine(setup_, pieces));
}

CourseFault LayerMachine::wind_alone(std::span<const Piece> pieces) const {
    return first_of(program_of(setup_, pieces).refused);
}

CourseFault LayerMachine::wind_circuits(std::span<const Piece> pieces) const {
    PieceProgramOptions options;
    options.lengths = LengthSearch::All;
    return first_of(program_of(setup_, pieces, options).refused);
}

std::unique_ptr<TrialWinding> LayerMachine::wind_all(const Plan& plan) const {
    std::unique_ptr<LayerPrograms> all = programs_of(plan, false);
    if (all->refused.empty() && plan.pattern() != nullptr &&
        plan.pattern()->starts_rad.size() > 1) {
        const Check closure =
            closure_check(plan, all->programs.front().made.verification.laid.path);
        if (!closure.ok) {
            all->refused.push_back(plan.pieces.size() - 1);
            all->why = closure.words;
        }
    }
    return all;
}

std::unique_ptr<LayerPrograms> LayerMachine::programs_of(const Plan& plan,
                                                         bool ignore_limits) const {
    done("plan");
    auto all = std::make_unique<LayerPrograms>();
    std::size_t before = 0;  // pieces
    for (const std::span<const Piece> fibre : fibres_of(plan.pieces)) {
        const std::size_t number = all->programs.size();
        FibreProgram& program = all->programs.emplace_back();
        program.file =
            "program" + options_.suffix + fibre_suffix(number) + setup_.dialect->extension();
        wind_fibre(fibre, plan.continues_fibre && number == 0, ignore_limits, program);
        for (const auto& [piece, reason] : program.made.refused) {
            all->refused.push_back(before + piece);
        }
        before += fibre.size();
    }
    all->why = why_refused(all->programs);
    return all;
}

void LayerMachine::wind_fibre(std::span<const Piece> pieces, bool continues_fibre,
                              bool ignore_limits, FibreProgram& program) const {
    PieceProgramOptions options;
    options.ignore_limits = ignore_limits;
    options.lengths = LengthSearch::All;
    options.optimal = wants_least_time(setup_);
    options.round_trip = [&](const PieceProgram& made) {
        return setup_.dialect->read(text_of(made, continues_fibre), program.file, setup_.machine);
    };
    options.context = options_.context;
    options.stage_done = [this](const char* stage) { done(stage); };
    if (continues_fibre) {
        const BlockList& blocks = options_.before->made.blocks;
        const std::size_t spindle = setup_.machine.mandrel_chain.size() - 1;
        options.spindle_rad = joints_at(blocks, blocks.blocks.size() - 1)[spindle];
    }
    program.made = program_of(setup_, pieces, options);
    if (!program.made.read.blocks.empty()) {
        program.made.duration_s = program.made.verification.duration_s;  // F has six digits
        program.made.corner_s = program.made.duration_s - program.made.read.duration_s();
    }
}

std::string LayerMachine::text_of(const PieceProgram& made, bool continues_fibre,
                                  const std::vector<std::string>& notes) const {
    ProgramHeader header = options_.header;
    if (continues_fibre) {
        header.goes_on_from = options_.before->file;
    }
    header.fibre_length_mm = made.eyes.path.back().s_mm;
    header.pins = setup_.pins;
    header.tie_on_mm = made.eyes.path.front().landing_mm;
    header.notes.insert(header.notes.end(), notes.begin(), notes.end());
    return write_with_digest(*setup_.dialect, setup_.machine, made.blocks, made.layout, header);
}

void LayerMachine::done(const char* stage) const {
    if (options_.stage_done) {
        options_.stage_done(stage);
    }
}

}  // namespace meshwind
