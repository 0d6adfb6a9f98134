#include "pipeline/wind.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "core/counted.h"
#include "core/error.h"
#include "core/text/digest.h"
#include "core/text/text_number.h"
#include "core/version.h"
#include "machines/eye_inverse.h"
#include "mesh/io/export.h"
#include "mesh/mandrel/thicken.h"
#include "mesh/revolution/revolution.h"
#include "pipeline/before_planning.h"
#include "pipeline/check_controller.h"
#include "pipeline/code_digest.h"
#include "pipeline/part_words.h"
#include "pipeline/run_names.h"
#include "postproc/verify/check_kinds.h"
#include "winding/laminate/build_up.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

class Stopwatch {
public:
    Stopwatch(std::map<std::string, double>& timing, double reading_s)
        : timing_(timing), reading_s_(reading_s) {
        timing_["import"] = reading_s;
    }

    // Adds the time since the last call to a stage.
    void stage(const std::string& name) {
        const auto now = std::chrono::steady_clock::now();
        timing_[name] += std::chrono::duration<double>(now - last_).count();
        timing_["total"] = reading_s_ + std::chrono::duration<double>(now - first_).count();
        last_ = now;
    }

private:
    std::map<std::string, double>& timing_;
    double reading_s_;
    std::chrono::steady_clock::time_point first_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_ = first_;
};

[[noreturn]] void not_offered(const fs::path& job, const std::string& pointer,
                              const std::string& value, const std::string& mend) {
    throw InputError("job.not_offered", job.string() + ": " + pointer,
                     value + " is not offered yet; " + mend);
}

// The landing points to wind: those of the caller, or of the job's layer.
std::optional<ImportRequest> import_of(const WindOptions& options, const LayerJob& layer) {
    if (options.import || layer.kind != LayerKind::Imported) {
        return options.import;
    }
    return ImportRequest{.points = layer.points};
}

void refuse_layers_not_offered(const Job& job, const fs::path& file) {
    if (job.eye.lengths.empty()) {
        return;
    }
    if (job.layers.size() > 1) {
        not_offered(file, "/eye/lengths", "a free length by stretches for several layers",
                    "give one layer");
    }
    if (job.layers.front().kind != LayerKind::Imported) {
        not_offered(file, "/eye/lengths",
                    "a free length by stretches of fibre that is yet to be planned",
                    "plan without it, then give path.csv and this job to meshwind post");
    }
}

void refuse_turns_not_offered(const Job& job, const fs::path& file, bool read_layers) {
    const TurnKindTraits& turn = traits_of(job.mandrel.turn);
    const std::string why_not =
        turn.why_not != nullptr ? turn.why_not(job, !read_layers) : std::string();
    if (!why_not.empty()) {
        throw InputError("job.not_offered", file.string() + ": /mandrel/turn", why_not);
    }
}

// What the job may ask for but this version does not do is refused at once, in words. Where landing
// points are given the layers are not read.
void refuse_what_is_not_offered(const Job& job, const fs::path& file, bool read_layers) {
    refuse_turns_not_offered(job, file, read_layers);
    if (read_layers) {
        refuse_layers_not_offered(job, file);
    }
}

// A job that says nothing gets the best that the machine can do; one that asks for a turn that the
// machine cannot choose is refused.
void refuse_turns_not_free(const Job& job, const fs::path& file, const Machine& machine) {
    const bool asks =
        job.redundancy == RedundancyRule::Hold || job.redundancy == RedundancyRule::Oscillate;
    if (asks && !machine_class(machine).free_turn) {
        throw InputError("job.turn_forced", file.string() + ": /redundancy",
                         machine.name +
                             " has fewer than three linear axes, so that the place of "
                             "the eye says how the mandrel turns; remove "
                             "\"redundancy\"");
    }
}

std::string layer_words(std::size_t layer) {
    return "layer " + std::to_string(layer + 1);
}

