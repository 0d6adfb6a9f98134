#include "cli/commands.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

#include "cli/inputs.h"
#include "cli/phases.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/files/project_files.h"
#include "core/files/write_file.h"
#include "core/text/text_file.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "machines/eye_inverse.h"
#include "machines/machine_json.h"
#include "machines/spindle_frame.h"
#include "mesh/io/export.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make.h"
#include "pipeline/check_controller.h"
#include "pipeline/load_inputs.h"
#include "pipeline/trials/trials.h"
#include "pipeline/wind.h"
#include "postproc/nc/dialect.h"
#include "report/folder/output_files.h"
#include "report/folder/run_files.h"
#include "report/inspection.h"
#include "report/report.h"
#include "report/report_carry.h"
#include "report/report_checks.h"
#include "report/report_design.h"
#include "report/report_study.h"
#include "report/summary.h"
#include "report/write_run.h"
#include "study/study_run.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

// Returns the number of triangles.
std::size_t write_refined(const Mandrel& mandrel, double edge_mm, const fs::path& file) {
    const MeshFormat format = mesh_format_of(file);  // before anything is made
    const TriangleSoup soup = refined_wall(mandrel, edge_mm);
    write_file(file, mesh_file_bytes(soup, format));
    return soup.faces.size();
}

// Reads the inputs, runs the main job, writes what came of it and shows it.
int run_main_job(const WindArguments& arguments, const PostArguments* post, const Common& common) {
    check_preview(arguments.png);
    Progress progress(common.quiet);
    WindOptions options;
    options.context.seed = common.seed;
    options.context.effort = arguments.effort;
    options.context.progress = [&](const std::string& step, double share) {
        progress.show(phase_text(step), share);
    };
    options.context.remark = [&](const std::string& words) {
        progress.say("meshwind: remark: " + words);
    };
    options.force = common.force;
    options.context.report_progress("import", 0.0);
    const fs::path mandrel_file = find_input(arguments.mandrel);
    options.files = {.machine = find_input(arguments.machine),
                     .job = found_or_none(arguments.job.file)};
    require_machine_file(options.files.machine);
    const Machine machine = load_machine(options.files.machine);
    const Job job = job_of(arguments.job, options.files.job, post == nullptr);
    if (post != nullptr) {
        options.import = ImportRequest{.points = read_landing_points(post->points),
                                       .mandrel_frame = post->frame == "mandrel",
                                       .farthest_mm = post->within_mm,
                                       .circuits = post->circuits,
                                       .turn_rad = rad_from_deg(post->turn_deg),
                                       .smooth_mm = post->smooth_mm};
    }
    const MandrelOf mandrel =
        mandrel_reader(mandrel_file, unit_mm(common.units), options.mandrel_digest);
    spare_inputs(arguments.out, {mandrel_file, options.files.machine, options.files.job,
                                 post != nullptr ? fs::path(post->points) : fs::path()});
    OutputFolder folder(arguments.out);  // unusable: better known now
    const Run run = wind(mandrel, machine, job, options);
    options.context.report_progress("write", 0.0);
    const std::string report = write_run(run, folder);
    if (!arguments.png.file.empty()) {
        options.context.report_progress("picture", 0.0);
        write_preview(arguments.png, run.layers);
    }
    progress.clear();
    if (common.json) {
        std::cout << report;
    } else if (!common.quiet) {
        print_summary(std::cout, run, arguments.out, common.verbose ? Detail::Full : Detail::Brief);
    }
    return exit_code(post != nullptr ? post->points : arguments.mandrel, run.checks, common);
}

std::vector<StudyMandrel> mandrels_of(const StudyArguments& arguments, double file_unit_mm) {
    std::vector<std::string> names = arguments.mandrels;
    if (names.empty()) {
        names = {"cylinder", "torus", "ellipsoid", "tee"};
    }
    const std::vector<double>& edges_mm = arguments.options.edges_mm;
    const double shortest_mm = *std::min_element(edges_mm.begin(), edges_mm.end());
    std::vector<StudyMandrel> mandrels;
    for (const std::string& name : names) {
        std::vector<StudyMandrel> known = known_studies(name, arguments.radii_mm);
        if (known.empty()) {
            known.push_back(study_of_file(find_input(name), file_unit_mm, shortest_mm));
        }
        std::move(known.begin(), known.end(), std::back_inserter(mandrels));
    }
    return mandrels;
}

}  // namespace

int run_wind(const WindArguments& arguments, const Common& common) {
    return run_main_job(arguments, nullptr, common);
}

