#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
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
#include "cli/program_commands.h"
#include "cli/shell_commands.h"
#include "cli/streams.h"
#include "cli/usage.h"
#include "core/error.h"
#include "core/files/project_files.h"
#include "core/parallel.h"
#include "core/version.h"

namespace meshwind {
namespace {

constexpr const char* kEvery = "Options of every command";

// More than any machine has cores.
constexpr std::uint64_t kMaxThreads = 1024;

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
void refuse_options_of_wind(const CLI::App& app) {
    const std::vector<const CLI::Option*> options = app.get_options();
    const auto ignored = std::find_if(options.begin(), options.end(), [&](const auto* option) {
        return !option->get_positional() && option->count() > 0 && option->get_group() != kEvery;
    });
    if (ignored != options.end()) {
        const std::string command = app.get_subcommands().front()->get_name();
        throw InputError("cli.unknown_option", (*ignored)->get_name(),
                         "belongs to the main job, '" + command +
                             "' does not read it here; see meshwind " + command + " --help");
    }
}

void add_common(CLI::App& app, Common& common) {
    app.add_option("--threads", common.threads, "threads to use; 0: one per core")
        ->group(kEvery)
        ->type_name("N")
        ->check(whole_number(kMaxThreads))
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
}

// Commands in the order of the help, each with the arguments that it reads.
class Commands {
public:
    Commands(CLI::App& app, const Common& common) : app_(app), common_(common) {}

    // \param add_options (CLI::App&, Arguments&) \param run (Arguments&, const Common&), the exit
    // code
    template <typename Arguments, typename AddOptions, typename Run>
    void add(CLI::App& parent, const char* name, const char* words, const char* help,
             AddOptions add_options, Run run) {
        CLI::App* command = parent.add_subcommand(name, words);
        const auto arguments = std::make_shared<Arguments>();
        add_options(*command, *arguments);
        command->fallthrough();
        command->footer(std::string(help) + "\n\n" + kCommonHelp);
        runs_.emplace_back(command, [this, arguments, run] { return run(*arguments, common_); });
    }

    template <typename Arguments, typename AddOptions, typename Run>
    void add(const char* name, const char* words, const char* help, AddOptions add_options,
             Run run) {
        add<Arguments>(app_, name, words, help, add_options, run);
    }

    // Commands below a word of their own.
    CLI::App& group(const char* name, const char* words) {
        CLI::App* group = app_.add_subcommand(name, words);
        group->require_subcommand(1);
        group->fallthrough();
        group->footer(std::string("\n") + kCommonHelp);
        return *group;
    }

    // The one that the command line names; nothing where it names none.
    [[nodiscard]] std::optional<int> run_named() const {
        for (const auto& [command, run] : runs_) {
            if (command->parsed()) {
                return run();
            }
        }
        return std::nullopt;
    }

private:
    CLI::App& app_;
    const Common& common_;
    std::vector<std::pair<const CLI::App*, std::function<int()>>> runs_;
};

struct NoArguments {};

void add_commands(Commands& commands) {
    commands.add<WindArguments>(
        "wind", "the main job: plan, post-process, check, write", kWindHelp,
        [](CLI::App& app, WindArguments& wind) { add_wind_options(app, wind, true); }, run_wind);
    commands.add<PostArguments>("post", "a program for landing points made elsewhere", kPostHelp,
                                add_post, run_post);
    commands.add<VerifyArguments>("verify", "wind a program again from its text, and check it",
                                  kVerifyHelp, add_verify, run_verify_command);
    commands.add<ResumeArguments>("resume", "what is left of a program that stopped, as a program",
                                  kResumeHelp, add_resume, run_resume);
    commands.add<DryRunArguments>("dry-run", "a program for a first run in the air", kDryRunHelp,
                                  add_dry_run, run_dry_run);
    commands.add<RepeatArguments>("repeat", "the main job that made a program, once more",
                                  kRepeatHelp, add_repeat, run_repeat);
    commands.add<ShowArguments>("show", "a page for the browser, of a run, a program or a mesh",
                                kShowHelp, add_show, run_show);
    commands.add<InspectArguments>(
        "inspect", "what is read from a mandrel file: units, repairs, regions, rims, axis",
        kInspectHelp, add_inspect, run_inspect);
    commands.add<MakeRequest>(
        "make", "write the mesh of a parametric mandrel: pipe, vessel, elbow, tee, wye, cross",
        kMakeHelp, add_make, run_make_command);
    commands.add<TraceArguments>("trace", "one fibre path over a mandrel, as a table", kTraceHelp,
                                 add_trace, run_trace_command);
    commands.add<NoArguments>(
        "machines", "the machine files that come with meshwind", kMachinesHelp,
        [](CLI::App&, NoArguments&) {},
        [](NoArguments&, const Common& common) { return run_machines(common); });
    commands.add<NoArguments>(
        "profiles", "the materials and processes that come with meshwind", kProfilesHelp,
        [](CLI::App&, NoArguments&) {},
        [](NoArguments&, const Common& common) { return run_profiles(common); });
    commands.add<ValidateArguments>("validate", "check a machine or job file", kValidateHelp,
                                    add_validate, run_validate);
    commands.add<CarryArguments>(
        "carry", "a program for a robot that carries a frame through a fixed ring head", kCarryHelp,
        add_carry, run_carry_command);
    CLI::App& design = commands.group("design", "numbers of a part before it has a mesh");
    commands.add<DesignArguments>(design, "vessel",
                                  "a cylinder with isotensoid domes: what each winding angle gives",
                                  kDesignHelp, add_design_vessel, run_design_command);
    CLI::App& study = commands.group("study", "studies of accuracy, and of many cases");
    commands.add<StudyArguments>(study, "mesh-size",
                                 "accuracy of paths and motion against mesh size", kMeshSizeHelp,
                                 add_mesh_size, run_mesh_size);
    commands.add<CaseArguments>(study, "cases", "the main job for one row of a table", kCaseHelp,
                                add_case, run_case);
    commands.add<CaseArguments>(study, "merge", "what came of all rows, in one table", kMergeHelp,
                                add_merge, run_merge);
    CLI::App& exports = commands.group("export", "a run for other programs");
    commands.add<ShellArguments>(exports, "fe",
                                 "the wall as shells with plies, for finite elements",
                                 kExportFeHelp, add_export_fe, run_export_fe);
    commands.add<ShellArguments>("strength", "where a wound wall fails first, by CalculiX",
                                 kStrengthHelp, add_strength, run_strength);
}

int run(const std::vector<std::string>& arguments) {
    CLI::App app(
        "Filament winding on triangulated mandrels: mesh and machine in, checked NC code out.\n"
        "Without a command it runs the main job, the same as meshwind wind.",
        "meshwind");
    app.set_version_flag("--version", std::string("meshwind ") + kVersion);
    app.footer(kMainHelp);
    Common common;
    WindArguments wind;
    add_wind_options(app, wind, false);
    add_common(app, common);
    Commands commands(app, common);
    add_commands(commands);
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
        refuse_options_of_wind(app);
        if (!wind.mandrel.empty()) {
            throw usage_error(command_words(app), arguments,
                              "'" + wind.mandrel + "' is one argument too many");
        }
    }
    if (const std::optional<int> code = commands.run_named()) {
        return *code;
    }
    if (wind.mandrel.empty()) {
        std::cerr << app.help();
        return kBadInput;
    }
    if (!std::filesystem::exists(find_input(wind.mandrel)) &&
        !command_meant(command_words(app), wind.mandrel).empty()) {
        throw usage_error(command_words(app), arguments, "");
    }
    return run_wind(wind, common);
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
