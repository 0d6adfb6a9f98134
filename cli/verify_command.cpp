#include "cli/verify_command.h"

#include <algorithm>
#include <chrono>

#include "cli/code_digest.h"
#include "cli/output_files.h"
#include "cli/report_verify.h"
#include "cli/run_files.h"
#include "core/error.h"
#include "core/text_file.h"
#include "winding/measure_plan.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Of the samples that coverage is measured on: the plan's by default.
constexpr std::uint64_t kVerifySeed = 1;

double seconds(Clock::duration duration) {
    return std::chrono::duration<double>(duration).count();
}

// The plan's table for this program: "path-2.csv" for "program-2.ngc", if there is one.
fs::path table_of(const VerifyRequest& request, const std::string& name) {
    const fs::path numbered = request.plan / (name + suffix_of(request.program) + ".csv");
    return fs::exists(numbered) ? numbered : request.plan / (name + ".csv");
}

VerifyPlan plan_of(const VerifyRequest& request, const Machine& machine) {
    VerifyPlan plan;
    if (!request.plan.empty()) {
        const fs::path path = table_of(request, "path");
        plan.fibre = read_path_csv(read_text_file(path), path.string());
        const fs::path motion = table_of(request, "motion");
        plan.motion = read_motion_csv(read_text_file(motion), motion.string(), machine);
    }
    return plan;
}

// The plan's motion, block by block.
Check program_check(const Machine& machine, const BlockList& program,
                    const std::vector<PlannedMotion>& motion, std::optional<std::size_t>& wrong) {
    const MotionDifference difference = first_difference(machine, program, motion);
    Check check{"program", difference.words.empty(), {}, {}};
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

bool VerifyOutcome::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.ok; });
}

VerifyOutcome run_verify(const VerifyRequest& request) {
    const auto begun = Clock::now();
    VerifyOutcome outcome;
    const auto tell = [&](const char* step, double share) {
        if (request.progress) {
            request.progress(step, share);
        }
    };
    tell("import", 0.0);
    outcome.setup = read_setup(request.setup);
    if (outcome.setup.job.mandrel.turn == TurnKind::Pins) {
        throw InputError("job.not_offered", request.setup.job.string() + ": /mandrel/turn",
                         "the pins are chosen with the plan, so a program that turns on them is "
                         "not wound again without it; `meshwind` has done so when it made the "
                         "program, see its report.json");
    }
    outcome.program = request.program.filename().string();
    const std::string text = read_text_file(request.program);
    outcome.blocks =
        outcome.setup.dialect->read(text, request.program.string(), outcome.setup.machine);
    if (request.tie_on_mm) {
        outcome.blocks.tie_on_mm = request.tie_on_mm;
    }
    const VerifyPlan plan = plan_of(request, outcome.setup.machine);
    const TextChecks texts =
        check_text(outcome.setup, text, request.program.string(), outcome.blocks, plan);
    outcome.checks = texts.checks;
    std::optional<OutputFolder> folder;
    if (!request.out.empty()) {
        folder.emplace(request.out);  // unusable: better known now
    }
    const auto read = Clock::now();
    outcome.verification = verify_program(outcome.setup, outcome.blocks, plan.fibre,
                                          [&](double share) { tell("verify", share); });
    outcome.coverage = coverage_of_fibre(
        outcome.setup.mandrel.surface, outcome.setup.wall->surface(),
        outcome.setup.job.tow.width_mm, kVerifySeed, outcome.verification.laid.path);
    // Where the program is not the planned one is the cause, what the fibre does the effect.
    if (texts.first_wrong) {
        outcome.verification.first_wrong_block = texts.first_wrong;
    }
    const std::vector<Check>& found = outcome.verification.checks;
    outcome.checks.insert(outcome.checks.end(), found.begin(), found.end());
    outcome.reading_s = seconds(read - begun);
    outcome.verifying_s = seconds(Clock::now() - read);
    if (folder) {
        folder->add("verify.json", verify_json(outcome));
        folder->add("laid.csv", laid_csv(outcome.verification, outcome.blocks));
        folder->publish();
    }
    return outcome;
}

}  // namespace meshwind