int run_post(const PostArguments& arguments, const Common& common) {
    WindArguments wind;
    wind.mandrel = arguments.mandrel;
    wind.machine = arguments.machine;
    wind.job = arguments.job;
    wind.out = arguments.out;
    wind.png = arguments.png;
    return run_main_job(wind, &arguments, common);
}

int run_inspect(const InspectArguments& arguments, const Common& common) {
    if (arguments.refine_mm && arguments.out.empty()) {
        throw InputError("cli.output", "inspect --refine",
                         "name the mesh file to write with -o FILE");
    }
    check_part_page(arguments.page);
    Progress progress(!shows_bar(common));
    progress.show("mandrel", 0.0);
    const Job job = job_of(arguments.job, found_or_none(arguments.job.file), false);
    Mandrel mandrel =
        load_mandrel(find_input(arguments.mandrel), mandrel_options(job, unit_mm(common.units)));
    std::optional<RefinedFile> refined;
    if (arguments.refine_mm) {
        progress.show("refine", 0.0);
        refined = {arguments.out, *arguments.refine_mm,
                   write_refined(mandrel, *arguments.refine_mm, arguments.out)};
    }
    progress.show("accuracy", 0.0);
    Inspection found = inspect(std::move(mandrel), job.tow.width_mm);
    found.refined = std::move(refined);
    if (!arguments.page.empty()) {
        found.page = arguments.page;
        write_part_page(found, arguments.page);
    }
    progress.clear();
    if (common.json) {
        std::cout << json_text(inspection_report(found));
    } else {
        print_inspection(std::cout, found);
    }
    return kDone;
}

int run_trace_command(TraceArguments& arguments, const Common& common) {
    TraceRequest& request = arguments.request;
    request.start = vector_of("--start", arguments.start);
    request.method = arguments.method == "walk" ? TraceMethod::Walk : TraceMethod::Patches;
    request.file_frame = arguments.frame == "file";
    if (arguments.angle_deg) {
        request.angle_deg = arguments.angle_deg;
    } else if (!arguments.direction.empty()) {
        request.direction = vector_of("--direction", arguments.direction);
    } else if (!arguments.to.empty()) {
        request.to = vector_of("--to", arguments.to);
    } else {
        throw InputError("cli.direction", "trace",
                         "give --direction X,Y,Z, --angle DEG or --to X,Y,Z");
    }
    Progress progress(!shows_bar(common));
    progress.show("trace", 0.0);
    const Mandrel mandrel =
        load_mandrel(find_input(arguments.mandrel), {.unit_mm = unit_mm(common.units)});
    const TraceTable table = trace_table(mandrel, request);
    write_file(arguments.out, table.csv);
    progress.clear();
    if (!common.quiet) {
        std::cout << arguments.out << ": " << table.words << '\n';
    }
    return kDone;
}

int run_mesh_size(StudyArguments& arguments, const Common& common) {
    Progress progress(common.quiet);
    arguments.options.context.seed = common.seed;
    arguments.options.context.progress = [&](const std::string& step, double share) {
        progress.show(step, share);
    };
    arguments.options.validate();
    OutputFolder folder(arguments.out);
    const StudyOutcome outcome =
        run_study(mandrels_of(arguments, unit_mm(common.units)), arguments.options);
    write_study(outcome, folder);
    progress.clear();
    if (common.json) {
        std::cout << study_json(outcome);
    } else if (!common.quiet) {
        print_study(std::cout, outcome, arguments.out);
    }
    return kDone;
}

int run_carry_command(CarryArguments& arguments, const Common& common) {
    CarryRequest& request = arguments.request;
    request.tool = tool_of(arguments.tool);
    request.force = common.force;
    const fs::path axis_file = find_input(arguments.axis);
    const fs::path machine_file = find_input(arguments.machine);
    CarryAxis axis = read_carry_axis(
        axis_file,
        {unit_mm(common.units), {arguments.from_the_end, rad_from_deg(arguments.bend_turn_deg)}});
    const Machine machine = load_machine(machine_file);
    spare_inputs(arguments.out, {axis_file, machine_file});
    OutputFolder folder(arguments.out);
    const CarryOutcome outcome = carry(std::move(axis), machine, request, machine_file.string());
    write_carry(outcome, folder);
    if (common.json) {
        std::cout << carry_json(outcome);
    } else if (!common.quiet) {
        print_carry(std::cout, outcome, arguments.out);
    }
    return exit_code(arguments.axis, outcome.checks, common);
}