std::string mesh_digest(const Mandrel& mandrel) {
    return short_digest(mesh_file_bytes(mandrel.whole, MeshFormat::Obj));
}

// What no plan can change is refused before there is one. \return what may be meant otherwise
std::vector<std::string> look_ahead(const Setup& setup, const WindOptions& options) {
    const InputFiles& files = options.files;
    check_controller(setup.machine, files.machine);
    refuse_what_is_not_offered(setup.job, files.job, !options.import);
    const EyeLaw& eye = setup.job.eye;
    require_main_job(setup.machine, eye.rule == EyeRule::Cylinder ? eye.radius_mm : 0.0);
    refuse_turns_not_free(setup.job, files.job, setup.machine);
    if (options.import) {
        return {};
    }
    for (std::size_t i = 0; i < setup.job.layers.size(); ++i) {
        if (setup.job.layers[i].kind == LayerKind::Wall) {
            require_wall(setup.mandrel, setup.job, i, files.job);
        }
    }
    const PlannedTask task{setup.machine, setup.envelope, setup.mandrel,
                           setup.job,     files.machine,  files.job};
    require_can_be_wound(task);
    std::vector<std::string> remarks = remarks_before_planning(task);
    for (const std::string& remark : remarks) {
        options.context.report_remark(remark);
    }
    return remarks;
}

// What the programs' heads say, and what the same run needs. The setup's job is what became of the
// job on this machine.
ProgramHeader header_of(const Setup& setup, Job job, const WindOptions& options) {
    ProgramHeader header;
    header.version = kVersion;
    header.mandrel = setup.mandrel.file;
    header.mandrel_digest =
        options.mandrel_digest.empty() ? mesh_digest(setup.mandrel) : options.mandrel_digest;
    header.job_digest = job_digest(setup.job);
    job.mandrel.units = setup.job.mandrel.units;
    header.job = told_job_text(job);
    if (options.files.machine != InputFiles{}.machine) {
        header.machine_file = options.files.machine.filename().string();
    }
    if (!options.import) {
        header.run = MainJobRun{setup.mandrel.file, options.context.seed, options.context.effort};
    }
    return header;
}

// A run as far as its layers are wound.
struct RunSoFar {
    Run run{};
    ProgramHeader header{};          // of the layer that is wound
    std::size_t job_layer = 0;       // of the job, that is wound
    std::optional<WallStages> wall;  // while that is one
};

// Sets the job of the last layer; a wall is begun where that asks for one.
// \return the wall's next stage
std::optional<StageAsk> next_stage(const WindOptions& options, RunSoFar& so_far) {
    const std::size_t number = so_far.run.layers.size() - 1;
    WoundLayer& layer = so_far.run.layers.back();
    std::optional<WallStages>& wall = so_far.wall;
    layer.job = layer.setup.job.layers[so_far.job_layer];
    if (layer.job.kind == LayerKind::Wall && !wall) {
        wall.emplace(layer.setup.mandrel, layer.setup.job, so_far.job_layer, options.context.seed,
                     options.files.job);
        so_far.run.walls.push_back({number, number, wall->figures(), wall->asked_of_faces()});
    }
    return wall ? std::optional(wall->next()) : std::nullopt;
}

// Sum of what each layer adds at most.
double most_build_up_mm(const std::vector<WoundLayer>& layers) {
    double sum_mm = 0.0;
    for (const WoundLayer& layer : layers) {
        sum_mm += layer.build_up_mm.empty()
                      ? 0.0
                      : *std::max_element(layer.build_up_mm.begin(), layer.build_up_mm.end());
    }
    return sum_mm;
}

