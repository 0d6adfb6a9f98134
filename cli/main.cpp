#include <algorithm>
#include <charconv>
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

#include "cli/commands.h"
#include "cli/crash.h"
#include "cli/ending.h"
#include "cli/help_text.h"
#include "cli/interrupt.h"
#include "cli/make_command.h"
#include "cli/streams.h"
#include "cli/usage.h"
#include "core/error.h"
#include "core/files/project_files.h"
#include "core/parallel.h"
#include "core/version.h"
#include "mesh/io/import.h"

namespace meshwind {
namespace {

// More than any machine has cores.
constexpr std::uint64_t kMostThreads = 1024;

// Digits and nothing else: the library behind options would take -1 for the largest number.
CLI::Validator whole_number(std::uint64_t most) {
    return {[most](const std::string& text) {
                std::uint64_t value = 0;
                const char* const end = text.data() + text.size();
                const auto read = std::from_chars(text.data(), end, value);
                const bool good = read.ec == std::errc() && read.ptr == end && value <= most;
                return good ? std::string()
                            : "'" + text + "' is no whole number from 0 to " + std::to_string(most);
            },
            ""};
}

// In place of CLI::IsMember, whose words propose nothing.
CLI::Validator one_of(const std::vector<std::string_view>& words) {
    return CLI::Validator([words](const std::string& word) { return why_no_choice(word, words); },
                          CLI::detail::generate_set(words));
}

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

void add_png(CLI::App& app, PreviewOptions& options) {
    auto* file = app.add_option("--png", options.file,
                                "picture to write: mandrel and bands, the last wound on top")
                     ->type_name("FILE");
    app.add_option("--png-size", options.size, "its size in pixels")
        ->type_name("WxH")
        ->needs(file)
        ->capture_default_str();
    app.add_option("--png-colour", options.colour,
                   "what its colours show: course by course, layers of the wall, slip up to the "
                   "friction, angle to the spindle")
        ->needs(file)
        ->check(one_of({"course", "layers", "slip", "angle"}))
        ->capture_default_str();
}

void add_job(CLI::App& app, JobArguments& job, const char* meaning) {
    app.add_option("--job", job.file, meaning)->type_name("FILE");
    app.add_option("--set", job.settings,
                   "a value over that of the job, as often as wanted: tow.width=8, "
                   "layers.0.angle=55")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}

void add_wind_options(CLI::App& app, WindArguments& options, bool required) {
    auto* mandrel = app.add_option("mandrel", options.mandrel,
                                   "mesh of the part: " + mesh_endings() +
                                       "; or the outline of a body of revolution: .csv or .dxf")
                        ->type_name("FILE");
    if (required) {
        mandrel->required();
    }
    app.add_option("--machine", options.machine,
                   "machine file, JSON: axes, limits, eye, controller")
        ->type_name("FILE")
        ->capture_default_str();
    add_job(app, options.job,
            "job file, JSON: tow, layers, eye rule, tolerances, speed; without it defaults");
    app.add_option("-o,--out", options.out, "output folder")
        ->type_name("DIR")
        ->capture_default_str();
    app.add_option("--effort", options.effort,
                   "how long the plan is improved: 4 takes about 4 times as long as 1, and saves "
                   "fibre; 0.1 is for a first look")
        ->type_name("N")
        ->check(CLI::Range(0.01, 1000.0))
        ->capture_default_str();
    add_png(app, options.png);
}

void add_post(CLI::App& app, PostArguments& options) {
    app.add_option("points", options.points, "table of landing points, CSV; columns below")
        ->type_name("FILE")
        ->required();
    app.add_option("--mandrel", options.mandrel, "mesh of the part")->type_name("FILE")->required();
    app.add_option("--machine", options.machine, "machine file, JSON")
        ->type_name("FILE")
        ->required();
    add_job(app, options.job,
            "job file, JSON: tow, eye rule, extensions, tolerances; its layers are not read; "
            "without it defaults");
    app.add_option("--frame", options.frame,
                   "axes of the table. file: those of the mandrel's file; mandrel: those of "
                   "meshwind's own tables, Z along the spindle, in mm")
        ->check(one_of({"file", "mandrel"}))
        ->capture_default_str();
    app.add_option("--within", options.within_mm,
                   "mm: a point further than this from the mandrel is refused")
        ->type_name("MM")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("-o,--out", options.out, "output folder")
        ->type_name("DIR")
        ->capture_default_str();
    add_png(app, options.png);
}

void add_verify(CLI::App& app, VerifyArguments& options) {
    app.add_option("program", options.program,
                   "NC program, by meshwind or anybody; the machine file names its language")
        ->type_name("FILE")
        ->required();
    app.add_option("--mandrel", options.mandrel, "mesh of the part")->type_name("FILE")->required();
    app.add_option("--machine", options.machine, "machine file")->type_name("FILE")->required();
    add_job(app, options.job,
            "job file: tow, friction, extensions, tolerances; without it the defaults hold");
    app.add_option(
           "--plan", options.plan,
           "folder with path.csv and motion.csv, to compare with at the end; for program-2.ngc "
           "path-2.csv and motion-2.csv")
        ->type_name("DIR");
    app.add_option("--tie-on", options.tie_on,
                   "X,Y,Z in the mandrel frame where the fibre is tied on, if the program does not "
                   "say it")
        ->type_name("X,Y,Z");
    app.add_option("-o,--out", options.out, "folder for verify.json and laid.csv")
        ->type_name("DIR");
}

void add_inspect(CLI::App& app, InspectArguments& options) {
    app.add_option("mandrel", options.mandrel, "mesh of the part")->type_name("FILE")->required();
    add_job(app, options.job,
            "job file: units, axis, regions, ends and blends of the mandrel; without it defaults");
    auto* refine = app.add_option("--refine", options.refine_mm,
                                  "write the winding surface with edges of at most so many mm, new "
                                  "vertices on its curved patches; frame and units of the file")
                       ->type_name("MM");
    app.add_option("-o,--out", options.out, "mesh file to write: .stl, .obj, .ply or .off")
        ->type_name("FILE")
        ->needs(refine);
    app.add_option("--page", options.page, "page to write, .html: the part, by what it is")
        ->type_name("FILE");
}

// What stands for a parameter's value in the help.
std::string name_of_unit(const MakeParameter& parameter) {
    switch (parameter.unit) {
        case MakeUnit::Angle:
            return "DEG";
        case MakeUnit::Ratio:
            return "RATIO";
        default:
            return "MM";
    }
}

// One subcommand per kind, with an option for each of its parameters.
void add_make(CLI::App& app, MakeRequest& request, std::map<std::string, double>& values) {
    app.require_subcommand(1);
    app.fallthrough();
    app.add_option("-o,--out", request.output, "mesh file to write: .stl, .obj, .ply or .off")
        ->type_name("FILE");
    app.add_option("--edge", request.options.edge_mm, "edge length, mm")
        ->type_name("MM")
        ->capture_default_str();
    app.add_flag("--irregular", request.options.irregular,
                 "jittered vertices and random diagonals");
    app.add_flag("--solid", request.options.solid, "with inner wall and end faces");
    app.add_option("--wall", request.options.wall_mm, "wall thickness of a solid, mm")
        ->type_name("MM")
        ->capture_default_str();
    for (const MakeKind& kind : make_kinds()) {
        CLI::App* sub = app.add_subcommand(std::string(kind.name), std::string(kind.meaning));
        sub->fallthrough();
        for (const MakeParameter& parameter : kind.parameters) {
            const std::string name(parameter.name);
            sub->add_option_function<double>(
                   "--" + name, [&values, name](const double& value) { values[name] = value; },
                   help_of(parameter))
                ->type_name(name_of_unit(parameter));
        }
    }
}

CLI::Option* add_trace(CLI::App& app, TraceArguments& text) {
    app.add_option("mandrel", text.mandrel, "mesh of the part")->type_name("FILE")->required();
    app.add_option("--start", text.start, "X,Y,Z in the file's frame; snapped to the surface")
        ->type_name("X,Y,Z")
        ->required();
    auto* direction = app.add_option("--direction", text.direction, "X,Y,Z in the file's frame")
                          ->type_name("X,Y,Z");
    auto* angle =
        app.add_option("--angle", text.angle_deg,
                       "degrees from the local axial direction, counter-clockwise from outside")
            ->type_name("DEG");
    direction->excludes(angle);
    auto* to = app.add_option("--to", text.to,
                              "X,Y,Z where the path ends, instead of a direction: its start angle "
                              "is found")
                   ->type_name("X,Y,Z");
    to->excludes(direction)->excludes(angle);
    app.add_option("--lambda", text.request.slip_ratio, "slip ratio kg / kn to steer with")
        ->type_name("RATIO")
        ->capture_default_str();
    auto* length =
        app.add_option("--length", text.request.length_mm, "longest path, mm")->type_name("MM");
    length->capture_default_str()->excludes(to);
    app.add_option("--method", text.method,
                   "patches: solved on curved patches, accurate; walk: over the facets, fast")
        ->check(one_of({"patches", "walk"}))
        ->capture_default_str();
    app.add_option("--frame", text.frame, "frame of the output")
        ->check(one_of({"mandrel", "file"}))
        ->capture_default_str();
    app.add_option("-o,--out", text.out, "table to write")->type_name("FILE")->required();
    return angle;
}

void add_mesh_size(CLI::App& app, StudyArguments& request) {
    MeshSizeOptions& options = request.options;
    request.out = "study-mesh-size";
    app.add_option(
           "--mandrel", request.mandrels,
           "cylinder, torus, ellipsoid, tee, or a mesh file; several may be named [all four]")
        ->type_name("NAME");
    app.add_option("--radius", request.radii_mm, "radii of the cylinders, mm")
        ->type_name("MM")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--edges", options.edges_mm, "edge lengths of the meshes, mm")
        ->type_name("MM")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--lambda", options.slip_ratios,
                   "slip ratios kg / kn to steer with; the eye is shown for the first")
        ->type_name("RATIO")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--paths", options.paths, "fibres on each mesh")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--length", options.length_mm, "length of a fibre unless it meets a rim, mm")
        ->type_name("MM")
        ->capture_default_str();
    app.add_option("--free-length", options.free_length_mm, "from landing point to eye, mm")
        ->type_name("MM")
        ->capture_default_str();
    app.add_flag("--irregular,!--regular", options.irregular,
                 "jittered vertices and random diagonals, as scans and CAD give them [irregular]");
    app.add_flag("--timing", options.timing,
                 "measure the cost of tracing too, one mesh at a time; writes timing.csv");
    app.add_option("-o,--out", request.out, "output folder")
        ->type_name("DIR")
        ->capture_default_str();
}

