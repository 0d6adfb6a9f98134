#include "cli/case_commands.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <vector>

#include "core/error.h"
#include "core/files/write_file.h"
#include "core/text/text_file.h"
#include "report/cases/case_results.h"
#include "report/cases/case_table.h"

namespace meshwind {
namespace {

std::vector<Case> cases_of(const CaseArguments& arguments) {
    return read_cases(read_text_file(arguments.table), arguments.table);
}

}  // namespace

int run_case(const CaseArguments& arguments, const Common& common) {
    const std::vector<Case> cases = cases_of(arguments);
    if (arguments.row < 1 || arguments.row > cases.size()) {
        throw InputError("case.row", "--row " + std::to_string(arguments.row),
                         arguments.table + " has rows 1 to " + std::to_string(cases.size()));
    }
    const Case& wanted = cases[arguments.row - 1];
    const std::filesystem::path folder = arguments.out;
    std::filesystem::create_directories(folder);
    forget_case_end(folder, wanted);
    WindArguments wind;
    wind.mandrel = wanted.mandrel;
    wind.machine = wanted.machine;
    wind.job.file = wanted.job;
    wind.job.settings = wanted.settings;
    wind.out = (folder / wanted.id).string();
    wind.effort = arguments.effort;
    try {
        const int code = run_wind(wind, common);
        write_case_end(folder, wanted, {.exit_code = code});
        return code;
    } catch (const Error& error) {
        write_case_end(folder, wanted,
                       {.exit_code = kBadInput, .code = error.code(), .words = error.what()});
        throw;
    }
}

int run_merge(const CaseArguments& arguments, const Common& common) {
    const std::vector<Case> cases = cases_of(arguments);
    const std::filesystem::path folder = arguments.out;
    const MergedCases merged = merge_cases(folder, cases);
    if (arguments.left) {
        std::vector<std::size_t> rows = merged.failed;
        rows.insert(rows.end(), merged.missing.begin(), merged.missing.end());
        std::sort(rows.begin(), rows.end());
        std::cout << numbers_text(rows) << '\n';
        return kDone;
    }
    const std::filesystem::path file = folder / "cases.csv";
    write_file(file, merged.csv);
    const bool whole = merged.failed.empty() && merged.missing.empty();
    if (common.json) {
        std::cout << merged_json(merged, file);
    } else if (!common.quiet) {
        std::cout << cases.size() << " cases: " << merged.passed << " ok, " << merged.failed.size()
                  << " failed, " << merged.missing.size() << " missing; " << file.string() << '\n';
        for (const auto& [what, rows] :
             {std::pair("failed", &merged.failed), std::pair("missing", &merged.missing)}) {
            if (!rows->empty()) {
                std::cout << what << "  rows " << numbers_text(*rows) << '\n';
            }
        }
    }
    return whole ? kDone : kCheckFailed;
}

}  // namespace meshwind
