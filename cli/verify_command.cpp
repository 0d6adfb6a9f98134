#include "cli/verify_command.h"

#include <algorithm>
#include <chrono>

#include "cli/output_files.h"
#include "cli/report_verify.h"
#include "cli/run_files.h"
#include "core/error.h"
#include "core/text_file.h"
#include "postproc/plan_tables.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds(Clock::duration duration) {
    return std::chrono::duration<double>(duration).count();
}

// The plan's table for this program: "path-2.csv" for "program-2.ngc", if there is one.
fs::path table_of(const VerifyRequest& request, const std::string& name) {
    const fs::path numbered = request.plan / (name + suffix_of(request.program) + ".csv");
    return fs::exists(numbered) ? numbered : request.plan / (name + ".csv");
}

// The plan's motion, block by block.
Check program_check(const VerifyRequest& request, const VerifyOutcome& outcome,
                    std::optional<std::size_t>& wrong) {
    const fs::path file = table_of(request, "motion");
    const MotionDifference difference = first_difference(
        outcome.setup.machine, outcome.blocks,
        read_motion_csv(read_text_file(file), file.string(), outcome.setup.machine));
    Check check{"program", difference.words.empty(), {}, {}};
    check.numbers["blocks"] = static_cast<double>(outcome.blocks.blocks.size());
    if (!check.ok) {
        // A block that is missing at the end is named by the last one there is.
        wrong = std::min(difference.block, outcome.blocks.blocks.size() - 1);
        check.words = "not the planned program from " + block_words(outcome.blocks, *wrong) +
                      " on: " + difference.words;
    }
    return check;
}

}  // namespace

bool VerifyOutcome::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.ok; });
}

VerifyOutcome run_verify(const VerifyRequest& request) {
    const auto begun = Clock::now();
    VerifyOutcome outcome;
    outcome.setup = read_setup(request.setup);
    if (outcome.setup.job.mandrel.turn == TurnKind::Pins) {
        throw InputError("job.not_offered", request.setup.job.string() + ": /mandrel/turn",
                         "the pins are chosen with the plan, so a program that turns on them is "
                         "not wound again without it; `meshwind` has done so when it made the "
                         "program, see its report.json");
    }
    outcome.program = request.program.filename().string();
    outcome.blocks = outcome.setup.dialect->read(read_text_file(request.program),
                                                 request.program.string(), outcome.setup.machine);
    if (request.tie_on_mm) {
        outcome.blocks.tie_on_mm = request.tie_on_mm;
    }
    PlannedFibre plan;
    std::optional<std::size_t> planned_until;
    if (!request.plan.empty()) {
        const fs::path file = table_of(request, "path");
        plan = read_path_csv(read_text_file(file), file.string());
        outcome.checks.push_back(program_check(request, outcome, planned_until));
    }
    std::optional<OutputFolder> folder;
    if (!request.out.empty()) {
        folder.emplace(request.out);  // unusable: better known now
    }
    const auto read = Clock::now();
    outcome.verification = verify_program(outcome.setup, outcome.blocks, plan);
    // Where the program is not the planned one is the cause, what the fibre does the effect.
    if (planned_until) {
        outcome.verification.first_wrong_block = planned_until;
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