void add_carry(CLI::App& app, CarryArguments& text) {
    CarryRequest& request = text.request;
    app.add_option("axis", text.axis,
                   "table of points along the frame's axis, CSV, columns below; or the frame's "
                   "mesh: .stl, .obj, .ply, .off")
        ->type_name("FILE")
        ->required();
    app.add_flag("--from-end", text.from_the_end, "of a mesh: begin at its other end");
    app.add_option("--bend-turn", text.bend_turn_deg,
                   "of a mesh: turn of the frame about its axis over each bend, degrees")
        ->type_name("DEG")
        ->capture_default_str();
    app.add_option("--machine", text.machine,
                   "machine file, JSON: a robot whose eye stands still, in the head's centre")
        ->type_name("FILE")
        ->capture_default_str();
    app.add_option("--tool", text.tool,
                   "X,Y,Z,A,B,C of the table's coordinates on the robot's flange, mm and degrees")
        ->type_name("X,Y,Z,A,B,C")
        ->capture_default_str();
    const auto number = [&](const char* name, const char* unit, double& value, const char* help) {
        app.add_option(name, value, help)->type_name(unit)->capture_default_str();
    };
    number("--speed", "MM/S", request.speed_mm_s, "speed of the frame through the head, mm/s");
    number("--tolerance", "MM", request.tolerance_mm,
           "how far the axis may be off the head's centre, mm");
    number("--tolerance-angle", "DEG", request.tolerance_deg,
           "how far the frame's turn may be off, degrees");
    app.add_option("--tube-radius", request.tube_radius_mm,
                   "radius of the frame's tube, mm; without it that of the mesh, or 20")
        ->type_name("MM");
    number("--ring-radius", "MM", request.ring_radius_mm, "radius of the rings' clear opening, mm");
    number("--ring-distance", "MM", request.ring_distance_mm, "distance between the two rings, mm");
    number("--clearance", "MM", request.clearance_mm,
           "distance to keep between the frame and the bodies on the machine's base, mm");
    number("--angle", "DEG", request.angle_deg,
           "wanted angle of the rings' fibres from the axis, degrees");
    app.add_option("--tows", request.tows, "tows on each ring")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--tow-width", request.tow_width_mm,
                   "mm; without it the narrowest that covers the tube in one pass")
        ->type_name("MM");
    CarryWindingOptions& winding = request.winding;
    app.add_option("--passes", winding.passes,
                   "passes of each ring; 0: as few as cover the tube with tows of that width")
        ->type_name("N")
        ->check(CLI::Range(0, 100))
        ->capture_default_str();
    app.add_flag("--at-once", winding.at_once,
                 "both rings wind on the way forth, instead of one on each way");
    app.add_option("--spool-radius", winding.spool_radius_mm,
                   "radius of the circle where fibres leave a ring, mm; without it its opening")
        ->type_name("MM");
    number("--angle-tolerance", "DEG", winding.angle_tolerance_deg,
           "how far laid fibre may be off the angle on regular arms, degrees");
    app.add_option("--friction", winding.friction,
                   "of fibre on the tube: no more may be needed; without it the need is told")
        ->type_name("RATIO");
    app.add_option("--tow-tex", winding.tow_tex, "mass of the tow, g per km, to tell the fibre's")
        ->type_name("TEX");
    app.add_option("--name", request.name, "name of the program")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("-o,--out", text.out, "output folder")->type_name("DIR")->capture_default_str();
}

