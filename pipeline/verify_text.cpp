#include "pipeline/verify_text.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/error.h"
#include "pipeline/code_digest.h"
#include "pipeline/job/job_friction.h"
#include "pipeline/run_names.h"
#include "postproc/verify/check_kinds.h"
#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

using Clock = std::chrono::steady_clock;

VerifyPlan plan_of(const VerifyInputs& inputs, const Machine& machine) {
    VerifyPlan plan;
    if (inputs.path && inputs.motion) {
        plan.fibre = read_path_csv(inputs.path->text, inputs.path->name);
        plan.motion = read_motion_csv(inputs.motion->text, inputs.motion->name, machine);
    }
    return plan;
}

// Puts the pins that a program's head names on the mandrel.
void put_pins_of(const BlockList& program, const std::string& file, Setup& setup) {
    for (const PinRing& ring : program.pins) {
        if (static_cast<std::size_t>(ring.rim) >= setup.mandrel.rims.size()) {
            throw InputError("nc.pins", file,
                             "its head has pins at rim " + std::to_string(ring.rim) +
                                 ", and the mandrel has rims 0 to " +
                                 std::to_string(setup.mandrel.rims.size() - 1) +
                                 "; give the mandrel that it was made for");
        }
    }
    if (program.pins.empty() && traits_of(setup.job.mandrel.turn).reads_pins) {
        throw InputError("nc.pins", file,
                         "the job turns the fibre on pins, and the program's head does not say "
                         "where they stand; wind the job again");
    }
    if (!program.pins.empty()) {
        put_pins(setup, program.pins);
    }
}

bool is_of_other_job(const BlockList& program, const Job& job) {
    return program.head && !program.head->job_digest.empty() &&
           program.head->job_digest != job_digest(job);
}

// The plan's motion, block by block.
Check program_check(const Machine& machine, const BlockList& program,
                    const std::vector<PlannedMotion>& motion, std::optional<std::size_t>& wrong) {
    const MotionDifference difference = first_difference(machine, program, motion);
    Check check(check_kind::kProgram, difference.words.empty());
    check.numbers["blocks"] = static_cast<double>(program.moves());
    if (!check.ok) {
        // A block that is missing at the end is named by the last one there is.
        wrong = std::min(difference.block, program.blocks.size() - 1);
        check.words = "not the planned program from " + block_words(program, *wrong) +
                      " on: " + difference.words;
    }
    return check;
}

}  // namespace

TextChecks check_text(const Setup& setup, std::string_view text, const std::string& file,
                      const BlockList& program, const VerifyPlan& plan) {
    TextChecks found;
    if (!plan.fibre.empty()) {
        found.checks.push_back(
            program_check(setup.machine, program, plan.motion, found.first_wrong));
    }
    if (const auto code = code_check(*setup.dialect, text, file, program)) {
        found.checks.push_back(*code);
    }
    return found;
}

BlockList read_program(Setup& setup, const VerifyInputs& inputs) {
    const std::string& name = inputs.program.name;
    setup.friction = friction_of(setup.job, layer_of(name));
    BlockList program = setup.dialect->read(inputs.program.text, name, setup.machine);
    if (inputs.tie_on_mm) {
        program.tie_on_mm = inputs.tie_on_mm;
    }
    put_pins_of(program, name, setup);
    return program;
}

bool VerifyOutcome::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.ok; });
}

VerifyOutcome verify_text(Setup setup, const VerifyInputs& inputs, const RunContext& context) {
    VerifyOutcome outcome;
    outcome.setup = std::move(setup);
    outcome.program = std::filesystem::path(inputs.program.name).filename().string();
    const std::string& text = inputs.program.text;
    const std::string& name = inputs.program.name;
    outcome.blocks = read_program(outcome.setup, inputs);
    outcome.other_job = is_of_other_job(outcome.blocks, outcome.setup.job);
    const VerifyPlan plan = plan_of(inputs, outcome.setup.machine);
    const TextChecks texts = check_text(outcome.setup, text, name, outcome.blocks, plan);
    outcome.checks = texts.checks;
    const auto begun = Clock::now();
    outcome.verification =
        verify_program(outcome.setup, outcome.blocks, plan.fibre,
                       [&](double share) { context.report_progress("verify", share); });
    outcome.coverage = coverage_of_fibre(
        outcome.setup.mandrel.surface, outcome.setup.wall->surface(),
        outcome.setup.job.tow.width_mm, context.seed, outcome.verification.laid.path);
    // Where the program is not the planned one is the cause, what the fibre does the effect.
    if (texts.first_wrong) {
        outcome.verification.first_wrong_block = texts.first_wrong;
    }
    const std::vector<Check>& found = outcome.verification.checks;
    outcome.checks.insert(outcome.checks.end(), found.begin(), found.end());
    outcome.verifying_s = std::chrono::duration<double>(Clock::now() - begun).count();
    return outcome;
}

}  // namespace meshwind
