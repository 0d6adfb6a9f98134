#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/inspect.h"
#include "cli/job.h"
#include "cli/make_command.h"
#include "cli/project_files.h"
#include "cli/refine_command.h"
#include "cli/report.h"
#include "cli/report_mandrel.h"
#include "cli/report_study.h"
#include "cli/report_verify.h"
#include "cli/study_command.h"
#include "cli/trace_command.h"
#include "cli/verify_command.h"
#include "cli/wind.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text_number.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "postproc/dialect.h"
#include "version.h"

namespace meshwind {
namespace {

constexpr int kDone = 0;
constexpr int kCheckFailed = 1;
constexpr int kBadInput = 2;
constexpr int kInternalError = 3;

// What every command takes.
struct Common {
    int threads = 0;
    std::uint64_t seed = 1;
    bool quiet = false;
    bool json = false;
    bool force = false;
    std::string units;
};

double unit_mm(const std::string& name) {
    static const std::map<std::string, double> kUnits = {{"", 0.0},   {"auto", 0.0}, {"um", 1e-3},
                                                         {"mm", 1.0}, {"cm", 10.0},  {"m", 1000.0},
                                                         {"in", 25.4}};
    return kUnits.at(name);
}

// A bar on a terminal, one line per step elsewhere.
class Progress {
public:
    explicit Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(const std::string& step, double share) {
        if (quiet_) {
            return;
        }
        if (terminal_) {
            constexpr int kWidth = 30;
            const int done = static_cast<int>(kWidth * share);
            std::cerr << "\r\033[K" << step << " ["
                      << std::string(static_cast<std::size_t>(done), '#')
                      << std::string(static_cast<std::size_t>(kWidth - done), '.') << "]"
                      << std::flush;
            shown_ = true;
        } else if (step != last_) {
            std::cerr << step << " ...\n";
        }
        last_ = step;
    }