// The moduli are one ply, all three of them.
void add_design_vessel(CLI::App& app, DesignRequest& request) {
    VesselDesign& design = request.design;
    const auto number = [&](const char* name, const char* unit, double& value, const char* help) {
        app.add_option(name, value, help)->type_name(unit)->capture_default_str();
    };
    app.add_option("--radius", design.radius_mm, "radius of the cylinder, mm")
        ->type_name("MM")
        ->required();
    app.add_option("--opening", design.opening_radius_mm, "radius of the polar openings, mm")
        ->type_name("MM")
        ->required();
    app.add_option("--length", design.cylinder_length_mm, "length of the cylinder, mm")
        ->type_name("MM")
        ->required();
    auto* ke = app.add_option("--ke", request.ke,
                              "E2 (1 + nu12) / (E1 (1 + nu21)) of the ply; 0: fibres alone [0.1]")
                   ->type_name("RATIO");
    const auto modulus = [&](const char* name, const char* unit, double PlyStiffness::*member,
                             const char* help) {
        return app
            .add_option_function<double>(
                name,
                [&request, member](const double& value) {
                    request.ply = request.ply.value_or(PlyStiffness{});
                    (*request.ply).*member = value;
                },
                help)
            ->type_name(unit)
            ->excludes(ke);
    };
    auto* e1 = modulus("--e1", "GPA", &PlyStiffness::e1_gpa, "stiffness along the fibres, GPa");
    auto* e2 = modulus("--e2", "GPA", &PlyStiffness::e2_gpa, "stiffness across them, GPa");
    auto* nu12 =
        modulus("--nu12", "RATIO", &PlyStiffness::nu12, "Poisson's ratio for a pull along them");
    e1->needs(e2)->needs(nu12);
    e2->needs(e1);
    nu12->needs(e1);
    number("--design-radius", "MM", design.design_radius_mm,
           "Clairaut radius of the geodesics the domes are made for, mm; 0: the opening's");
    request.angles_deg = {10, 15, 20, 25, 30, 35, 40, 45, 50, 55};
    app.add_option("--angles", request.angles_deg, "winding angles on the cylinder, degrees")
        ->type_name("DEG")
        ->delimiter(',')
        ->capture_default_str();
    number("--band", "MM", design.band_mm, "width of the band, mm");
    number("--thickness", "MM", design.ply_mm, "thickness of the band, mm");
    number("--density", "KG/M3", design.density_kg_m3, "of the band, kg/m3");
    app.add_option("--wall", design.wall_mm, "wanted thickness on the cylinder, mm")
        ->type_name("MM");
    app.add_option("--pressure", design.pressure_mpa, "wanted pressure, MPa; needs --strength")
        ->type_name("MPA");
    app.add_option("--strength", design.strength_mpa,
                   "of the band along its fibres, MPa, safety taken off")
        ->type_name("MPA");
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
    ValidateArguments validate_options;
    CLI::App* validate = app.add_subcommand("validate", "check a machine or job file");
    validate->add_option("file", validate_options.file, "JSON file")->type_name("FILE");
    validate
        ->add_option("--schema", validate_options.schema,
                     "print the JSON Schema of job or machine files instead")
        ->expected(0, 1)
        ->default_str(kJobSchema)
        ->check(one_of({kJobSchema, kMachineSchema}));
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
    CLI::App* study = app.add_subcommand("study", "studies of accuracy");
    study->require_subcommand(1);
    CLI::App* mesh_size =
        study->add_subcommand("mesh-size", "accuracy of paths and motion against mesh size");
    add_mesh_size(*mesh_size, study_request);
    app.footer(kMainHelp);
    for (CLI::App* command : {design, study}) {
        command->fallthrough();
        command->footer(std::string("\n") + kCommonHelp);
    }
    for (const auto& [command, more] : {std::pair(wind_command, kWindHelp),
                                        {post_command, kPostHelp},
                                        {verify_command, kVerifyHelp},
                                        {inspect, kInspectHelp},
                                        {make, kMakeHelp},
                                        {trace_command, kTraceHelp},
                                        {validate, kValidateHelp},
                                        {carry, kCarryHelp},
                                        {design_vessel, kDesignHelp},
                                        {mesh_size, kMeshSizeHelp}}) {
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
    if (!app.get_subcommands().empty() && !wind_options.mandrel.empty()) {
        throw usage_error(command_words(app), arguments,
                          "'" + wind_options.mandrel + "' is one argument too many");
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
