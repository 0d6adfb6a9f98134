#include "report/report_verify.h"

#include <nlohmann/json.hpp>

#include "core/counted.h"
#include "core/text/text_number.h"
#include "core/version.h"
#include "report/report_checks.h"

namespace meshwind {
namespace {

constexpr double kMmPerM = 1000.0;
constexpr double kSPerMin = 60.0;

std::vector<std::string> remarks_of(const BlockList& program) {
    return program.head ? program.head->remarks : std::vector<std::string>{};
}

}  // namespace

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
        {"remarks", remarks_of(outcome.blocks)},
        {"other_job", outcome.other_job},
        {"ok", outcome.passed()},
        {"timing_s", {{"import", reading_s}, {"verify", outcome.verifying_s}}}};
    return json_text(report);
}

std::string resume_json(const ResumedProgram& rest, const std::string& program,
                        const std::string& file) {
    const nlohmann::json report = {
        {"meshwind", kVersion},
        {"program", program},
        {"block", rest.block},
        {"line", rest.line},
        {"laid_mm", report_number(rest.laid_mm)},
        {"file", file.empty() ? nlohmann::json(nullptr) : nlohmann::json(file)},
        {"verification", verification_report(rest.verification, rest.blocks)},
        {"checks", checks_report(rest.verification.checks)},
        {"ok", rest.passed()}};
    return json_text(report);
}

void print_resume(std::ostream& out, const ResumedProgram& rest, const std::string& program) {
    const Verification& left = rest.verification;
    const Eigen::Vector3d tie = *rest.blocks.tie_on_mm;
    out << program << " goes on behind block " << rest.block << " (line " << rest.line
        << "): " << fixed(rest.laid_mm / kMmPerM, 1) << " m of fibre lie, "
        << fixed(left.fibre_length_mm / kMmPerM, 1) << " m are left in "
        << counted(rest.blocks.moves(), "block") << ", " << fixed(left.duration_s / kSPerMin, 1)
        << " min\n"
        << "tie the fibre on at X" << fixed(tie.x(), 3) << " Y" << fixed(tie.y(), 3) << " Z"
        << fixed(tie.z(), 3) << " of the mandrel, where it lies\n";
    print_checks(out, left.checks);
}

void print_verify(std::ostream& out, const VerifyOutcome& outcome) {
    const Verification& verification = outcome.verification;
    out << outcome.program << " on " << outcome.setup.machine.name << " lays "
        << fixed(verification.fibre_length_mm / kMmPerM, 1) << " m of fibre on "
        << outcome.setup.mandrel.file << " in " << counted(outcome.blocks.moves(), "block") << ", "
        << fixed(verification.duration_s / kSPerMin, 1) << " min\n";
    out << "covered " << percent(outcome.coverage.fraction) << " of the wall, "
        << fixed(outcome.coverage.mean_layers, 2) << " layers on average, at most "
        << outcome.coverage.max_layers << '\n';
    for (const std::string& remark : remarks_of(outcome.blocks)) {
        out << "remark: " << remark << '\n';
    }
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