// \param stage of a wall; both are kept
WindLayerOptions options_of_layer(const WindOptions& options, const RunSoFar& so_far,
                                  const std::optional<StageAsk>& stage) {
    const std::vector<WoundLayer>& layers = so_far.run.layers;
    const std::size_t number = layers.size() - 1;
    const WoundLayer& layer = layers.back();
    WindLayerOptions of_layer;
    of_layer.stage = stage ? &*stage : nullptr;
    of_layer.suffix = layer_suffix(number);
    of_layer.header = so_far.header;
    of_layer.import = import_of(options, layer.job);
    if (number > 0) {
        of_layer.before = &layers[number - 1];
        of_layer.bare = &layers.front().setup.mandrel;
        of_layer.build_up_mm = most_build_up_mm(layers);
    }
    of_layer.context = options.context;
    if (layer.setup.job.layers.size() > 1 || stage) {
        of_layer.context.progress = [&options, number](const std::string& step, double share) {
            options.context.report_progress(layer_words(number) + ", " + step, share);
        };
    }
    of_layer.least_covered = number == 0 ? options.least_covered : 0.0;
    of_layer.least_joined = number == 0 ? options.least_joined : 0.0;
    of_layer.patterns_first = number == 0 && options.patterns_first;
    return of_layer;
}

// Of a wall that cannot be finished, what of it can be wound.
std::string stages_so_far(const std::optional<WallStages>& wall) {
    return !wall || wall->stages() == 0
               ? std::string()
               : "; the " + counted(wall->stages(), "stage") + " before can be wound, which are " +
                     fixed(wall->layers_so_far(), 1) + " layers of the wall";
}

void end_wall(RunSoFar& so_far) {
    Run& run = so_far.run;
    const WoundWall& wall = run.walls.back();
    const double most_below = run.layers.back().setup.job.tolerance.bare;
    Check& check = run.checks.emplace_back(wall_check(wall.figures, most_below));
    check.name += layer_suffix(wall.first);
    so_far.wall.reset();
}

// A wall is laid but for a few places, for which there are no courses. What is next in the job lies
// on the same mandrel. \return whether there is something
bool give_up_stage(RunSoFar& so_far) {
    Run& run = so_far.run;
    end_wall(so_far);
    ++so_far.job_layer;
    run.complete = so_far.job_layer == run.layers.front().setup.job.layers.size();
    WoundLayer again;
    again.setup = std::move(run.layers.back().setup);
    run.layers.pop_back();
    if (!run.complete) {
        run.layers.push_back(std::move(again));
    }
    return !run.complete;
}

// What lies there now, and the wall's check where that was the last stage.
void end_stage(const WoundLayer& layer, std::size_t number, RunSoFar& so_far) {
    so_far.wall->enter(layer.setup.mandrel.surface, layer.plan);
    WoundWall& wall = so_far.run.walls.back();
    wall.last = number;
    wall.figures = so_far.wall->figures();
    if (so_far.wall->done()) {
        end_wall(so_far);
    }
}

// What may help where little of the bare mandrel is covered.
void propose_mends(const WoundLayer& layer, const RunContext& context,
                   std::vector<std::string>& remarks) {
    if (layer.plan.failure.empty() && layer.plan.coverage.fraction >= kCoveredShare) {
        return;
    }
    const std::size_t told = remarks.size();
    propose_blend(layer.setup.mandrel, layer.setup.job.tow.width_mm, remarks);
    for (std::size_t i = told; i < remarks.size(); ++i) {
        context.report_remark(remarks[i]);
    }
}

// Those of a layer, as the run has them.
void add_checks(const WoundLayer& layer, std::size_t number, std::vector<Check>& checks) {
    for (Check check : layer.checks) {
        check.name += layer_suffix(number);
        if (check.place) {
            check.place->layer = number;
        }
        checks.push_back(std::move(check));
    }
}

std::vector<double> build_up_of(const WoundLayer& layer) {
    const Surface& surface = layer.setup.mandrel.surface;
    const Job::TowJob& tow = layer.setup.job.tow;
    if (layer.plan.planner == Planner::Pattern) {
        const RevolutionFinding found = find_revolution(layer.setup.mandrel);
        if (found.body) {
            return regular_build_up_mm(surface, *found.body, layer.plan.pieces, tow.width_mm,
                                       tow.thickness_mm);
        }
    }
    return build_up_mm(surface, layer.plan.face_layers, tow.width_mm, tow.thickness_mm);
}