    void clear() {
        if (shown_) {
            std::cerr << "\r\033[K" << std::flush;
            shown_ = false;
        }
    }

private:
    bool quiet_;
    bool terminal_;
    bool shown_ = false;
    std::string last_;
};

Eigen::Vector3d vector_of(const std::string& option, const std::string& text) {
    Eigen::Vector3d v;
    std::istringstream in(text);
    std::array<char, 2> comma{};
    std::string rest;
    if (!(in >> v.x() >> comma[0] >> v.y() >> comma[1] >> v.z()) || comma[0] != ',' ||
        comma[1] != ',' || in >> rest || !v.allFinite()) {
        throw InputError("cli.vector", option,
                         "'" + text + "' is not three numbers; write them as X,Y,Z without blanks");
    }
    return v;
}

// A line on stderr for each check that failed.
int exit_code(const std::string& file, const std::vector<Check>& checks) {
    int code = kDone;
    for (const Check& check : checks) {
        if (!check.ok) {
            code = kCheckFailed;
            std::cerr << "meshwind: " << file << ": check failed: " << check.name << ": "
                      << check.words << '\n';
        }
    }
    return code;
}

struct WindOptions {
    std::string mandrel;
    std::string machine = "six_axis.json";
    std::string job;
    std::string out = "meshwind-out";
    int effort = 1;
};

void add_wind_options(CLI::App& app, WindOptions& options, bool required) {
    auto* mandrel =
        app.add_option("mandrel", options.mandrel, "mesh of the part: STL, OBJ, PLY, OFF");
    if (required) {
        mandrel->required();
    }
    app.add_option("--machine", options.machine, "machine file")->capture_default_str();
    app.add_option("--job", options.job, "job file; without it the defaults hold");
    app.add_option("-o,--out", options.out, "output folder")->capture_default_str();
    app.add_option("--effort", options.effort,
                   "how long the plan is improved: 4 takes about 4 times as long as 1, and saves "
                   "fibre")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
}

int run_wind(const WindOptions& options, const Common& common) {
    Progress progress(common.quiet);
    WindRequest request;
    request.mandrel = find_input(options.mandrel);
    request.machine = find_input(options.machine);
    request.job = options.job.empty() ? std::filesystem::path() : find_input(options.job);
    request.out = options.out;
    request.unit_mm = unit_mm(common.units);
    request.seed = common.seed;
    request.effort = options.effort;
    request.force = common.force;
    request.progress = [&](const std::string& step, double share) { progress.show(step, share); };
    const WindResult result = wind(request);
    progress.clear();
    if (common.json) {
        std::cout << report_json(result);
    } else if (!common.quiet) {
        print_summary(std::cout, result, request.out);
    }
    return exit_code(options.mandrel, result.checks);
}

constexpr const char* kVerifyHelp =
    "Wind a program again from its code.\n"
    "Nothing but the program, the machine and the mandrel says where the fibre goes. It is then\n"
    "checked for slip, bridging, collisions, free length, axis limits and pay-out, and with "
    "--plan\n"
    "compared with what was planned: exit code 1 and the first wrong block where anything fails.\n"
    "  meshwind verify meshwind-out/program.ngc --mandrel tee.stl --machine six_axis.json "
    "--plan meshwind-out";

struct VerifyOptions {
    std::string program, mandrel, machine, job, plan, out, tie_on;
};

void add_verify(CLI::App& app, VerifyOptions& options) {
    app.add_option("program", options.program, "NC program, of meshwind or of anybody")->required();
    app.add_option("--mandrel", options.mandrel, "mesh of the part")->required();
    app.add_option("--machine", options.machine, "machine file")->required();
    app.add_option("--job", options.job,
                   "job file: tow, friction, extensions, tolerances; without it the defaults hold");
    app.add_option(
        "--plan", options.plan,
        "folder with path.csv and motion.csv, to compare with at the end; for program-2.ngc "
        "path-2.csv and motion-2.csv");
    app.add_option("--tie-on", options.tie_on,
                   "X,Y,Z in the mandrel frame where the fibre is tied on, if the program does not "
                   "say it");
    app.add_option("-o,--out", options.out, "folder for verify.json and laid.csv");
}

int run_verify_command(const VerifyOptions& options, const Common& common) {
    VerifyRequest request;
    request.program = options.program;
    request.setup.mandrel = find_input(options.mandrel);
    request.setup.machine = find_input(options.machine);
    request.setup.job = options.job.empty() ? std::filesystem::path() : find_input(options.job);
    request.setup.unit_mm = unit_mm(common.units);
    request.plan = options.plan;
    request.out = options.out;
    if (!options.tie_on.empty()) {
        request.tie_on_mm = vector_of("--tie-on", options.tie_on);
    }
    const VerifyOutcome outcome = run_verify(request);
    if (common.json) {
        std::cout << verify_json(outcome);
    } else if (!common.quiet) {
        print_verify(std::cout, outcome);
    }
    return exit_code(options.program, outcome.checks);
}

struct InspectOptions {
    std::string mandrel;
    std::optional<double> refine_mm;
    std::string out;
};

void add_inspect(CLI::App& app, InspectOptions& options) {
    app.add_option("mandrel", options.mandrel, "mesh of the part")->required();
    auto* refine = app.add_option("--refine", options.refine_mm,
                                  "write the winding surface with edges of at most so many mm, new "
                                  "vertices on its curved patches; frame and units of the file");
    app.add_option("-o,--out", options.out, "mesh file to write: .stl, .obj, .ply or .off")
        ->needs(refine);
}

int run_inspect(const InspectOptions& options, const Common& common) {
    if (options.refine_mm && options.out.empty()) {
        throw InputError("cli.output", "inspect --refine",
                         "name the mesh file to write with -o FILE");
    }
    const Mandrel mandrel =
        load_mandrel(find_input(options.mandrel), {.unit_mm = unit_mm(common.units)});
    const std::size_t refined_faces =
        options.refine_mm ? write_refined(mandrel, *options.refine_mm, options.out) : 0;
    const PathAccuracy accuracy = estimate_path_accuracy(mandrel.surface);
    if (common.json) {
        nlohmann::json report{{"meshwind", kVersion}, {"mandrel", mandrel_report(mandrel)}};
        report["mandrel"]["accuracy"] = accuracy_report(accuracy);
        if (options.refine_mm) {
            report["refined"] = {{"file", options.out},
                                 {"longest_edge_mm", *options.refine_mm},
                                 {"triangles", refined_faces}};
        }
        std::cout << report.dump(1) << '\n';
    } else {
        print_mandrel(std::cout, mandrel, accuracy);
        if (options.refine_mm) {
            std::cout << "refined       " << options.out << ": " << refined_faces
                      << " triangles, edges of at most " << fixed(*options.refine_mm, 3) << " mm\n";
        }
    }
    return kDone;
}

// One subcommand per kind, with an option for each of its parameters.
void add_make(CLI::App& app, MakeRequest& request, std::map<std::string, double>& values) {
    app.require_subcommand(1);
    app.fallthrough();
    app.add_option("-o,--out", request.output, "mesh file to write: .stl, .obj, .ply or .off");
    app.add_option("--edge", request.options.edge_mm, "edge length, mm")->capture_default_str();
    app.add_flag("--irregular", request.options.irregular,
                 "jittered vertices and random diagonals");
    app.add_flag("--solid", request.options.solid, "with inner wall and end faces");
    app.add_option("--wall", request.options.wall_mm, "wall thickness of a solid, mm")
        ->capture_default_str();
    for (const MakeKind& kind : make_kinds()) {
        CLI::App* sub = app.add_subcommand(std::string(kind.name), std::string(kind.meaning));
        sub->fallthrough();
        for (const MakeParameter& parameter : kind.parameters) {
            const std::string name(parameter.name);
            sub->add_option_function<double>(
                "--" + name, [&values, name](const double& value) { values[name] = value; },
                help_of(parameter));
        }
    }
}

struct TraceOptionsText {
    std::string mandrel, start, direction, to, frame = "mandrel", method = "patches";
    double angle_deg = 0.0;
    TraceRequest request;
};

CLI::Option* add_trace(CLI::App& app, TraceOptionsText& text) {
    app.add_option("mandrel", text.mandrel, "mesh of the part")->required();
    app.add_option("--start", text.start, "X,Y,Z in the file's frame; snapped to the surface")
        ->required();
    auto* direction = app.add_option("--direction", text.direction, "X,Y,Z in the file's frame");
    auto* angle =
        app.add_option("--angle", text.angle_deg,
                       "degrees from the local axial direction, counter-clockwise from outside");
    direction->excludes(angle);
    auto* to = app.add_option("--to", text.to,
                              "X,Y,Z where the path ends, instead of a direction: its start angle "
                              "is found");
    to->excludes(direction)->excludes(angle);
    app.add_option("--lambda", text.request.slip_ratio, "slip ratio kg / kn to steer with")
        ->capture_default_str();
    auto* length = app.add_option("--length", text.request.length_mm, "longest path, mm");
    length->capture_default_str()->excludes(to);
    app.add_option("--method", text.method,
                   "patches: solved on curved patches, accurate; walk: over the facets, fast")
        ->check(CLI::IsMember({"patches", "walk"}))
        ->capture_default_str();
    app.add_option("--frame", text.frame, "frame of the output")
        ->check(CLI::IsMember({"mandrel", "file"}))
        ->capture_default_str();
    app.add_option("-o,--out", text.request.out, "table to write")->required();
    return angle;
}

int run_trace_command(TraceOptionsText& text, bool has_angle, const Common& common) {
    TraceRequest& request = text.request;
    request.mandrel = find_input(text.mandrel);
    request.unit_mm = unit_mm(common.units);
    request.start = vector_of("--start", text.start);
    request.method = text.method == "walk" ? TraceMethod::Walk : TraceMethod::Patches;
    request.file_frame = text.frame == "file";
    if (has_angle) {
        request.angle_deg = text.angle_deg;
    } else if (!text.direction.empty()) {
        request.direction = vector_of("--direction", text.direction);
    } else if (!text.to.empty()) {
        request.to = vector_of("--to", text.to);
    } else {
        throw InputError("cli.direction", "trace",
                         "give --direction X,Y,Z, --angle DEG or --to X,Y,Z");
    }
    const std::string line = run_trace(request);
    if (!common.quiet) {
        std::cout << line << '\n';
    }
    return kDone;
}

constexpr const char* kMeshSizeHelp =
    "Accuracy against mesh size.\n"
    "Lays the same random fibres on ever finer meshes of known surfaces and compares them with "
    "the\n"
    "exact fibres: the path's end, the winding angle and the slip; then, with the fibre's "
    "direction\n"
    "taken from the landing points by chord (P1-P2), central chord (P1-P3), parabola or tracer, "
    "the\n"
    "spindle angle C and the eye point. An error that falls by 2^k when the edges are halved is "
    "of\n"
    "order k.\n"
    "Cylinders are compared with closed forms; torus, ellipsoid and tee with the differential\n"
    "equation of their exact surface; a file with itself, coarsened: choose edges well above its\n"
    "own, and mind that what its own mesh has wrong is not seen.\n"
    "To choose a mesh for a part: take the row of the surface most like it, and the edge length "
    "at\n"
    "which the error that matters is small enough.\n"
    "  meshwind study mesh-size\n"
    "  meshwind study mesh-size --mandrel cylinder --radius 35 --edges 8,4,2,1 -o pipe\n"
    "  meshwind study mesh-size --mandrel part.stl --edges 12,8,6";

void add_mesh_size(CLI::App& app, StudyRequest& request) {
    MeshSizeOptions& options = request.options;
    request.out = "study-mesh-size";
    app.add_option(
        "--mandrel", request.mandrels,
        "cylinder, torus, ellipsoid, tee, or a mesh file; several may be named [all four]");
    app.add_option("--radius", request.radii_mm, "radii of the cylinders, mm")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--edges", options.edges_mm, "edge lengths of the meshes, mm")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--lambda", options.slip_ratios,
                   "slip ratios kg / kn to steer with; the eye is shown for the first")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--paths", options.paths, "fibres on each mesh")->capture_default_str();
    app.add_option("--length", options.length_mm, "length of a fibre unless it meets a rim, mm")
        ->capture_default_str();
    app.add_option("--free-length", options.free_length_mm, "from landing point to eye, mm")
        ->capture_default_str();
    app.add_flag("--irregular,!--regular", options.irregular,
                 "jittered vertices and random diagonals, as scans and CAD give them [irregular]");
    app.add_flag("--timing", options.timing,
                 "measure the cost of tracing too, one mesh at a time; writes timing.csv");
    app.add_option("-o,--out", request.out, "output folder")->capture_default_str();
}

int run_mesh_size(StudyRequest& request, const Common& common) {
    Progress progress(common.quiet);
    request.unit_mm = unit_mm(common.units);
    request.options.seed = common.seed;
    request.options.progress = [&](const std::string& step, double share) {
        progress.show(step, share);
    };
    const StudyOutcome outcome = run_study(request);
    progress.clear();
    if (common.json) {
        std::cout << study_json(outcome);
    } else if (!common.quiet) {
        print_study(std::cout, outcome, request.out);
    }
    return kDone;
}

// A machine file names its schema; everything else is read as a job.
int run_validate(const std::string& name, const Common& common) {
    const std::string file = find_input(name).string();
    if (std::filesystem::is_directory(file)) {
        throw IoError("io.cannot_read", file, "is a folder; name a JSON file");
    }
    std::ifstream in(file);
    const nlohmann::json text = nlohmann::json::parse(in, nullptr, false);
    const bool machine =
        text.is_object() && (text.contains("schema") || text.contains("eye_chain"));
    if (machine) {
        const Machine read = read_machine(file);
        const SpindleWristInverse inverse(read);
        make_dialect(read.controller.dialect)->check(read);
    } else {
        (void)read_job(file);
    }
    if (!common.quiet) {
        std::cout << name << ": a valid " << (machine ? "machine" : "job") << " file\n";
    }
    return kDone;
}

int run(int argc, char** argv) {
    CLI::App app(
        "Filament winding on triangulated mandrels: mesh and machine in, checked NC code out.\n"
        "meshwind MANDREL --machine MACHINE.json is the main job, the same as meshwind wind.",
        "meshwind");
    app.set_version_flag("--version", std::string("meshwind ") + kVersion);
    Common common;
    WindOptions wind_options;
    add_wind_options(app, wind_options, false);
    app.add_option("--threads", common.threads, "threads; 0 for one per core")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--seed", common.seed, "seed of every random draw")->capture_default_str();
    app.add_option("--units", common.units, "length of a file unit")
        ->check(CLI::IsMember({"auto", "um", "mm", "cm", "m", "in"}));
    app.add_flag("--json", common.json, "the report on stdout");
    app.add_flag("--quiet", common.quiet, "no progress and no summary");
    app.add_flag("--force", common.force, "write the program although a check failed");

    WindOptions named_wind_options;
    CLI::App* wind_command = app.add_subcommand("wind", "the main job");
    add_wind_options(*wind_command, named_wind_options, true);
    VerifyOptions verify_options;
    CLI::App* verify_command = app.add_subcommand("verify", kVerifyHelp);
    add_verify(*verify_command, verify_options);
    InspectOptions inspect_options;
    CLI::App* inspect = app.add_subcommand("inspect", "what is read from a mandrel file");
    add_inspect(*inspect, inspect_options);
    MakeRequest make_request;
    std::map<std::string, double> make_values;
    CLI::App* make = app.add_subcommand("make", "a parametric mandrel");
    add_make(*make, make_request, make_values);
    TraceOptionsText trace_text;
    CLI::App* trace_command = app.add_subcommand("trace", "one fibre path");
    CLI::Option* angle = add_trace(*trace_command, trace_text);
    std::string validate_file;
    CLI::App* validate = app.add_subcommand("validate", "check a machine or job file");
    validate->add_option("file", validate_file, "JSON file")->required();
    StudyRequest study_request;
    CLI::App* study = app.add_subcommand("study", "studies of accuracy");
    study->require_subcommand(1);
    CLI::App* mesh_size = study->add_subcommand("mesh-size", kMeshSizeHelp);
    add_mesh_size(*mesh_size, study_request);
    for (CLI::App* command :
         {wind_command, verify_command, inspect, make, trace_command, validate, study, mesh_size}) {
        command->fallthrough();
    }

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help, --version
        }
        std::cerr << "meshwind: " << error.what() << "; see meshwind --help\n";
        return kBadInput;
    }
    set_thread_count(common.threads);
    if (!app.get_subcommands().empty() && !wind_options.mandrel.empty()) {
        throw InputError(
            "cli.extra", "",
            "'" + wind_options.mandrel + "' is one argument too many; see meshwind --help");
    }
    if (wind_command->parsed()) {
        return run_wind(named_wind_options, common);
    }
    if (verify_command->parsed()) {
        return run_verify_command(verify_options, common);
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
    if (mesh_size->parsed()) {
        return run_mesh_size(study_request, common);
    }
    if (validate->parsed()) {
        return run_validate(validate_file, common);
    }
    if (wind_options.mandrel.empty()) {
        std::cerr << app.help();
        return kBadInput;
    }
    return run_wind(wind_options, common);
}

}  // namespace
}  // namespace meshwind

int main(int argc, char** argv) {
    try {
        return meshwind::run(argc, argv);
    } catch (const meshwind::NumericalError& error) {
        std::cerr << "meshwind: " << error.what() << '\n';
        return meshwind::kInternalError;
    } catch (const meshwind::Error& error) {
        std::cerr << "meshwind: " << error.what() << '\n';
        return meshwind::kBadInput;
    } catch (const std::bad_alloc&) {
        std::cerr << "meshwind: out of memory\n";
        return meshwind::kInternalError;
    } catch (const std::exception& error) {
        std::cerr << "meshwind: internal error: " << error.what() << '\n';
        return meshwind::kInternalError;
    }
}
