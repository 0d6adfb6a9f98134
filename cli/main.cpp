#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/case_commands.h"
#include "cli/commands.h"
#include "cli/crash.h"
#include "cli/ending.h"
#include "cli/help_text.h"
#include "cli/interrupt.h"
#include "cli/make_command.h"
#include "cli/options.h"
#include "cli/shell_commands.h"
#include "cli/streams.h"
#include "cli/usage.h"
#include "core/error.h"
#include "core/files/project_files.h"
#include "core/parallel.h"
#include "core/version.h"

namespace meshwind {
namespace {

// More than any machine has cores.
constexpr std::uint64_t kMostThreads = 1024;

CommandWords command_words(const CLI::App& app) {
    CommandWords words{app.get_name(), {}, {}};
    for (const CLI::Option* option : app.get_options()) {
        const bool takes_value = option->get_items_expected_max() > 0;
        for (const std::string& name : option->get_lnames()) {
            words.options.push_back({"--" + name, takes_value});
        }
        for (const std::string& name : option->get_snames()) {
            words.options.push_back({"-" + name, takes_value});
        }
    }
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        words.commands.push_back(command_words(*command));
    }
    return words;
}

// Behind the name of a command the parser takes the program's options as well, those of the main
// job among them: the command would not hear of them.
void refuse_options_of_wind(const CLI::App& app, const std::string& group_of_every_command) {
    const std::vector<const CLI::Option*> options = app.get_options();
    const auto ignored = std::find_if(options.begin(), options.end(), [&](const auto* option) {
        return !option->get_positional() && option->count() > 0 &&
               option->get_group() != group_of_every_command;
    });
    if (ignored != options.end()) {
        const std::string command = app.get_subcommands().front()->get_name();
        throw InputError("cli.unknown_option", (*ignored)->get_name(),
                         "belongs to the main job, '" + command +
                             "' does not read it here; see meshwind " + command + " --help");
    }
}

int run(const std::vector<std::string>& arguments) {
    CLI::App app(
        "Filament winding on triangulated mandrels: mesh and machine in, checked NC code out.\n"
        "Without a command it runs the main job, the same as meshwind wind.",
        "meshwind");
    app.set_version_flag("--version", std::string("meshwind ") + kVersion);
    Common common;
    WindArguments wind_options;
    add_wind_options(app, wind_options, false);
    constexpr const char* kEvery = "Options of every command";
    app.add_option("--threads", common.threads, "threads to use; 0: one per core")
        ->group(kEvery)
        ->type_name("N")
        ->check(whole_number(kMostThreads))
        ->capture_default_str();
    app.add_option("--seed", common.seed,
                   "seed of every random draw; the same seed gives the same files")
        ->group(kEvery)
        ->type_name("N")
        ->check(whole_number(std::numeric_limits<std::uint64_t>::max()))
        ->capture_default_str();
    app.add_option("--units", common.units,
                   "length of a unit of the mandrel's file; overrides the job")
        ->group(kEvery)
        ->check(one_of({"auto", "um", "mm", "cm", "m", "in"}));
    app.add_flag("--json", common.json, "the report as JSON on stdout, in place of the summary")
        ->group(kEvery);
    app.add_flag("--verbose", common.verbose, "every check and all figures in the summary")
        ->group(kEvery);
    app.add_flag("--quiet", common.quiet, "no progress and no summary")->group(kEvery);
    app.add_flag("--force", common.force,
                 "write the program although a check failed; its head says so")
        ->group(kEvery);

    WindArguments named_wind_options;
    CLI::App* wind_command =
        app.add_subcommand("wind", "the main job: plan, post-process, check, write");
    add_wind_options(*wind_command, named_wind_options, true);
    PostArguments post_options;
    CLI::App* post_command =
        app.add_subcommand("post", "a program for landing points made elsewhere");
    add_post(*post_command, post_options);
    VerifyArguments verify_options;
    CLI::App* verify_command =
        app.add_subcommand("verify", "wind a program again from its text, and check it");
    add_verify(*verify_command, verify_options);
    ResumeArguments resume_options;
    CLI::App* resume_command =
        app.add_subcommand("resume", "what is left of a program that stopped, as a program");
    add_resume(*resume_command, resume_options);
    InspectArguments inspect_options;
    CLI::App* inspect = app.add_subcommand(
        "inspect", "what is read from a mandrel file: units, repairs, regions, rims, axis");
    add_inspect(*inspect, inspect_options);
    MakeRequest make_request;
    std::map<std::string, double> make_values;
    CLI::App* make = app.add_subcommand(
        "make", "write the mesh of a parametric mandrel: pipe, vessel, elbow, tee");
    add_make(*make, make_request, make_values);
    TraceArguments trace_text;
    CLI::App* trace_command =
        app.add_subcommand("trace", "one fibre path over a mandrel, as a table");
    CLI::Option* angle = add_trace(*trace_command, trace_text);
    CLI::App* machines =
        app.add_subcommand("machines", "the machine files that come with meshwind");
    ValidateArguments validate_options;
    CLI::App* validate = app.add_subcommand("validate", "check a machine or job file");
    validate->add_option("file", validate_options.file, "JSON file")->type_name("FILE");
    validate
        ->add_option(
            "--schema", validate_options.schema,
            "print the JSON Schema of job or machine files instead, or of the results report.json "
            "and layup.json")
        ->expected(0, 1)
        ->default_str(kJobSchema)
        ->check(one_of({kJobSchema, kMachineSchema, kReportSchema, kLayupSchema}));
    CarryArguments carry_text;
    CLI::App* carry = app.add_subcommand(
        "carry", "a program for a robot that carries a frame through a fixed ring head");
    add_carry(*carry, carry_text);
    DesignRequest design_request;
    CLI::App* design = app.add_subcommand("design", "numbers of a part before it has a mesh");
    design->require_subcommand(1);
    CLI::App* design_vessel = design->add_subcommand(
        "vessel", "a cylinder with isotensoid domes: what each winding angle gives");
    add_design_vessel(*design_vessel, design_request);
    StudyArguments study_request;
    CaseArguments case_arguments;
    CLI::App* study = app.add_subcommand("study", "studies of accuracy, and of many cases");
    study->require_subcommand(1);
    CLI::App* mesh_size =
        study->add_subcommand("mesh-size", "accuracy of paths and motion against mesh size");
    add_mesh_size(*mesh_size, study_request);
    CLI::App* one_case = study->add_subcommand("cases", "the main job for one row of a table");
    add_case(*one_case, case_arguments);
    CLI::App* merge = study->add_subcommand("merge", "what came of all rows, in one table");
    add_merge(*merge, case_arguments);
    ShellArguments shell_arguments;
    CLI::App* exporting = app.add_subcommand("export", "a run for other programs");
    exporting->require_subcommand(1);
    CLI::App* export_fe =
        exporting->add_subcommand("fe", "the wall as shells with plies, for finite elements");
    add_export_fe(*export_fe, shell_arguments);
    CLI::App* strength =
        app.add_subcommand("strength", "where a wound wall fails first, by CalculiX");
    add_strength(*strength, shell_arguments);
    app.footer(kMainHelp);
    for (CLI::App* command : {design, study, exporting}) {
        command->fallthrough();
        command->footer(std::string("\n") + kCommonHelp);
    }
    for (const auto& [command, more] : {std::pair(wind_command, kWindHelp),
                                        {post_command, kPostHelp},
                                        {verify_command, kVerifyHelp},
                                        {resume_command, kResumeHelp},
                                        {inspect, kInspectHelp},
                                        {make, kMakeHelp},
                                        {trace_command, kTraceHelp},
                                        {machines, kMachinesHelp},
                                        {validate, kValidateHelp},
                                        {carry, kCarryHelp},
                                        {design_vessel, kDesignHelp},
                                        {mesh_size, kMeshSizeHelp},
                                        {one_case, kCaseHelp},
                                        {merge, kMergeHelp},
                                        {export_fe, kExportFeHelp},
                                        {strength, kStrengthHelp}}) {
        command->fallthrough();
        command->footer(std::string(more) + "\n\n" + kCommonHelp);
    }

    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help, --version
        }
        throw usage_error(command_words(app), arguments, error.what());
    }
    set_thread_count(common.threads);
    if (!app.get_subcommands().empty()) {
        refuse_options_of_wind(app, kEvery);
        if (!wind_options.mandrel.empty()) {
            throw usage_error(command_words(app), arguments,
                              "'" + wind_options.mandrel + "' is one argument too many");
        }
    }
    if (wind_command->parsed()) {
        return run_wind(named_wind_options, common);
    }
    if (post_command->parsed()) {
        return run_post(post_options, common);
    }
    if (verify_command->parsed()) {
        return run_verify_command(verify_options, common);
    }
    if (resume_command->parsed()) {
        return run_resume(resume_options, common);
    }
    if (inspect->parsed()) {
        return run_inspect(inspect_options, common);
    }
    if (make->parsed()) {
        make_request.kind = make->get_subcommands().front()->get_name();
        make_request.shown_values.insert(make_values.begin(), make_values.end());
        make_request.options.seed = common.seed;
        if (make_request.output.empty()) {
            throw InputError("cli.output", "make", "name the mesh file to write with -o FILE");
        }
        const std::string line = run_make(make_request);
        if (!common.quiet) {
            std::cout << line << '\n';
        }
        return kDone;
    }
    if (trace_command->parsed()) {
        return run_trace_command(trace_text, angle->count() > 0, common);
    }
    if (carry->parsed()) {
        return run_carry_command(carry_text, common);
    }
    if (design_vessel->parsed()) {
        return run_design_command(design_request, common);
    }
    if (mesh_size->parsed()) {
        return run_mesh_size(study_request, common);
    }
    if (one_case->parsed()) {
        return run_case(case_arguments, common);
    }
    if (merge->parsed()) {
        return run_merge(case_arguments, common);
    }
    if (export_fe->parsed()) {
        return run_export_fe(shell_arguments, common);
    }
    if (strength->parsed()) {
        return run_strength(shell_arguments, common);
    }
    if (machines->parsed()) {
        return run_machines(common);
    }
    if (validate->parsed()) {
        return run_validate(validate_options, common);
    }
    if (wind_options.mandrel.empty()) {
        std::cerr << app.help();
        return kBadInput;
    }
    if (!std::filesystem::exists(find_input(wind_options.mandrel)) &&
        !command_meant(command_words(app), wind_options.mandrel).empty()) {
        throw usage_error(command_words(app), arguments, "");
    }
    return run_wind(wind_options, common);
}

}  // namespace
}  // namespace meshwind

int main(int argc, char** argv) {
    meshwind::open_standard_streams();
    meshwind::end_on_signals();
    meshwind::end_on_crashes();
    const std::vector<std::string> arguments =
        meshwind::with_help_as_option({argv + std::min(1, argc), argv + argc});
    meshwind::HeldOutput output;
    return meshwind::shown(
        output,
        meshwind::run_to_the_end([&arguments] { return meshwind::run(arguments); }, arguments));
}