// The mandrel with the last layer on it, for the next one. \param number of that
// \return whether there is such a mandrel
bool grow_next(std::size_t number, Stopwatch& watch, RunSoFar& so_far) {
    Run& run = so_far.run;
    const WoundLayer& layer = run.layers.back();
    const Setup& setup = layer.setup;
    WoundLayer next;
    try {
        next.setup = setup_for(setup, thicken(setup.mandrel, layer.build_up_mm), number);
    } catch (const InputError& error) {
        Check& check = run.checks.emplace_back(
            check_kind::kPlan, false,
            layer_words(number) + ": " + error.what() + stages_so_far(so_far.wall));
        check.name += layer_suffix(number);
        return false;
    }
    so_far.header.mandrel = grown_mandrel_name(number);
    so_far.header.mandrel_digest = mesh_digest(next.setup.mandrel);
    run.layers.push_back(std::move(next));
    watch.stage("import");
    return true;
}

// Goes on in the job behind a layer that was wound. \return whether there is something to wind
bool go_on(std::size_t number, Stopwatch& watch, RunSoFar& so_far) {
    Run& run = so_far.run;
    WoundLayer& layer = run.layers.back();
    if (so_far.wall) {
        end_stage(layer, number, so_far);
    }
    so_far.job_layer += so_far.wall ? 0 : 1;
    run.complete = so_far.job_layer == layer.setup.job.layers.size();
    if (run.complete && number == 0) {
        return false;
    }
    layer.build_up_mm = build_up_of(layer);
    return !run.complete && grow_next(number + 1, watch, so_far);
}

// Winds the last layer that is there, a layer of the job or a stage of its wall; adds the next one
// where there is one and this one can be wound on. \return whether one was added
bool wind_next(const WindOptions& options, Stopwatch& watch, RunSoFar& so_far) {
    Run& run = so_far.run;
    const std::size_t number = run.layers.size() - 1;
    WoundLayer& layer = run.layers.back();
    const std::optional<StageAsk> stage = next_stage(options, so_far);
    WindLayerOptions of_layer = options_of_layer(options, so_far, stage);
    of_layer.stage_done = [&watch](const char* name) { watch.stage(name); };
    wind_layer(layer, of_layer);
    const bool failed = !layer.plan.failure.empty();
    if (failed && so_far.wall && so_far.wall->laid()) {
        return give_up_stage(so_far);
    }
    if (failed) {
        layer.checks.back().words += stages_so_far(so_far.wall);
    }
    if (number == 0 && !options.import) {
        propose_mends(layer, options.context, run.remarks);
    }
    add_checks(layer, number, run.checks);
    return !failed && !options.import && go_on(number, watch, so_far);
}

}  // namespace

bool Run::planned() const {
    for (const WoundLayer& layer : layers) {
        if (!layer.plan.failure.empty()) {
            return false;
        }
    }
    return layers.back().import || complete;
}

Run wind(Mandrel mandrel, const Machine& machine, const Job& job, const WindOptions& options) {
    RunSoFar so_far;
    Run& run = so_far.run;
    Stopwatch watch(run.timing_s, options.reading_s);
    run.seed = options.context.seed;
    run.effort = options.context.effort;
    WoundLayer& first = run.layers.emplace_back();
    first.setup = make_setup(std::move(mandrel), machine, job, options.files,
                             [&](const Setup& setup) { run.remarks = look_ahead(setup, options); });
    so_far.header = header_of(first.setup, job, options);
    run.job = so_far.header.job;
    watch.stage("import");
    while (wind_next(options, watch, so_far)) {
    }
    run.usable = run.planned() && (run.passed() || options.force);
    return std::move(run);
}

}  // namespace meshwind
