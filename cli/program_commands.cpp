#include "cli/program_commands.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/inputs.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/files/project_files.h"
#include "core/files/write_file.h"
#include "core/text/text_file.h"
#include "core/text/text_number.h"
#include "core/version.h"
#include "mesh/mandrel/load_mandrel.h"
#include "pipeline/load_inputs.h"
#include "pipeline/resume/dry_run.h"
#include "pipeline/resume/resume.h"
#include "pipeline/run_names.h"
#include "pipeline/verify_text.h"
#include "postproc/nc/made_from.h"
#include "report/folder/output_files.h"
#include "report/folder/run_files.h"
#include "report/inspection.h"
#include "report/page/verified_run.h"
#include "report/report_checks.h"
#include "report/report_verify.h"
#include "report/write_run.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

MadeFrom head_of(const std::string& text) {
    return made_from(text).value_or(MadeFrom{});
}

// Whether a mandrel is one that a run has grown by its layers and written.
bool is_grown(const fs::path& mandrel) {
    const std::size_t layer = layer_of(mandrel);
    return layer > 0 && mandrel.filename() == grown_mandrel_name(layer);
}

// It is in the mandrel frame, and nothing of it is cut or blended anew.
MandrelOptions as_grown() {
    MandrelOptions options;
    options.axis = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
    return options;
}

struct ProgramInputs {
    Setup setup;
    VerifyInputs verify;
};

// What the arguments leave open is as the program's head says.
ProgramInputs inputs_of(ProgramArguments arguments, const Common& common) {
    ProgramInputs inputs;
    inputs.verify.program = {arguments.program, read_text_file(arguments.program)};
    const MadeFrom head = head_of(inputs.verify.program.text);
    arguments.job.program = arguments.program;
    arguments.job.text = head.job;
    const InputFiles files{.machine = arguments.machine.empty()
                                          ? machine_named_by(arguments.program, head.machine_file)
                                          : find_input(arguments.machine),
                           .job = found_or_none(arguments.job.file)};
    require_machine_file(files.machine);
    const fs::path mandrel =
        arguments.mandrel.empty()
            ? mandrel_named_by(arguments.program, head.mandrel, head.mandrel_digest)
            : find_input(arguments.mandrel);
    const Machine machine = load_machine(files.machine);
    const Job job = job_of(arguments.job, files.job, false);
    inputs.setup = make_setup(
        load_mandrel(mandrel,
                     is_grown(mandrel) ? as_grown() : mandrel_options(job, unit_mm(common.units))),
        machine, job, files);
    if (!arguments.tie_on.empty()) {
        Eigen::Vector3d& tie_on_mm =
            inputs.verify.tie_on_mm.emplace(vector_of("--tie-on", arguments.tie_on));
        if (arguments.frame == "file") {
            tie_on_mm = inputs.setup.mandrel.file_to_mandrel * tie_on_mm;
        }
    }
    return inputs;
}

// Of a program that is made of another one: as it is named, or beside that one.
fs::path program_file(const std::string& named, const std::string& begin, const fs::path& of) {
    fs::path file =
        named.empty() ? of.parent_path() / (begin + of.filename().string()) : fs::path(named);
    std::error_code absent;
    if (fs::equivalent(file, of, absent)) {
        throw InputError("output.holds_input", file.string(),
                         "this is the program that is read; give another name");
    }
    return file;
}

// The first program of a folder, in the order of layers and fibres; empty where there is none.
fs::path first_program(const fs::path& folder) {
    std::vector<fs::path> programs;
    for (const std::string& name : files_of_earlier_run(folder)) {
        if (role_of(name) == FileRole::Program) {
            programs.push_back(folder / name);
        }
    }
    const auto shortest = std::ranges::min_element(programs, {}, [](const fs::path& file) {
        return std::pair(file.stem().string().size(), file.stem().string());
    });
    return shortest == programs.end() ? fs::path() : *shortest;
}