namespace {

// Edges of a design's mesh, in radii of its cylinder: 125 around it. Paths are of fourth order in
// them, and a coarser mesh is told from its domes by eye.
constexpr double kEdgesOfRadius = 0.05;

// Mesh and job of a design. Returns the command that winds them.
std::string write_design(const DesignOutcome& outcome, const std::filesystem::path& folder) {
    const VesselDesign& design = outcome.design;
    const VesselAngle& angle = least_fibre(outcome);
    const TriangleSoup mesh = make_isotensoid({.radius_mm = design.radius_mm,
                                               .cylinder_length_mm = design.cylinder_length_mm,
                                               .opening_radius_mm = design.opening_radius_mm,
                                               .stiffness_ratio = design.stiffness_ratio,
                                               .design_radius_mm = design.design_radius_mm},
                                              {.edge_mm = kEdgesOfRadius * design.radius_mm});
    std::filesystem::create_directories(folder);
    const std::filesystem::path part = folder / "vessel.stl";
    const std::filesystem::path job = folder / "job.json";
    write_file(part, mesh_file_bytes(mesh, mesh_format_of(part)));
    write_file(job, design_job(design, angle));
    return "meshwind " + part.string() + " --units mm --job " + job.string();
}

}  // namespace

int run_design_command(const DesignArguments& arguments, const Common& common) {
    const DesignOutcome outcome = run_design(arguments.request);
    const std::string wind =
        arguments.out.empty() ? std::string() : write_design(outcome, arguments.out);
    if (common.json) {
        std::cout << design_json(outcome);
    } else if (!common.quiet) {
        print_design(std::cout, outcome);
        std::cout << (wind.empty() ? wind : "to wind it   " + wind + '\n');
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

// Those of files that are read come from the tables that read them, those of results are files.
std::string schema_text(const std::string& name) {
    if (name == kJobSchema) {
        return job_schema_text();
    }
    if (name == kMachineSchema) {
        return machine_schema_text();
    }
    return read_text_file((project_home() / "data/schema" / (name + ".schema.json")).string());
}

// A machine file names its schema; everything else is read as a job.
int run_validate(const ValidateArguments& arguments, const Common& common) {
    if (!arguments.schema.empty()) {
        std::cout << schema_text(arguments.schema);
        return kDone;
    }
    const std::string& name = arguments.file;
    if (name.empty()) {
        throw InputError("cli.usage", "validate",
                         "needs a file to check; meshwind validate JOB.json");
    }
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
        const Machine read = in_spindle_frame(read_machine(file));
        if (!carries_frames(read)) {
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

int run_machines(const Common& common) {
    std::vector<std::pair<std::string, Machine>> machines;
    std::size_t widest = 0;
    for (const std::string& file : shipped_machines()) {
        machines.emplace_back(file, in_spindle_frame(read_machine(find_input(file).string())));
        widest = std::max(widest, file.size());
    }
    nlohmann::json all = nlohmann::json::array();
    for (const auto& [file, machine] : machines) {
        const bool main_job = machine_class(machine).refusal.empty();
        std::string axes;
        for (std::size_t joint = 0; joint < machine.axis_count(); ++joint) {
            axes += joint > 0 ? " " : "";
            axes += machine.axis(joint).letter;
        }
        if (common.json) {
            all.push_back({{"file", file},
                           {"name", machine.name},
                           {"axes", axes},
                           {"dialect", machine.controller.dialect},
                           {"main_job", main_job}});
        } else {
            std::cout << file << std::string(widest + 2 - file.size(), ' ') << machine.name
                      << ": axes " << axes << ", dialect " << machine.controller.dialect
                      << (main_job ? "" : ", for \"carry\" alone") << '\n';
        }
    }
    if (common.json) {
        std::cout << json_text(all);
    }
    return kDone;
}

int run_profiles(const Common& common) {
    const std::vector<std::string> files = shipped_profiles();
    std::size_t widest = 0;
    for (const std::string& file : files) {
        widest = std::max(widest, file.size());
    }
    nlohmann::json all = nlohmann::json::array();
    for (const std::string& file : files) {
        const std::string says = told_job_text(load_profile(find_input(file)));
        if (common.json) {
            all.push_back({{"file", file}, {"job", nlohmann::json::parse(says)}});
        } else {
            std::cout << file << std::string(widest + 2 - file.size(), ' ') << says << '\n';
        }
    }
    if (common.json) {
        std::cout << json_text(all);
    }
    return kDone;
}

}  // namespace meshwind
