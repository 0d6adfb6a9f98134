#include "cli/commands.h"

#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "cli/check_controller.h"
#include "cli/inspect.h"
#include "cli/job.h"
#include "cli/phases.h"
#include "cli/progress.h"
#include "cli/project_files.h"
#include "cli/refine_command.h"
#include "cli/report.h"
#include "cli/report_carry.h"
#include "cli/report_checks.h"
#include "cli/report_design.h"
#include "cli/report_mandrel.h"
#include "cli/report_study.h"
#include "cli/report_verify.h"
#include "cli/streams.h"
#include "cli/verify_command.h"
#include "core/error.h"
#include "core/text_number.h"
#include "machines/eye_inverse.h"
#include "machines/machine_json.h"
#include "postproc/dialect.h"
#include "version.h"

namespace meshwind {
namespace {

double unit_mm(const std::string& name) {
    static const std::map<std::string, double> kUnits = {{"", 0.0},   {"auto", 0.0}, {"um", 1e-3},
                                                         {"mm", 1.0}, {"cm", 10.0},  {"m", 1000.0},
                                                         {"in", 25.4}};
    return kUnits.at(name);
}

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

// What takes seconds at most tells of its phases on a terminal alone: a log needs no line of them.
bool shows_bar(const Common& common) {
    return !common.quiet && ::isatty(STDERR_FILENO) != 0;
}

// A line on stderr for each check that failed, unless the summary has told it on the same terminal.
int exit_code(const std::string& file, const std::vector<Check>& checks, const Common& common) {
    const bool told = !common.json && !common.quiet && ::isatty(STDOUT_FILENO) != 0 &&
                      ::isatty(STDERR_FILENO) != 0;
    int code = kDone;
    for (const Check& check : checks) {
        if (!check.ok) {
            code = kCheckFailed;
        }
        if (!check.ok && !told) {
            std::cerr << one_line("meshwind: " + file + ": check failed: " + check.name + ": " +
                                  check.words)
                      << '\n';
        }
    }
    return code;
}

// Runs the main job, shows what came of it.
int run_main_job(const std::string& name, WindRequest& request, const PreviewOptions& png,
                 const Common& common) {
    check_preview(png);
    Progress progress(common.quiet);
    request.unit_mm = unit_mm(common.units);
    request.seed = common.seed;
    request.force = common.force;
    request.progress = [&](const std::string& step, double share) {
        progress.show(phase_text(step), share);
    };
    request.remark = [&](const std::string& words) { progress.say("meshwind: remark: " + words); };
    const WindResult result = wind(request);
    if (!png.file.empty()) {
        progress.show(phase_text("picture"), 0.0);
        write_preview(png, result.layers);
    }
    progress.clear();
    if (common.json) {
        std::cout << report_json(result);
    } else if (!common.quiet) {
        print_summary(std::cout, result, request.out);
    }
    return exit_code(name, result.checks, common);
}

}  // namespace

int run_wind(const WindOptions& options, const Common& common) {
    WindRequest request;
    request.mandrel = find_input(options.mandrel);
    request.machine = find_input(options.machine);
    request.job = options.job.empty() ? std::filesystem::path() : find_input(options.job);
    request.out = options.out;
    request.effort = options.effort;
    return run_main_job(options.mandrel, request, options.png, common);
}

int run_post(const PostOptions& options, const Common& common) {
    WindRequest request = wind_request(options);
    return run_main_job(options.points, request, options.png, common);
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
    Progress progress(common.quiet);
    request.progress = [&](const std::string& step, double share) { progress.show(step, share); };
    const VerifyOutcome outcome = run_verify(request);
    progress.clear();
    if (common.json) {
        std::cout << verify_json(outcome);
    } else if (!common.quiet) {
        print_verify(std::cout, outcome);
    }
    return exit_code(options.program, outcome.checks, common);
}

int run_inspect(const InspectOptions& options, const Common& common) {
    if (options.refine_mm && options.out.empty()) {
        throw InputError("cli.output", "inspect --refine",
                         "name the mesh file to write with -o FILE");
    }
    Progress progress(!shows_bar(common));
    progress.show("mandrel", 0.0);
    const Mandrel mandrel =
        load_mandrel(find_input(options.mandrel), {.unit_mm = unit_mm(common.units)});
    std::size_t refined_faces = 0;
    if (options.refine_mm) {
        progress.show("refine", 0.0);
        refined_faces = write_refined(mandrel, *options.refine_mm, options.out);
    }
    progress.show("accuracy", 0.0);
    const PathAccuracy accuracy = estimate_path_accuracy(mandrel.surface);
    const RevolutionFinding revolution = find_revolution(mandrel);
    const TubeFinding tube = find_tube(mandrel);
    progress.clear();
    if (common.json) {
        nlohmann::json report{{"meshwind", kVersion}, {"mandrel", mandrel_report(mandrel)}};
        report["mandrel"]["revolution"] = revolution_report(revolution);
        report["mandrel"]["tube"] = tube_report(tube);
        report["mandrel"]["accuracy"] = accuracy_report(accuracy);
        if (options.refine_mm) {
            report["refined"] = {{"file", options.out},
                                 {"longest_edge_mm", *options.refine_mm},
                                 {"triangles", refined_faces}};
        }
        std::cout << json_text(report);
    } else {
        print_mandrel(std::cout, mandrel, accuracy, revolution, tube);
        if (options.refine_mm) {
            std::cout << "refined       " << options.out << ": " << refined_faces
                      << " triangles, edges of at most " << fixed(*options.refine_mm, 3) << " mm\n";
        }
    }
    return kDone;
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
    Progress progress(!shows_bar(common));
    progress.show("trace", 0.0);
    const std::string line = run_trace(request);
    progress.clear();
    if (!common.quiet) {
        std::cout << line << '\n';
    }
    return kDone;
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

int run_carry_command(CarryOptionsText& text, const Common& common) {
    CarryRequest& request = text.request;
    request.axis = find_input(text.axis);
    request.machine = find_input(text.machine);
    request.out = text.out;
    request.tool = tool_of(text.tool);
    request.unit_mm = unit_mm(common.units);
    request.force = common.force;
    const CarryOutcome outcome = run_carry(request);
    if (common.json) {
        std::cout << carry_json(outcome);
    } else if (!common.quiet) {
        print_carry(std::cout, outcome);
    }
    return exit_code(text.axis, outcome.checks, common);
}

int run_design_command(const DesignRequest& request, const Common& common) {
    const DesignOutcome outcome = run_design(request);
    if (common.json) {
        std::cout << design_json(outcome);
    } else if (!common.quiet) {
        print_design(std::cout, outcome);
    }
    return kDone;
}

std::string main_job_words(const MachineClass& what) {
    if (!what.refusal.empty()) {
        return "cannot be run: " + what.refusal;
    }
    return what.eye_distance_mm > 0.0
               ? "can be run, with the eye " + fixed(what.eye_distance_mm, 3) +
                     " mm from the spindle axis (eye rule \"cylinder\")"
               : "can be run";
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
    std::string more;
    if (machine) {
        const Machine read = read_machine(file);
        if (read.controller.dialect != kCarryDialect) {
            check_controller(read, file);
        }
        const MachineClass what = machine_class(read);
        more = "class         " + what.words + "\nfreedom       " +
               std::to_string(read.axis_count()) +
               " axes: " + std::to_string(read.mandrel_chain.size()) + " of the mandrel, " +
               std::to_string(read.eye_chain.size()) + " of the eye\nmain job      " +
               main_job_words(what) + "\n";
    } else {
        (void)read_job(file);
    }
    if (!common.quiet) {
        std::cout << name << ": a valid " << (machine ? "machine" : "job") << " file\n" << more;
    }
    return kDone;
}

}  // namespace meshwind