// A program of a folder with the same blocks; empty where there is none.
fs::path same_blocks(const fs::path& folder, const std::string& code_digest) {
    for (const std::string& name : files_of_earlier_run(folder)) {
        if (role_of(name) == FileRole::Program &&
            head_of(read_text_file(folder / name)).code_digest == code_digest) {
            return folder / name;
        }
    }
    return {};
}

std::string repeated_words(const fs::path& out, const MadeFrom& head) {
    const fs::path same =
        head.code_digest.empty() ? fs::path() : same_blocks(out, head.code_digest);
    if (!same.empty()) {
        return same.string() + " has the same blocks";
    }
    return "no program has the same blocks" +
           (head.version == kVersion
                ? std::string()
                : "; it was made by meshwind " + head.version + ", this is meshwind " + kVersion);
}

std::string page_of_program(const ProgramArguments& arguments, const Common& common,
                            Progress& progress) {
    ProgramInputs inputs = inputs_of(arguments, common);
    VerifyOutcome outcome =
        verify_text(std::move(inputs.setup), inputs.verify, context_of(common, progress));
    return run_page(run_of(std::move(outcome), inputs.verify.program.text, common.seed));
}

std::string page_of_mandrel(const fs::path& file, const Common& common) {
    const Job job;
    Mandrel mandrel = load_mandrel(file, mandrel_options(job, unit_mm(common.units)));
    return part_page(inspect(std::move(mandrel), job.tow.width_mm));
}

}  // namespace

int run_verify_command(const VerifyArguments& arguments, const Common& common) {
    Progress progress(common.quiet);
    const RunContext context = context_of(common, progress);
    context.report_progress("import", 0.0);
    const auto begun = std::chrono::steady_clock::now();
    auto [setup, inputs] = inputs_of(arguments, common);
    if (!arguments.plan.empty()) {
        inputs.path = plan_table(arguments.plan, arguments.program, "path");
        inputs.motion = plan_table(arguments.plan, arguments.program, "motion");
    }
    std::optional<OutputFolder> folder;
    if (!arguments.out.empty()) {
        folder.emplace(arguments.out);  // unusable: better known now
    }
    const double reading_s = seconds_since(begun);
    VerifyOutcome outcome = verify_text(std::move(setup), inputs, context);
    const std::string report = verify_json(outcome, reading_s);
    std::ostringstream said;
    print_verify(said, outcome);
    const std::vector<Check> checks = outcome.checks;
    if (folder) {
        folder->add("verify.json", report);
        folder->add("laid.csv", laid_csv(outcome.verification, outcome.blocks));
        context.report_progress("write", 0.0);
        const std::string page =
            run_page(run_of(std::move(outcome), inputs.program.text, common.seed));
        if (!page.empty()) {
            folder->add("verify.html", page);
            said << "page:    " << (fs::path(arguments.out) / "verify.html").string() << '\n';
        }
        folder->publish();
    }
    progress.clear();
    if (common.json) {
        std::cout << report;
    } else if (!common.quiet) {
        std::cout << said.str();
    }
    return exit_code(arguments.program, checks, common);
}

int run_resume(const ResumeArguments& arguments, const Common& common) {
    if (arguments.block.has_value() == arguments.line.has_value()) {
        throw InputError("resume.block", "resume",
                         "say by --block or --line how far the program has been run");
    }
    Progress progress(common.quiet);
    const RunContext context = context_of(common, progress);
    context.report_progress("import", 0.0);
    auto [setup, inputs] = inputs_of(arguments, common);
    const LaidProgram whole = lay_program(std::move(setup), inputs, context);
    const ResumedProgram rest = resume(
        whole, arguments.block ? *arguments.block : block_of_line(whole, *arguments.line), context);
    fs::path file = program_file(arguments.out, "resume_", arguments.program);
    if (rest.passed() || common.force) {
        write_file(file, rest.text);
    } else {
        file.clear();
    }
    progress.clear();
    if (common.json) {
        std::cout << resume_json(rest, arguments.program, file.string());
    } else if (!common.quiet) {
        print_resume(std::cout, rest, arguments.program);
        std::cout << (file.empty() ? "no program written" : "program   " + file.string()) << '\n';
    }
    return exit_code(arguments.program, rest.verification.checks, common);
}

