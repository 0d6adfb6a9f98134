#include "cli/options.h"

#include <charconv>

#include "cli/usage.h"
#include "mesh/io/import.h"
#include "report/shell/decks.h"

namespace meshwind {
namespace {

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

void add_settings(CLI::App& app, JobArguments& job) {
    app.add_option("--profile", job.profiles,
                   "a material or process, as often as wanted: a file with keys of a job, for what "
                   "the job leaves out; meshwind profiles lists those that come along")
        ->type_name("FILE")
        ->allow_extra_args(false);
    app.add_option("--set", job.settings,
                   "a value over that of the job, as often as wanted: tow.width=8, "
                   "layers.0.angle=55")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}

void add_job(CLI::App& app, JobArguments& job, const char* meaning) {
    app.add_option("--job", job.file, meaning)->type_name("FILE");
    add_settings(app, job);
}

void add_effort(CLI::App& app, double& effort) {
    app.add_option("--effort", effort,
                   "how long the plan is improved: 4 takes about 4 times as long as 1, and saves "
                   "fibre; 0.1 is for a first look")
        ->type_name("N")
        ->check(CLI::Range(0.01, 1000.0))
        ->capture_default_str();
}

void add_case_table(CLI::App& app, CaseArguments& arguments) {
    app.add_option("table", arguments.table,
                   "CSV: columns id, mandrel, and machine, job or a job's keys")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--out", arguments.out, "folder of all cases")
        ->type_name("DIR")
        ->capture_default_str();
}

void add_shell(CLI::App& app, ShellArguments& arguments) {
    app.add_option("run", arguments.run, "output folder of a run, or its layup.json")
        ->type_name("DIR")
        ->capture_default_str();
    app.add_option("--material", arguments.material,
                   "material file, JSON: ply with strengths, matrix, liner")
        ->type_name("FILE")
        ->capture_default_str();
    ShellLoads& loads = arguments.request.loads;
    app.add_option_function<double>(
           "--pressure",
           [&arguments](const double& value) {
               arguments.request.loads.pressure_mpa = value;
               arguments.pressure_given = true;
           },
           "inside, on the wall and on lids over its rims, MPa; 1 where there is no other load")
        ->type_name("MPA");
    app.add_option("--axial", loads.axial_n, "tension between two rims, N")->type_name("N");
    app.add_option("--moment", arguments.moment,
                   "between two rims, N mm: bending or twisting by its direction")
        ->type_name("X,Y,Z");
    app.add_option("--rims", arguments.rims,
                   "the two rims that are pulled at; without it the two that face away from each "
                   "other")
        ->type_name("N")
        ->delimiter(',');
    app.add_option("--merge", arguments.request.merge_deg,
                   "plies of one layer within this angle are computed as one, degrees")
        ->type_name("DEG")
        ->check(CLI::Range(0.0, 90.0))
        ->capture_default_str();
    app.add_option("--plies", arguments.request.most_plies,
                   "most plies of an element; the nearest angles of more are merged")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
}

// Where they are not given the head of the program names them.
void add_named_by_head(CLI::App& app, std::string& mandrel, std::string& machine) {
    app.add_option("--mandrel", mandrel,
                   "mesh of the part; without it the one that the program's head names, beside the "
                   "program, in the folder above or in this one")
        ->type_name("FILE");
    app.add_option("--machine", machine, "machine file; without it as --mandrel")
        ->type_name("FILE");
}

void add_program(CLI::App& app, ProgramArguments& options) {
    app.add_option("program", options.program,
                   "NC program, by meshwind or anybody; the machine file names its language")
        ->type_name("FILE")
        ->required();
    add_named_by_head(app, options.mandrel, options.machine);
    add_job(app, options.job,
            "job file: tow, friction, extensions, tolerances; without it the job in the program's "
            "head, else the defaults");
    app.add_option("--tie-on", options.tie_on,
                   "X,Y,Z where the fibre is tied on, if the program does not say it")
        ->type_name("X,Y,Z");
    app.add_option("--frame", options.frame,
                   "axes of --tie-on. mandrel: Z along the spindle, in mm; file: those of the "
                   "mandrel's file, in its unit")
        ->check(one_of({"file", "mandrel"}))
        ->capture_default_str();
}

}  // namespace

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

CLI::Validator one_of(const std::vector<std::string_view>& words) {
    return CLI::Validator([words](const std::string& word) { return why_no_choice(word, words); },
                          CLI::detail::generate_set(words));
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
    add_effort(app, options.effort);
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
    auto* circuits = app.add_option("--circuits", options.circuits,
                                    "wind the table so many times, turned on each time")
                         ->type_name("N")
                         ->check(CLI::Range(1, 100'000))
                         ->capture_default_str();
    app.add_option("--turn", options.turn_deg,
                   "degrees about the spindle from one circuit to the next")
        ->type_name("DEG")
        ->needs(circuits);
    app.add_option("--smooth", options.smooth_mm,
                   "mm that the fibre may pass by a point so that it runs smoothly; without it "
                   "through all of them")
        ->type_name("MM")
        ->check(CLI::PositiveNumber);
    app.add_option("-o,--out", options.out, "output folder")
        ->type_name("DIR")
        ->capture_default_str();
    add_png(app, options.png);
}

void add_resume(CLI::App& app, ResumeArguments& options) {
    add_program(app, options);
    auto* block = app.add_option("--block", options.block,
                                 "the last block that has been run, counted from 1");
    auto* line =
        app.add_option("--line", options.line, "the same by its line in the program's text");
    block->type_name("N")->excludes(line);
    line->type_name("N");
    app.add_option("-o,--out", options.out,
                   "program to write; without it resume_ and the program's name, beside it")
        ->type_name("FILE");
}

void add_verify(CLI::App& app, VerifyArguments& options) {
    add_program(app, options);
    app.add_option(
           "--plan", options.plan,
           "folder with path.csv and motion.csv, to compare with at the end; for program-2.ngc "
           "path-2.csv and motion-2.csv")
        ->type_name("DIR");
    app.add_option("-o,--out", options.out,
                   "folder for verify.json, laid.csv and verify.html, the page")
        ->type_name("DIR");
}

void add_dry_run(CLI::App& app, DryRunArguments& options) {
    add_program(app, options);
    app.add_option("--clearance", options.clearance_mm,
                   "mm that the head stays off the part, its extensions and bodies")
        ->type_name("MM")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("-o,--out", options.out,
                   "program to write; without it air_PROGRAM beside the program")
        ->type_name("FILE");
}

void add_repeat(CLI::App& app, RepeatArguments& options) {
    app.add_option("program", options.program, "NC program that the main job has made")
        ->type_name("FILE")
        ->required();
    add_named_by_head(app, options.mandrel, options.machine);
    add_settings(app, options.job);
    app.add_option("-o,--out", options.out, "output folder")
        ->type_name("DIR")
        ->capture_default_str();
    add_png(app, options.png);
}

void add_show(CLI::App& app, ShowArguments& options) {
    app.add_option("what", options.what, "output folder of a run, NC program, or mesh of a part")
        ->type_name("FILE")
        ->required();
    add_named_by_head(app, options.program.mandrel, options.program.machine);
    app.add_option("-o,--out", options.out,
                   "page to write; without it a name like that of the file, in this folder")
        ->type_name("FILE");
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

void add_trace(CLI::App& app, TraceArguments& text) {
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
}

void add_validate(CLI::App& app, ValidateArguments& options) {
    app.add_option("file", options.file, "JSON file")->type_name("FILE");
    app.add_option("--schema", options.schema,
                   "print the JSON Schema of job or machine files instead, or of the results "
                   "report.json and layup.json")
        ->expected(0, 1)
        ->default_str(kJobSchema)
        ->check(one_of({kJobSchema, kMachineSchema, kReportSchema, kLayupSchema}));
}

void add_case(CLI::App& app, CaseArguments& arguments) {
    add_case_table(app, arguments);
    app.add_option("--row", arguments.row, "which one to wind, from 1")->type_name("N")->required();
    add_effort(app, arguments.effort);
}

void add_merge(CLI::App& app, CaseArguments& arguments) {
    add_case_table(app, arguments);
    app.add_flag("--left", arguments.left,
                 "only print the rows that failed or are missing, 3,7: an array of jobs");
}

void add_export_fe(CLI::App& app, ShellArguments& arguments) {
    add_shell(app, arguments);
    std::vector<std::string_view> names;
    for (const DeckFormat& format : deck_formats()) {
        names.push_back(format.name);
    }
    app.add_option("--format", arguments.format, "program that the deck is for")
        ->check(one_of(names))
        ->capture_default_str();
    app.add_option("-o,--out", arguments.out, "deck to write [wall.inp or wall.bdf]")
        ->type_name("FILE");
}

void add_strength(CLI::App& app, ShellArguments& arguments) {
    add_shell(app, arguments);
    app.add_option("-o,--out", arguments.out, "folder to write [meshwind-strength]")
        ->type_name("DIR");
}

}  // namespace meshwind
