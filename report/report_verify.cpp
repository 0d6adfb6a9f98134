#include "report/report_verify.h"

#include <nlohmann/json.hpp>

#include "core/counted.h"
#include "core/text/text_number.h"
#include "core/version.h"
#include "report/report_checks.h"

namespace meshwind {

std::string verify_json(const VerifyOutcome& outcome, double reading_s) {
    const Verification& verification = outcome.verification;
    const Coverage& coverage = outcome.coverage;
    nlohmann::json report = {
        {"meshwind", kVersion},
        {"program", outcome.program},
        {"mandrel", outcome.setup.mandrel.file},
        {"machine", outcome.setup.machine.name},
        {"dialect", outcome.setup.machine.controller.dialect},
        {"verification", verification_report(verification, outcome.blocks)},
        {"coverage",
         {{"fraction", report_number(coverage.fraction)},
          {"mean_layers", report_number(coverage.mean_layers)},
          {"max_layers", coverage.max_layers}}},
        {"checks", checks_report(outcome.checks)},
        {"other_job", outcome.other_job},
        {"ok", outcome.passed()},
        {"timing_s", {{"import", reading_s}, {"verify", outcome.verifying_s}}}};
    return json_text(report);
}

void print_verify(std::ostream& out, const VerifyOutcome& outcome) {
    const Verification& verification = outcome.verification;
    out << outcome.program << " on " << outcome.setup.machine.name << " lays "
        << fixed(verification.fibre_length_mm / 1000.0, 1) << " m of fibre on "
        << outcome.setup.mandrel.file << " in " << counted(outcome.blocks.moves(), "block") << ", "
        << fixed(verification.duration_s / 60.0, 1) << " min\n";
    out << "covered " << percent(outcome.coverage.fraction) << " of the wall, "
        << fixed(outcome.coverage.mean_layers, 2) << " layers on average, at most "
        << outcome.coverage.max_layers << '\n';
    if (outcome.other_job) {
        out << "remark: the program was written for another job than the one given here; where "
               "checks fail, give by --job and --set what it was wound with\n";
    }
    print_checks(out, outcome.checks);
    if (verification.first_wrong_block) {
        out << "first wrong: " << block_words(outcome.blocks, *verification.first_wrong_block)
            << '\n';
    }
}

}  // namespace meshwind