int run_dry_run(const DryRunArguments& arguments, const Common& common) {
    Progress progress(!shows_bar(common));
    progress.show("import", 0.0);
    const fs::path file = program_file(arguments.out, "air_", arguments.program);
    auto [setup, inputs] = inputs_of(arguments, common);
    progress.show("verify", 0.0);
    const DryRun run = dry_run(std::move(setup), inputs, arguments.clearance_mm);
    write_file(file, run.text);
    progress.clear();
    if (common.json) {
        std::cout << json_text({{"file", file.string()},
                                {"axis", std::string(1, run.axis)},
                                {"moved_mm", run.moved_mm},
                                {"clearance_mm", arguments.clearance_mm},
                                {"blocks", run.blocks.moves()}});
    } else if (!common.quiet) {
        std::cout << "in the air: " << run.axis << " starts " << fixed(run.moved_mm, 1)
                  << " mm from where it does in " << arguments.program << ", and in all "
                  << run.blocks.moves() << " blocks the head stays "
                  << fixed(arguments.clearance_mm, 1) << " mm off the part\nprogram   "
                  << file.string() << '\n';
    }
    return kDone;
}

int run_repeat(const RepeatArguments& arguments, const Common& common) {
    const MadeFrom head = head_of(read_text_file(arguments.program));
    if (!head.run || head.job.empty()) {
        throw InputError("repeat.no_run", arguments.program,
                         "its head does not say how the main job made it; programs of post, of "
                         "resume and of others do not, nor those of older versions");
    }
    const bool grown = head.mandrel != head.run->mandrel;
    WindArguments wind;
    wind.mandrel = !arguments.mandrel.empty()
                       ? arguments.mandrel
                       : mandrel_named_by(arguments.program, head.run->mandrel,
                                          grown ? std::string() : head.mandrel_digest)
                             .string();
    wind.machine = !arguments.machine.empty()
                       ? arguments.machine
                       : machine_named_by(arguments.program, head.machine_file).string();
    wind.job = arguments.job;
    wind.job.program = arguments.program;
    wind.job.text = head.job;
    wind.effort = head.run->effort;
    wind.out = arguments.out;
    wind.png = arguments.png;
    spare_inputs(arguments.out, {arguments.program});
    Common as_made = common;
    as_made.seed = head.run->seed;
    const int code = run_wind(wind, as_made);
    if (code == kDone && !common.quiet) {
        (common.json ? std::cerr : std::cout)
            << "repeat    " << repeated_words(wind.out, head) << '\n';
    }
    return code;
}

int run_show(ShowArguments arguments, const Common& common) {
    fs::path what = find_input(arguments.what);
    const fs::path page = arguments.out.empty() ? what.stem().string() + ".html" : arguments.out;
    check_part_page(page.string());
    const auto tell = [&](const fs::path& written) {
        if (common.json) {
            std::cout << json_text({{"page", written.string()}});
        } else if (!common.quiet) {
            std::cout << "page: " << written.string() << '\n';
        }
        return kDone;
    };
    if (fs::is_directory(what)) {
        if (fs::exists(what / "report.html") && arguments.out.empty()) {
            return tell(what / "report.html");
        }
        const fs::path folder = what;
        what = first_program(folder);
        if (what.empty()) {
            throw InputError("show.nothing", folder.string(),
                             "has neither a page nor a program of a run; name such a folder, a "
                             "program, or a mandrel's file");
        }
    }
    Progress progress(!shows_bar(common));
    arguments.program.program = what.string();
    const std::string text = role_of(what) == FileRole::Program
                                 ? page_of_program(arguments.program, common, progress)
                                 : page_of_mandrel(what, common);
    write_file(page, text);
    progress.clear();
    return tell(page);
}

}  // namespace meshwind
